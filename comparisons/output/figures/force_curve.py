"""Force-displacement curves of several models in one picture (as Figs. 3(b) and 13)."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.model import Curve
from comparisons.output.style import COLOURS, styled

__all__ = ["draw"]

# Where the load is below this share of the pull-off force, a curve approaches the axis and ends the picture.
_FAINT = 0.02

_LINES = ("-", "--", "-.", ":")


def draw(curves: dict[str, Curve], title: str) -> Figure:
    """Draw the load against the displacement.

    Parameters
    ----------
    curves : dict of str to Curve
        By model name.
    title : str
        Which problem it is.
    """
    with styled():
        figure = Figure(figsize=(5.0, 3.8), layout="constrained")
        axes = figure.subplots()
        for index, (name, curve) in enumerate(curves.items()):
            colour, line = COLOURS[index % len(COLOURS)], _LINES[index % len(_LINES)]
            axes.plot(curve.displacement, curve.load, label=name, color=colour, ls=line)
        axes.axhline(0, color="0.4", lw=0.8)
        axes.set_xlabel(r"displacement $\delta / z_0$")
        axes.set_ylabel(r"load $P / (\pi Q^{2/n} \Delta\gamma z_0^{2/n-1})$, tension negative")
        axes.set_title(title)
        _look_at_adhesion(axes, list(curves.values()))
        if curves:
            axes.legend()
    return figure


def _look_at_adhesion(axes: Axes, curves: list[Curve]) -> None:
    """Limit the axes to where the surfaces pull, and as much compression: some curves go on far beyond."""
    deepest = min((float(curve.load.min()) for curve in curves), default=0.0)
    if deepest >= 0.0:
        return
    axes.set_ylim(1.15 * deepest, -deepest)
    within = [curve.displacement[(abs(curve.load) > -_FAINT * deepest) & (curve.load < -deepest)] for curve in curves]
    shown = np.concatenate(within)
    margin = 0.05 * float(np.ptp(shown))
    axes.set_xlim(shown.min() - margin, shown.max() + margin)
