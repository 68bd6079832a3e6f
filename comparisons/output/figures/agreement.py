"""Differences of two references beside their stated uncertainty: one panel a quantity, one point a case."""

from __future__ import annotations

from string import ascii_lowercase
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from comparisons.output.style import COLOURS, MARKERS, lettered, model_label, new_figure, styled
from comparisons.quantities import QUANTITIES, title_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw"]

#: Differences below this, far below any stated uncertainty, are drawn on the lower edge.
_SMALLEST = 1e-13
_COLUMNS = 4


def draw(agreement: pd.DataFrame) -> Figure:
    """Draw the differences of two models as points, and their combined uncertainty as dashes.

    Parameters
    ----------
    agreement : DataFrame
        As `comparisons.output.errors.agreement` returns it; at least one row.
    """
    names = [str(agreement[column].iloc[0]) for column in ("model", "reference")]
    pair = " and ".join(model_label(name) for name in names)
    quantities = [name for name in QUANTITIES if name in set(agreement["quantity"])]
    columns = min(_COLUMNS, len(quantities))
    rows = -(-len(quantities) // columns)
    with styled():
        figure = new_figure(9.6, 0.8 + 2.3 * rows)
        panels = figure.subplots(rows, columns, sharey=True, squeeze=False)
        for letter, axes, quantity in zip(ascii_lowercase, panels.flat, quantities, strict=False):
            _panel(axes, agreement[agreement["quantity"] == quantity], sorted(agreement["n"].unique()))
            lettered(axes, letter, title_of(quantity))
        for axes in panels.flat[len(quantities) :]:
            axes.set_visible(False)
        # The lowest panel of each column.
        for axes in panels.flat[max(len(quantities) - columns, 0) : len(quantities)]:
            axes.set_xlabel(r"Tabor number $\mu$")
        figure.supylabel("difference (force and energy: relative; else in $z_0$)", fontsize=9)
        figure.suptitle(f"Difference of {pair} (points), and the sum of their bounds (dashes)")
        handles, labels = panels.flat[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    return figure


def _panel(axes: Axes, rows: pd.DataFrame, shapes: list[float]) -> None:
    for index, n in enumerate(shapes):
        of_shape = rows[rows["n"] == n]
        colour, marker = COLOURS[index % len(COLOURS)], MARKERS[index % len(MARKERS)]
        # Side by side: cases of one Tabor number would cover each other.
        mu = of_shape["mu"] * 1.06 ** (index - 1.5) * 1.015 ** (10 * of_shape["k"] - 3)
        axes.plot(mu, of_shape["claimed"], ls="none", marker="_", ms=5, color=colour)
        size = np.maximum(of_shape["difference"].abs(), _SMALLEST)
        axes.plot(mu, size, ls="none", marker=marker, ms=3.5, mfc="white", color=colour, label=f"$n$ = {n:g}")
    axes.set_xscale("log")
    axes.set_yscale("log")
    ticks = sorted(rows["mu"].unique())
    axes.set_xticks(ticks, [f"{mu:g}" for mu in ticks])
    axes.set_xticks([], minor=True)
