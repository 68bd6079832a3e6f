"""Help, version, completion and the name of the program."""

import re
import shlex
import subprocess
import sys

import pytest

from comparisons.cli.main import _COMMANDS, _parser, main


@pytest.mark.parametrize("command", ["", *_COMMANDS])
def test_help_has_examples_that_are_admissible(capsys, command):
    assert main([command, "--help"] if command else ["--help"]) == 0
    examples = re.findall(r"^  (fscm-bench .*)", capsys.readouterr().out.partition("\nexample")[2], re.MULTILINE)
    assert examples
    for words in map(shlex.split, examples):
        if "COMMAND" not in words:
            assert words[1] == command or not command
            _parser(words[1:2]).parse_args(words[1:])


@pytest.mark.parametrize(("shell", "word"), [("fish", "tcsh"), ("bash", "pip install 'fscm-bench[completion]'")])
def test_completion_that_is_not_possible_is_one_sentence(capsys, monkeypatch, shell, word):
    monkeypatch.setitem(sys.modules, "shtab", None)
    assert main(["--print-completion", shell]) == 2
    assert word in capsys.readouterr().err


#: What is typed -> the word that the Tab key makes of it.  A model may be a file.
COMPLETED = {
    "fscm-bench leader": "leaderboard",
    "fscm-bench run --ti": "--tier",
    "fscm-bench run --tier qu": "quick",
    "fscm-bench list ga": "gates",
    "fscm-bench solve --quantity jump_in_g": "jump_in_gap",
    "fscm-bench solve --model md-im": "md-improved",
    "fscm-bench solve --model zz_o": "zz_own_model.py",
}


def test_bash_completes_with_the_script(tmp_path, capsys):
    pytest.importorskip("shtab")
    assert main(["--print-completion", "bash"]) == 0
    (tmp_path / "completion").write_text(capsys.readouterr().out)
    (tmp_path / "zz_own_model.py").touch()
    function = "F=$(complete -p fscm-bench | sed 's/.*-F \\([^ ]*\\) .*/\\1/')"
    for typed, word in COMPLETED.items():
        words = typed.split()
        line = f"COMP_WORDS=({shlex.join(words)}); COMP_CWORD={len(words) - 1}; $F fscm-bench {words[-1]}"
        program = f'source ./completion; {function}; {line}; echo "${{COMPREPLY[@]}}"'
        done = subprocess.run(["bash", "-c", program], capture_output=True, text=True, check=True, cwd=tmp_path)
        assert done.stdout.split() == [word]


@pytest.mark.parametrize("shell", ["zsh", "tcsh"])
def test_the_scripts_of_other_shells_have_models_and_quantities(shell, capsys):
    pytest.importorskip("shtab")
    assert main(["--print-completion", shell]) == 0
    script = capsys.readouterr().out
    assert "md-improved" in script
    assert "jump_in_gap" in script


def test_python_m_comparisons_calls_itself_so():
    for arguments, status in (["dance"], 2), (["list", "-h"], 0):
        done = subprocess.run([sys.executable, "-m", "comparisons", *arguments], capture_output=True, text=True)
        assert done.returncode == status
        assert "python -m comparisons" in done.stdout + done.stderr
