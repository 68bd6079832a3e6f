"""Elimination of the unknowns of a mesh by nested dissection: dense blocks, merged in pairs.

The mesh is halved again and again, along its longer side.  Of two halves that are merged, the unknowns on the line
between them belong to no other element: they are eliminated, and what is left is a dense matrix on the outer sides of
both.  No linear system is solved column by column, and the work is in products of dense matrices.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dpotrf, dtrtrs

from fem_reference._elastic.condensed_elements import CondensedElements
from fem_reference._elastic.scaling import unit_scaling
from fem_reference._typing import Array, Index
from fem_reference.errors import Failure, NotConverged

__all__ = ["Elimination", "condensed_on", "eliminated"]

#: Elements of the smallest block: with fewer there are more merges, with more the blocks are larger than they need be
#: (measured: 0.149, 0.146 and 0.170 s a mesh of degree 7 with 4, 8 and 16).
LEAF = 8


@dataclass(frozen=True, slots=True, eq=False)
class Elimination:
    """Rows that were eliminated, and how they follow those that stay: u[rows] = follow u[stays]."""

    rows: Index
    stays: Index
    follow: Array


def eliminated(K: Array, count: int, recoverable: bool = False) -> tuple[Array, Array]:
    """Eliminate the last unknowns of a dense matrix [[A, B], [C, D]].

    Parameters
    ----------
    K : ndarray, shape (n, n)
        Symmetric but for rounding, positive definite on those that are eliminated.
    count : int
        How many unknowns to keep, the first ones.
    recoverable : bool
        Whether to return `follow`, which is empty otherwise.

    Returns
    -------
    complement : ndarray, shape (count, count)
        A - B D^-1 C, symmetric but for rounding.
    follow : ndarray, shape (n - count, count)
        -D^-1 C.

    Raises
    ------
    NotConverged
        If D is not positive definite.

    Examples
    --------
    >>> eliminated(np.array([[2.0, -1.0], [-1.0, 1.0]]), count=1, recoverable=True)
    (array([[1.]]), array([[1.]]))
    """
    if count == K.shape[0]:
        return K.copy(), np.empty((0, count))
    # The upper triangle of a matrix whose rows are contiguous is the lower one of its transpose, as LAPACK has it.
    L, failed = dpotrf(K[count:, count:].T, lower=1)
    if failed:
        raise NotConverged("the stiffness of a part of the mesh is not positive definite", Failure.STIFFNESS)
    Y, _ = dtrtrs(L, K[:count, count:].T, lower=1)
    if recoverable:
        # The product of Y with itself would lose two to ten times as much (measured on four meshes).
        follow = -dtrtrs(L, Y, lower=1, trans=1, overwrite_b=1)[0]
        product = follow.T @ K[count:, :count]
        return np.add(K[:count, :count], product, out=product), follow
    product = Y.T @ Y
    return np.subtract(K[:count, :count], product, out=product), np.empty((0, count))


def condensed_on(
    retained: Index,
    elements: CondensedElements,
    places: Index,
    free: Index,
    eliminations: list[Elimination] | None = None,
) -> Array:
    """Eliminate the unknowns of a mesh but for some.

    Parameters
    ----------
    retained : ndarray of int, shape (k,)
        Rows to keep, of the free ones.
    elements : CondensedElements
        The mesh.
    places : ndarray of int, shape (2, elements)
        Column and row of each element of a tensor-product mesh.
    free : ndarray of int
        Rows that are not fixed.
    eliminations : list of Elimination, optional
        Gets what recovers the others, in the order in which they are eliminated.

    Returns
    -------
    ndarray, shape (k, k)
        Schur complement, symmetric but for rounding.

    Raises
    ------
    NotConverged
        If a diagonal entry of the stiffness is not positive.
    """
    diagonals = np.einsum("eii->ei", elements.stiffness)
    diagonal = np.asarray(np.bincount(elements.sides.ravel(), diagonals.ravel(), minlength=elements.size), float)
    scale = np.zeros(elements.size)
    scale[free] = unit_scaling(diagonal[free])
    dissection = _Dissection(elements, places, free, retained, scale, eliminations)
    everything = dissection.block(np.arange(places.shape[1]))
    by_row = np.argsort(everything.rows)
    order = by_row[np.searchsorted(everything.rows[by_row], retained)]
    return everything.K[np.ix_(order, order)] / scale[retained, None] / scale[retained]


@dataclass(frozen=True, slots=True, eq=False)
class _Block:
    """Stiffness of some elements on the rows that are left; `counts` of these elements have each row."""

    rows: Index
    counts: Index
    K: Array


class _Dissection:
    """Blocks of a mesh: which rows they have, and which of them they lose."""

    def __init__(
        self,
        elements: CondensedElements,
        places: Index,
        free: Index,
        retained: Index,
        scale: Array,
        eliminations: list[Elimination] | None,
    ) -> None:
        self._rows, self._places = elements.sides, places
        self._scale, self._eliminations = scale, eliminations
        self._stiffness = elements.stiffness
        self._counts = np.bincount(elements.sides.ravel(), minlength=elements.size)
        self._free = np.zeros(elements.size, bool)
        self._free[free] = True
        self._retained = np.zeros(elements.size, bool)
        self._retained[retained] = True
        self._place = np.full(elements.size, -1)
        self._workspaces = np.empty(0), np.empty(0)

    def block(self, members: Index) -> _Block:
        """Condense some elements on the rows that others share, or that are kept."""
        if members.size <= LEAF:
            return self._leaf(members)
        places = self._places[:, members]
        spans = np.ptp(places, axis=1)
        along = places[int(spans[1] > spans[0])]
        lower = along <= (int(along.min()) + int(along.max())) // 2
        return self._merged(self.block(members[lower]), self.block(members[~lower]))

    def _leaf(self, members: Index) -> _Block:
        """Assemble some elements."""
        sides = self._rows[members]
        rows, local = np.unique(sides, return_inverse=True)
        counts = np.bincount(local.ravel())
        free = self._free[rows]
        stays = free & ((counts < self._counts[rows]) | self._retained[rows])
        # Fixed rows are last.
        order = np.concatenate([np.flatnonzero(group) for group in (stays, free & ~stays, ~free)])
        position = np.empty(rows.size, np.intp)
        position[order] = np.arange(rows.size)
        local = position[local].reshape(sides.shape)
        places = local[:, :, None] * rows.size + local[:, None, :]
        scaling = self._scale[sides]
        values = scaling[:, :, None] * self._stiffness[members] * scaling[:, None, :]
        K = np.bincount(places.ravel(), values.ravel(), minlength=rows.size**2).reshape(rows.size, rows.size)
        left, count = int(free.sum()), int(stays.sum())
        return self._reduced(rows[order[:left]], counts[order[:count]], np.asarray(K[:left, :left], float))

    def _merged(self, left: _Block, right: _Block) -> _Block:
        """Join two blocks."""
        place = self._place
        place[left.rows] = np.arange(left.rows.size)
        at = place[right.rows]
        place[left.rows] = -1
        in_right = np.flatnonzero(at >= 0)
        twin = np.full(left.rows.size, -1)
        twin[at[in_right]] = in_right
        counts = left.counts.copy()
        counts[at[in_right]] += right.counts[in_right]
        gone = (counts == self._counts[left.rows]) & ~self._retained[left.rows]
        # What stays of the left block ends, and what stays of the right one begins, with what both have.
        only_left, both, gone = (np.flatnonzero(group) for group in (twin < 0, (twin >= 0) & ~gone, gone))
        of_left = np.concatenate([only_left, both, gone])
        of_right = np.concatenate([twin[both], np.flatnonzero(at < 0), twin[gone]])
        in_left, only_right = only_left.size + both.size, of_right[both.size : of_right.size - gone.size]
        count = in_left + only_right.size
        K, gathered = self._matrices(count + gone.size, max(of_left.size, of_right.size))
        K[:] = 0.0
        stays = (left, of_left, slice(0, in_left)), (right, of_right, slice(only_left.size, count))
        for block, order, there in stays:
            stay = there.stop - there.start
            ordered = block.K.take(order, 0, out=gathered[: order.size, : order.size], mode="clip").take(order, 1)
            K[there, there] += ordered[:stay, :stay]
            K[there, count:] += ordered[:stay, stay:]
            K[count:, there] += ordered[stay:, :stay]
            K[count:, count:] += ordered[stay:, stay:]
        rows = np.concatenate([left.rows[of_left[:in_left]], right.rows[only_right], left.rows[gone]])
        return self._reduced(rows, np.concatenate([counts[of_left[:in_left]], right.counts[only_right]]), K)

    def _matrices(self, *sizes: int) -> list[Array]:
        """Square matrices in memory that the next merge uses again: new memory costs more than the merge."""
        if any(size**2 > space.size for size, space in zip(sizes, self._workspaces, strict=True)):
            self._workspaces = np.empty(2 * sizes[0] ** 2), np.empty(2 * sizes[1] ** 2)
        return [space[: size**2].reshape(size, size) for size, space in zip(sizes, self._workspaces, strict=True)]

    def _reduced(self, rows: Index, counts: Index, K: Array) -> _Block:
        """Eliminate the rows of a block beyond those with counts: no other element has them."""
        stay, gone = rows[: counts.size], rows[counts.size :]
        complement, follow = eliminated(K, counts.size, self._eliminations is not None)
        if self._eliminations is not None:
            follow = self._scale[gone, None] * follow / self._scale[stay]
            self._eliminations.append(Elimination(gone, stay, follow))
        return _Block(stay, counts, complement)
