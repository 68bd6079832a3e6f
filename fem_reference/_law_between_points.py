"""Tractions between the points of a sparse table of a surface law.

A spline through few points overshoots on the wall, where the traction changes most, and its waves reach the tail.  Two
powers of the distance from a wall are fitted to the points first; a spline of degree five interpolates the small rest,
relative to its scale, over the logarithm of that distance.
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
import scipy

from fem_reference._typing import Array

__all__ = ["denser_points"]

#: Smallest number of points after the division of the intervals.
DENSE = 200
#: Share of the largest tension below which deviations are not relative to the traction.
SHARE = 0.1
#: Exponents at the start of the fit, and the largest: attraction, and what the repulsion has more.
START, LARGEST = (3.0, 6.0), 60.0
#: Smallest distance from the wall in the fit, relative to that of the gap without traction.
CLOSEST = 1e-2
#: Tolerance of the fit: near rounding, so that the law does not depend on the way to the optimum.
TOLERANCE = 1e-14
#: Largest number of evaluations of the fit.
EVALUATIONS = 2000


class _TwoPowers(NamedTuple):
    """factor (y^-(n + more) - y^-n) with y = (x - wall) / length."""

    wall: float
    log_length: float
    log_factor: float
    log_more: float
    log_n: float

    def parts(self, x: Array) -> tuple[Array, Array]:
        """Attraction and repulsion, both positive."""
        log_y = np.log(np.maximum((x - self.wall) * math.exp(-self.log_length), CLOSEST))
        attraction = np.exp(self.log_factor - math.exp(self.log_n) * log_y)
        return attraction, attraction * np.exp(-math.exp(self.log_more) * log_y)

    def net(self, x: Array) -> Array:
        """Repulsion less attraction, without cancellation where the exponents are close."""
        log_y = np.log(np.maximum((x - self.wall) * math.exp(-self.log_length), CLOSEST))
        return self.parts(x)[0] * np.expm1(-math.exp(self.log_more) * log_y)

    def scale(self, x: Array) -> Array:
        """Scale of the traction that does not vanish with it."""
        n, more = math.exp(self.log_n), math.exp(self.log_more)
        log_peak = math.log1p(more / n) / more
        tension = math.exp(-n * log_peak) * -math.expm1(-more * log_peak)
        attraction, repulsion = self.parts(x)
        return np.hypot(self.net(x), 0.5 * SHARE * tension * (attraction + repulsion))


# One problem makes the law several times.
@lru_cache(maxsize=8)
def _fit(gaps: tuple[float, ...], tractions: tuple[float, ...]) -> _TwoPowers:
    """Two powers with the smallest squares of relative deviations."""
    x, p = np.array(gaps), np.array(tractions)
    tension, lowest = -float(p.min()), int(np.argmin(p))
    zero = float(np.interp(0.0, -p[: lowest + 1], x[: lowest + 1]))
    wall = min(zero - 1.0, x[0] - 0.1 * (zero - x[0]))
    first = _TwoPowers(wall, math.log(zero - wall), math.log(2.6 * tension), math.log(START[1]), math.log(START[0]))
    highest = [x[0], np.inf, np.inf, math.log(LARGEST), math.log(LARGEST)]
    scale = np.abs(p) + SHARE * tension
    result = scipy.optimize.least_squares(
        lambda v: (_TwoPowers(*v).net(x) - p) / scale,
        first,
        bounds=(-np.inf, highest),
        jac="3-point",
        x_scale="jac",
        ftol=TOLERANCE,
        xtol=TOLERANCE,
        gtol=TOLERANCE,
        max_nfev=EVALUATIONS,
    )
    return _TwoPowers(*map(float, result.x))


def denser_points(x: Array, p: Array) -> tuple[Array, Array]:
    """The points and others between them, on a curve through all of them.

    Parameters
    ----------
    x, p : ndarray
        Gaps in lengths of the law, and tractions.

    Examples
    --------
    >>> gap = np.geomspace(0.75, 20.0, 12)
    >>> x, p = denser_points(gap, gap**-9 - gap**-3)
    >>> len(x), bool(abs(p - (x**-9 - x**-3)).max() < 1e-6)
    (210, True)
    """
    powers = _fit(tuple(x.tolist()), tuple(p.tolist()))
    log_distance = np.log(x - powers.wall)
    rest = scipy.interpolate.make_interp_spline(log_distance, (p - powers.net(x)) / powers.scale(x), k=5)
    parts = math.ceil(DENSE / (len(x) - 1))
    # Equal steps of the logarithm in each interval.
    steps = np.arange(parts * (len(x) - 1) + 1) / parts
    at = np.interp(steps, np.arange(len(x)), log_distance)
    gaps = powers.wall + np.exp(at)
    gaps[::parts] = x
    return gaps, powers.net(gaps) + rest(at) * powers.scale(gaps)
