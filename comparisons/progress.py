"""What a person sees on stderr: messages, and on a terminal a bar while waiting."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

__all__ = ["counting", "log", "waiting"]


def log(text: str) -> None:
    """Write a line on stderr."""
    Console(stderr=True, soft_wrap=True, highlight=False, markup=False).print(text)


def _bar(*columns: TextColumn | MofNCompleteColumn | TimeElapsedColumn | TimeRemainingColumn) -> Progress:
    console = Console(stderr=True)
    # Without a terminal (a file, a CI log) a redrawn bar is only noise.
    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        *columns,
        console=console,
        transient=True,
        disable=not console.is_terminal,
    )


@contextmanager
def waiting(description: str) -> Iterator[None]:
    """Show that one computation of unknown length is under way."""
    with _bar(TimeElapsedColumn()) as bar:
        bar.add_task(description, total=None)
        yield


class Counter:
    """Counts finished computations on a bar."""

    def __init__(self, bar: Progress, description: str, total: int) -> None:
        self._bar = bar
        self._task = bar.add_task(description, total=total)

    def step(self) -> None:
        """Count one more."""
        self._bar.advance(self._task)


@contextmanager
def counting(description: str, total: int) -> Iterator[Counter]:
    """Show how many of `total` computations are done and how long the rest will take."""
    with _bar(MofNCompleteColumn(), TimeElapsedColumn(), TimeRemainingColumn()) as bar:
        yield Counter(bar, description, total)
