"""Fig. 11: change of the JKR pull-off force by the gradient at one Tabor number (Eq. 58)."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy.optimize import brentq, minimize_scalar

from comparisons.models.jkr import JKR
from comparisons.output.style import COLOURS
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, level, line_a_value, panels
from comparisons.paper.paper_figure import Plan, Tables, paper_figure
from comparisons.problem import Problem

__all__ = ["chi", "insensitive_regions", "largest_chi"]

_SHAPES = (1.0, 1.5, 2.0, 5.0)
_GRADIENTS = np.linspace(0.0, 1.0, 101)
_SHAPE_INDICES = np.unique(np.concatenate([np.linspace(0.9, 2.0, 111), np.linspace(2.0, 8.0, 121)]))
#: In the two regions of Fig. 11(b) the chi of Eq. 58 is below it.
_LIMIT = 0.1
#: Brackets of the four ends of the regions; chi_max - 0.1 changes its sign once in each.
_BRACKETS = ((0.9, 1.0), (1.0, 1.2), (3.0, 4.0), (5.0, 8.0))
#: Gradient exponents of the search: between neighbours chi(k) has one maximum at most.
_SEARCHED = np.linspace(0.0, 1.0, 21)
#: Of the gradient exponent where chi is largest; chi is stationary there, or it is an end.
_PLACE_TOLERANCE = 1e-9


def chi(n: float, k: float) -> float:
    """Relative deviation of the JKR pull-off force from that of the homogeneous solid (Eq. 58).

    Parameters
    ----------
    n, k : float
        Shape index and gradient exponent, 0 <= k <= 1; the Tabor number cancels.

    Examples
    --------
    >>> round(chi(2, 1.0), 12)
    0.333333333333
    """
    graded, homogeneous = (JKR().evaluate(Problem.dimensionless(n, x, 1.0), "pull_off_force").value for x in (k, 0.0))
    return abs(graded / homogeneous - 1.0)


def largest_chi(n: float, up_to: float = 1.0) -> tuple[float, float]:
    """Return the largest chi over 0 <= k <= `up_to`, and the k it is at.

    Examples
    --------
    >>> [round(100 * largest_chi(n)[0], 1) for n in (1, 1.5, 2, 5)]
    [4.4, 40.9, 33.3, 4.2]
    """
    gradients = up_to * _SEARCHED
    values = [chi(n, float(k)) for k in gradients]
    at = int(np.argmax(values))
    low, high = gradients[max(at - 1, 0)], gradients[min(at + 1, len(gradients) - 1)]
    peak = minimize_scalar(
        lambda k: -chi(n, float(k)), bounds=(low, high), method="bounded", options={"xatol": _PLACE_TOLERANCE}
    )
    return max((values[at], float(gradients[at])), (-float(peak.fun), float(peak.x)))


def insensitive_regions(up_to: float = 1.0) -> list[float]:
    """Return the four shape indices between which, two and two, the largest chi over k is at most 10 %.

    Examples
    --------
    >>> [round(n, 2) for n in insensitive_regions()]
    [0.97, 1.06, 3.34, 6.22]
    """
    return [float(brentq(lambda n: largest_chi(n, up_to)[0] - _LIMIT, *bracket, xtol=1e-10)) for bracket in _BRACKETS]


def over_gradients(n: float) -> list[float]:
    """Return chi at `_GRADIENTS`."""
    return [chi(n, float(k)) for k in _GRADIENTS]


def over_shapes() -> list[tuple[float, float]]:
    """Return the largest chi, and its k, at `_SHAPE_INDICES`."""
    return [largest_chi(float(n)) for n in _SHAPE_INDICES]


def _picture(figure: Figure, tables: Tables) -> None:
    left, right = panels(figure, 1, 2, ("", ""))
    line_a_value(left, tables[""], "n", "k", "chi", 100)
    left.set(xlabel=LABELS["k"], ylabel=r"deviation $\chi$ (%)", xlim=(0, 1), ylim=(0, None))
    left.legend()
    right.plot(tables["largest"]["n"], 100 * tables["largest"]["chi_max"], color=COLOURS[0])
    level(right, 100 * _LIMIT, ls="--")
    for row, position in zip(tables["regions"].itertuples(), ((1.3, 2.0), (3.5, 17.0)), strict=True):
        right.axvspan(row.n_from, row.n_to, color=COLOURS[1], alpha=0.2, lw=0)
        ends, arrow = f"{row.n_from:.3f} ≤ $n$ ≤ {row.n_to:.3f}", {"arrowstyle": "-", "lw": 0.6, "color": "0.3"}
        right.annotate(ends, (0.5 * (row.n_from + row.n_to), 100 * _LIMIT), position, fontsize=8, arrowprops=arrow)
    right.set(xlabel=LABELS["n"], ylabel=r"largest deviation $\chi_{\max}$ (%)", ylim=(0, 50), xlim=(0.9, 8))


@paper_figure(_picture)
def fig11_gradient_effect() -> Plan[Tables]:
    """Deviation chi of the JKR pull-off force from the homogeneous solid's, and its largest over k."""
    calls = {n: CachedCall.of(over_gradients, n) for n in _SHAPES}
    results = yield {"largest": CachedCall.of(over_shapes), "ends": CachedCall.of(insensitive_regions), **calls}
    parts = [pd.DataFrame({"n": n, "k": _GRADIENTS, "chi": results[n]}) for n in _SHAPES]
    largest = pd.DataFrame(results["largest"], columns=["chi_max", "k_of_chi_max"])
    largest.insert(0, "n", _SHAPE_INDICES)
    regions = pd.DataFrame({"limit": _LIMIT, "n_from": results["ends"][::2], "n_to": results["ends"][1::2]})
    return {"": pd.concat(parts, ignore_index=True), "largest": largest, "regions": regions}
