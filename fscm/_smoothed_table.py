"""Smooth curve through the noisy or sparse points of a surface law.

A difference of two powers is fitted to the points; a quintic smoothing spline fits the small remainder within the
stated error of the points.
"""

from __future__ import annotations

import numpy as np
import scipy

from fscm._typing import Array

__all__ = ["smoothed_table"]

#: Points of the curve, enough for the quintic interpolation of a law to 1e-6.
_POINTS = 200
#: Errors are relative to the traction, but at least to this share of the largest tension.
_FLOOR = 0.1
#: Excess of the exponent of the repulsion, and exponent of the attraction: initial and largest values of the fit.
_EXPONENTS, _LARGEST = (6.0, 3.0), (60.0, 60.0)
#: Least distance of the fit from the wall, and largest number of evaluations.
_NEAREST, _EVALUATIONS = 1e-2, 2000


def smoothed_table(gap: Array, p: Array, error: float) -> tuple[Array, Array]:
    """Gaps and tractions of a smooth curve through the points within about their relative error.

    Parameters
    ----------
    gap, p : ndarray, shape (N,)
    error : float
        Standard error of the tractions, relative to their size.
    """
    tension = float(np.max(-p))
    weight = error * (np.abs(p) + _FLOOR * tension)
    falling = slice(0, int(np.argmin(p)) + 1)
    zero = float(np.interp(0.0, -p[falling], gap[falling]))

    def powers(x: Array, at: Array, sign: float = -1.0) -> Array:
        """A (h^-(m+n) - h^-n), h the distance from the wall in units of that of the zero; or the sum of the two."""
        h = np.maximum((at - x[0]) / np.exp(x[1]), _NEAREST)
        n = np.exp(x[4])
        return np.asarray(np.exp(x[2]) * (h ** -(n + np.exp(x[3])) + sign * h**-n))

    wall = min(zero - 1.0, gap[0] - 0.1 * (zero - gap[0]))
    start = [wall, np.log(zero - wall), np.log(2.6 * tension), *np.log(_EXPONENTS)]
    upper = [gap[0], np.inf, np.inf, *np.log(_LARGEST)]
    x = scipy.optimize.least_squares(
        lambda x: (powers(x, gap) - p) / weight, start, bounds=(-np.inf, upper), x_scale="jac", max_nfev=_EVALUATIONS
    ).x
    weight = error * powers(x, gap, 1.0)
    # The sum of the squares of N errors of size 1 is N.
    correction = scipy.interpolate.UnivariateSpline(np.log(gap - x[0]), (p - powers(x, gap)) / weight, k=5, s=len(gap))
    at = np.exp(np.linspace(np.log(gap[0] - x[0]), np.log(gap[-1] - x[0]), _POINTS)) + x[0]
    at[0], at[-1] = gap[0], gap[-1]
    return at, powers(x, at) + correction(np.log(at - x[0])) * error * powers(x, at, 1.0)
