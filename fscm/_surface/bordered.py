r"""The bordered tangent, and its elimination down to the nodes near the contact.

Far out the traction hardly changes with the gap, so that no other node feels the gap there:

    |  A   0  B | |  x  |   |  a  |        x_far = a_far - F x - G z,      where z are displacement and scale,
    |  F   1  G | |x_far| = |a_far|
    |  R   Q  S | |  z  |   |  b  |        |    A          B    | | x |   |      a      |
                                           | R - Q F   S - Q G  | | z | = | b - Q a_far | .
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fscm._typing import Array

__all__ = ["FAR", "Bordered", "Condensed"]

#: A node is far out if its own entry differs from 1 by at most this, as those behind it.
FAR = 1e-10


@dataclass(frozen=True)
class Bordered:
    """1 - W diag(slope) with two more columns and rows.

    Attributes
    ----------
    response : ndarray, shape (N, N)
    slope : ndarray, shape (N,)
    columns : ndarray, shape (N, 2)
    rows : ndarray, shape (2, N + 2)
    """

    response: Array
    slope: Array
    columns: Array
    rows: Array

    def __matmul__(self, x: Array) -> Array:
        near = x[:-2]
        return np.concatenate([near - self.response @ (self.slope * near) + self.columns @ x[-2:], self.rows @ x])

    def matrix(self) -> Array:
        """All entries, shape (N + 2, N + 2)."""
        return self.condensed(len(self.slope)).matrix

    def near(self, change: float) -> int:
        """Number of nodes up to the last one whose own entry differs from 1 by more than `change`."""
        coupled = np.flatnonzero(np.abs(self.response.diagonal() * self.slope) > change)
        return int(coupled[-1]) + 1 if coupled.size else 0

    def condensed(self, near: int) -> Condensed:
        """The system of this number of nodes, if all others are far out."""
        W, slope, N = self.response, self.slope, len(self.slope)
        matrix = np.empty((near + 2, near + 2))
        np.multiply(W[:near, :near], -slope[:near], out=matrix[:near, :near])
        matrix.flat[: near * (near + 2) : near + 3] += 1.0
        matrix[:near, near:] = self.columns[:near]
        matrix[near:, :near], matrix[near:, near:] = self.rows[:, :near], self.rows[:, N:]
        far = np.concatenate([W[near:, :near] * -slope[:near], self.columns[near:]], axis=1)
        by_far = self.rows[:, near:N]
        matrix[near:] -= by_far @ far
        return Condensed(matrix, far, by_far)


class Condensed(NamedTuple):
    """The system of the near nodes and the borders.

    Attributes
    ----------
    matrix : ndarray, shape (n + 2, n + 2)
    far : ndarray, shape (N - n, n + 2)
        Rows of the far nodes.
    by_far : ndarray, shape (2, N - n)
        Entries of the last two rows there.
    """

    matrix: Array
    far: Array
    by_far: Array

    def right(self, right: Array) -> Array:
        """Right side of this system, shape (n + 2,), for that of the whole one, shape (N + 2,)."""
        n = len(self.matrix) - 2
        return np.concatenate([right[:n], right[-2:] - self.by_far @ right[n:-2]])

    def whole(self, x: Array, right: Array) -> Array:
        """Solution of the whole system for a right side, from that of this one."""
        n = len(x) - 2
        return np.concatenate([x[:n], right[n:-2] - self.far @ x, x[n:]])

    def adjoints(self, right: Array) -> Array:
        """Solutions of the transposed whole system, shape (N + 2, m).

        Raises
        ------
        numpy.linalg.LinAlgError
            When the matrix is singular.
        """
        n = len(self.matrix) - 2
        near = np.concatenate([right[:n], right[-2:]]) - self.far.T @ right[n:-2]
        y = np.linalg.solve(self.matrix.T, near)
        return np.concatenate([y[:n], right[n:-2] - self.by_far.T @ y[n:], y[n:]])
