"""Chebyshev series of up to three coordinates."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from fscm._typing import Array

__all__ = ["Series", "basis", "degrees_within", "design_matrix"]

# Points that are evaluated together: their values of the basis stay in the cache of the processor.
_CHUNK = 4096


def basis(x: Array, degree: int) -> Array:
    """Chebyshev polynomials T_0 ... T_degree at points, shape (m, degree + 1).

    Examples
    --------
    >>> basis(np.array([0.5]), 3).tolist()
    [[1.0, 0.5, -0.5, -1.0]]
    """
    found = np.empty((degree + 1, len(x)))
    found[0] = 1.0
    if degree:
        found[1] = x
    for i in range(2, degree + 1):
        found[i] = 2.0 * x * found[i - 1] - found[i - 2]
    return found.T


def degrees_within(largest: tuple[int, ...], power: float) -> NDArray[np.int_]:
    """Degrees (i, j, ...) with (i / largest_i)^power + (j / largest_j)^power + ... <= 1, shape (terms, dimensions).

    Examples
    --------
    >>> degrees_within((1, 2), 1.0).tolist()
    [[0, 0], [0, 1], [0, 2], [1, 0]]
    """
    boxes = product(*(range(most + 1) for most in largest))
    return np.array([d for d in boxes if sum((i / most) ** power for i, most in zip(d, largest, strict=True)) < 1.0001])


def design_matrix(cube: Array, degrees: NDArray[np.int_]) -> Array:
    """Values of the terms of a series at points, shape (m, terms)."""
    found = np.ones((len(cube), len(degrees)))
    for axis, of_axis in enumerate(degrees.T):
        found *= basis(cube[:, axis], int(of_axis.max()))[:, of_axis]
    return found


@dataclass(frozen=True)
class Series:
    """A Chebyshev series.

    Attributes
    ----------
    coefficients : ndarray
        One axis for each coordinate.

    Examples
    --------
    >>> series = Series.of(np.array([[0, 0, 0], [1, 0, 2]]), np.array([2.0, 3.0]))
    >>> series(np.array([[0.5, 0.1, 0.0]])).tolist()
    [0.5]
    """

    coefficients: Array

    @classmethod
    def of(cls, degrees: NDArray[np.int_], values: Array) -> Series:
        """The series with these coefficients at these degrees."""
        coefficients = np.zeros(tuple(degrees.max(axis=0) + 1))
        coefficients[tuple(degrees.T)] = values
        return cls(coefficients)

    def __call__(self, cube: Array) -> Array:
        """Values at points of shape (m, dimensions)."""
        found = np.empty(len(cube))
        for start in range(0, len(cube), _CHUNK):
            found[start : start + _CHUNK] = self._chunk(cube[start : start + _CHUNK])
        return found

    def _chunk(self, cube: Array) -> Array:
        c = self.coefficients
        left = basis(cube[:, 0], c.shape[0] - 1) @ c.reshape(c.shape[0], -1)
        for axis in range(1, c.ndim):
            left = left.reshape(len(cube), c.shape[axis], -1)
            left = np.einsum("mi,mij->mj", basis(cube[:, axis], c.shape[axis] - 1), left)
        return left.reshape(len(cube))
