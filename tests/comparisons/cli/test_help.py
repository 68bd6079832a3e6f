"""Help, version, completion and the name of the program."""

import os
import pty
import re
import select
import shlex
import shutil
import signal
import subprocess
import sys

import pytest

from comparisons.cli.main import _COMMANDS, _parser, main
from comparisons.runs import environment


@pytest.mark.parametrize("command", ["", *_COMMANDS])
def test_help_has_examples_that_are_admissible(capsys, command):
    assert main([command, "--help"] if command else ["--help"]) == 0
    examples = re.findall(r"^  (fscm-bench .*)", capsys.readouterr().out.partition("\nexample")[2], re.MULTILINE)
    assert examples
    for words in map(shlex.split, examples):
        if "COMMAND" not in words:
            assert words[1] == command or not command
            _parser(words[1:2]).parse_args(words[1:])


@pytest.mark.parametrize(
    ("shell", "message"), [("fish", "none of bash, zsh, tcsh"), ("bash", "pip install 'fscm-bench[completion]'")]
)
def test_completion_that_is_not_possible_is_one_sentence(capsys, monkeypatch, shell, message):
    monkeypatch.setitem(sys.modules, "shtab", None)
    assert main(["--print-completion", shell]) == 2
    assert message in capsys.readouterr().err


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


@pytest.fixture
def script(request, tmp_path, capsys):
    pytest.importorskip("shtab")
    if shutil.which(request.param) is None:
        pytest.skip(f"{request.param} is not installed")
    assert main(["--print-completion", request.param]) == 0
    (tmp_path / "completion").write_text(capsys.readouterr().out)
    (tmp_path / "zz_own_model.py").touch()
    return tmp_path / "completion"


@pytest.mark.parametrize("script", ["bash"], indirect=True)
def test_bash_completes_with_the_script(script):
    for typed, word in COMPLETED.items():
        words = typed.split()
        line = f"COMP_WORDS=({shlex.join(words)}); COMP_CWORD={len(words) - 1}; $F fscm-bench {words[-1]}"
        program = f"source {script}; F=$(complete -p fscm-bench | sed 's/.*-F \\([^ ]*\\) .*/\\1/'); {line}; "
        program += 'echo "${COMPREPLY[@]}"'
        done = subprocess.run(["bash", "-c", program], capture_output=True, text=True, check=True, cwd=script.parent)
        assert done.stdout.split() == [word]


#: Shell -> its arguments, and what a user has in the file of settings.
INTERACTIVE = {
    "zsh": (
        ["-f", "-i"],
        ["unsetopt zle_bracketed_paste", "autoload -Uz compinit && compinit -u -D", 'eval "$(cat {})"'],
    ),
    "tcsh": (["-f"], ["source {}"]),
}
#: So many seconds without a character mean that the shell waits: a failure, not a measurement.
PATIENCE = 60.0


def read_until(terminal, text):
    screen = ""
    while text not in screen:
        ready, _, _ = select.select([terminal], [], [], PATIENCE)
        assert ready, f"{text!r} is not in {screen!r}"
        screen += os.read(terminal, 4096).decode(errors="replace")


@pytest.mark.parametrize("script", INTERACTIVE, indirect=True)
def test_the_tab_key_on_a_terminal(script, request):
    shell = request.node.callspec.params["script"]
    arguments, settings = INTERACTIVE[shell]
    process, terminal = pty.fork()
    if process == 0:
        os.chdir(script.parent)
        variables = {"PATH": "/usr/bin:/bin", "TERM": "xterm", "HOME": str(script.parent)}
        os.execve(shutil.which(shell), [shell, *arguments], variables)
    try:
        for number, line in enumerate(settings):
            # The shell prints the word without the quotes, so that its echo of the line is not taken for its output.
            os.write(terminal, f"{line.format(script)}\necho done''{number}\n".encode())
            read_until(terminal, f"done{number}")
        for typed, word in COMPLETED.items():
            os.write(terminal, f"{typed}\t".encode())
            read_until(terminal, word.removeprefix(typed.rpartition(" ")[2]))
            # Ctrl-U: an empty line.
            os.write(terminal, b"\x15")
    finally:
        os.kill(process, signal.SIGKILL)
        os.waitpid(process, 0)
        os.close(terminal)


def test_python_m_comparisons_calls_itself_so():
    for arguments, status in (["dance"], 2), (["list", "-h"], 0):
        done = subprocess.run([sys.executable, "-m", "comparisons", *arguments], capture_output=True, text=True)
        assert done.returncode == status
        assert "python -m comparisons" in done.stdout + done.stderr


@pytest.mark.parametrize(
    ("installed", "text"),
    [
        ({"commit": None, "dirty": None}, "1.2"),
        ({"commit": "0123456789abcdef", "dirty": False}, "1.2 (commit 0123456789ab)"),
        ({"commit": "0123456789abcdef", "dirty": True}, "1.2 (commit 0123456789ab, with changes)"),
    ],
)
def test_the_version_states_the_commit_that_pip_recorded(capsys, monkeypatch, installed, text):
    monkeypatch.setattr(environment, "package_version", lambda: "1.2")
    monkeypatch.setattr(environment, "_commit", lambda: installed)
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"fscm-bench {text}\n"
