"""Cubic Hermite test of an interval between two samples whose values and derivatives are known.

In x from 0 to 1 over the interval, the function is the cubic plus d(x) x^2 (1 - x)^2, where d is a fourth divided
difference.  The values and derivatives of neighbouring samples tell its size.  If the slope or the curvature of the
cubic exceeds its possible error at each x, then the cubic has as many turning points as the function.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fem_reference._typing import Array

__all__ = ["Interval", "Sample"]

#: Factor on the largest fourth difference among the neighbours: the assumption of the test.
SAFETY = 2.0

#: Values of x at which slope and curvature are compared with their errors.
PLACES = 65


@dataclass(frozen=True, slots=True)
class Sample:
    """A parameter, and the value and derivative of a function there."""

    parameter: float
    value: float
    rate: float


@dataclass(frozen=True, eq=False)
class Interval:
    """Two samples and their neighbours.

    Attributes
    ----------
    first, second : Sample
        The ends.
    neighbours : sequence of Sample
        Samples beyond the ends; without any the error of the cubic is unknown.

    Examples
    --------
    A cubic with a maximum and a minimum between two ends where it rises:

    >>> ends = Sample(-1.0, -0.9, 2.9), Sample(1.0, 0.9, 2.9)  # x^3 - 0.1 x
    >>> inside = Interval(*ends, [Sample(2.0, 7.8, 11.9)])
    >>> inside.decided(0.0), [round(float(t), 6) for t in inside.turns()]
    (True, [-0.182574, 0.182574])
    """

    first: Sample
    second: Sample
    neighbours: Sequence[Sample]

    @property
    def _length(self) -> float:
        return self.second.parameter - self.first.parameter

    @cached_property
    def _coefficients(self) -> tuple[float, float, float]:
        """Coefficients of x, x^2 and x^3."""
        start, end = self.first.rate * self._length, self.second.rate * self._length
        rise = self.second.value - self.first.value
        return start, 3.0 * rise - 2.0 * start - end, start + end - 2.0 * rise

    def _cubic(self, x: Array) -> Array:
        """Value of the cubic."""
        a, b, c = self._coefficients
        return self.first.value + x * (a + x * (b + x * c))

    def _slope(self, x: Array) -> Array:
        """Derivative of the cubic with respect to x."""
        a, b, c = self._coefficients
        return a + x * (2.0 * b + 3.0 * c * x)

    @cached_property
    def _difference(self) -> float:
        """Largest fourth divided difference, in x, that the neighbours show."""
        difference = np.inf
        for sample in self.neighbours:
            x = (sample.parameter - self.first.parameter) / self._length
            area = x * (x - 1.0)
            value = (sample.value - float(self._cubic(np.array(x)))) / area**2
            rate = (sample.rate * self._length - float(self._slope(np.array(x)))) / (2.0 * area * (2.0 * x - 1.0))
            largest = max(abs(value), abs(rate))
            difference = largest if np.isinf(difference) else max(difference, largest)
        return float(difference)

    def decided(self, tolerance: float) -> bool:
        """Whether the number of turning points is that of the cubic, but for changes of the value below a tolerance."""
        x = np.linspace(0.0, 1.0, PLACES)
        error = SAFETY * self._difference
        if not np.isfinite(error):
            return False
        _, b, c = self._coefficients
        slope, curvature = np.abs(self._slope(x)), np.abs(2.0 * b + 6.0 * c * x)
        # The derivatives of x^2 (1 - x)^2 are at most 2 x (1 - x) and 2.
        uncertain = slope <= error * x * (1.0 - x)
        return not np.any(uncertain & (curvature <= 2.0 * error) & (slope + 0.25 * error > tolerance))

    def turns(self) -> Array:
        """Parameters of the turning points of the cubic strictly inside, in ascending x."""
        a, b, c = self._coefficients
        with np.errstate(divide="ignore", invalid="ignore"):
            root = np.sqrt(b * b - 3.0 * a * c)
            # Both roots without cancellation.
            q = -(b + np.copysign(root, b))
            x = np.sort(np.array([np.divide(q, 3.0 * c), np.divide(a, q)]))
        x = x[(x > 0.0) & (x < 1.0)]
        return self.first.parameter + self._length * x

    def value_at(self, parameter: float) -> float:
        """Value of the cubic."""
        return float(self._cubic(np.array((parameter - self.first.parameter) / self._length)))

    def rate_at(self, parameter: float) -> float:
        """Derivative of the cubic."""
        return float(self._slope(np.array((parameter - self.first.parameter) / self._length))) / self._length

    def range(self) -> tuple[float, float]:
        """Smallest and largest value of the cubic."""
        values = [self.first.value, self.second.value, *map(self.value_at, self.turns())]
        return min(values), max(values)
