"""Help, version, completion and the name of the program."""

import re
import shlex
import subprocess
import sys

import pytest

from comparisons.cli.completion import SHELLS, completion_script
from comparisons.cli.help_text import HelpFormatter
from comparisons.cli.main import _COMMANDS, _keep_negative_numbers, _parser, main
from comparisons.runs import environment


def helped(capsys, command, monkeypatch, columns):
    monkeypatch.setenv("COLUMNS", str(columns))
    assert main([command, "--help"] if command else ["--help"]) == 0
    return capsys.readouterr().out


@pytest.mark.parametrize("columns", [60, 80, 120])
@pytest.mark.parametrize("command", ["", *_COMMANDS])
def test_help_has_an_example_no_markup_and_fits_the_terminal(capsys, monkeypatch, command, columns):
    shown = helped(capsys, command, monkeypatch, columns)
    assert re.search(r"^examples?:\n  fscm-bench", shown, re.MULTILINE)
    assert "`" not in shown
    assert max(map(len, shown.splitlines())) <= columns


@pytest.mark.parametrize("command", _COMMANDS)
def test_the_examples_of_the_help_are_admissible(capsys, monkeypatch, command):
    shown = helped(capsys, command, monkeypatch, 80)
    lines = re.sub(r" \\\n +", " ", shown.partition("example")[2]).splitlines()[1:]
    assert lines
    for line in lines:
        words = shlex.split(line)
        assert words[:2] == ["fscm-bench", command]
        _parser([command]).parse_args(_keep_negative_numbers(words[1:]))


def test_a_long_command_is_folded_between_options():
    lines = HelpFormatter("fscm-bench")._fill_text("  fscm-bench solve --model jkr --n 2 --k 0", 30, "").splitlines()
    assert lines == ["  fscm-bench solve \\", "    --model jkr --n 2 --k 0"]


@pytest.mark.parametrize("shell", SHELLS)
def test_completion_knows_commands_options_and_names(capsys, shell):
    pytest.importorskip("shtab")
    assert main(["--print-completion", shell]) == 0
    script = capsys.readouterr().out
    for word in ("check-model", "--tier", "quick"):
        assert word in script
    if shell != "tcsh":
        assert "md-improved" in script
        assert "jump_out_gap" in script


def test_bash_completes_with_the_script(tmp_path):
    pytest.importorskip("shtab")
    script = tmp_path / "completion.bash"
    script.write_text(completion_script(_parser(list(_COMMANDS)), "bash"))

    def completed(*words):
        line = f"COMP_WORDS=({shlex.join(words)}); COMP_CWORD={len(words) - 1}; $F fscm-bench {words[-1]}"
        program = f"source {script}; F=$(complete -p fscm-bench | sed 's/.*-F \\([^ ]*\\) .*/\\1/'); {line}; "
        done = subprocess.run(
            ["bash", "-c", program + 'echo "${COMPREPLY[@]}"'], capture_output=True, text=True, check=True, cwd=tmp_path
        )
        return done.stdout.split()

    assert completed("fscm-bench", "ru") == ["run"]
    assert completed("fscm-bench", "run", "--tier", "q") == ["quick"]
    assert completed("fscm-bench", "solve", "--model", "md-i") == ["md-improved"]
    assert completed("fscm-bench", "solve", "--quantity", "jump_in_g") == ["jump_in_gap"]
    assert completed("fscm-bench", "list", "ga") == ["gates"]


def test_completion_that_is_not_possible_is_one_sentence(capsys, monkeypatch):
    assert main(["--print-completion", "fish"]) == 2
    assert "none of bash, zsh, tcsh" in capsys.readouterr().err
    monkeypatch.setitem(sys.modules, "shtab", None)
    assert main(["--print-completion", "bash"]) == 2
    assert "pip install 'fscm-bench[completion]'" in capsys.readouterr().err


def test_python_m_comparisons_calls_itself_so():
    done = subprocess.run([sys.executable, "-m", "comparisons", "dance"], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert done.stderr.startswith("python -m comparisons: ")
    assert done.stderr.endswith("see python -m comparisons --help\n")
    done = subprocess.run(
        [sys.executable, "-m", "comparisons", "list", "-h"], capture_output=True, text=True, check=True
    )
    assert done.stdout.startswith("usage: python -m comparisons list")


@pytest.mark.parametrize(
    ("found", "text"),
    [
        ({"commit": None, "dirty": None}, "1.2"),
        ({"commit": "0123456789abcdef", "dirty": False}, "1.2 (commit 0123456789ab)"),
        ({"commit": "0123456789abcdef", "dirty": True}, "1.2 (commit 0123456789ab, with changes)"),
    ],
)
def test_the_version_states_the_commit_that_pip_recorded(capsys, monkeypatch, found, text):
    monkeypatch.setattr(environment, "package_version", lambda: "1.2")
    monkeypatch.setattr(environment, "_clones", lambda digest: iter(()))
    monkeypatch.setattr(environment, "_installed_commit", lambda: found if found["commit"] else None)
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"fscm-bench {text}\n"


def test_the_version_of_a_clone_is_described_by_git(tmp_path, capsys, monkeypatch):
    who = ["-c", "user.name=Test", "-c", "user.email=test@example.org"]

    def git(*arguments):
        return subprocess.run(["git", "-C", tmp_path, *who, *arguments], check=True, capture_output=True, text=True)

    for package in ("fscm", "fem_reference", "comparisons"):
        (tmp_path / package).mkdir()
        (tmp_path / package / "__init__.py").touch()
    git("init", "-q")
    git("add", ".")
    git("commit", "-q", "-m", "first")
    git("tag", "v7")
    monkeypatch.setattr(environment, "package_version", lambda: "7")
    monkeypatch.setattr(environment, "_running_root", lambda: tmp_path)
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == "fscm-bench 7 (commit v7)\n"
    (tmp_path / "fscm" / "__init__.py").write_text("x = 1\n")
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == "fscm-bench 7 (commit v7, with changes)\n"
