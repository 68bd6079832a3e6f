"""LU factors of the bordered tangent, reused for other controls and for neighbouring states."""

from __future__ import annotations

from functools import cached_property

import numpy as np
import scipy

from fscm._typing import Array
from fscm.errors import Failure, NotConverged

__all__ = ["BorderedFactor"]


class BorderedFactor:
    """LU factors of a bordered matrix, whose last row is a control.

    Parameters
    ----------
    matrix : ndarray, shape (N + 2, N + 2)
        In Fortran order; it is overwritten.
    stiffness_slope : ndarray, shape (N,)
        Factors of the columns of the response in the matrix.

    Raises
    ------
    NotConverged
        When the matrix is singular.
    """

    def __init__(self, matrix: Array, stiffness_slope: Array) -> None:
        self.stiffness_slope = stiffness_slope
        # dgetrf directly: the rows differ by many orders of magnitude, which does not harm partial pivoting but makes
        # the condition estimate of the wrapper warn.
        self._lu, self._pivots, info = scipy.linalg.lapack.dgetrf(matrix, overwrite_a=1)
        if info != 0:
            raise NotConverged("Newton met a singular tangent", Failure.ITERATION)

    def _back(self, right: Array) -> Array:
        solution: Array = scipy.linalg.lapack.dgetrs(self._lu, self._pivots, right, overwrite_b=1)[0]
        return solution

    @cached_property
    def tangent(self) -> Array:
        """Solution of the system whose right side is the last unit vector."""
        right = np.zeros(len(self.stiffness_slope) + 2)
        right[-1] = 1.0
        return self._back(right)

    def solve(self, right: Array, row: Array) -> Array:
        """Solution with the last row of the matrix replaced.

        Parameters
        ----------
        right, row : ndarray, shape (N + 2,)
        """
        top = right.copy()
        top[-1] = 0.0
        solution = self._back(top)
        along = float(row @ self.tangent)
        if along == 0.0:
            raise NotConverged("Newton met a singular tangent", Failure.ITERATION)
        solution += (float(right[-1]) - float(row @ solution)) / along * self.tangent
        return solution
