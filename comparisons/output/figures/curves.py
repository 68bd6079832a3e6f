"""A curve or field of several models in one picture (as Figs. 3(b) and 13)."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

from comparisons.output.plots import tension_view
from comparisons.output.style import model_styles, new_figure, styled
from comparisons.quantities import CurveQuantity, Kind, Points

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["draw", "sections"]

#: Column that a model with a stability analysis adds, and the width of an unstable section.
_STABLE, _THIN = "stable_under_displacement", 0.7


def draw(points: dict[str, Points], quantity: CurveQuantity, title: str) -> Figure:
    """Draw the points of every model, the equilibrium path only where the surfaces pull.

    Parameters
    ----------
    points : dict of str to Points
        By model name.
    quantity : CurveQuantity
        A row of `comparisons.quantities.CURVES`.
    title : str
        Which problem it is.

    Examples
    --------
    >>> from comparisons.quantities import CURVES
    >>> figure = draw({"a": Points([0.0, 1.0], [1.0, 1.5], 0.0)}, CURVES["pull_off_gap"], "n = 2")
    >>> figure.axes[0].get_ylabel()
    'gap at pull-off $H / z_0$'
    """
    styles = model_styles(points)
    with styled():
        figure = new_figure(5.0, 3.8)
        axes = figure.subplots()
        for name, curve in points.items():
            stable = [bool(mark) for mark in curve.columns.get(_STABLE, [True] * len(curve.x))]
            for held, start, end in sections(stable) or [(True, 0, 0)]:
                width = {} if held else {"lw": _THIN}
                x, y = curve.x[start : end + 1], curve.y[start : end + 1]
                axes.plot(x, y, label=None if start else name, **styles[name].arguments | width)
        axes.axhline(0, color="0.4", lw=0.8)
        axes.set(xlabel=quantity.x.figure_label, ylabel=quantity.y.signed_figure_label, title=title)
        if quantity.kind is Kind.FIELD:
            axes.set_xlim(left=0.0)
        elif view := tension_view((curve.x, curve.y) for curve in points.values()):
            axes.set(xlim=view[:2], ylim=view[2:])
        if any(_STABLE in curve.columns for curve in points.values()):
            axes.plot([], [], color="0.4", lw=_THIN, label="thin: unstable if $\\delta$ is prescribed")
        if points:
            axes.legend()
    return figure


def sections(stable: list[bool]) -> list[tuple[bool, int, int]]:
    """Return the parts of a curve as (stable, first point, last point); neighbours share a point.

    The points that join two parts, the folds, are marked unstable.

    Examples
    --------
    >>> sections([True, True, False, False, False, True])
    [(True, 0, 2), (False, 2, 4), (True, 4, 5)]
    """
    parts: list[tuple[bool, int, int]] = []
    for i, held in enumerate(a or b for a, b in pairwise(stable)):
        if parts and parts[-1][0] == held:
            parts[-1] = (held, parts[-1][1], i + 1)
        else:
            parts.append((held, i, i + 1))
    return parts
