"""Grid convergence: what a number computed on several grids says about its own error.

`three_grids` is the procedure of Celik et al. (J. Fluids Eng. 130 (2008) 078001), which rests on Roache's
grid convergence index; `least_squares` that of Eca and Hoekstra (J. Comput. Phys. 262 (2014) 104-130), for
four grids or more and values that scatter.  Both take the order of convergence as *declared* for the
quantity: singularities at a cohesive edge decide it, not the polynomials of an element.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["DECLARED_ORDERS", "GridConvergence", "declared_order", "least_squares", "three_grids"]

Array = NDArray[np.float64]

#: Factor on the error estimate of three grids in their asymptotic range, and otherwise (Roache 1998, Sec.
#: 5.9).
SAFETY, CAUTIOUS_SAFETY = 1.25, 3.0
#: An observed order in this range around the declared one is trusted (Eca and Hoekstra take 0.5 to 2.1 for
#: 2).
_LOWEST, _EXCESS = 0.5, 0.1
_FIXED_POINT_STEPS, _FIXED_POINT_TOLERANCE = 200, 1e-12
#: Orders searched by the least-squares fit.
_ORDERS = np.linspace(0.05, 12.0, 120)
#: Differences below this many roundings of the value are noise: they have no order.
_NOISE = 16.0 * 2.0**-52

#: Model -> quantity -> order in the width of the segments.  The published scheme is a midpoint sum: 2,
#: measured 1.9 to 2.1 on 100 to 400 segments where the edge is wider than a segment.  The finite elements are of
#: degree 6 on meshes that resolve the edge; what they are asked converges faster (measured 7 to 15), which is
#: not relied on.
DECLARED_ORDERS: dict[str, dict[str, float]] = {
    "fem": dict.fromkeys(
        (
            "pull_off_force",
            "pull_off_displacement",
            "jump_in_displacement",
            "jump_out_displacement",
            "zero_load_displacement",
            "hysteresis_energy",
            "jump_in_gap",
        ),
        6.0,
    )
    # Just before jump-out the punch is in contact, and under the tip of a cone the stress is singular.
    | {"jump_out_gap": 2.0},
    "fscm-stieltjes": dict.fromkeys(("pull_off_force", "pull_off_displacement", "zero_load_displacement"), 2.0),
}


def declared_order(model: str, quantity: str) -> float:
    """Return the declared order of a quantity.

    Raises
    ------
    ValueError
        If none is declared.

    Examples
    --------
    >>> declared_order("fscm-stieltjes", "pull_off_force")
    2.0
    """
    try:
        return DECLARED_ORDERS[model][quantity]
    except KeyError:
        raise ValueError(f"no order of convergence is declared for {quantity} of {model}") from None


@dataclass(frozen=True, slots=True)
class GridConvergence:
    """What a family of grids says.

    Attributes
    ----------
    value : float
        On the finest grid; it is not replaced by the extrapolated one.
    extrapolated : float
        At zero grid size, by the order that was used.
    u_num : float
        Bound on abs(value - exact).
    observed_order : float
        As fitted; NaN where the differences are noise or no order fits.

    Examples
    --------
    >>> found = three_grids([1, 2, 4], [1.01, 1.04, 1.16], declared=2)
    >>> found.value, round(found.extrapolated, 12), round(found.u_num, 12)
    (1.01, 1.0, 0.0125)
    """

    value: float
    extrapolated: float
    u_num: float
    observed_order: float


def _checked(sizes: Sequence[float], values: Sequence[float], fewest: int) -> tuple[Array, Array]:
    h, f = np.asarray(sizes, float), np.asarray(values, float)
    if h.shape != f.shape or h.ndim != 1 or len(h) < fewest:
        raise ValueError(
            f"{len(h)} grid sizes and {len(f)} values: at least {fewest} of each are needed, as many of each"
        )
    if not (np.isfinite(h).all() and np.isfinite(f).all() and h.min() > 0.0):
        raise ValueError("grid sizes must be positive and everything finite")
    order = np.argsort(h)
    if (np.diff(h[order]) <= 0.0).any():
        raise ValueError("two grids have the same size: they say nothing about convergence")
    return h[order], f[order]


def three_grids(sizes: Sequence[float], values: Sequence[float], declared: float) -> GridConvergence:
    """Observed order, Richardson extrapolation and grid convergence index of three grids.

    Parameters
    ----------
    sizes, values : sequence of float, length 3
        Typical element sizes, in any order, and the value on each grid.
    declared : float
        Order the quantity converges with; what was observed is not trusted beyond it.

    Returns
    -------
    GridConvergence
        `u_num` is 1.25 times the Richardson estimate of the finest grid.  Where the observed order is above
        the declared one the latter is used, where it is below 1/2 or the values oscillate the factor is 3.

    Examples
    --------
    >>> found = three_grids([1, 2, 4], [0.97050, 0.96854, 0.96178], declared=2)     # Roache's nozzle
    >>> round(found.observed_order, 5), round(found.extrapolated, 5), round(found.u_num / 0.97050, 8)
    (1.78617, 0.9713, 0.00103083)
    """
    h, f = _checked(sizes, values, 3)
    if len(h) != 3:
        raise ValueError(f"{len(h)} grids are not three: use least_squares")
    (h1, h2, h3), (f1, f2, f3) = h.tolist(), f.tolist()
    fine, coarse = f2 - f1, f3 - f2
    noise = _NOISE * max(abs(f1), abs(f2), abs(f3))
    if abs(fine) <= noise or abs(coarse) <= noise:
        return GridConvergence(f1, f1, CAUTIOUS_SAFETY * max(abs(fine), abs(coarse), noise), math.nan)
    p = _observed_order(h2 / h1, h3 / h2, coarse / fine)
    # A negative order is divergence; the estimate of order 1/2 then only tells how far the grids are apart.
    used = min(max(p, _LOWEST), declared) if math.isfinite(p) else _LOWEST
    error = fine / ((h2 / h1) ** used - 1.0)
    oscillates = coarse / fine < 0.0
    factor = CAUTIOUS_SAFETY if oscillates or not p >= _LOWEST else SAFETY
    size = max(abs(error), abs(f1 - f3)) if oscillates or not p > 0.0 else abs(error)
    return GridConvergence(f1, f1 - error, factor * size, p)


def _observed_order(r21: float, r32: float, ratio: float) -> float:
    """Solve Celik et al.'s p = abs(ln abs(ratio) + q(p)) / ln r21 by fixed point; NaN if not reached."""
    s, p = math.copysign(1.0, ratio), 1.0
    for _ in range(_FIXED_POINT_STEPS):
        a, b = r21**p - s, r32**p - s
        if a <= 0.0 or b <= 0.0:
            return math.nan
        new = abs(math.log(abs(ratio)) + math.log(a / b)) / math.log(r21)
        if abs(new - p) <= _FIXED_POINT_TOLERANCE * max(1.0, p):
            # The absolute value makes a positive number of divergence too; tell it apart.
            return -new if s > 0.0 and abs(ratio) < _ratio(r21, r32, 0.0) else new
        p = new
    return math.nan


