"""Messages on stderr, and on a terminal a progress bar."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext, suppress
from contextvars import ContextVar
from datetime import timedelta
from math import ceil, inf

from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    Task,
    TextColumn,
    TimeElapsedColumn,
)
from rich.text import Text

from comparisons.console.safe_console import SafeConsole

__all__ = ["EVIDENCE", "counting", "log", "note", "quiet", "waiting"]


#: Share of the computations of one kind that are finished before there is an estimate of the time left, at least one:
#: the first may take longer than hundreds after it, since a process starts and a solver stores its tables.
EVIDENCE = 0.05

_quiet: ContextVar[bool] = ContextVar("quiet", default=False)


def log(text: str) -> None:
    """Write a sentence on stderr, on a terminal folded between words and else as one line.

    A message that cannot be written is lost and stops no computation.
    """
    with suppress(OSError):
        console = SafeConsole(stderr=True, highlight=False, markup=False)
        console.print(text, soft_wrap=not console.is_terminal)


def note(text: str) -> None:
    """Write a line on stderr that `quiet` leaves out: what is under way, and no warning."""
    if not _quiet.get():
        log(text)


@contextmanager
def quiet() -> Iterator[None]:
    """Leave out notes and progress bars.

    Examples
    --------
    >>> with quiet():
    ...     note("not written")
    """
    before = _quiet.set(True)
    try:
        yield
    finally:
        _quiet.reset(before)


@contextmanager
def waiting(description: str) -> Iterator[None]:
    """Show that one computation of unknown length is under way."""
    with _bar(TimeElapsedColumn()) as bar:
        bar.add_task(description, total=None)
        yield


class _TimeLeft(ProgressColumn):
    """The time left, which only falls: by the seconds that the computation states, or by its number of steps.

    Between two steps it falls with the clock.  A new estimate that is longer leaves the time as it is, until the work
    catches up.
    """

    def __init__(self) -> None:
        super().__init__()
        self._shown: dict[int, float] = {}

    def render(self, task: Task) -> Text:
        since = task.get_time() - task.fields["counted"]
        left = task.fields["left"]
        if (
            left is None
            and task.total
            and task.completed >= ceil(EVIDENCE * task.total)
            and task.start_time is not None
        ):
            elapsed = task.fields["counted"] - task.start_time
            left = elapsed / task.completed * (task.total - task.completed)
        if left is None or left == inf:
            return Text("-:--:--", style="progress.remaining")
        shown = min(self._shown.get(task.id, float("inf")), max(left - since, 0.0))
        self._shown[task.id] = shown
        return Text(str(timedelta(seconds=ceil(shown))), style="progress.remaining")


@contextmanager
def counting(description: str, total: int) -> Iterator[Callable[..., None]]:
    """Show how many of `total` computations are done.

    Call the returned function when one more is done, with the seconds left if they are estimated: infinite before there
    is an estimate.
    """
    with _bar(MofNCompleteColumn(), TimeElapsedColumn(), _TimeLeft()) as bar:
        task = bar.add_task(description, total=total, left=None, counted=bar.get_time())

        def count(left: float | None = None) -> None:
            bar.update(task, advance=1, left=left, counted=bar.get_time())

        yield count


@contextmanager
def _bar(*columns: ProgressColumn) -> Iterator[Progress]:
    console = SafeConsole(stderr=True)
    bar = Progress(
        TextColumn("{task.description}", markup=False), BarColumn(), *columns, console=console, transient=True
    )
    # Without a terminal (a file, a CI log) a redrawn bar is only noise: it counts, but is not started.
    with bar if console.is_terminal and not _quiet.get() else nullcontext():
        yield bar
