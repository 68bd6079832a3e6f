"""Elimination of the unknowns of a mesh by nested dissection: dense blocks, merged in pairs.

The mesh is halved again and again, along its longer side.  Of two halves that are merged, the unknowns on the line
between them belong to no other element: they are eliminated, and what is left is a dense matrix on the outer sides of
both.  No linear system is solved column by column, and the work is in products of dense matrices.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import linalg
from scipy.linalg.lapack import dpotrf, dtrtrs

from fem_reference._elastic.condensed_elements import CondensedElements
from fem_reference._elastic.scaling import unit_scaling
from fem_reference._typing import Array, Index
from fem_reference.errors import NotConverged

__all__ = ["Elimination", "condensed_on", "eliminated"]

#: Elements of the smallest block: with fewer there are more merges, with more the blocks are larger than they need be
#: (measured: 0.43, 0.29 and 0.36 s a mesh with 4, 16 and 32).
LEAF = 16


@dataclass(frozen=True, slots=True, eq=False)
class Elimination:
    """Rows that were eliminated, and how they follow those that stay: u[rows] = follow u[stays]."""

    rows: Index
    stays: Index
    follow: Array


def eliminated(K: Array, count: int, twice: bool = False) -> tuple[Array, Array]:
    """Eliminate the last unknowns of a dense matrix [[A, B], [C, D]].

    Parameters
    ----------
    K : ndarray, shape (n, n)
        Symmetric but for rounding, positive definite on those that are eliminated.
    count : int
        How many unknowns to keep, the first ones.
    twice : bool
        Whether both triangles are factorised: what rounding makes of one of them shows in one of the result.

    Returns
    -------
    complement : ndarray, shape (count, count)
        A - B D^-1 C, not symmetrised.
    follow : ndarray, shape (n - count, count)
        -D^-1 C.

    Raises
    ------
    NotConverged
        If D is not positive definite.

    Examples
    --------
    >>> eliminated(np.array([[2.0, -1.0], [-1.0, 1.0]]), count=1, twice=True)
    (array([[1.]]), array([[1.]]))
    """
    D, C = K[count:, count:], K[count:, :count]
    if count == K.shape[0]:
        return K, -C
    if twice:
        follow = -linalg.lu_solve(linalg.lu_factor(D, check_finite=False), C, check_finite=False)
        return K[:count, :count] + K[:count, count:] @ follow, follow
    L, failed = dpotrf(D, lower=1)
    if failed:
        raise NotConverged("the stiffness of a part of the mesh is not positive definite; check modulus, mesh and nu")
    Y, _ = dtrtrs(L, C, lower=1)
    return K[:count, :count] - Y.T @ Y, np.empty((0, count))


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
        Gets what recovers the others, in the order in which they are eliminated; both triangles are factorised then.

    Returns
    -------
    ndarray, shape (k, k)
        Schur complement; its two triangles differ by rounding.

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
    order = np.searchsorted(everything.rows, retained)
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
        scaling = scale[elements.sides]
        self._stiffness = scaling[:, :, None] * elements.stiffness * scaling[:, None, :]
        self._counts = np.bincount(elements.sides.ravel(), minlength=elements.size)
        self._free = np.zeros(elements.size, bool)
        self._free[free] = True
        self._retained = np.zeros(elements.size, bool)
        self._retained[retained] = True

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
        local = local.reshape(sides.shape)
        counts, size = np.bincount(local.ravel()), rows.size
        position, count, free = self._order(rows, counts)
        local = position[local]
        places = local[:, :, None] * size + local[:, None, :]
        values = self._stiffness[members].ravel()
        K = np.asarray(np.bincount(places.ravel(), values, minlength=size**2), float).reshape(size, size)
        return self._reduced(rows, counts, position, count, K[:free, :free])

    def _merged(self, left: _Block, right: _Block) -> _Block:
        """Join two blocks."""
        rows = np.union1d(left.rows, right.rows)
        halves = [(np.searchsorted(rows, block.rows), block) for block in (left, right)]
        counts, K = np.zeros(rows.size, np.intp), np.zeros((rows.size, rows.size))
        for local, block in halves:
            counts[local] += block.counts
        position, count, _ = self._order(rows, counts)
        for local, block in halves:
            target = position[local]
            K[np.ix_(target, target)] += block.K
        return self._reduced(rows, counts, position, count, K)

    def _reduced(self, rows: Index, counts: Index, position: Index, count: int, K: Array) -> _Block:
        """Eliminate the rows of a block that no other element has."""
        complement, follow = eliminated(K, count, self._eliminations is not None)
        if self._eliminations is not None:
            ordered = np.empty_like(rows)
            ordered[position] = rows
            stay, gone = ordered[:count], ordered[count : K.shape[0]]
            follow = self._scale[gone, None] * follow / self._scale[stay]
            self._eliminations.append(Elimination(gone, stay, follow))
        stays = position < count
        return _Block(rows[stays], counts[stays], complement)

    def _order(self, rows: Index, counts: Index) -> tuple[Index, int, int]:
        """New position of each row; how many stay, which come first, and how many are free: fixed ones are last.

        A row is eliminated when no other element has it.
        """
        free = self._free[rows]
        stays = free & ((counts < self._counts[rows]) | self._retained[rows])
        gone = free & ~stays
        position = np.empty(rows.size, np.intp)
        position[np.concatenate([np.flatnonzero(group) for group in (stays, gone, ~free)])] = np.arange(rows.size)
        return position, int(stays.sum()), int(free.sum())
