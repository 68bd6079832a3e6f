"""Both references in one picture: force-displacement curves and pressures at pull-off."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pandas as pd

from comparisons.output.style import COLOURS, lettered, model_label, model_styles, new_figure, styled
from comparisons.quantities import CURVES

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["draw"]

_BROAD = {name: value for name, value in model_styles(["fscm"])["fscm"].arguments.items() if name != "color"}

#: Quantity -> limits of x, and of y.
_PANELS = {"force_curve": ((-4.5, 2.5), (-2.0, 1.0)), "pull_off_pressure": ((0.0, 3.0), None)}


def draw(curves: pd.DataFrame) -> Figure:
    """Draw the stored curves: a line for the FSCM, points for the finite elements.

    Parameters
    ----------
    curves : DataFrame
        As a run stores them in ``curves.csv``.
    """
    with styled():
        figure = new_figure(7.2, 4.0)
        for letter, axes, quantity in zip("ab", figure.subplots(1, 2), _PANELS, strict=True):
            _panel(axes, curves[(curves["quantity"] == quantity) & (curves["status"] == "ok")], quantity)
            lettered(axes, letter)
        handles, labels = figure.axes[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=2)
    return figure


def _panel(axes: Axes, curves: pd.DataFrame, quantity: str) -> None:
    x_limits, y_limits = _PANELS[quantity]
    for index, ((n, k, mu), case) in enumerate(curves.groupby(["n", "k", "mu"])):
        colour, label = COLOURS[index % len(COLOURS)], f"$n$ = {n:g}, $k$ = {k:g}, $\\mu$ = {mu:g}"
        for model, points in case.groupby("model"):
            points = points.sort_values("point")
            line = _BROAD if model == "fscm" else {"ls": "none", "marker": "o", "ms": 2.5, "mfc": "white"}
            axes.plot(points["x"], points["y"], color=colour, label=f"{model_label(str(model))}, {label}", **line)
    axes.axhline(0, color="0.4", lw=0.8)
    axes.set_xlim(*x_limits)
    if y_limits:
        axes.set_ylim(*y_limits)
    axes.set_xlabel(CURVES[quantity].x.figure_label)
    axes.set_ylabel(CURVES[quantity].y.figure_label)
