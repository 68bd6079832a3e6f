"""Messages on stderr, and on a terminal a progress bar."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, nullcontext, suppress
from contextvars import ContextVar

from rich.progress import BarColumn, Progress, ProgressColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from comparisons.console.safe_console import SafeConsole

__all__ = ["counting", "log", "note", "quiet", "waiting"]


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


@contextmanager
def counting(description: str, costs: Sequence[float]) -> Iterator[Callable[[float], None]]:
    """Show how many computations are done, and the time left.

    Parameters
    ----------
    description : str
    costs : sequence of float
        What the computations may take, in any unit; the time left follows from their sum.

    Yields
    ------
    callable
        Takes the cost of one more computation that is done.
    """
    done = 0
    columns = (TextColumn("{task.fields[done]}/{task.fields[count]}"), TimeElapsedColumn(), TimeRemainingColumn())
    with _bar(*columns) as bar:
        task = bar.add_task(description, total=sum(costs), done=0, count=len(costs))

        def advance(cost: float) -> None:
            nonlocal done
            done += 1
            bar.update(task, advance=cost, done=done)

        yield advance


@contextmanager
def _bar(*columns: ProgressColumn) -> Iterator[Progress]:
    console = SafeConsole(stderr=True)
    bar = Progress(
        TextColumn("{task.description}", markup=False), BarColumn(), *columns, console=console, transient=True
    )
    # Without a terminal (a file, a CI log) a redrawn bar is only noise: it counts, but is not started.
    with bar if console.is_terminal and not _quiet.get() else nullcontext():
        yield bar
