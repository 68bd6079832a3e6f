"""Parts of the benchmark: measurements, which are calls of a function, and what is made of the table of all of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from comparisons.paper.cache import CachedCall, Outcome

#: What a measurement is made with, or what it gives: values that JSON holds, by name.
Numbers = dict[str, Any]


@dataclass(frozen=True, slots=True)
class Part:
    """A part of the benchmark.

    Attributes
    ----------
    name, title : str
        Its name on the command line and in the names of its files; its line in the help and above its summary.
    plan : callable
        Returns the arguments of each measurement by name; with True also those that take long.
    measure : callable
        Makes one measurement; a function of a module, because it is called in another process.
    ratios : callable
        Adds errors and ratios to the table of measurements, of which one has no failure.
    summary : callable
        Returns the rows and columns that are printed, of the rows without failure.
    draw : callable or None
        Draws the rows without failure; None for a part that is a table only.
    """

    name: str
    title: str
    plan: Callable[[bool], Sequence[Numbers]]
    measure: Callable[..., Numbers]
    ratios: Callable[[pd.DataFrame], pd.DataFrame]
    summary: Callable[[pd.DataFrame], pd.DataFrame]
    draw: Callable[[pd.DataFrame], Figure] | None = None

    def calls(self, full: bool) -> list[CachedCall]:
        """Return the measurements in the order of the plan."""
        return [CachedCall.of(self.measure, *settings.values()) for settings in self.plan(full)]

    def files(self, folder: Path) -> list[Path]:
        """Return the paths of its table and of its figure, if it has one."""
        stem = folder / self.name.replace("-", "_")
        return [stem.with_suffix(suffix) for suffix in ((".csv", ".png") if self.draw else (".csv",))]

    def table(self, full: bool, outcomes: Mapping[CachedCall, Outcome]) -> pd.DataFrame:
        """Return the measurements in the order of the plan, with their errors and ratios."""
        rows = []
        for settings, call in zip(self.plan(full), self.calls(full), strict=True):
            outcome = outcomes[call]
            ended = {"status": "failed" if outcome.failure else "ok", "reason": outcome.failure}
            rows.append({**settings, **(outcome.result or {}), **ended})
        table = pd.DataFrame(rows)
        table = table[[*table.columns.drop(["status", "reason"]), "status", "reason"]]
        return self.ratios(table) if (table["status"] == "ok").any() else table
