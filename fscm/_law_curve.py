"""Smooth curve through sparse or noisy points of a surface law.

A difference of two powers is fitted to the points.  What it leaves, relative to its size, is small and changes slowly
with the logarithm of the distance from the wall: a quintic spline interpolates it, or a cubic one fits it within the
stated error of the points.
"""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import scipy

from fscm._typing import Array

__all__ = ["law_curve"]

#: Fewest points of the curve, enough for the quintic interpolation of a law to 1e-6.
_POINTS = 200
#: Errors are relative to the traction, but at least to this share of the largest tension.
_FLOOR = 0.1
#: Excess of the exponent of the repulsion, and exponent of the attraction: initial and largest values of the fit.
_EXPONENTS, _LARGEST = (6.0, 3.0), (60.0, 60.0)
#: Least distance of the fit from the wall, and largest number of evaluations.
_NEAREST, _EVALUATIONS = 1e-2, 2000
#: Relative tolerance of the fit: the curve between the points depends on it, and must be the same wherever it is drawn.
_TOLERANCE = 1e-14


@dataclass(frozen=True)
class _Powers:
    """A (h^-(n + excess) - h^-n), h the distance from the wall in units of that of the zero."""

    wall: float
    zero: float
    A: float
    excess: float
    n: float

    @classmethod
    def of(cls, x: Array) -> _Powers:
        """From the variables of the fit: the wall, and logarithms."""
        return cls(float(x[0]), *(float(np.exp(value)) for value in x[1:]))

    def _terms(self, gap: Array) -> tuple[Array, Array]:
        """Attraction, and the repulsion relative to it minus one."""
        log_h = np.log(np.maximum((gap - self.wall) / self.zero, _NEAREST))
        return self.A * np.exp(-self.n * log_h), np.expm1(-self.excess * log_h)

    def traction(self, gap: Array) -> Array:
        """The difference."""
        attraction, net = self._terms(gap)
        return attraction * net

    def size(self, gap: Array) -> Array:
        """Size of the traction; at its zero, where a relative error means nothing, a share of the largest tension."""
        attraction, net = self._terms(gap)
        log_peak = math.log1p(self.excess / self.n) / self.excess
        largest = math.exp(-self.n * log_peak) * -math.expm1(-self.excess * log_peak)
        return np.hypot(attraction * net, 0.5 * _FLOOR * largest * attraction * (net + 2.0))


# A file is read, checked and posed with a law for each, of the same points.
@lru_cache(maxsize=8)
def _fitted_powers(gaps: tuple[float, ...], tractions: tuple[float, ...]) -> _Powers:
    """Least squares of the relative deviations from the points."""
    gap, p = np.array(gaps), np.array(tractions)
    tension = float(np.max(-p))
    weight = np.abs(p) + _FLOOR * tension
    falling = slice(0, int(np.argmin(p)) + 1)
    zero = float(np.interp(0.0, -p[falling], gap[falling]))
    wall = min(zero - 1.0, gap[0] - 0.1 * (zero - gap[0]))
    start = [wall, np.log(zero - wall), np.log(2.6 * tension), *np.log(_EXPONENTS)]
    upper = [gap[0], np.inf, np.inf, *np.log(_LARGEST)]
    x = scipy.optimize.least_squares(
        lambda x: (_Powers.of(x).traction(gap) - p) / weight,
        start,
        bounds=(-np.inf, upper),
        jac="3-point",
        x_scale="jac",
        ftol=_TOLERANCE,
        xtol=_TOLERANCE,
        gtol=_TOLERANCE,
        max_nfev=_EVALUATIONS,
    ).x
    return _Powers.of(x)


def law_curve(gap: Array, p: Array, error: float) -> tuple[Array, Array]:
    """Gaps and tractions of a smooth curve through the points, within about their relative error.

    Parameters
    ----------
    gap, p : ndarray, shape (N,)
    error : float
        Standard error of the tractions, relative to their size; 0 for a curve through every point.

    Returns
    -------
    ndarray, ndarray
        Each interval between two points is cut into equal steps of the logarithm of the distance from the wall.
    """
    powers, scale = _fitted_powers(tuple(gap.tolist()), tuple(p.tolist())), error or 1.0
    distance, left = np.log(gap - powers.wall), (p - powers.traction(gap)) / (scale * powers.size(gap))
    if error == 0.0:
        correction = scipy.interpolate.make_interp_spline(distance, left, k=5)
    else:  # the sum of the squares of N errors of size 1 is N; a quintic one bends at the end, where the wall begins
        with warnings.catch_warnings():
            # Its search may end before the sum is N to a thousandth (measured: at 0.98 N).
            warnings.simplefilter("ignore", UserWarning)
            correction = scipy.interpolate.UnivariateSpline(distance, left, k=3, s=len(gap))
    steps = len(gap) - 1
    pieces = math.ceil(_POINTS / steps)
    between = np.interp(np.arange(steps * pieces + 1) / pieces, np.arange(len(gap)), distance)
    at = np.exp(between) + powers.wall
    at[::pieces] = gap
    return at, powers.traction(at) + correction(between) * scale * powers.size(at)
