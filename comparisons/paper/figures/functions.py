"""Figs. 2, 11 and 12: functions inside the models: kernel, change of the JKR force by the gradient, surface laws."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy.optimize import brentq, minimize_scalar

import fscm
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.models.jkr import JKR
from comparisons.output.style import COLOURS
from comparisons.paper.drawing import LABELS, by_model, case, dashed, legend_below, level, lines_by, panels
from comparisons.paper.paper_figure import Tables, paper_figure
from comparisons.paper.plan import Plan, cases, result_of, rows_of, together
from comparisons.paper.tasks import SHAPES, TRACTION
from comparisons.problem import Problem

#: Gradient exponents; at k = 1, the Gibson limit, both functions are steps at s = 1.
_GRADIENTS = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)
_FARTHEST = 3.0
#: Near s = 0, where Psi_k falls like -s^(1-k), and on both sides of s = 1, where the derivative is singular.
_NEAR = np.geomspace(1e-6, 0.02, 24)
#: Ratios of radii s = t/r.
RATIOS = np.unique(np.concatenate([np.linspace(0.0, _FARTHEST, 151), _NEAR, 1.0 + _NEAR, 1.0 - _NEAR]))

#: Last gradient exponent with which the search gives all eight numbers of Fig. 11 with the printed digits; the paper
#: does not state it.  Three of which the end of the second region is shown, and that end as it is printed.
LAST_K = 0.999
_LAST, _PRINTED = (1.0, 0.9995, LAST_K), 6.219
#: Shape indices of Fig. 11(b), and near the end of the second region.
_OVER = np.unique(np.concatenate([np.linspace(0.9, 2.0, 111), np.linspace(2.0, 8.0, 121)])).tolist()
_END = np.linspace(6.213, 6.223, 11).tolist()
_CHI_MAX = r"largest deviation $\chi_{\max}$ (%)"
#: In the two regions of Fig. 11(b) the chi of Eq. 58 is below it.
_LIMIT = 0.1
#: Brackets of the four ends of the regions; chi_max - 0.1 changes its sign once in each.
_BRACKETS = ((0.9, 1.0), (1.0, 1.2), (3.0, 4.0), (5.0, 8.0))
#: Gradient exponents of the search: between neighbours chi(k) has one maximum at most.
_SEARCHED = np.linspace(0.0, 1.0, 21)
#: Of the gradient exponent where chi is largest; chi is stationary there, or it is an end.
_PLACE_TOLERANCE = 1e-9

#: Gaps at which the laws are drawn.
_GAPS = np.linspace(-0.08, 4.0, 409)
#: Shape index whose improved law is drawn.
_DRAWN = 2.0


def kernel_functions(k: float) -> dict[str, list[float | None]]:
    """Return Phi_k (Eq. 18), its derivative (Eq. 19) and Psi_k (Eq. 22) over s = t/r; None where infinite.

    At k = 1 they are the limits k -> 1 at every s: a step, zero but for a delta function at s = 1, and a step.

    Examples
    --------
    >>> kernel_functions(0.4)["psi"][0], kernel_functions(1.0)["phi"][-1]
    (0.0, 1.0)
    """
    if k == 1.0:
        # Phi_k(1) = Gamma(1-k) / [Gamma((1-k)/2) Gamma((3-k)/2)] -> 1/2, and Psi_k(0) = 0 for every k < 1.
        phi = np.heaviside(RATIOS - 1.0, 0.5)
        slope = np.where(RATIOS == 1.0, np.inf, 0.0)
        psi = np.where(RATIOS > 0.0, phi - 1.0, 0.0)
    else:
        phi, psi = fscm.Phi(k, RATIOS), fscm.Psi(k, RATIOS)
        away = RATIOS != 1.0
        slope = np.full(RATIOS.shape, np.inf)
        # Eq. 19 is (1-k) times the ring response at unit radius.
        slope[away] = (1.0 - k) * fscm.ring_response(k, np.ones(away.sum()), RATIOS[away])
    finite = [float(value) if np.isfinite(value) else None for value in slope]
    return {"s": RATIOS.tolist(), "phi": phi.tolist(), "slope": finite, "psi": psi.tolist()}


def _kernel(figure: Figure, table: pd.DataFrame) -> None:
    left, right = panels(figure, ("", ""), "ratio of radii $s = t/r$")
    lines_by(left, table, "k", "s", "phi")
    lines_by(left, table[table["k"] < 1.0], "k", "s", "slope", lw=0.7, label="_")
    # At k = 1 Psi jumps at s = 0, too.
    lines_by(right, table[(table["k"] < 1.0) | (table["s"] > 0.0)], "k", "s", "psi")
    left.set(ylabel=r"$\Phi_k(s)$ (thick), $\Phi_k'(s)$ (thin)", xlim=(0.0, _FARTHEST), ylim=(0.0, 2.5))
    right.set(ylabel=r"$\Psi_k(s)$", xlim=(0.0, _FARTHEST), ylim=(-1.05, 0.05))
    legend_below(figure, len(_GRADIENTS))


@paper_figure(_kernel, size=(7.2, 3.8))
def fig02_kernel_functions() -> Plan[Tables]:
    """The functions Phi_k, its derivative, and Psi_k."""
    return together({"": rows_of(kernel_functions, cases(k=_GRADIENTS))})


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


def largest_chi(n: float, last_k: float = 1.0) -> dict[str, float]:
    """Return the largest chi over 0 <= k <= `last_k`, ``chi_max``, and the k it is at.

    Examples
    --------
    >>> [round(100 * largest_chi(n)["chi_max"], 1) for n in (1, 1.5, 2, 5)]
    [4.4, 40.9, 33.3, 4.2]
    """
    gradients = last_k * _SEARCHED
    values = [chi(n, float(k)) for k in gradients]
    at = int(np.argmax(values))
    low, high = gradients[max(at - 1, 0)], gradients[min(at + 1, len(gradients) - 1)]
    peak = minimize_scalar(
        lambda k: -chi(n, float(k)), bounds=(low, high), method="bounded", options={"xatol": _PLACE_TOLERANCE}
    )
    chi_max, k = max((values[at], float(gradients[at])), (-float(peak.fun), float(peak.x)))
    return {"chi_max": chi_max, "k_of_chi_max": k}


def insensitive_regions(last_k: float = 1.0) -> list[float]:
    """Return the four shape indices between which, two and two, the largest chi over k is at most 10 %.

    Examples
    --------
    >>> [round(n, 2) for n in insensitive_regions()]
    [0.97, 1.06, 3.34, 6.22]
    """

    def excess(n: float) -> float:
        return largest_chi(n, last_k)["chi_max"] - _LIMIT

    return [float(brentq(excess, *bracket, xtol=1e-10)) for bracket in _BRACKETS]


def over_gradients(n: float) -> dict[str, list[float]]:
    """Return chi over k."""
    gradients = np.linspace(0.0, 1.0, 101).tolist()
    return {"k": gradients, "chi": [chi(n, k) for k in gradients]}


def _gradient_effect(figure: Figure, table: pd.DataFrame, largest: pd.DataFrame, regions: pd.DataFrame) -> None:
    left, right = panels(figure, ("", ""))
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


@paper_figure(_gradient_effect)
def fig11_gradient_effect() -> Plan[Tables]:
    """Deviation chi of the JKR pull-off force from the homogeneous solid's, and its largest over k."""

    def table_of_ends(ends: list[float]) -> pd.DataFrame:
        return pd.DataFrame({"limit": _LIMIT, "n_from": ends[::2], "n_to": ends[1::2]})

    return together(
        {
            "": rows_of(over_gradients, cases(n=SHAPES)),
            "largest": rows_of(largest_chi, cases(n=_OVER)),
            "regions": result_of(insensitive_regions).then(table_of_ends),
        }
    )


