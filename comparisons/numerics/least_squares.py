"""Bound on the error of a number from scattered values on four grids or more.

The procedure of Eca and Hoekstra (J. Comput. Phys. 262 (2014) 104-130).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from comparisons.numerics.grid_convergence import CAUTIOUS_SAFETY, LOWEST_ORDER, NOISE, SAFETY, GridConvergence, checked

__all__ = ["least_squares"]

Array = NDArray[np.float64]

#: A fitted order is trusted up to this much above the declared one (Eca and Hoekstra take 0.5 to 2.1 for 2).
_EXCESS = 0.1
#: Orders of the first search.
_ORDERS = np.linspace(0.05, 12.0, 120)


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
    >>> round(found.observed_order, 6), round(found.extrapolated, 6), round(found.u_num, 6)
    (2.0, 2.0, 0.125)
    """
    h, f = checked(sizes, values, 4)
    fits = [_best_power(h, f, weights) for weights in _weightings(h)]
    p, fit = min(fits, key=lambda found: found[1].scatter)
    trusted = LOWEST_ORDER <= p <= declared + _EXCESS
    if not trusted:
        terms = [(1.0,), (declared,)] + ([(1.0, declared)] if p < LOWEST_ORDER and declared != 1.0 else [])
        fit = min(
            (_fit(h, f, weights, powers) for powers in terms for weights in _weightings(h)),
            key=lambda found: found.scatter,
        )
    spread = float(np.ptp(f)) / (len(f) - 1)
    error, misfit = abs(f[0] - fit.limit), abs(f[0] - fit.at_finest)
    if spread == 0.0:
        noise = NOISE * abs(f[0])
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
    """The order with the least scatter: the best of a table, then between its neighbours."""

    def scatter(p: float) -> float:
        return _fit(h, f, weights, (p,)).scatter

    best = int(np.argmin([scatter(p) for p in _ORDERS]))
    ends = _ORDERS[max(best - 1, 0)], _ORDERS[min(best + 1, len(_ORDERS) - 1)]
    p = float(minimize_scalar(scatter, bounds=ends, method="bounded", options={"xatol": 1e-9}).x)
    return p, _fit(h, f, weights, (p,))
