"""Parts of the benchmark: a plan, a measurement, and what is made of the table of all measurements."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypedDict

import pandas as pd
from matplotlib.figure import Figure

#: What a measurement is made with: values that JSON holds, by name.
Settings = dict[str, Any]
#: What a measurement gives: values that JSON holds, by name.
Numbers = dict[str, Any]


class Measurement(TypedDict):
    """One measurement as it is stored: its numbers are empty, and it has a reason, if its status is "failed"."""

    part: str
    settings: Settings
    numbers: Numbers
    status: str
    reason: str


@dataclass(frozen=True, slots=True)
class Part:
    """A part of the benchmark.

    Attributes
    ----------
    name, title : str
        Its name on the command line and in the names of its files; its line in the help and above its summary.
    plan : callable
        Returns the settings of each measurement; with True also those that take long.
    measure : callable
        Makes one measurement; a function of a module, because it is called in another process.
    ratios : callable
        Adds errors and ratios to the table of measurements, of which one has no failure.
    summary : callable
        Returns the rows and columns that are printed, of the rows without failure.
    draw : callable or None
        Draws the rows without failure; None for a part that is a table only.
    own_process : bool
        Whether each measurement is made in a process of its own; one that starts processes itself needs none.
    """

    name: str
    title: str
    plan: Callable[[bool], Sequence[Settings]]
    measure: Callable[[Settings], Numbers]
    ratios: Callable[[pd.DataFrame], pd.DataFrame]
    summary: Callable[[pd.DataFrame], pd.DataFrame]
    draw: Callable[[pd.DataFrame], Figure] | None = None
    own_process: bool = True

    def files(self, folder: Path) -> list[Path]:
        """Return the paths of its table and of its figure, if it has one."""
        stem = folder / self.name.replace("-", "_")
        return [stem.with_suffix(suffix) for suffix in ((".csv", ".png") if self.draw else (".csv",))]


def table_of(part: Part, measurements: Sequence[Measurement]) -> pd.DataFrame:
    """Return the table of a part: its measurements in the order of the plan, with their errors and ratios."""
    order = [key(settings) for settings in part.plan(True)]
    rows = sorted(measurements, key=lambda row: order.index(key(row["settings"])))
    table = pd.DataFrame(
        {**row["settings"], **row["numbers"], "status": row["status"], "reason": row["reason"]} for row in rows
    )
    table = table[[*table.columns.drop(["status", "reason"]), "status", "reason"]]
    return part.ratios(table) if (table["status"] == "ok").any() else table


def key(settings: Settings) -> tuple[tuple[str, str], ...]:
    """Return what tells the settings of a measurement from others; JSON changes their types."""
    return tuple(sorted((name, str(value)) for name, value in settings.items()))