def _chi_range(figure: Figure, table: pd.DataFrame, ends: pd.DataFrame) -> None:
    axes = figure.subplots()
    for index, (last_k, end) in enumerate(ends.to_numpy()):
        line = table[table["last_k"] == last_k]
        label = rf"$k \leq$ {last_k:g}: 10 % at $n$ = {end:.4f}"
        axes.plot(line["n"], 100.0 * line["chi_max"], label=label, marker="o", ms=3, **dashed(index))
    level(axes, 100.0 * _LIMIT, ls="--")
    axes.axvline(_PRINTED, color="0.4", lw=0.8, ls=":", label=f"printed: {_PRINTED}")
    axes.set(xlabel=LABELS["n"], ylabel=_CHI_MAX)
    axes.legend()


@paper_figure(_chi_range, size=(5.0, 3.4))
def finding_chi_range() -> Plan[Tables]:
    """End of the second range of small chi, for three largest gradient exponents."""

    def table_of_ends(regions: dict[float, list[float]]) -> pd.DataFrame:
        return pd.DataFrame([{"last_k": last_k, "n_to": ends[3]} for last_k, ends in regions.items()])

    regions = together({last_k: result_of(insensitive_regions, last_k) for last_k in _LAST})
    largest = rows_of(largest_chi, cases(last_k=_LAST, n=_END), "chi_max")
    return together({"": largest, "ends": regions.then(table_of_ends)})


