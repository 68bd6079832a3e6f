"""Messages and progress bars on a terminal."""

import pandas as pd
import pytest

from comparisons.cli.screen import output, print_lines
from comparisons.console.progress import counting, log, note
from comparisons.output.terminal import rich_table


def print_table(text):
    output().print(rich_table(pd.DataFrame({"reason": [text]}), text))


@pytest.mark.parametrize(
    "write", [log, note, print_table, lambda text: output().print(text), lambda text: print_lines([text])]
)
def test_control_characters_do_not_reach_the_terminal(write, capsys):
    write("fails: \x1b[2J\x1b]0;title\x07 \x9b2K \u202e [red]plain[/] \r gone")
    printed = "".join(capsys.readouterr())
    assert "fails" in printed
    assert "[red]plain[/]" in printed
    assert [character for character in printed if not character.isprintable() and character != "\n"] == []


def test_counting_works_without_a_terminal(capsys):
    with counting("computing", 1) as advance:
        advance()
    assert capsys.readouterr().err == ""
