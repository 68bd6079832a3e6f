"""Completion in zsh and tcsh: what the Tab key writes on a terminal."""

import os
import pty
import select
import shutil
import signal

import pytest

from comparisons.cli.completion import completion_script
from comparisons.cli.main import _COMMANDS, _parser

#: Shell -> its arguments, and what a user has in the file of settings.
SHELLS = {
    "zsh": (
        ["-f", "-i"],
        ["unsetopt zle_bracketed_paste", "autoload -Uz compinit && compinit -u -D", 'eval "$(cat {})"'],
    ),
    "tcsh": (["-f"], ["source {}"]),
}

#: So many seconds without a character mean that the shell waits: a failure, not a measurement.
PATIENCE = 60.0


class Terminal:
    """A shell on a terminal of its own."""

    def __init__(self, shell, folder):
        arguments, self._settings = SHELLS[shell]
        self._pid, self._file = pty.fork()
        if self._pid == 0:
            os.chdir(folder)
            program = shutil.which(shell)
            os.execve(program, [shell, *arguments], {"PATH": "/usr/bin:/bin", "TERM": "xterm", "HOME": str(folder)})

    def settle(self, script):
        for number, line in enumerate(self._settings):
            self.type(line.format(script) + "\n")
            # The shell prints the word without the quotes, so that its echo of the line is not taken for its output.
            self.type(f"echo done''{number}\n")
            self.wait(f"done{number}")

    def type(self, text):
        os.write(self._file, text.encode())

    def wait(self, text):
        """Read until a text is there."""
        shown = ""
        while text not in shown:
            ready, _, _ = select.select([self._file], [], [], PATIENCE)
            assert ready, f"{text!r} is not in {shown!r}"
            shown += os.read(self._file, 4096).decode(errors="replace")

    def close(self):
        os.kill(self._pid, signal.SIGKILL)
        os.waitpid(self._pid, 0)
        os.close(self._file)


@pytest.fixture(params=SHELLS)
def terminal(request, tmp_path):
    if shutil.which(request.param) is None:
        pytest.skip(f"{request.param} is not installed")
    pytest.importorskip("shtab")
    script = tmp_path / "completion"
    script.write_text(completion_script(_parser(list(_COMMANDS)), request.param))
    (tmp_path / "zz_own_model.py").touch()
    opened = Terminal(request.param, tmp_path)
    yield opened, script
    opened.close()


def test_the_tab_key_completes_commands_options_and_names(terminal):
    opened, script = terminal
    opened.settle(script)
    for typed, completed in {
        "fscm-bench leader": "leaderboard",
        "fscm-bench run --ti": "--tier",
        "fscm-bench run --tier qu": "quick",
        "fscm-bench list ga": "gates",
        "fscm-bench solve --quantity jump_in_g": "jump_in_gap",
        "fscm-bench solve --model md-im": "md-improved",
        # A model may be a file.
        "fscm-bench solve --model zz_o": "zz_own_model.py",
    }.items():
        opened.type(typed + "\t")
        opened.wait(completed.removeprefix(typed.rpartition(" ")[2]))
        # Ctrl-U: an empty line.
        opened.type("\x15")
