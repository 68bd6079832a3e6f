"""Dense blocks of the strips of a tensor-product mesh, from those of its elements.

A strip is two elements wide, without the grid lines on both sides.  Along it, a block is what is between two lines that
cross it and then the second of these lines.  Every block has the same places: first for the functions of the middle
line between two that cross it, and then, on the line that crosses it, for those of the edge before the middle, of the
vertex there, and of the edge beyond.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np

from fem_reference._linear.element_sums import ElementSum, ScaledStiffness
from fem_reference._typing import Array, Index

__all__ = ["PERIOD", "StripBlocks", "coupling_of", "split", "strip_blocks"]

#: Positions from one strip to the next that is solved with it: strips of three positions, a line between two.
PERIOD = 4


@dataclass(frozen=True, slots=True, eq=False)
class StripBlocks:
    """A matrix on every other strip, block tridiagonal on each.

    Attributes
    ----------
    diagonal : ndarray, shape (blocks, strips, s, s)
        With ones where no unknown is.
    below : ndarray, shape (blocks, strips, s, c)
        Coupling of a block to the line of the one before, which is the last c of its unknowns; zero in the first.
    places : ndarray of int, shape (n,)
        Place of each unknown in an array of shape (blocks, strips, s).
    """

    diagonal: Array
    below: Array
    places: Index


@dataclass(frozen=True, slots=True, eq=False)
class _Members:
    """Elements whose line at the start (0) or at the end (2) is between strips.

    Attributes
    ----------
    blocks : ndarray, shape (e, a, m, m)
        By their strip and by their place along it.
    sides : ndarray of int, shape (e, a, m)
    first : int
        The strip of the first; each has another.
    end : int
    """

    blocks: Array
    sides: Index
    first: int
    end: int


def split(positions: Index, dropped: int) -> tuple[Index, Index]:
    """Return the unknowns in strips, and those on the lines between them."""
    between = positions % PERIOD == dropped
    return np.flatnonzero(~between), np.flatnonzero(between)


def _strip(positions: Index, dropped: int) -> Index:
    """Number of the strip of each position across the strips."""
    return (positions - dropped - 1) // PERIOD + int(dropped > 0)


def _members(stiffness: ScaledStiffness, axis: int, dropped: int) -> Iterator[_Members]:
    for end in (0, 2):
        begin = (dropped - end) // 2 % 2
        blocks, sides = (
            np.moveaxis(stiffness.blocks, axis, 0)[begin::2],
            np.moveaxis(stiffness.sides, axis, 0)[begin::2],
        )
        if len(blocks):
            yield _Members(blocks, sides, int(_strip(np.array(2 * begin + 1), dropped)), end)


def strip_blocks(stiffness: ScaledStiffness, axis: int, dropped: int) -> StripBlocks:
    """Return the blocks of every other column (axis 0) or row (axis 1) of elements.

    Parameters
    ----------
    stiffness : ScaledStiffness
        Its border is left out.
    axis : int
        Across the strips.
    dropped : int
        Position, of a period, of the lines between them.
    """
    across, along = stiffness.positions[axis], stiffness.positions[1 - axis]
    inside, _ = split(across, dropped)
    edge = stiffness.functions(axis, 1, 0).size
    size = 3 * edge + 2
    count = stiffness.blocks.shape[1 - axis]
    strips = int(_strip(across[inside], dropped).max()) + 1
    diagonal, below = np.zeros((count + 1, strips, size, size)), np.zeros((count + 1, strips, size, size - edge))
    for members in _members(stiffness, axis, dropped):
        blocks = np.swapaxes(members.blocks, 0, 1)
        which = slice(members.first, members.first + len(members.blocks))
        middle = 2 - members.end
        # The edge is before the middle of the strip, or beyond it.
        crossing = slice(edge, 2 * edge + 2) if middle else slice(2 * edge, size)
        order = (1, middle) if middle else (middle, 1)
        start, end = (np.concatenate([stiffness.functions(axis, at, line) for at in order]) for line in (0, 2))
        rest = (slice(0, edge), stiffness.functions(axis, middle, 1)), (crossing, end)
        for (rows, i), (columns, j) in product(rest, rest):
            diagonal[1:, which, rows, columns] += blocks[:, :, i[:, None], j]
        diagonal[:-1, which, crossing, crossing] += blocks[:, :, start[:, None], start]
        of_line = slice(crossing.start - edge, crossing.stop - edge)
        for rows, i in rest:
            below[1:, which, rows, of_line] += blocks[:, :, i[:, None], start]
    step, place = (along[inside] + 1) // 2, (across[inside] - dropped) % PERIOD
    slots = np.array([0, edge, 2 * edge, 2 * edge + 2])[np.where(along[inside] % 2 == 1, 0, place)]
    places = (step * strips + _strip(across[inside], dropped)) * size + slots + stiffness.ranks[inside]
    used = np.zeros(diagonal.size // size, bool)
    used[places] = True
    unused = np.flatnonzero(~used)
    diagonal.reshape(-1, size)[unused, unused % size] = 1.0
    return StripBlocks(diagonal, below, places)


def coupling_of(stiffness: ScaledStiffness, axis: int, dropped: int) -> ElementSum:
    """Return the matrix on the strips, as they are numbered, and on the lines between them: columns and rows.

    Parameters
    ----------
    stiffness, axis, dropped
        As for `strip_blocks`, with the border.
    """
    inside, lines = split(stiffness.positions[axis], dropped)
    in_strips, on_lines = np.zeros((2, stiffness.size), np.intp)
    in_strips[inside], on_lines[lines] = np.arange(inside.size), np.arange(lines.size)
    parts = []
    for members in _members(stiffness, axis, dropped):
        gone = stiffness.in_element[axis] == members.end
        rows, columns = np.flatnonzero(gone), np.flatnonzero(~gone)
        blocks = members.blocks[:, :, rows[:, None], columns]
        targets, sources = on_lines[members.sides[:, :, rows]], in_strips[members.sides[:, :, columns]]
        parts.append([array.reshape(-1, *array.shape[2:]) for array in (targets, sources, blocks)])
    targets, sources, blocks = (np.concatenate(some) for some in zip(*parts, strict=True))
    of_lines, of_strips = (stiffness.border.within(some, stiffness.size) for some in (lines, inside))
    return ElementSum(targets, sources, blocks, lines.size, of_lines, of_strips)
