"""Fig. 16(b): relative error of the pull-off force of both Maugis-Dugdale models."""

from __future__ import annotations

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.figures.style import COLOURS, MARKERS, styled

__all__ = ["draw"]

#: Model -> (line style, legend): dashed and solid as in the paper.
_MODELS = {"md-original": ("--", "original"), "md-improved": ("-", "improved")}


def draw(kappa: pd.DataFrame, k: float = 0.4) -> Figure:
    """Draw kappa against mu for every n, both models, at one gradient exponent.

    Parameters
    ----------
    kappa : DataFrame
        As `comparisons.tables.relative_error` returns it.
    k : float
        Gradient exponent.

    Returns
    -------
    Figure
        Left all of it, right the neighbourhood of zero, where the improved model lives.
    """
    chosen = kappa[(kappa["quantity"] == "pull_off_force") & (kappa["k"] == k)].sort_values("mu")
    with styled():
        figure = Figure(figsize=(7.2, 3.4), layout="constrained")
        whole, near = figure.subplots(1, 2)
        for index, (n, of_shape) in enumerate(chosen.groupby("n")):
            for model, (line, label) in _MODELS.items():
                points = of_shape[of_shape["model"] == model]
                for axes in (whole, near) if len(points) else ():
                    _plot(axes, points, index, line, f"n = {n:g}, {label}")
        for axes in (whole, near):
            axes.set_xscale("log")
            axes.set_xlabel(r"Tabor number $\mu$")
            axes.axhline(0, color="0.4", lw=0.8)
        whole.set_ylabel(r"relative error of the pull-off force $\kappa$ (%)")
        whole.set_title(f"k = {k:g}, against the full self-consistent model")
        near.set_title("the same, enlarged")
        near.set_ylim(-9, 9)
        if whole.get_legend_handles_labels()[1]:
            whole.legend(loc="lower right")
    return figure


def _plot(axes: Axes, points: pd.DataFrame, index: int, line: str, label: str) -> None:
    """Draw one model's errors and, where it can be seen, the band of their uncertainty."""
    centre, band = 100 * points["kappa"], 100 * points["u_kappa"]
    colour = COLOURS[index]
    axes.plot(points["mu"], centre, color=colour, marker=MARKERS[index], ms=3.0, ls=line, label=label)
    axes.fill_between(points["mu"], centre - band, centre + band, color=colour, alpha=0.2)
