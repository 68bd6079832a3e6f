"""The bordered tangent in a form that serves many right sides: other controls and neighbouring states."""

from __future__ import annotations

import numpy as np

from fscm._surface.bordered import FAR, Bordered
from fscm._surface.elimination import Elimination
from fscm._typing import Array
from fscm.errors import Failure, NotConverged

__all__ = ["BorderedFactor"]

#: Rows of the largest block that is inverted: a smaller one takes less time, two of them no less than one.
_BLOCK = 110
#: First and second correction of the tangent, relative to its largest component, up to which the solutions serve.
#: Otherwise the whole matrix is inverted: no rows are exchanged between blocks, and a block may belong to a part of the
#: surface that is at a fold of its own.
_ACCURATE = 1e-5, 1e-8
#: After a correction below this the tangent is exact to rounding.
_ROUNDED = 1e-8


class BorderedFactor:
    """Inverse blocks of a bordered matrix, whose last row is a control.

    Parameters
    ----------
    bordered : Bordered

    Attributes
    ----------
    tangent : ndarray, shape (N + 2,)
        Solution, to rounding, of the system whose right side is the last unit vector.

    Raises
    ------
    NotConverged
        When the matrix is singular.
    """

    def __init__(self, bordered: Bordered) -> None:
        self.stiffness_slope = bordered.slope
        # Far from equilibrium the numbers may overflow, which Newton's method notices.
        with np.errstate(over="ignore", invalid="ignore"):
            if not self._eliminates(bordered, bordered.near(FAR), _BLOCK):
                self._eliminates(bordered, len(bordered.slope), len(bordered.slope) + 2)

    def _eliminates(self, bordered: Bordered, near: int, largest: int) -> bool:
        """Set the blocks and the tangent; whether they are accurate."""
        self._condensed = bordered.condensed(near)
        try:
            self._eliminated = Elimination(self._condensed.matrix, largest)
        except np.linalg.LinAlgError as error:
            if largest == _BLOCK:
                return False
            raise NotConverged("Newton met a singular tangent", Failure.ITERATION) from error
        unit = np.zeros(len(bordered.slope) + 2)
        unit[-1] = 1.0
        self.tangent = self._solved(unit)
        for largest_change in _ACCURATE:
            correction = self._solved(unit - bordered @ self.tangent)
            self.tangent = self.tangent + correction
            change = float(np.abs(correction).max() / np.abs(self.tangent).max())
            if not change <= largest_change:
                return False
            if change <= _ROUNDED:
                break
        return True

    def _solved(self, right: Array) -> Array:
        x = self._condensed.right(right)
        self._eliminated.solve(x)
        return self._condensed.whole(x, right)

    def solve(self, right: Array, row: Array) -> Array:
        """Solution with the last row of the matrix replaced.

        Parameters
        ----------
        right, row : ndarray, shape (N + 2,)
        """
        along = float(row @ self.tangent)
        if along == 0.0:
            raise NotConverged("Newton met a singular tangent", Failure.ITERATION)
        top = right.copy()
        top[-1] = 0.0
        solution = self._solved(top)
        solution += (float(right[-1]) - float(row @ solution)) / along * self.tangent
        return solution
