"""Elements without the functions inside them (static condensation).

Of the (p + 1)^2 functions of an element of degree p, (p - 1)^2 vanish on its sides and couple with those of this
element only.  No load acts on them: the traction is on the surface.  With K = [[S, C'], [C, B]], sides before interior,
the sides feel S - C' B^-1 C.  At degree 6 this is half of the unknowns and
three quarters of the entries of an element.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.linalg.lapack import dpotrf, dtrtrs
from skfem import Dofs

from fem_reference._elastic.scaling import unit_scaling
from fem_reference._typing import Array, Index
from fem_reference.errors import Failure, NotConverged

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
    follow : ndarray, shape (elements, q, m)
        How the displacement inside follows that of the sides, where no load is inside: u[inside] = follow u[sides].
        Empty if that was not wanted.
    size : int
        Rows of all.
    """

    sides: Index
    stiffness: Array
    inside: Index
    follow: Array
    size: int

    def assembled(self) -> sparse.csr_array:
        """Sum of the stiffness of all elements, shape (size, size); the rows inside the elements are empty."""
        narrow = self.sides.astype(np.int32)
        rows = np.broadcast_to(narrow[:, :, None], self.stiffness.shape).ravel()
        cols = np.broadcast_to(narrow[:, None, :], self.stiffness.shape).ravel()
        return sparse.coo_array((self.stiffness.ravel(), (rows, cols)), shape=(self.size, self.size)).tocsr()


def condensed_elements(
    parts: Iterable[tuple[Index, Index, Array]], dofs: Dofs, recoverable: bool = False
) -> CondensedElements:
    """Eliminate the functions inside elements.

    Parameters
    ----------
    parts : iterable of ndarray of int, ndarray of int, ndarray
        Numbers of some elements, shape (e,); their rows, shape (e, n), those inside last; and their stiffness,
        shape (e, n, n).
    dofs : skfem.Dofs
        Numbering of the scalar functions.
    recoverable : bool
        Whether the displacement inside is to follow that of the sides.

    Raises
    ------
    NotConverged
        If the stiffness of the functions inside an element is not positive definite.
    """
    elements, count, size = int(dofs.topo.nelements), 2 * int(dofs.interior_dofs.shape[0]), 2 * int(dofs.N)
    result: CondensedElements | None = None
    for which, rows, K in parts:
        sides = rows.shape[1] - count
        if result is None:
            result = CondensedElements(
                np.empty((elements, sides), np.intp),
                np.empty((elements, sides, sides)),
                np.empty((elements, count), np.intp),
                np.empty((elements, count, sides) if recoverable else 0),
                size,
            )
        result.sides[which], result.inside[which] = rows[:, :sides], rows[:, sides:]
        # The stiffness across a thin element is larger by many powers of ten than that along it.
        scale = unit_scaling(np.einsum("eii->ei", K)[:, sides:])
        blocks = scale[:, :, None] * K[:, sides:, sides:] * scale[:, None, :]
        couplings = K[:, :sides, sides:] * scale[:, None, :]
        result.stiffness[which] = K[:, :sides, :sides]
        for element, block, coupling, unit in zip(which, blocks, couplings, scale, strict=True):
            # With Y of L Y = C the product C' B^-1 C is Y' Y: formed with B^-1 C it would lose ten times as much.
            L, failed = dpotrf(block.T, lower=1, overwrite_a=1, clean=0)
            if failed:
                raise NotConverged("an element is not positive definite", Failure.STIFFNESS)
            Y, _ = dtrtrs(L, coupling.T, lower=1, overwrite_b=1)
            result.stiffness[element] -= Y.T @ Y
            if recoverable:
                result.follow[element] = -unit[:, None] * dtrtrs(L, Y, lower=1, trans=1, overwrite_b=1)[0]
    if result is None:
        raise ValueError("there is no element to condense")
    return result
