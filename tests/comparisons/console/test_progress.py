"""Messages and progress bars on a terminal."""

import pandas as pd
import pytest

from comparisons.cli.screen import output, print_lines
from comparisons.console.progress import counting, log, note
from comparisons.output.terminal import rich_table


@pytest.mark.parametrize("write", [log, note, lambda text: output().print(text), lambda text: print_lines([text])])
def test_control_characters_do_not_reach_the_terminal(write, capsys):
    write("fails: \x1b[2J\x1b]0;title\x07 \x9b2K \u202e [red]plain[/] \r gone")
    shown = "".join(capsys.readouterr())
    assert "fails" in shown
    assert "[red]plain[/]" in shown
    assert [character for character in shown if not character.isprintable() and character != "\n"] == []


def test_control_characters_in_a_table_do_not_reach_the_terminal(capsys):
    output().print(rich_table(pd.DataFrame({"model": ["a\x1b[31m"], "reason": ["b\x9bK c"]}), "title \x1b[1m"))
    shown = capsys.readouterr().out
    assert "\\x1b[31m" in shown
    assert "\x1b" not in shown
    assert "\x9b" not in shown


def test_counting_works_without_a_terminal(capsys):
    with counting("computing", 2) as advance:
        advance()
        advance()
    assert capsys.readouterr().err == ""
