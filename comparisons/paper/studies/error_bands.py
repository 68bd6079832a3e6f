"""Ranges of the Tabor number with errors below 1, 2 and 5 %, and convergence rates of the jumps."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from itertools import pairwise, product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.models.semi_rigid import jump_in_coefficient
from comparisons.output.style import COLOURS, LINES, MARKERS
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, held, level, panels
from comparisons.paper.paper_figure import Plan, Tables, paper_figure
from comparisons.paper.studies.errors import CANDIDATES, compared, errors_at, with_kappa

__all__ = ["bands", "coefficients", "error_table", "rates"]

#: Limits of the relative error.
LIMITS = (0.01, 0.02, 0.05)
_KEY = ["quantity", "model", "n", "k"]
#: Tabor numbers, from nearly rigid to nearly JKR; jumps begin between 0.64 and 1.32, by shape and gradient.
_TABOR = (0.01, 0.02, 0.05, 0.1, 0.2, 0.35, 0.6, 0.8, 1.0, 1.4, 2.0, 3.2, 5.0)
#: Shape indices (the attraction of the 9-3 law has no finite sum for n <= 2/3) at two gradient exponents, and gradient
#: exponents (beyond 0.8 the cohesive edge is too narrow at large mu) at two shapes.
_CASES = [(n, k, mu) for k in (0.0, 0.4) for n in (0.8, 1.0, 1.2, 1.5, 2.0, 2.5, 3.5, 5.0, 8.0) for mu in _TABOR]
_CASES += [(n, k, mu) for n in (1.5, 2.0) for k in (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8) for mu in _TABOR]
_CASES = list(dict.fromkeys(_CASES))
#: Beyond, for the rates.
_SOFT = [(2.0, k, mu) for k in (0.0, 0.4) for mu in (10.0, 20.0)]


def error_table(results: Any, cases: Iterable[tuple[float, float, float]], quantities: Iterable[str]) -> pd.DataFrame:
    """Return one row a case, quantity and model, from results of `errors_at` by case."""
    return with_kappa(
        {"n": n, "k": k, "mu": mu, "quantity": name} | row
        for n, k, mu in cases
        for name in quantities
        for row in compared(results[n, k, mu][name])
    )


def _crossing(a: list[float], b: list[float], limit: float) -> float:
    """Tabor number where |kappa| passes the limit between two points (mu, kappa), linear in log mu and kappa."""
    (mu_a, low), (mu_b, high) = a, b
    target = math.copysign(limit, high if abs(high) > limit else low)
    # Linear interpolation between the computed Tabor numbers has two digits.
    return float(f"{mu_a * (mu_b / mu_a) ** ((target - low) / (high - low)):.2g}")


def bands(table: pd.DataFrame) -> pd.DataFrame:
    """Return for each model, quantity, n, k and limit the ranges of mu in which abs(kappa) stays within it.

    Parameters
    ----------
    table : DataFrame
        As of `error_table`.

    Returns
    -------
    DataFrame
        One row a range.  ``mu_from`` and ``mu_to`` are its ends with two digits, interpolated between the computed
        Tabor numbers ``from_below``, ``from_above`` and ``to_below``, ``to_above``.  Where the range begins or ends
        with the computed ones both are equal: it may extend further.  A row without numbers
        stands for no range.  ``largest_kappa`` and ``at_mu`` belong to all computed Tabor numbers of the row's n and k.

    Examples
    --------
    >>> table = pd.DataFrame({"quantity": "q", "model": "m", "n": 2.0, "k": 0.0, "mu": [0.1, 1.0, 10.0]})
    >>> ranges = bands(table.assign(kappa=[0.0, 0.02, 0.001]))
    >>> ranges[ranges["limit"] == 0.01][["mu_from", "mu_to"]].values.tolist()
    [[0.1, 0.32], [3.4, 10.0]]
    """
    rows = []
    for key, points in _series(table, "mu", "kappa"):
        at_mu, largest = max(points, key=lambda point: abs(point[1]))
        for limit in LIMITS:
            row = key | {"limit": limit, "largest_kappa": largest, "at_mu": at_mu}
            rows += [row | span for span in _spans(points, limit) or [{}]]
    columns = ["mu_from", "mu_to", "from_below", "from_above", "to_below", "to_above"]
    return pd.DataFrame(rows).reindex(columns=[*_KEY, "limit", *columns, "largest_kappa", "at_mu"])


def _series(table: pd.DataFrame, *columns: str) -> Iterator[tuple[dict[str, Any], list[list[float]]]]:
    """Points with an error of one quantity of one model at one n and k, by rising Tabor numbers."""
    for key, line in table.groupby(_KEY, sort=False):
        points = line[line["kappa"].notna()].sort_values("mu")[list(columns)].to_numpy(float).tolist()
        if points:
            yield dict(zip(_KEY, key, strict=True)), points


def _spans(points: list[list[float]], limit: float) -> list[dict[str, float]]:
    """Ranges of mu within the limit; a sign change between two points beyond the limit is not a range."""
    spans: list[dict[str, float]] = []
    lowest, highest = points[0][0], points[-1][0]
    start = {"mu_from": lowest, "from_below": lowest, "from_above": lowest}
    for a, b in pairwise(points):
        if abs(a[1]) > limit >= abs(b[1]):
            start = {"mu_from": _crossing(a, b, limit), "from_below": a[0], "from_above": b[0]}
        elif abs(a[1]) <= limit < abs(b[1]):
            spans.append(start | {"mu_to": _crossing(a, b, limit), "to_below": a[0], "to_above": b[0]})
    if abs(points[-1][1]) <= limit:
        spans.append(start | {"mu_to": highest, "to_below": highest, "to_above": highest})
    return spans


def rates(table: pd.DataFrame) -> pd.DataFrame:
    """Return the exponent r of abs(kappa) ~ mu^-r of the jumps between neighbouring large Tabor numbers.

    Parameters
    ----------
    table : DataFrame
        As of `error_table`, with jumps.

    Returns
    -------
    DataFrame
        For each model, n and k the last two pairs of Tabor numbers: ``mu_from``, ``mu_to``, ``kappa`` and ``u_kappa``
        at the second, and ``rate``; NaN where kappa changes its sign between them.

    Notes
    -----
    JKR's jump-out should become exact as mu^-2 for all n and k.  In the units in which JKR is one curve (Eqs. 63-65)
    the range of the forces is z0~ = 1/mu.  Outside the contact they are ~ z0~^2 / H^3, inside the surfaces overlap by
    p / 16 in units of z0 and dgamma / z0, which is ~ z0~^2: both are corrections of the order mu^-2, the first with a
    logarithm of mu at k = 0, so that the rate comes to 2 from below and slowly.  The cohesive edge, of width
    mu^(-2/(1-k)), is no larger a correction; it is the only one of the Maugis-Dugdale models.
    """
    rows = []
    for key, points in _series(table[table["mu"] >= 1.0], "mu", "kappa", "u_kappa"):
        for (mu_a, kappa_a, _), (mu_b, kappa_b, u_kappa) in list(pairwise(points))[-2:]:
            same = kappa_a * kappa_b > 0.0
            rate = -math.log(kappa_b / kappa_a) / math.log(mu_b / mu_a) if same else math.nan
            rows.append(key | {"mu_from": mu_a, "mu_to": mu_b, "kappa": kappa_b, "u_kappa": u_kappa, "rate": rate})
    return pd.DataFrame(rows)


def coefficients(table: pd.DataFrame) -> pd.DataFrame:
    """Return C_in of Eq. 48 and (1 - delta_in) / mu^((2n+k-1)/(4n+k-1)) of the FSCM, which it approximates.

    Parameters
    ----------
    table : DataFrame
        As of `error_table`, with the jump-in.

    Returns
    -------
    DataFrame
        For each n and k at the two largest Tabor numbers: ``semi_rigid``, ``fscm``, ``u_fscm`` and ``excess``, the
        relative error of Eq. 48.

    Notes
    -----
    Without the repulsion, negligible at a jump-in from far, one gap H + 1 measured in mu^((2n+k-1)/(4n+k-1)) obeys one
    equation for all mu.  The power of Eq. 47 is therefore exact, and the excess of its coefficient does not vanish as
    mu grows: at the fold the deformation is a fixed share of the gap.
    """
    rows: list[dict[str, float]] = []
    for key, points in _series(table[table["model"] == "semi-rigid"], "mu", "fscm", "u_fscm"):
        n, k = key["n"], key["k"]
        for mu, value, u in points[-2:]:
            unit, closed = mu ** ((2.0 * n + k - 1.0) / (4.0 * n + k - 1.0)), jump_in_coefficient(n, k)
            exact = (1.0 - value) / unit
            row = {"n": n, "k": k, "mu": mu, "semi_rigid": closed, "fscm": exact, "u_fscm": u / unit}
            rows.append(row | {"excess": closed / exact - 1.0})
    return pd.DataFrame(rows)


def _picture(figure: Figure, tables: Tables) -> None:
    jumps = tables["jumps"].dropna(subset="kappa").set_index(["quantity", "model"]).sort_index()
    lattice = panels(figure, 1, 2, ("jump-in, semi-rigid", "jump-out, JKR"), LABELS["mu"])
    pairs = (("jump_in_displacement", "semi-rigid"), ("jump_out_displacement", "jkr"))
    for axes, pair in zip(lattice, pairs, strict=True):
        table = jumps.loc[pair]
        for (i, n), (j, k) in product(enumerate((1.0, 1.5, 2.0, 5.0)), enumerate((0.0, 0.4))):
            line = table[(table["n"] == n) & (table["k"] == k)].sort_values("mu")
            style: Any = {"color": COLOURS[i], "ls": LINES[j], "marker": MARKERS[i], "ms": 3.5, "lw": 1.0}
            axes.plot(line["mu"], 100.0 * line["kappa"], label=held(n=n, k=k), **style)
        # The scale of kappa passes zero linearly and is logarithmic beyond.
        axes.set_yscale("symlog", linthresh=0.1, linscale=0.5)
        level(axes)
        for limit in LIMITS:
            level(axes, 100.0 * limit, lw=0.6, ls=":")
            level(axes, -100.0 * limit, lw=0.6, ls=":")
        axes.set(xscale="log", ylabel=r"relative error of the displacement $\kappa$ (%)")
        axes.set_xticks([1, 2, 5, 10, 20], labels=["1", "2", "5", "10", "20"])
        # A third beyond the smallest and the largest error, whatever their signs.
        low, high = 100.0 * table["kappa"].min(), 100.0 * table["kappa"].max()
        low, high = low * (1.3 if low < 0.0 else 0.7), high * (1.3 if high > 0.0 else 0.7)
        ticks = [sign * tick for tick in (0.1, 0.2, 0.5, 1, 2, 5, 10, 20) for sign in (-1, 1)]
        ticks = [tick for tick in (0, *ticks) if low <= tick <= high]
        axes.set_yticks(ticks, labels=[f"{tick:+g}" if tick else "0" for tick in ticks])
        axes.set_ylim(low, high)
        axes.minorticks_off()
    guide = np.array([5.0, 20.0])
    lattice[1].plot(guide, 0.05 * (guide / 20.0) ** -2.0, color="0.4", lw=2.5, alpha=0.5, label=r"$\mu^{-2}$")
    figure.legend(*lattice[1].get_legend_handles_labels(), loc="outside lower center", ncol=5)


@paper_figure(_picture, size=(7.2, 3.8))
def error_bands() -> Plan[Tables]:
    """Where each closed form is good to 1, 2 and 5 %, and how fast the jumps approach their asymptotes."""
    results = yield {case: CachedCall.of(errors_at, *case) for case in _CASES + _SOFT}
    jumps = error_table(results, _CASES + _SOFT, [name for name in CANDIDATES if name != "pull_off_force"])
    return {
        "": bands(error_table(results, _CASES, CANDIDATES)),
        "rates": rates(jumps),
        "jump_in_coefficients": coefficients(jumps),
        "jumps": jumps,
    }