def _ratio(r21: float, r32: float, p: float) -> float:
    """(f3 - f2) / (f2 - f1) of a term h^p; the limit at p = 0 divides convergence from divergence."""
    if p == 0.0:
        return math.log(r32) / math.log(r21)
    return r21**p * (r32**p - 1.0) / (r21**p - 1.0)


def least_squares(sizes: Sequence[float], values: Sequence[float], declared: float) -> GridConvergence:
    """Fit f0 + alpha h^p to four grids or more; bound the error by the fit, its scatter and its misfit.

    Parameters
    ----------
    sizes, values : sequence of float, length >= 4
        Typical element sizes, in any order, and the value on each grid.
    declared : float
        Order the quantity converges with; takes the place of the 2 of the original procedure.

    Returns
    -------
    GridConvergence
        With the data range D = (max f - min f) / (m - 1) and the scatter s of the chosen fit:
        u_num = F abs(f1 - f0) + s + abs(f1 - fit) if s < D, and 3 s/D times (error + s + misfit) otherwise;
        F = 1.25 if the fitted order is trusted and s < D, else 3.

    Notes
    -----
    Where the fitted order is above the declared one the best of the fits with p = 1 and p = declared is
    taken, and where it is below 1/2 also f0 + a h + b h^declared.  Every fit is made with equal weights and
    with weights 1/h, and the one of less scatter is taken (Eca and Hoekstra, Secs. 3.3 and 4).

    Examples
    --------
    >>> h = [1.0, 1.5, 2.0, 3.0]
    >>> found = least_squares(h, [2.0 + 0.1 * x**2 for x in h], declared=2)
    >>> round(found.observed_order, 6), round(found.extrapolated, 9), round(found.u_num, 9)
    (2.0, 2.0, 0.125)
    """
    h, f = _checked(sizes, values, 4)
    fits = [_best_power(h, f, weights) for weights in _weightings(h)]
    p, fit = min(fits, key=lambda found: found[1].scatter)
    trusted = _LOWEST <= p <= declared + _EXCESS
    if not trusted:
        terms = [(1.0,), (declared,)] + ([(1.0, declared)] if p < _LOWEST and declared != 1.0 else [])
        fit = min(
            (_fit(h, f, weights, powers) for powers in terms for weights in _weightings(h)),
            key=lambda found: found.scatter,
        )
    spread = float(np.ptp(f)) / (len(f) - 1)
    error, misfit = abs(f[0] - fit.limit), abs(f[0] - fit.at_finest)
    if spread == 0.0:
        noise = _NOISE * abs(f[0])
        return GridConvergence(float(f[0]), float(f[0]), float(CAUTIOUS_SAFETY * noise), math.nan)
    if fit.scatter < spread:
        u_num = (SAFETY if trusted else CAUTIOUS_SAFETY) * error + fit.scatter + misfit
    else:
        u_num = CAUTIOUS_SAFETY * fit.scatter / spread * (error + fit.scatter + misfit)
    return GridConvergence(float(f[0]), fit.limit, float(u_num), p)


