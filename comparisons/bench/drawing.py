"""Figures of the benchmark: panels of lines, and bars."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, MARKERS, styled
from comparisons.paper.drawing import panels

__all__ = ["Panel", "bars", "lines"]


@dataclass(frozen=True, slots=True)
class Panel:
    """Lines of one panel: the columns `y` over `x` of a table, a line for each value of the column `by`.

    Attributes
    ----------
    rows : DataFrame
    x, y, by : str
    labels : tuple of str
        Of both axes.
    scales : str
        "x", "y" or "xy" where these axes are logarithmic.
    title : str
    """

    rows: pd.DataFrame
    x: str
    y: str
    by: str
    labels: tuple[str, str]
    scales: str = ""
    title: str = ""


def lines(contents: Sequence[Panel], title: str, columns: int) -> Figure:
    """Draw panels in rows of so many; a value of `by` has the same colour in all of them."""
    rows = -(-len(contents) // columns)
    names = list(dict.fromkeys(name for panel in contents for name in panel.rows[panel.by]))
    with styled():
        figure = Figure(figsize=(3.4 * columns, 3.2 * rows), layout="constrained")
        lattice = panels(figure, rows, columns, [panel.title for panel in contents])
        for axes, panel in zip(lattice, contents, strict=False):
            drawn = panel.rows.dropna(subset=[panel.y])
            for name, of_name in drawn.groupby(panel.by, sort=False):
                line = of_name.sort_values(panel.x)
                style = names.index(name) % len(COLOURS)
                axes.plot(line[panel.x], line[panel.y], color=COLOURS[style], marker=MARKERS[style], ms=5, label=name)
            axes.set(xlabel=panel.labels[0], ylabel=panel.labels[1])
            if len(drawn):
                axes.set(**{f"{axis}scale": "log" for axis in panel.scales})
                axes.legend()
        figure.suptitle(title, fontsize=10)
    return figure


def bars(names: Sequence[str], seconds: pd.Series, label: str, title: str) -> Figure:
    """Draw times as horizontal bars with their numbers, the first on top."""
    with styled():
        figure = Figure(figsize=(7.4, 0.8 + 0.45 * len(names)), layout="constrained")
        axes = figure.subplots()
        heights = -np.arange(len(names))
        axes.bar_label(axes.barh(heights, seconds.to_numpy(), 0.6, color=COLOURS[1]), fmt="%.2g s", padding=4)
        axes.set_xscale("log")
        axes.set_yticks(heights, names)
        axes.set(xlabel=label, xlim=(seconds.min() / 2.0, 3.0 * seconds.max()))
        axes.set_title(title, fontsize=10)
    return figure
