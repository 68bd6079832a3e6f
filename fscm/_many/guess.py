"""Guesses of the states of least load, from series in n, k and mu that are stored with the package.

A state is described by ln c, its displacement, the width of its edge, and ln(1 + H) at points whose logarithmic
distances from the edge, in units of that width, are graded equally for all problems.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from fscm._typing import Array
from fscm.interpolation.coordinates import BOX, reduced_compliance

__all__ = ["DATA", "INSIDE", "OUTSIDE", "Guess", "basis", "described", "guesses", "outer_end", "point_offsets", "terms"]

#: File of the series.
DATA = Path(__file__).parents[1] / "interpolation" / "data" / "pull_off_states.npz"
#: Numbers of points inside and outside the edge.
INSIDE, OUTSIDE = 16, 24
#: Factor of the compliance in the third coordinate, and the weight of its degree.
_FACTOR, _SLOWER = 1.0, 0.75
#: Height of the punch at the last point.
_HEIGHT = 1e3


def _points(count: int) -> Array:
    return 0.5 * (1.0 - np.cos(np.pi * (np.arange(count) + 0.5) / count))


class Guess(NamedTuple):
    """Guesses of states, arrays of shape (b,) and (b, points).

    Attributes
    ----------
    log_scale, displacement, width : ndarray
        Of the edge, relative to its radius.
    inside, outside : ndarray
        ln(1 + H) at the points.
    """

    log_scale: Array
    displacement: Array
    width: Array
    inside: Array
    outside: Array

    def deformation(self, i: int, n: float, k: float, offsets: Array) -> Array:
        """Deformations of one state at radii relative to the edge."""
        height = np.exp(n * (self.log_scale[i] + np.log1p(offsets))) / n
        return np.asarray(self.gaps(i, n, k, offsets) + self.displacement[i] - height)

    def gaps(self, i: int, n: float, k: float, offsets: Array) -> Array:
        """Gaps of one state at radii relative to the edge."""
        width, c = self.width[i], np.exp(self.log_scale[i])
        far = outer_end(n, c)
        log_gap = np.empty(len(offsets))
        inner = offsets < 0.0
        share = np.log1p(-offsets[inner] / width) / np.log1p(1.0 / width)
        log_gap[inner] = _interpolated(self.inside[i], share)
        share = np.log1p(offsets[~inner] / width) / np.log1p(far / width)
        log_gap[~inner] = _interpolated(self.outside[i], np.minimum(share, 1.0))
        gap = np.expm1(log_gap)
        beyond = offsets > far
        if beyond.any():
            at_end = np.expm1(_interpolated(self.outside[i], np.ones(1))[0])
            unit = c**n / n
            lift = at_end + self.displacement[i] - unit * (1.0 + far) ** n
            radius = 1.0 + offsets[beyond]
            gap[beyond] = unit * radius**n - self.displacement[i] + lift * ((1.0 + far) / radius) ** (1.0 + k)
        return gap


def outer_end(n: float, c: float) -> float:
    """Distance of the last point from the edge, relative to its radius."""
    return max((_HEIGHT * n) ** (1.0 / n) / c - 1.0, 1.0)


def point_offsets(n: float, c: float, width: float) -> tuple[Array, Array]:
    """Radii of the points inside and outside, relative to the edge."""
    inside = -width * np.expm1(_points(INSIDE) * np.log1p(1.0 / width))
    return inside, width * np.expm1(_points(OUTSIDE) * np.log1p(outer_end(n, c) / width))


def _interpolated(values: Array, share: Array) -> Array:
    count = len(values)
    angle = np.pi * (np.arange(count) + 0.5) / count
    weights = (-1.0) ** np.arange(count) * np.sin(angle)
    difference = share[:, None] - _points(count)
    difference[difference == 0.0] = 1e-200
    rows = weights / difference
    return (rows @ values) / rows.sum(axis=1)


def terms(degree: int) -> Array:
    """Degrees of the terms of the series in the three coordinates, shape (terms, 3)."""
    most = int(degree / _SLOWER)
    return np.array(
        [
            (i, j, m)
            for i in range(degree + 1)
            for j in range(degree + 1 - i)
            for m in range(most + 1)
            if i + j + _SLOWER * m <= degree
        ]
    )


def basis(n: Array, k: Array, mu: Array, degrees: Array) -> Array:
    """Values of the terms, shape (b, terms)."""
    low, middle, high = (
        np.log1p(_FACTOR * reduced_compliance(n, k, np.broadcast_to(m, n.shape)))
        for m in (BOX["mu"][0], mu, BOX["mu"][1])
    )
    least, most = 1.0 / BOX["n"][1], 1.0 / BOX["n"][0]
    coordinates = (
        (2.0 / n - least - most) / (most - least),
        2.0 * k / BOX["k"][1] - 1.0,
        2.0 * (middle - low) / (high - low) - 1.0,
    )
    values = np.ones((len(n), len(degrees)))
    for x, degree in zip(coordinates, degrees.T, strict=True):
        values *= chebyshev.chebvander(x, int(degree.max()))[:, degree]
    return values


@cache
def _stored() -> tuple[Array, Array]:
    with np.load(DATA) as arrays:
        return arrays["degrees"].astype(int), arrays["coefficients"].astype(float)


def described(n: Array, k: Array, mu: Array, numbers: Array) -> Guess:
    """States from the numbers that series expand, shape (b, 3 + points)."""
    inside = 3 + INSIDE
    return Guess(
        numbers[:, 0],
        numbers[:, 1] * (1.0 + mu),
        np.exp(numbers[:, 2] / (1.0 - k)),
        numbers[:, 3:inside],
        numbers[:, inside:],
    )


def guesses(n: Array, k: Array, mu: Array) -> Guess:
    """Guesses of the states of least load."""
    degrees, coefficients = _stored()
    return described(n, k, mu, basis(n, k, mu, degrees) @ coefficients)
