"""Work of the surface tension of a half-space: the integral of u_z' v_z' r dr over its surface.

On an element it depends on the difference of the displacements at both ends and on the functions that vanish there, so
that a common displacement makes exactly no force.  Beyond the mesh the surface moves by w(R) (R/r)^(1+k), the response
to a load far away; the integral from R on is then (1 + k)/2 times the square of w(R).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse

from fem_reference._elastic.gauss import unit_gauss
from fem_reference._elastic.line_functions import line_slopes
from fem_reference._typing import Array, Index

__all__ = ["SurfaceTension"]


@dataclass(frozen=True, eq=False)
class SurfaceTension:
    """The integral of u' v' s ds over a surface mesh and beyond it, per unit of the tension.

    Attributes
    ----------
    nodes : ndarray, shape (e + 1,)
        Surface vertices.
    order : int
        Degree of the elements.
    depth_exponent : float
        Exponent k of the modulus far below the surface.
    """

    nodes: Array
    order: int
    depth_exponent: float

    @cached_property
    def _elements(self) -> tuple[Index, Array]:
        """Surface functions of each element, both ends first, and its matrix of the slopes."""
        e = self.nodes.size - 1
        element = np.arange(e)[:, None]
        inside = e + 1 + element * (self.order - 1) + np.arange(self.order - 1)
        x, w = unit_gauss(self.order + 1)
        # The slope of the second end is 1, that of the first -1.
        slopes = line_slopes(np.array([0.0, 1.0]), self.order, x)[:, 1:]
        h = np.diff(self.nodes)[:, None]
        weight = w * (self.nodes[:-1, None] + h * x) / h
        return np.hstack([element, element + 1, inside]), np.einsum("eq,qa,qb->eab", weight, slopes, slopes)

    @property
    def _end(self) -> float:
        return 0.5 * (1.0 + self.depth_exponent)

    @cached_property
    def of_elements(self) -> tuple[Index, Array]:
        """Functions of each element in surface order, both ends first, and its matrix; the last has what is beyond."""
        functions, slopes = self._elements
        local = np.empty((slopes.shape[0], self.order + 1, self.order + 1))
        local[:, 1:, 1:] = slopes
        local[:, 0, 1:] = -slopes[:, 0]
        local[:, 1:, 0] = -slopes[:, 0]
        local[:, 0, 0] = slopes[:, 0, 0]
        local[-1, 1, 1] += self._end
        return functions, local

    @cached_property
    def matrix(self) -> sparse.csr_array:
        """In surface order, shape (m, m)."""
        functions, local = self.of_elements
        rows = np.repeat(functions, self.order + 1, axis=1).ravel()
        columns = np.tile(functions, (1, self.order + 1)).ravel()
        m = int(functions.max()) + 1
        return sparse.coo_array((local.ravel(), (rows, columns)), shape=(m, m)).tocsr()

    def forces(self, w: Array) -> Array:
        """Return the product of the matrix with surface displacements, shape (m, q), to the rounding of the forces."""
        functions, slopes = self._elements
        local = w[functions]
        rises = np.concatenate([(local[:, 1] - local[:, 0])[:, None], local[:, 2:]], axis=1)
        on_rises = slopes @ rises
        on_functions = np.concatenate([-on_rises[:, :1], on_rises], axis=1)
        total = np.zeros_like(w)
        np.add.at(total, functions, on_functions)
        total[self.nodes.size - 1] += self._end * w[self.nodes.size - 1]
        return total