def dugdale(stress: float) -> pd.DataFrame:
    """Return the corners of Dugdale's law: -stress up to the gap 1 / stress, so that its area is dgamma.

    Examples
    --------
    >>> dugdale(0.5).values.tolist()
    [[0.0, 0.0], [0.0, -0.5], [2.0, -0.5], [2.0, 0.0], [4.0, 0.0]]
    """
    ends = [0.0, 0.0, 1.0 / stress, 1.0 / stress, float(_GAPS[-1])]
    return pd.DataFrame({"gap": ends, "pressure": [0.0, -stress, -stress, 0.0, 0.0]})


def _laws(figure: Figure, table: pd.DataFrame, laws: pd.DataFrame) -> None:
    left, right = panels(figure, ("", f"{case(n=_DRAWN)} (improved M-D)"))
    left.plot("n", "eta", data=table[np.isfinite(table["n"])], color=COLOURS[0], label=r"$\eta(n)$")
    strength = rf"theoretical strength $\sigma_{{\mathrm{{th}}}}$ = {THEORETICAL_STRENGTH:.3f}"
    left.axhline(THEORETICAL_STRENGTH, color=COLOURS[2], ls=":", label=strength)
    left.set(xscale="log", xlim=(0.7, 100), ylim=(0, 1.15))
    left.set(xlabel=LABELS["n"], ylabel=r"cohesive stress $\sigma_0 z_0/\Delta\gamma$")
    left.xaxis.set_major_formatter("{x:g}")
    left.legend(loc="lower right")
    by_model(right, laws, "gap", "pressure")
    level(right)
    right.set(xlabel=r"gap $H/z_0$", ylabel=r"pressure $p_s z_0/\Delta\gamma$", xlim=(-0.1, 4), ylim=(-1.15, 0.9))
    right.legend(loc="upper right")


@paper_figure(_laws)
def fig12_surface_laws() -> Plan[Tables]:
    """The cohesive stress eta(n), and the surface laws of the FSCM and both Maugis-Dugdale models."""
    return Plan({}, lambda _: _stresses_and_laws())


def _stresses_and_laws() -> Tables:
    shapes = [*np.unique(np.concatenate([np.geomspace(0.7, 100.0, 200), SHAPES])).tolist(), math.inf]
    laws = {
        "fscm": pd.DataFrame({"gap": _GAPS, "pressure": TRACTION(_GAPS)}),
        "md-original": dugdale(THEORETICAL_STRENGTH),
        "md-improved": dugdale(eta(_DRAWN)),
    }
    stresses = pd.DataFrame({"n": shapes, "eta": [eta(n) for n in shapes]})
    return {"": stresses, "laws": pd.concat(laws, names=["model"]).reset_index("model")}
