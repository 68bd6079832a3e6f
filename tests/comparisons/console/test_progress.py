"""Time left of a computation: it only falls."""

import math

import pandas as pd
import pytest
from rich.progress import Progress

from comparisons.cli.screen import output, print_lines
from comparisons.console.progress import _TimeLeft, counting, log, note
from comparisons.output.terminal import rich_table


class Clock:
    """Seconds that a test sets."""

    now = 0.0

    def __call__(self):
        return self.now


@pytest.fixture
def clock():
    return Clock()


def shown(clock, steps):
    """The seconds left after each (time, stated seconds left or None for no step)."""
    column = _TimeLeft()
    bar = Progress(column, get_time=clock)
    task = bar.add_task("computing", total=10, left=None, counted=0.0)
    found = []
    for time, left in steps:
        clock.now = time
        if left != "between":
            bar.update(task, advance=1, left=left, counted=time)
        text = column.render(bar.tasks[0]).plain
        hours, minutes, seconds = map(int, text.split(":"))
        found.append(3600 * hours + 60 * minutes + seconds)
    return found


def test_an_estimate_that_rises_leaves_the_time_as_it_is(clock):
    assert shown(clock, [(1, 100), (2, 300), (3, 90), (4, 200)]) == [100, 100, 90, 90]


def test_it_falls_with_the_clock_between_two_steps_and_not_below_zero(clock):
    assert shown(clock, [(1, 5), (3, "between"), (20, "between"), (21, 40)]) == [5, 3, 0, 0]


def test_without_stated_seconds_it_follows_from_the_steps(clock):
    # One of ten in two seconds: nine more in 18; the second takes longer, and the time stays.
    assert shown(clock, [(2, None), (12, None), (13, None)]) == [18, 18, 18]
    clock.now = 0.0
    assert shown(clock, [(2, None), (3, "between"), (4, None)]) == [18, 17, 16]


def test_the_first_of_many_steps_give_no_estimate(clock):
    column = _TimeLeft()
    bar = Progress(column, get_time=clock)
    task = bar.add_task("computing", total=100, left=None, counted=0.0)
    texts = []
    for step in range(1, 6):
        clock.now = 10.0 + step
        bar.update(task, advance=1, counted=clock.now)
        texts.append(column.render(bar.tasks[0]).plain)
    assert texts == ["-:--:--"] * 4 + ["0:04:45"]
    bar.update(task, advance=1, left=math.inf, counted=clock.now)
    assert column.render(bar.tasks[0]).plain == "-:--:--"


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


def test_before_the_first_step_nothing_is_known(clock):
    column = _TimeLeft()
    bar = Progress(column, get_time=clock)
    bar.add_task("computing", total=10, left=None, counted=0.0)
    assert column.render(bar.tasks[0]).plain == "-:--:--"


def test_counting_works_without_a_terminal(capsys):
    with counting("computing", 2) as count:
        count()
        count(1.0)
    assert capsys.readouterr().err == ""
