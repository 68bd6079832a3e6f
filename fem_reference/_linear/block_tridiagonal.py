"""Exact solves of the strips of a half-space by small dense blocks, all strips of a mesh at a time.

Along a strip of a tensor-product mesh each grid line meets the next through one row of elements, so that the matrix of
a strip is block tridiagonal: Cholesky factors of some 40 x 40, the same number for every strip.  Only the exterior of
the mesh couples all of its boundary.  It is smooth there and has a low rank: V V' is added to the strips by Woodbury's
formula.  A general sparse factorisation has three times the bytes, and memory is what these solves wait for.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.linalg import cholesky, solve_triangular
from scipy.linalg.lapack import dtrtri

from fem_reference._linear.element_sums import Border, places_in
from fem_reference._linear.strip_blocks import StripBlocks
from fem_reference._typing import Array, Index
from fem_reference.errors import Failure, NotConverged

__all__ = ["BlockTridiagonal", "spread"]


class BlockTridiagonal:
    """Factorised strips, each block tridiagonal, and a border that couples them.

    Parameters
    ----------
    blocks : StripBlocks
        The strips without the border; they are overwritten.
    border : Border
        Its unknowns are in the last strip or on the last line of one.

    Raises
    ------
    NotConverged
        If a strip is singular.
    """

    def __init__(self, blocks: StripBlocks, border: Border) -> None:
        self._shape, self._between = blocks.diagonal.shape[:3], blocks.below.shape[2] - blocks.below.shape[3]
        self._place = blocks.places
        self._origin = places_in(self._place, math.prod(self._shape))
        # The border is on the last line of every strip, and all along the last strip.
        count, strips, size = self._shape
        block, slot = np.divmod(self._place[border.rows], size)
        step, strip = np.divmod(block, strips)
        rank, last = border.root.shape[1], step == count - 1
        on_last_line, in_last_strip = np.zeros((strips, size, rank)), np.zeros((count - 1, size, rank))
        on_last_line[strip[last], slot[last]] = border.root[last]
        in_last_strip[step[~last], slot[~last]] = border.root[~last]
        self._factorise(blocks.diagonal, blocks.below)
        self._add(on_last_line, in_last_strip)

    def _factorise(self, diagonal: Array, below: Array) -> None:
        """Factorise the strips: inverses of the Cholesky factors, and what couples them."""
        # Factors and inverses take the memory of the blocks: new memory costs as much as they do.
        self._inverses, self._couplings = diagonal, below
        between = self._between
        for step in range(self._shape[0]):
            if step:
                of_line = self._inverses[step - 1][:, between:, between:]
                below[step] = below[step] @ np.swapaxes(of_line, 1, 2)
                diagonal[step] -= below[step] @ np.swapaxes(below[step], 1, 2)
            try:
                factor = np.linalg.cholesky(diagonal[step])
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


def spread(values: Array, places: Index) -> Array:
    """Take values from their places, and zero from the place after the last.

    It costs a tenth of an assignment to indices of rows.
    """
    return np.concatenate([values, np.zeros((1, *values.shape[1:]))]).take(places, axis=0)
