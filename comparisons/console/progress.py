"""Messages on stderr, and on a terminal a progress bar."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext, suppress
from typing import NoReturn

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

__all__ = ["counting", "log", "waiting"]


class _Messages(Console):
    def on_broken_pipe(self) -> NoReturn:
        raise BrokenPipeError  # rich would end the process with status 1


def log(text: str) -> None:
    """Write a line on stderr; a message that cannot be written is lost and stops no computation."""
    with suppress(OSError):
        _Messages(stderr=True, soft_wrap=True, highlight=False, markup=False).print(text)


@contextmanager
def waiting(description: str) -> Iterator[None]:
    """Show that one computation of unknown length is under way."""
    with _bar(TimeElapsedColumn()) as bar:
        bar.add_task(description, total=None)
        yield


@contextmanager
def counting(description: str, total: int) -> Iterator[Callable[[], None]]:
    """Show how many of `total` computations are done; call the returned function when one more is done."""
    with _bar(MofNCompleteColumn(), TimeElapsedColumn(), TimeRemainingColumn()) as bar:
        task = bar.add_task(description, total=total)
        yield lambda: bar.advance(task)


@contextmanager
def _bar(*columns: ProgressColumn) -> Iterator[Progress]:
    console = Console(stderr=True)
    bar = Progress(TextColumn("{task.description}"), BarColumn(), *columns, console=console, transient=True)
    # Without a terminal (a file, a CI log) a redrawn bar is only noise: it counts, but is not started.
    with bar if console.is_terminal else nullcontext():
        yield bar
