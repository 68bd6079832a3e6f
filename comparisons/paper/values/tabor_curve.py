"""Forces as functions of the Tabor number, from their values at Chebyshev points, and the largest error of one."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from comparisons.model import Array

#: The paper shows mu from 0.01 to a few; beyond 10 the differences vanish.
RANGE = (0.01, 10.0)
# The last coefficients estimate the error of the series: measured at random mu, it is at most 3 times the largest of
# the last five.
_LAST, _SAFETY = 5, 3.0
# Points of the search; the largest is refined by a parabola, whose error is then below 1e-8 of the maximum.
_SEARCH = 4001


def tabor_numbers(degree: int) -> tuple[float, ...]:
    """Return the Chebyshev points of log(mu) on `RANGE`, `degree` + 1 of them, increasing.

    Examples
    --------
    >>> [round(mu, 6) for mu in tabor_numbers(2)]
    [0.01, 0.316228, 10.0]
    """
    low, high = np.log(RANGE)
    points = low + 0.5 * (chebyshev.chebpts2(degree + 1) + 1.0) * (high - low)
    return tuple(float(mu) for mu in np.exp(points))


class TaborCurve(NamedTuple):
    """A positive force over mu, as a series for its logarithm, and the bound on its relative error."""

    coefficients: Array
    error: float

    @classmethod
    def through(cls, forces: Array, relative_error: float = 0.0) -> TaborCurve:
        """Return the curve through forces, of this error, at `tabor_numbers` of the degree that fits their number.

        Examples
        --------
        >>> curve = TaborCurve.through(np.array(tabor_numbers(8)) ** 0.5)
        >>> bool(np.isclose(curve(np.array([0.04]))[0], 0.2, rtol=1e-12))
        True
        """
        degree = len(forces) - 1
        coefficients = np.asarray(chebyshev.chebfit(chebyshev.chebpts2(degree + 1), np.log(forces), degree), float)
        return cls(coefficients, _SAFETY * float(np.max(np.abs(coefficients[-_LAST:]))) + relative_error)

    def __call__(self, mu: Array) -> Array:
        """The force, shape of `mu`."""
        low, high = np.log(RANGE)
        return np.asarray(np.exp(chebyshev.chebval(2.0 * (np.log(mu) - low) / (high - low) - 1.0, self.coefficients)))


class Extreme(NamedTuple):
    """The largest relative error, signed, its bound, and the Tabor number it is at."""

    kappa: float
    u: float
    mu: float


def largest_error(model: TaborCurve, exact: TaborCurve) -> Extreme:
    """Return the largest abs(kappa) of a model over `RANGE`.

    Examples
    --------
    >>> mu = np.array(tabor_numbers(20))
    >>> hump = TaborCurve.through(1.0 + 0.1 / (1.0 + np.log(mu) ** 2 / 10.0))
    >>> extreme = largest_error(hump, TaborCurve.through(np.ones(21)))
    >>> round(extreme.kappa, 6), round(extreme.mu, 4)
    (0.1, 1.0)
    """
    mu = np.geomspace(*RANGE, _SEARCH)
    kappa = model(mu) / exact(mu) - 1.0
    at = int(np.argmax(np.abs(kappa)))
    value, at_mu = float(kappa[at]), float(mu[at])
    if 0 < at < _SEARCH - 1:
        value, log_mu = _parabola(np.log(mu[at - 1 : at + 2]), kappa[at - 1 : at + 2])
        at_mu = float(np.exp(log_mu))
    return Extreme(value, (1.0 + abs(value)) * (model.error + exact.error), at_mu)


def _parabola(x: Array, y: Array) -> tuple[float, float]:
    """Extreme of the parabola through three points with equal steps, and where it is."""
    rise, bend = 0.5 * (y[2] - y[0]), y[2] - 2.0 * y[1] + y[0]
    return float(y[1] - 0.5 * rise**2 / bend), float(x[1] - (x[1] - x[0]) * rise / bend)
