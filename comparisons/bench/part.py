"""Parts of the benchmark: what is measured, how, and what is made of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

__all__ = ["Item", "Measurement", "Numbers", "Part", "Settings", "table_of"]

#: What a measurement is made with: values that JSON holds, by name.
Settings = dict[str, Any]
#: What a measurement gives: values that JSON holds, by name.
Numbers = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Item:
    """One measurement that is to be made.

    Attributes
    ----------
    settings : dict
        What tells it from the others of its part.
    seconds : float
        What it takes on a server of 2023, for the estimate of the time left.
    """

    settings: Settings
    seconds: float = 1.0


@dataclass(frozen=True, slots=True)
class Measurement:
    """One measurement that was made.

    Attributes
    ----------
    part : str
        Name of the part.
    settings, numbers : dict
        What was measured, and what it gave (empty if it failed).
    status : str
        "ok" or "failed".
    reason : str
        Why it failed.
    """

    part: str
    settings: Settings
    numbers: Numbers = field(default_factory=dict)
    status: str = "ok"
    reason: str = ""

    @property
    def row(self) -> dict[str, Any]:
        """One row of the table of the part."""
        return {**self.settings, **self.numbers, "status": self.status, "reason": self.reason}


@dataclass(frozen=True, slots=True)
class Part:
    """A part of the benchmark.

    Attributes
    ----------
    name, title : str
        Its name on the command line and in the names of its files; its line in the help.
    items : callable
        Returns what is measured; with True also the sizes that take long.
    measure : callable
        Makes one measurement; a function of a module, because it is called in another process.
    table : callable
        Returns the table: a row for each measurement, with errors and ratios.
    draw : callable
        Draws the table, which has a row without failure.
    summary : callable
        Returns what is printed, ratios first: lines of at most 80 columns.
    own_process : bool
        Whether each measurement is made in a process of its own; one that starts processes itself needs none.
    """

    name: str
    title: str
    items: Callable[[bool], Sequence[Item]]
    measure: Callable[[Settings], Numbers]
    table: Callable[[pd.DataFrame], pd.DataFrame]
    draw: Callable[[pd.DataFrame], Figure]
    summary: Callable[[pd.DataFrame], list[str]]
    own_process: bool = True

    def files(self, folder: Path) -> tuple[Path, Path]:
        """Return the paths of its table and of its figure."""
        stem = folder / self.name.replace("-", "_")
        return stem.with_suffix(".csv"), stem.with_suffix(".png")


def table_of(measurements: Sequence[Measurement]) -> pd.DataFrame:
    """Return the rows of measurements as a table; a number that a measurement does not have is missing.

    Examples
    --------
    >>> table_of([Measurement("a", {"mu": 1.0}, {"cpu_seconds": 2.0})]).columns.tolist()
    ['mu', 'cpu_seconds', 'status', 'reason']
    """
    table = pd.DataFrame([one.row for one in measurements])
    last = ["status", "reason"]
    return table[[*(name for name in table.columns if name not in last), *(name for name in last if name in table)]]
