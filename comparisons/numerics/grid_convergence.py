"""Bound on the error of a number from its values on several grids.

`three_grids` is the procedure of Celik et al. (J. Fluids Eng. 130 (2008) 078001), with Roache's grid convergence index.
It takes the order of convergence as *declared* for the quantity, since it is decided by singularities at a cohesive
edge and not by the polynomials of an element.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

__all__ = [
    "CAUTIOUS_SAFETY",
    "LOWEST_ORDER",
    "NOISE",
    "SAFETY",
    "GridConvergence",
    "checked",
    "three_grids",
]

Array = NDArray[np.float64]

#: Factor on the error estimate of three grids in their asymptotic range, and otherwise (Roache 1998, Sec. 5.9).
SAFETY, CAUTIOUS_SAFETY = 1.25, 3.0
#: An observed order below this is not trusted (Eca and Hoekstra).
LOWEST_ORDER = 0.5
#: Ratios of grid sizes nearer to each other than this count as equal; the order has then a closed form.
_SAME_RATIO = 1e-12
#: Natural logarithm of the largest power of a ratio in the search for the order.
_LARGEST_POWER = 200.0
#: Differences below this many roundings of the value are noise: they have no order.
NOISE = 16.0 * 2.0**-52


@dataclass(frozen=True, slots=True)
class GridConvergence:
    """Value, limit and bound from a family of grids.

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


def checked(sizes: Sequence[float], values: Sequence[float], fewest: int) -> tuple[Array, Array]:
    """Return sizes and values as arrays, finest grid first, or raise a ValueError if they have no order."""
    h, f = np.asarray(sizes, float), np.asarray(values, float)
    if h.shape != f.shape or h.ndim != 1 or len(h) < fewest:
        raise ValueError(
            f"{len(h)} grid sizes and {len(f)} values: at least {fewest} of each are needed, as many of each"
        )
    if not (np.isfinite(h).all() and np.isfinite(f).all() and h.min() > 0.0):
        raise ValueError("grid sizes must be positive and everything finite")
    order = np.argsort(h)
    if (np.diff(h[order]) <= 0.0).any():
        raise ValueError("two grids have the same size: they show nothing about convergence")
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
    h, f = checked(sizes, values, 3)
    if len(h) != 3:
        raise ValueError(f"{len(h)} grids are not three: the procedure takes the finest three")
    (h1, h2, h3), (f1, f2, f3) = h.tolist(), f.tolist()
    fine, coarse = f2 - f1, f3 - f2
    noise = NOISE * max(abs(f1), abs(f2), abs(f3))
    if abs(fine) <= noise or abs(coarse) <= noise:
        return GridConvergence(f1, f1, CAUTIOUS_SAFETY * max(abs(fine), abs(coarse), noise), math.nan)
    p = _observed_order(h2 / h1, h3 / h2, coarse / fine)
    # A negative order is divergence; the estimate of order 1/2 then only tells how far the grids are apart.
    used = min(max(p, LOWEST_ORDER), declared) if math.isfinite(p) else LOWEST_ORDER
    error = fine / ((h2 / h1) ** used - 1.0)
    oscillates = coarse / fine < 0.0
    factor = CAUTIOUS_SAFETY if oscillates or not p >= LOWEST_ORDER else SAFETY
    size = max(abs(error), abs(f1 - f3)) if oscillates or not p > 0.0 else abs(error)
    return GridConvergence(f1, f1 - error, factor * size, p)


def _observed_order(r21: float, r32: float, ratio: float) -> float:
    """Return Celik et al.'s p of (f3 - f2)/(f2 - f1) = ratio; negative for divergence, NaN if there is none.

    Where the values oscillate, p a = abs(ln abs(ratio) + q(p)) makes p positive for growing oscillations too.
    """
    a, b, size = math.log(r21), math.log(r32), math.log(abs(ratio))
    sign = 1.0 if ratio > 0.0 else math.copysign(1.0, size)
    size *= sign
    if abs(b - a) <= _SAME_RATIO * a:
        return size / a

    def misfit(p: float) -> float:
        if ratio < 0.0:
            return p * a + sign * math.log((math.exp(p * b) + 1.0) / (math.exp(p * a) + 1.0)) - size
        return p * a + math.log(math.expm1(p * b) / math.expm1(p * a) if p else b / a) - size

    end = _LARGEST_POWER / max(a, b)
    start = -end if ratio > 0.0 else 0.0
    return scipy.optimize.brentq(misfit, start, end, xtol=1e-13) if misfit(start) <= 0.0 < misfit(end) else math.nan
