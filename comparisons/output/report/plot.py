"""Plots of the page: axes, choices, and series of stored numbers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import asdict, dataclass, field
from typing import Any, cast

import pandas as pd

from comparisons.numerics.number_text import exact
from comparisons.output.style import first_shown

__all__ = ["Control", "Plot", "Series", "grouped", "key", "options"]


@dataclass(frozen=True, slots=True)
class Control:
    """A choice: its label, its options as (key, text), and the one that is shown first (else the first)."""

    label: str
    options: tuple[tuple[str, str], ...]
    first: str = ""


@dataclass(frozen=True, slots=True)
class Series:
    """The points of one model under one choice; `low` and `high` bound a band, `hover` is shown at a point."""

    group: str
    model: str
    label: str
    x: list[float]
    y: list[float]
    hover: list[str]
    low: list[float] | None = None
    high: list[float] | None = None


@dataclass(frozen=True, slots=True)
class Plot:
    """One plot: axes, choices, series; `views` holds the first view [x0, x1, y0, y1] of a group if not all of it.

    `y_labels` has the label of the second axis for a group whose label is another.

    `mark` is "both" for a line with markers, "line" or "points"; `table` the id of the table with the numbers.
    """

    id: str
    title: str
    x_label: str
    y_label: str
    controls: tuple[Control, ...]
    series: list[Series]
    table: str
    caption: str
    x_scale: str = "linear"
    y_scale: str = "linear"
    mark: str = "both"
    views: dict[str, list[float]] = field(default_factory=dict)
    y_labels: dict[str, str] = field(default_factory=dict)

    @property
    def models(self) -> list[str]:
        """Names of what can be switched on and off, in the order of the series."""
        return list(dict.fromkeys(series.model for series in self.series))

    @property
    def first_models(self) -> list[str]:
        """Those of them that are switched on at first."""
        return first_shown(self.models)

    def data(self) -> dict[str, Any]:
        """Return what the page's script draws, ready for JSON."""
        wanted = ("id", "x_label", "y_label", "x_scale", "y_scale", "mark", "table", "views", "y_labels")
        return {name: getattr(self, name) for name in wanted} | {"series": [asdict(series) for series in self.series]}


def key(*parts: str | float) -> str:
    """Return the choice that several options make: the key by which the script of the page finds its series."""
    return "|".join(part if isinstance(part, str) else exact(part) for part in parts)


def options(values: Iterable[float]) -> tuple[tuple[str, str], ...]:
    """Return numbers as options of a control, each once, sorted."""
    return tuple((exact(value), exact(value)) for value in sorted(set(values)))


def grouped(table: pd.DataFrame, names: list[str]) -> Iterator[tuple[tuple[Any, ...], pd.DataFrame]]:
    """Return the rows of each combination, sorted; without Poisson's ratio, that is one of its own."""
    for combination, rows in table.groupby(names, dropna=False):
        yield cast(tuple[Any, ...], combination), rows
