"""Chebyshev series of up to three coordinates."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.polynomial.chebyshev import chebvander
from numpy.typing import NDArray

from fscm._typing import Array

__all__ = ["Series", "degrees_within", "design_matrix"]

#: Points evaluated together: their basis functions fit into the cache of the processor.
_CHUNK = 4096


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
    terms = np.ones((len(cube), len(degrees)))
    for axis, of_axis in enumerate(degrees.T):
        terms *= chebvander(cube[:, axis], int(of_axis.max()))[:, of_axis]
    return terms


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
        chunks = [self._chunk(cube[start : start + _CHUNK]) for start in range(0, len(cube), _CHUNK)]
        return np.concatenate([np.empty(0), *chunks])

    def _chunk(self, cube: Array) -> Array:
        c = self.coefficients
        left = chebvander(cube[:, 0], c.shape[0] - 1) @ c.reshape(c.shape[0], -1)
        for axis in range(1, c.ndim):
            left = left.reshape(len(cube), c.shape[axis], -1)
            left = np.einsum("mi,mij->mj", chebvander(cube[:, axis], c.shape[axis] - 1), left)
        return left.reshape(len(cube))
