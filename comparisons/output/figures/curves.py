"""A curve or field of several models in one picture (as Figs. 3(b) and 13)."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.output.style import model_styles, styled
from comparisons.quantities import CurveQuantity, Kind, Points

__all__ = ["draw", "sections", "tension_view"]

#: Where the load is below this share of the pull-off force, a curve approaches the axis and ends the picture.
_FAINT = 0.02
#: Column that a model with a stability analysis adds, and the width of an unstable part.
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
        figure = Figure(figsize=(5.0, 3.8), layout="constrained")
        axes = figure.subplots()
        for name, curve in points.items():
            _plot(axes, name, curve, styles[name].arguments)
        axes.axhline(0, color="0.4", lw=0.8)
        axes.set_xlabel(quantity.x.figure_label)
        axes.set_ylabel(quantity.y.signed_figure_label)
        axes.set_title(title)
        _set_limits(axes, quantity, points)
        if any(_STABLE in curve.columns for curve in points.values()):
            axes.plot([], [], color="0.4", lw=_THIN, label="thin: unstable if $\\delta$ is prescribed")
        if points:
            axes.legend()
    return figure


def _plot(axes: Axes, name: str, curve: Points, style: dict[str, Any]) -> None:
    """Draw one curve; the parts that cannot be held at their displacement are thin."""
    stable = [bool(mark) for mark in curve.columns.get(_STABLE, [True] * len(curve.x))]
    for held, first, last in sections(stable) or [(True, 0, 0)]:
        part = slice(first, last + 1)
        axes.plot(
            curve.x[part], curve.y[part], label=None if first else name, **style | ({} if held else {"lw": _THIN})
        )


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


def _set_limits(axes: Axes, quantity: CurveQuantity, points: dict[str, Points]) -> None:
    if quantity.kind is Kind.FIELD:
        axes.set_xlim(left=0.0)
        return
    view = tension_view((curve.x, curve.y) for curve in points.values())
    if view:
        axes.set_xlim(*view[:2])
        axes.set_ylim(*view[2:])


def tension_view(curves: Iterable[tuple[list[float], list[float]]]) -> list[float] | None:
    """Return the limits [x0, x1, y0, y1] of the tension, and of as much compression; None without tension.

    Examples
    --------
    >>> tension_view([([0.0, 1.0, 2.0, 9.0], [-0.5, -1.0, 0.5, 40.0])])
    [-0.1, 2.1, -1.15, 1.0]
    """
    pairs = [(np.array(x), np.array(y)) for x, y in curves]
    deepest = min((float(load.min()) for _, load in pairs), default=0.0)
    if deepest >= 0.0:
        return None
    visible = np.concatenate([x[(abs(load) > -_FAINT * deepest) & (load < -deepest)] for x, load in pairs])
    margin = 0.05 * float(np.ptp(visible))
    return [float(visible.min()) - margin, float(visible.max()) + margin, 1.15 * deepest, -deepest]
