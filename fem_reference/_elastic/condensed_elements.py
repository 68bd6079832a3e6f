"""Elements without the functions inside them (static condensation).

Of the (p + 1)^2 functions of an element of degree p, (p - 1)^2 vanish on its sides and couple with those of this
element only.  No load acts on them: the traction is on the surface.  With K = [[S, C'], [C, B]], sides before interior,
the sides feel S - C' B^-1 C, and the interior follows them as -B^-1 C u.  At degree 6 this is half of the unknowns and
three quarters of the entries of an element.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.linalg.lapack import dpotrf, dtrtrs

from fem_reference._elastic.scaling import unit_scaling
from fem_reference._typing import Array, Index
from fem_reference.errors import NotConverged

__all__ = ["CondensedElements", "condensed_elements"]


@dataclass(frozen=True, slots=True, eq=False)
class CondensedElements:
    """Stiffness of elements on their sides.

    Attributes
    ----------
    sides : ndarray of int, shape (elements, m)
        Rows of the functions that do not vanish on the sides.
    stiffness : ndarray, shape (elements, m, m)
        Symmetric but for rounding.
    inside : ndarray of int, shape (elements, q)
        Rows of the functions inside.
    roots, halves : ndarray, shapes (elements, q, q) and (elements, q, m)
        Their stiffness is L L', with `roots` L, and their coupling to the sides L Y, with `halves` Y.
    size : int
        Rows of all.
    """

    sides: Index
    stiffness: Array
    inside: Index
    cholesky: Array
    coupling: Array
    size: int

    def assembled(self) -> sparse.csr_array:
        """Sum of the stiffness of all elements, shape (size, size); the rows inside the elements are empty."""
        narrow = self.sides.astype(np.int32)
        rows = np.broadcast_to(narrow[:, :, None], self.stiffness.shape).ravel()
        cols = np.broadcast_to(narrow[:, None, :], self.stiffness.shape).ravel()
        return sparse.coo_array((self.stiffness.ravel(), (rows, cols)), shape=(self.size, self.size)).tocsr()

    def completed(self, u: Array) -> Array:
        """Fill in the displacement inside every element, under that of the sides; shape (size,)."""
        complete = u.copy()
        pulled = self.coupling @ u[self.sides][:, :, None]
        complete[self.inside] = -np.linalg.solve(np.swapaxes(self.cholesky, 1, 2), pulled)[:, :, 0]
        return complete


def condensed_elements(
    parts: Iterable[tuple[Index, Index, Array]], elements: int, count: int, size: int
) -> CondensedElements:
    """Eliminate the functions inside elements.

    Parameters
    ----------
    parts : iterable of ndarray of int, ndarray of int, ndarray
        Numbers of some elements, shape (e,); their rows, shape (e, n), those inside last; and their stiffness,
        shape (e, n, n).
    elements : int
        How many there are.
    count : int
        Functions inside an element.
    size : int
        Rows of all.

    Raises
    ------
    NotConverged
        If the stiffness of the functions inside an element is not positive definite.

    Examples
    --------
    >>> springs = np.array([[[2.0, -1.0], [-1.0, 1.0]]])  # the second unknown hangs on the first
    >>> element = condensed_elements([(np.array([0]), np.array([[0, 1]]), springs)], elements=1, count=1, size=2)
    >>> element.stiffness.tolist(), element.completed(np.array([3.0, 0.0])).tolist()
    ([[[1.0]]], [3.0, 3.0])
    """
    result: CondensedElements | None = None
    for which, rows, K in parts:
        sides = rows.shape[1] - count
        if result is None:
            result = CondensedElements(
                np.empty((elements, sides), np.intp),
                np.empty((elements, sides, sides)),
                np.empty((elements, count), np.intp),
                np.empty((elements, count, count)),
                np.empty((elements, count, sides)),
                size,
            )
        result.sides[which], result.inside[which] = rows[:, :sides], rows[:, sides:]
        # The stiffness across a thin element is larger by many powers of ten than that along it.
        scales = unit_scaling(np.einsum("eii->ei", K)[:, sides:])
        for element, matrix, scale in zip(which, K, scales, strict=True):
            # With Y of L Y = C the product C' B^-1 C is Y' Y: formed with B^-1 C it would lose ten times as much.
            L, failed = dpotrf(scale[:, None] * matrix[sides:, sides:] * scale, lower=1, clean=1)
            if failed:
                raise NotConverged("an element is not positive definite; check modulus, mesh and nu")
            Y, _ = dtrtrs(L, scale[:, None] * matrix[sides:, :sides], lower=1)
            result.cholesky[element], result.coupling[element] = L / scale[:, None], Y
            result.stiffness[element] = matrix[:sides, :sides] - Y.T @ Y
    if result is None:
        raise ValueError("there is no element to condense")
    return result
