"""Tangents of elements from the derivatives of the stresses at their Gauss points, one axis after the other.

Functions and Gauss points of an element are products of those along r and along z: the sum over the points of a line
along r comes first, for each pair of functions along r.  That takes a fourth of the operations of sums over all points
of an element.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem_reference._elastic.gauss import unit_gauss
from fem_reference._elastic.line_functions import line_functions, line_slopes
from fem_reference._large_strain.material import GRADIENTS, HOOP
from fem_reference._typing import Array, Index

__all__ = ["DERIVATIVES", "KINDS", "TensorTangent", "tensor_tangent"]

#: Gradient of each component: function along r, along z, or itself (the hoop), for u_r and then for u_z.
KINDS = ((0, 0), (1, 1), (2, 2), (3, 0), (4, 1))

#: Derivatives of a function along r and along z in each of these.
DERIVATIVES = ((1, 0), (0, 1), (0, 0))

#: Blocks of components that are formed; the fourth is the transpose of the second.
BLOCKS = ((0, 0), (0, 1), (1, 1))


@dataclass(frozen=True, slots=True, eq=False)
class TensorTangent:
    """Sums over the Gauss points of an element.

    Attributes
    ----------
    along_r : list of list of (list of (int, int), ndarray)
        For each block, and for each pair of derivatives along z: the pairs of gradients that have them, and the
        products of their functions along r, shape (pairs q, n n).
    along_z : ndarray, shape (4 q, n n)
        Products of functions along z for each pair of derivatives.
    places : ndarray of int, shape (2 n^2, 2 n^2)
        Entries of the tangent among the sums of all blocks.
    """

    along_r: list[list[tuple[list[tuple[int, int]], Array]]]
    along_z: Array
    places: Index

    def of(self, D: Array) -> Array:
        """Return the tangents, shape (e, 2 n^2, 2 n^2), components interleaved.

        Parameters
        ----------
        D : ndarray, shape (5, 5, e, q^2)
            Weighted derivatives of the stresses; points along r follow each other.
        """
        elements, pairs = D.shape[2], self.along_z.shape[1]
        points = self.along_z.shape[0] // 4
        by_line = np.empty((elements, 4, points, pairs))
        sums = np.empty((elements, len(BLOCKS), pairs, pairs))
        for block, of_block in enumerate(self.along_r):
            for derivatives, (gradients, products) in enumerate(of_block):
                lines = [D[i, j].reshape(elements, points, points) for i, j in gradients]
                by_line[:, derivatives] = np.concatenate(lines, axis=2) @ products
            of_lines = by_line.reshape(elements, 4 * points, pairs)
            np.matmul(of_lines.swapaxes(1, 2), self.along_z, out=sums[:, block])
        return sums.reshape(elements, -1).take(self.places, axis=1, mode="clip")


def tensor_tangent(order: int, count: int, along: tuple[Index, Index]) -> TensorTangent:
    """Return the sums for elements of a degree, with so many Gauss points a direction.

    Parameters
    ----------
    order, count : int
    along : tuple of ndarray of int
        Degrees of the factors of each function, of `fem_reference._elastic.tensor_elements.factors`.
    """
    x, _ = unit_gauss(count)
    ends = np.array([0.0, 1.0])
    lines = line_functions(ends, order, x), line_slopes(ends, order, x)

    def product(first: int, second: int) -> Array:
        return np.asarray((lines[first][:, :, None] * lines[second][:, None, :]).reshape(count, -1))

    both = [(first, second) for first in (0, 1) for second in (0, 1)]
    of_component = [KINDS[: HOOP + 1], KINDS[HOOP + 1 : GRADIENTS]]
    along_r = []
    for component, other in BLOCKS:
        groups = []
        for pair in both:
            chosen = [
                ((i, j), product(DERIVATIVES[kind][0], DERIVATIVES[second][0]))
                for i, kind in of_component[component]
                for j, second in of_component[other]
                if (DERIVATIVES[kind][1], DERIVATIVES[second][1]) == pair
            ]
            groups.append(([gradients for gradients, _ in chosen], np.concatenate([p for _, p in chosen])))
        along_r.append(groups)
    along_z = np.concatenate([product(*pair) for pair in both])
    return TensorTangent(along_r, along_z, _places(*along, order + 1))


def _places(along_r: Index, along_z: Index, n: int) -> Index:
    size = 2 * along_r.size
    places = np.empty((size, size), np.intp)
    first, second = (pair[:, None] * n + pair for pair in (along_r, along_z))
    for block, (i, j) in enumerate(BLOCKS):
        of_block = (block * n**2 + first) * n**2 + second
        places[i::2, j::2] = of_block
        if i != j:
            places[j::2, i::2] = of_block.T
    return places
