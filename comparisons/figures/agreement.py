"""How far two references are apart, beside what they claim: one panel a quantity, one point a case."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.figures.style import COLOURS, MARKERS, styled
from comparisons.quantities import QUANTITIES

__all__ = ["draw"]

#: Differences below this, far below any claim, are drawn on the lower edge.
_SMALLEST = 1e-13
_COLUMNS = 4


def draw(agreement: pd.DataFrame) -> Figure:
    """Draw the differences of two models as points, and the uncertainty both claim together as dashes.

    Parameters
    ----------
    agreement : DataFrame
        As `comparisons.tables.agreement` returns it; at least one row.
    """
    pair = f"{agreement['model'].iloc[0]} and {agreement['reference'].iloc[0]}"
    quantities = [name for name in QUANTITIES if name in set(agreement["quantity"])]
    columns = min(_COLUMNS, len(quantities))
    rows = -(-len(quantities) // columns)
    with styled():
        figure = Figure(figsize=(9.6, 0.8 + 2.3 * rows), layout="constrained")
        panels = figure.subplots(rows, columns, sharey=True, squeeze=False)
        for axes, quantity in zip(panels.flat, quantities, strict=False):
            _panel(axes, agreement[agreement["quantity"] == quantity], sorted(agreement["n"].unique()))
            axes.set_title(quantity.replace("_", " "), fontsize=9)
        for axes in panels.flat[len(quantities) :]:
            axes.set_visible(False)
        for axes in panels[-1]:
            axes.set_xlabel(r"Tabor number $\mu$")
        figure.supylabel("difference (force and energy: relative; else in $z_0$)", fontsize=9)
        figure.suptitle(f"Difference of {pair} (points), and the uncertainty both claim together (dashes)")
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
        axes.plot(mu, size, ls="none", marker=marker, ms=3.5, mfc="white", color=colour, label=f"n = {n:g}")
    axes.set_xscale("log")
    axes.set_yscale("log")
    ticks = sorted(rows["mu"].unique())
    axes.set_xticks(ticks, [f"{mu:g}" for mu in ticks])
    axes.set_xticks([], minor=True)
