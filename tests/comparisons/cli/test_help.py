"""Help and the name of the program."""

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


def test_python_m_comparisons_calls_itself_so():
    for arguments, status in (["dance"], 2), (["list", "-h"], 0):
        done = subprocess.run([sys.executable, "-m", "comparisons", *arguments], capture_output=True, text=True)
        assert done.returncode == status
        assert "python -m comparisons" in done.stdout + done.stderr
