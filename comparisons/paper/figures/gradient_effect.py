"""Fig. 11: change of the JKR pull-off force by the gradient at one Tabor number (Eq. 58); where its effect is small."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy.optimize import brentq, minimize_scalar

from comparisons.models.jkr import JKR
from comparisons.output.style import COLOURS
from comparisons.paper.drawing import LABELS, dashed, level, lines_by, panels
from comparisons.paper.paper_figure import Plan, Tables, keyed, paper_figure, result_of, rows_of, together
from comparisons.paper.tasks import SHAPES
from comparisons.problem import Problem

#: Last gradient exponent with which the search gives all eight numbers of Fig. 11 with the printed digits; the paper
#: does not state it.  Three of which the end of the second region is shown, and that end as it is printed.
LAST_K = 0.999
_LAST, _PRINTED = (1.0, 0.9995, LAST_K), 6.219
_CHI_MAX = r"largest deviation $\chi_{\max}$ (%)"
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


def over_gradients(n: float) -> dict[str, list[float]]:
    """Return chi over k."""
    gradients = np.linspace(0.0, 1.0, 101).tolist()
    return {"k": gradients, "chi": [chi(n, k) for k in gradients]}


def _largest(shapes: np.ndarray, up_to: float = 1.0) -> dict[str, list[float]]:
    peaks = [largest_chi(float(n), up_to) for n in shapes]
    return {"n": shapes.tolist(), "chi_max": [peak for peak, _ in peaks], "k_of_chi_max": [k for _, k in peaks]}


def over_shapes() -> dict[str, list[float]]:
    """Return the largest chi, and its k, over n."""
    return _largest(np.unique(np.concatenate([np.linspace(0.9, 2.0, 111), np.linspace(2.0, 8.0, 121)])))


def near_the_end(up_to: float) -> dict[str, list[float]]:
    """Return the largest chi over k, up to a last k, near the end of the second region.

    Examples
    --------
    >>> bool(near_the_end(1.0)["chi_max"][0] < 0.1 < near_the_end(1.0)["chi_max"][-1])
    True
    """
    return _largest(np.linspace(6.213, 6.223, 11), up_to)


def _regions() -> Plan[pd.DataFrame]:
    ends = yield from result_of(insensitive_regions)
    return pd.DataFrame({"limit": _LIMIT, "n_from": ends[::2], "n_to": ends[1::2]})


def _picture(figure: Figure, table: pd.DataFrame, largest: pd.DataFrame, regions: pd.DataFrame) -> None:
    left, right = panels(figure, 1, 2, ("", ""))
    lines_by(left, table, "n", "k", "chi", 100)
    left.set(xlabel=LABELS["k"], ylabel=r"deviation $\chi$ (%)", xlim=(0, 1), ylim=(0, None))
    left.legend()
    right.plot(largest["n"], 100 * largest["chi_max"], color=COLOURS[0])
    level(right, 100 * _LIMIT, ls="--")
    for index, row in enumerate(regions.itertuples()):
        words = f"{row.n_from:.3f} ≤ $n$ ≤ {row.n_to:.3f}"
        right.axvspan(row.n_from, row.n_to, color=COLOURS[1 + index], alpha=0.2, lw=0, label=words)
    right.legend()
    right.set(xlabel=LABELS["n"], ylabel=_CHI_MAX, ylim=(0, 50), xlim=(0.9, 8))


@paper_figure(_picture)
def fig11_gradient_effect() -> Plan[Tables]:
    """Deviation chi of the JKR pull-off force from the homogeneous solid's, and its largest over k."""
    largest = rows_of([keyed(over_shapes)], "n", "chi_max", "k_of_chi_max")
    by_shape = rows_of(keyed(over_gradients, n=n) for n in SHAPES)
    return together({"": by_shape, "largest": largest, "regions": _regions()})


def _draw_chi_range(figure: Figure, table: pd.DataFrame, ends: pd.DataFrame) -> None:
    axes = figure.subplots()
    for index, (last_k, end) in enumerate(ends.to_numpy()):
        line = table[table["last_k"] == last_k]
        label = rf"$k \leq$ {last_k:g}: 10 % at $n$ = {end:.4f}"
        axes.plot(line["n"], 100.0 * line["chi_max"], label=label, marker="o", ms=3, **dashed(index))
    level(axes, 100.0 * _LIMIT, ls="--")
    axes.axvline(_PRINTED, color="0.4", lw=0.8, ls=":", label=f"printed: {_PRINTED}")
    axes.set(xlabel=LABELS["n"], ylabel=_CHI_MAX)
    axes.legend()


def _ends() -> Plan[pd.DataFrame]:
    ends = yield from together({last_k: result_of(insensitive_regions, last_k) for last_k in _LAST})
    return pd.DataFrame([{"last_k": last_k, "n_to": regions[3]} for last_k, regions in ends.items()])


@paper_figure(_draw_chi_range, size=(5.0, 3.4))
def finding_chi_range() -> Plan[Tables]:
    """End of the second range of small chi, for three largest gradient exponents."""
    calls = [keyed(near_the_end, last_k=last_k) for last_k in _LAST]
    return together({"": rows_of(calls, "n", "chi_max"), "ends": _ends()})
