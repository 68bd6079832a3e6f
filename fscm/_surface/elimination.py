r"""Elimination of a dense matrix by blocks, with the linear algebra of NumPy, for any number of right sides.

NumPy solves for right sides that are given with the matrix, and keeps no factors.  Those of SciPy are not used here:
its import takes longer than a pull-off force.  With the Schur complement S = D - C A^-1 B,

    | A  B | | x |   | a |              y = S^-1 (b - C A^-1 a),
    | C  D | | y | = | b |              x = A^-1 a - (A^-1 B) y,

where A and S are eliminated likewise, down to blocks that are inverted.  Rows are exchanged within these blocks only:
the result has to be checked (see `fscm._surface.bordered_factor`).
"""

from __future__ import annotations

import numpy as np

from fscm._typing import Array

__all__ = ["Elimination"]


class Elimination:
    """Inverse blocks of a square matrix.

    Parameters
    ----------
    matrix : ndarray, shape (N, N)
        It is overwritten.
    largest : int
        Largest number of rows of a block that is inverted as a whole.

    Raises
    ------
    numpy.linalg.LinAlgError
        When a block is singular.
    """

    def __init__(self, matrix: Array, largest: int) -> None:
        n = self._size = len(matrix) // 2 if len(matrix) > largest else 0
        if not n:
            self._inverse = np.linalg.inv(matrix)
            return
        self._first = Elimination(matrix[:n, :n], largest)
        self._A_B = matrix[:n, n:].copy()
        self._first.solve(self._A_B)
        self._C, S = matrix[n:, :n], matrix[n:, n:]
        S -= self._C @ self._A_B
        self._second = Elimination(S, largest)

    def solve(self, right: Array) -> None:
        """Replace right sides, shape (N,) or (N, m), by the solutions."""
        n = self._size
        if not n:
            right[:] = self._inverse @ right
            return
        x, y = right[:n], right[n:]
        self._first.solve(x)
        y -= self._C @ x
        self._second.solve(y)
        x -= self._A_B @ y
