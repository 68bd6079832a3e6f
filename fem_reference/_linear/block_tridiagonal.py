"""Exact solves of the strips of a half-space by small dense blocks, all strips of a mesh at a time.

Along a strip of a tensor-product mesh each grid line meets the next through one row of elements, so that the matrix of
a strip is block tridiagonal: Cholesky factors of some 40 x 40, the same number for every strip.  Only the exterior of
the mesh couples all of its boundary.  It is smooth there and has a low rank: V V' is added to the strips by Woodbury's
formula.  A general sparse factorisation has three times the bytes, and memory is what these solves wait for.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.linalg import cholesky, solve_triangular
from scipy.linalg.lapack import dpstrf, dtrtri

from fem_reference._typing import Array, Index
from fem_reference.errors import Failure, NotConverged

__all__ = ["BlockTridiagonal", "Border", "border_of", "places_in", "spread"]


@dataclass(frozen=True, slots=True, eq=False)
class Border:
    """Coupling V V' of unknowns that are on the boundary of the mesh.

    Attributes
    ----------
    rows : ndarray of int, shape (b,)
        The unknowns.
    root : ndarray, shape (b, rank)
        V.
    """

    rows: Index
    root: Array

    def within(self, inside: Index, count: int) -> Border:
        """Return the part on some of `count` unknowns, numbered as they are there."""
        there = places_in(inside, count)[self.rows]
        return Border(there[there < inside.size], self.root[there < inside.size])


def border_of(rows: Index, coupling: Array) -> Border:
    """Return a positive semidefinite coupling as V V', to rounding.

    Examples
    --------
    >>> border_of(np.arange(2), np.array([[4.0, 2.0], [2.0, 1.0]])).root.tolist()
    [[2.0], [1.0]]
    """
    factor, order, rank, _ = dpstrf(coupling, lower=1)
    root = np.empty((rows.size, rank))
    root[order - 1] = np.tril(factor)[:, :rank]
    return Border(rows, root)


class BlockTridiagonal:
    """Strips of a matrix, each block tridiagonal, and a border that couples them.

    Parameters
    ----------
    matrix : csr_array, shape (n, n)
        Symmetric positive definite, with the border.
    strips : ndarray of int, shape (n,)
        Number of the strip of each unknown.
    along : ndarray of int, shape (n,)
        Position along the strip: even on grid lines, odd between them.
    border : Border
        Its unknowns are in the last strip or on the last line of one.

    Raises
    ------
    NotConverged
        If a strip is singular.
    """

    def __init__(self, matrix: sparse.csr_array, strips: Index, along: Index, border: Border) -> None:
        steps, between = (along + 1) // 2, along % 2 == 1
        # A block is what is between two lines, and then the second line: the one before couples by its line only.
        rank = _ranks(2 * (strips * (int(steps.max()) + 1) + steps) + between)
        self._between = int(rank[between].max(initial=-1)) + 1
        size = self._between + int(rank[~between].max(initial=-1)) + 1
        slots = np.where(between, rank, self._between + rank)
        self._shape = int(steps.max()) + 1, int(strips.max()) + 1, size
        self._place = (steps * self._shape[1] + strips) * size + slots
        self._origin = places_in(self._place, math.prod(self._shape))
        root = np.zeros((*self._shape, border.root.shape[1]))
        root.reshape(-1, root.shape[-1])[self._place[border.rows]] = border.root
        on_last_line, in_last_strip = root[-1], root[:-1, -1]
        diagonal, below = self._blocks(matrix, strips, steps, slots)
        self._take_away(diagonal, below, on_last_line, in_last_strip)
        self._factorise(diagonal, below)
        self._add(on_last_line, in_last_strip)

    def _blocks(self, matrix: sparse.csr_array, strips: Index, steps: Index, slots: Index) -> tuple[Array, Array]:
        """Blocks on the diagonal, and those that couple a block to the line before it."""
        count, of_strips, size = self._shape
        place, block = self._place.astype(np.int32), (steps * of_strips + strips).astype(np.int32)
        repeats, columns = np.diff(matrix.indptr), matrix.indices
        # How many blocks before the row the column is: those of one strip are a step apart.
        apart = np.repeat(block, repeats) - block[columns]
        diagonal = np.zeros((count, of_strips, size, size))
        diagonal[...] = np.eye(size)
        diagonal.reshape(-1, size)[place] = 0.0
        within = np.flatnonzero(apart == 0)
        starts = np.repeat(place * size, repeats)
        slots = slots.astype(np.int32)
        diagonal.reshape(-1)[starts[within] + slots[columns[within]]] = matrix.data[within]
        lines = size - self._between
        below = np.zeros((count, of_strips, size, lines))
        before = np.flatnonzero(apart == of_strips)
        on_line = slots[columns[before]] - self._between
        before, on_line = before[on_line >= 0], on_line[on_line >= 0]
        below.reshape(-1)[starts[before] // size * lines + on_line] = matrix.data[before]
        return diagonal, below

    def _take_away(self, diagonal: Array, below: Array, on_last_line: Array, in_last_strip: Array) -> None:
        """Subtract the border from the blocks."""
        diagonal[-1] -= on_last_line @ np.swapaxes(on_last_line, 1, 2)
        diagonal[:-1, -1] -= in_last_strip @ np.swapaxes(in_last_strip, 1, 2)
        of_strip = np.concatenate([in_last_strip, on_last_line[-1:]])
        below[1:, -1] -= of_strip[1:] @ np.swapaxes(of_strip[:-1, self._between :], 1, 2)

    def _factorise(self, diagonal: Array, below: Array) -> None:
        """Factorise the strips: inverses of the Cholesky factors, and what couples them."""
        self._inverses, self._couplings = np.empty_like(diagonal), np.empty_like(below)
        between = self._between
        for step in range(self._shape[0]):
            block = diagonal[step]
            if step:
                of_line = self._inverses[step - 1][:, between:, between:]
                coupling = np.matmul(below[step], np.swapaxes(of_line, 1, 2), out=self._couplings[step])
                block = block - coupling @ np.swapaxes(coupling, 1, 2)
            try:
                factor = np.linalg.cholesky(block)
            except np.linalg.LinAlgError as error:
                raise NotConverged(f"a strip of the mesh is singular ({error})", Failure.STIFFNESS) from error
            for lower, inverse in zip(factor, self._inverses[step], strict=True):
                # The transpose of a matrix whose rows are contiguous is the one that LAPACK has.
                inverse[:] = dtrtri(lower.T)[0].T

    def _add(self, on_last_line: Array, in_last_strip: Array) -> None:
        """Prepare Woodbury's formula: the border behind the forward substitution, with its own factor."""
        between, of_strip = self._between, np.zeros_like(in_last_strip)
        loads = on_last_line.copy()
        for step, load in enumerate((*in_last_strip.copy(), loads[-1])):
            if step:
                load -= self._couplings[step, -1] @ of_strip[step - 1, between:]
            if step < of_strip.shape[0]:
                of_strip[step] = self._inverses[step, -1] @ load
        last = self._inverses[-1] @ loads
        rank = last.shape[-1]
        flat_last, flat_strip = last.reshape(-1, rank), of_strip.reshape(-1, rank)
        gram = np.eye(rank) + flat_last.T @ flat_last + flat_strip.T @ flat_strip
        # I - Z (I + Z' Z)^-1 Z', with Z the border behind the forward substitution.
        root = cholesky(gram, lower=True)
        self._last, self._in_strip = (solve_triangular(root, flat.T, lower=True) for flat in (flat_last, flat_strip))

    def solve(self, b: Array) -> Array:
        """Solve for loads, shape (n,) or (n, q)."""
        count, strips, size = self._shape
        between = self._between
        x = spread(b.reshape(b.shape[0], -1), self._origin).reshape(count, strips, size, -1)
        for step in range(count):
            if step:
                x[step] -= self._couplings[step] @ x[step - 1][:, between:]
            x[step] = self._inverses[step] @ x[step]
        self._under_border(x)
        for step in reversed(range(count)):
            if step + 1 < count:
                x[step][:, between:] -= np.swapaxes(self._couplings[step + 1], 1, 2) @ x[step + 1]
            x[step] = np.swapaxes(self._inverses[step], 1, 2) @ x[step]
        return np.asarray(x.reshape(-1, x.shape[-1]).take(self._place, axis=0).reshape(b.shape))

    def _under_border(self, x: Array) -> None:
        """Take the border into account, between both substitutions."""
        q = x.shape[-1]
        on_line, in_strip = x[-1].reshape(-1, q), x[:-1, -1].reshape(-1, q)
        moved = self._last @ on_line + self._in_strip @ in_strip
        x[-1] -= (self._last.T @ moved).reshape(x[-1].shape)
        x[:-1, -1] -= (self._in_strip.T @ moved).reshape(x[:-1, -1].shape)

    @property
    def nbytes(self) -> int:
        """Bytes of the factors."""
        arrays = self._inverses, self._couplings, self._last, self._in_strip, self._place, self._origin
        return sum(array.nbytes for array in arrays)


def places_in(numbers: Index, size: int) -> Index:
    """Place of each of `size` numbers among some of them; of the others the place after the last.

    Examples
    --------
    >>> places_in(np.array([2, 0]), 4).tolist()
    [1, 2, 0, 2]
    """
    places = np.full(size, numbers.size)
    places[numbers] = np.arange(numbers.size)
    return places


def spread(values: Array, places: Index) -> Array:
    """Take values from their places, and zero from the place after the last.

    It costs a tenth of an assignment to indices of rows.
    """
    return np.concatenate([values, np.zeros((1, *values.shape[1:]))]).take(places, axis=0)


def _ranks(keys: Index) -> Index:
    """Number of each entry among those with the same key.

    Examples
    --------
    >>> _ranks(np.array([7, 3, 7, 7])).tolist()
    [0, 0, 1, 2]
    """
    order = np.argsort(keys, kind="stable")
    ordered = keys[order]
    starts = np.flatnonzero(np.append(True, ordered[1:] != ordered[:-1]))
    ranks = np.empty(keys.size, np.intp)
    ranks[order] = np.arange(keys.size) - np.repeat(starts, np.diff(np.append(starts, keys.size)))
    return ranks
