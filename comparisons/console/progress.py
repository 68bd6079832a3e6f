"""Messages on stderr, and on a terminal a progress bar."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext, suppress
from contextvars import ContextVar
from typing import TYPE_CHECKING

from comparisons.console.printable import wrapped

if TYPE_CHECKING:
    from rich import progress

_quiet: ContextVar[bool] = ContextVar("quiet", default=False)


def log(text: str) -> None:
    """Write a sentence on stderr: one line, which a terminal shows in several as `wrapped` has them.

    A message that cannot be written is lost and stops no computation.
    """
    # Imported here, as rich below: most commands write no message and show no bar.
    from comparisons.console.safe_console import SafeConsole

    with suppress(OSError):
        console = SafeConsole(stderr=True, highlight=False, markup=False)
        for line in wrapped(text) if console.is_terminal else [text]:
            console.print(line, soft_wrap=True)


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
def waiting(description: str, is_long: bool = False) -> Iterator[None]:
    """Show that one computation of unknown length is under way; where it may be long, also by a note."""
    from rich import progress

    if is_long:
        note(f"{description}: this may take a minute")
    with _bar(progress.TimeElapsedColumn()) as bar:
        bar.add_task(description, total=None)
        yield


@contextmanager
def counting(description: str, count: int) -> Iterator[Callable[[], None]]:
    """Show how many computations are done, and the time left; the yielded function counts one more."""
    from rich import progress

    with _bar(progress.MofNCompleteColumn(), progress.TimeElapsedColumn(), progress.TimeRemainingColumn()) as bar:
        task = bar.add_task(description, total=count)
        yield lambda: bar.advance(task)


@contextmanager
def _bar(*columns: progress.ProgressColumn) -> Iterator[progress.Progress]:
    from rich import progress

    from comparisons.console.safe_console import SafeConsole

    console = SafeConsole(stderr=True)
    text = progress.TextColumn("{task.description}", markup=False)
    bar = progress.Progress(text, progress.BarColumn(), *columns, console=console, transient=True)
    # Without a terminal (a file, a CI log) a redrawn bar is only noise: it counts, but is not started.
    with bar if console.is_terminal and not _quiet.get() else nullcontext():
        yield bar