@dataclass(frozen=True, slots=True)
class _Fit:
    limit: float
    at_finest: float
    scatter: float


def _weightings(h: Array) -> tuple[Array, Array]:
    inverse = 1.0 / h
    return np.full(len(h), 1.0 / len(h)), inverse / inverse.sum()


def _fit(h: Array, f: Array, weights: Array, powers: tuple[float, ...]) -> _Fit:
    """Weighted least squares of f0 + sum alpha_j h^p_j; an order counts as a parameter, fitted or not."""
    matrix = np.column_stack([np.ones(len(h)), *((h / h[-1]) ** p for p in powers)])
    root = np.sqrt(weights)
    coefficients = np.linalg.lstsq(matrix * root[:, None], f * root, rcond=None)[0]
    fitted = matrix @ coefficients
    # m w is 1 on average; the two-term and the power fit both spend three parameters.
    freedom = max(len(h) - 1 - max(len(powers), 1), 1)
    scatter = math.sqrt(float((len(h) * weights * (f - fitted) ** 2).sum()) / freedom)
    return _Fit(float(coefficients[0]), float(fitted[0]), scatter)


def _best_power(h: Array, f: Array, weights: Array) -> tuple[float, _Fit]:
    """The order with the least scatter: the best of a table, then golden section between its neighbours."""

    def scatter(p: float) -> float:
        return _fit(h, f, weights, (p,)).scatter

    best = int(np.argmin([scatter(p) for p in _ORDERS]))
    low, high = _ORDERS[max(best - 1, 0)], _ORDERS[min(best + 1, len(_ORDERS) - 1)]
    golden = (math.sqrt(5.0) - 1.0) / 2.0
    for _ in range(40):
        width = golden * (high - low)
        a, b = high - width, low + width
        low, high = (low, b) if scatter(a) < scatter(b) else (a, high)
    p = float(0.5 * (low + high))
    return p, _fit(h, f, weights, (p,))
