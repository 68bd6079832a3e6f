"""Symmetric two-level preconditioner of the stiffness of the half-space, with pyamg on the coarse level.

The smoother solves whole strips of the mesh exactly (`strips`), columns or rows.  The vertex functions of the
hierarchical element, which are exactly the bilinear space, carry the smooth error to pyamg's smoothed aggregation,
whose finest level is smoothed by strips as well (`hierarchy`).  A sweep is columns, vertices, rows, vertices, columns,
the same in both directions: it is its own adjoint.

Measured for an edge a thousandth of its radius wide, from 1e4 to 3e5 unknowns and k = 0 ... 0.8, nu = 0 ... 0.45:
conjugate gradients take 5 to 7 iterations to 1e-10, at most one more on the finest mesh than on the coarsest.
"""

from __future__ import annotations

import numpy as np

from fem_reference._elastic.assembly import HalfSpace
from fem_reference._linear.algebraic_multigrid import pyamg
from fem_reference._linear.element_sums import ScaledStiffness, grid_positions
from fem_reference._linear.hierarchy import hierarchy_bytes, vertex_hierarchy
from fem_reference._linear.strips import element_strips
from fem_reference._typing import Array, Index
from fem_reference.errors import Failure, NotConverged

__all__ = ["ElasticPreconditioner"]


#: Cycles of smoothed aggregation a correction: with one, the outer iterations grow by one or two, and with more they do
#: not fall (measured for 8e3 to 3e5 unknowns; at a Tabor number of 300 they are 19, 14 and, with four, 11).
COARSE_CYCLES = 2


#: Least work of the residual on a correction by pyamg, in energies of the correction: 1 but for rounding.
SMALLEST_WORK = 0.9


class ElasticPreconditioner:
    """Symmetric positive definite approximate inverse of the scaled stiffness on the free rows.

    Parameters
    ----------
    half_space : HalfSpace
        The assembled half-space.

    Attributes
    ----------
    matrix : ScaledStiffness
        The scaled stiffness D A D on the free rows.
    scale : ndarray
        The diagonal of D.

    Raises
    ------
    NotConverged
        If a strip of the mesh is singular, or the diagonal not positive.
    """

    def __init__(self, half_space: HalfSpace) -> None:
        self.matrix = ScaledStiffness(half_space)
        self.scale: Array = self.matrix.scale
        self._columns, self._rows = (element_strips(self.matrix, axis) for axis in (0, 1))
        self._vertices, self._coarse = self._build_coarse(half_space)
        self._vertex_columns = self.matrix.on_vertices(self._vertices[self._vertices >= 0])

    def _build_coarse(self, half_space: HalfSpace) -> tuple[Index, pyamg.MultilevelSolver]:
        """Galerkin matrix of the vertex functions, in 2 x 2 blocks, and its aggregation hierarchy."""
        rows = 2 * half_space.dofs.nodal_dofs[0][:, None] + np.arange(2)
        position = np.full(half_space.elements.size, -1)
        position[half_space.free] = np.arange(half_space.free.size)
        vertices = position[rows.ravel()]
        present = np.flatnonzero(vertices >= 0)
        free_vertices = vertices[present]
        # A vertex on the axis has no u_r: a unit row keeps the blocks whole.
        coarse = self.matrix.among_vertices(free_vertices, present, vertices.size)
        unit = np.zeros(vertices.size)
        unit[present] = 1.0 / self.scale[free_vertices]
        candidates = np.zeros((vertices.size, 2))
        candidates[0::2, 0], candidates[1::2, 1] = unit[0::2], unit[1::2]
        # Grid lines have even positions.
        places = [along[half_space.dofs.nodal_dofs[0]] // 2 for along in grid_positions(half_space)]
        return vertices, vertex_hierarchy(coarse, candidates, places)

    def __call__(self, b: Array) -> Array:
        """Apply the preconditioner to right-hand sides of the scaled system, shape (free,) or (free, q).

        Raises
        ------
        NotConverged
            If a correction by pyamg is none.
        """
        b = np.asarray(b, float)
        residual = b.reshape(b.shape[0], -1).copy()
        x = np.zeros_like(residual)
        columns, (row, other_row) = self._columns, self._rows
        for strips in columns:
            strips.correct(x, residual)
        self._correct_vertices(x, residual)
        for strips in (row, other_row, row):
            strips.correct(x, residual)
        self._correct_vertices(x, residual)
        for strips in reversed(columns):
            strips.correct(x, residual)
        return x.reshape(b.shape)

    def _correct_vertices(self, x: Array, residual: Array) -> None:
        """Reduce the error of the vertex functions by pyamg; update x and the residual in place.

        A cycle leaves of every error a share of the same sign.  The work of the residual on the correction is therefore
        no less than the energy of the correction, and an exact solve has as much of both.
        """
        present = self._vertices >= 0
        vertices = self._vertices[present]
        for column, left in zip(x.T, residual.T, strict=True):
            coarse = np.zeros(self._vertices.size)
            coarse[present] = left[vertices]
            correction = self._coarse.solve(coarse, tol=1e-300, maxiter=COARSE_CYCLES)[present]
            image = (self._vertex_columns @ correction[:, None])[:, 0]
            work, energy = float(left[vertices] @ correction), float(correction @ image[vertices])
            if not work >= SMALLEST_WORK * energy or (energy == 0.0 and np.any(left[vertices])):
                raise NotConverged(
                    f"the correction by pyamg is none: the residual does the work {work:.1e} on it, and its energy is "
                    f"{energy:.1e}",
                    Failure.LINEAR,
                )
            column[vertices] += correction
            left -= image

    @property
    def storage(self) -> int:
        """Bytes of the scaled matrix, of the strips with their factors, and of pyamg's hierarchy."""
        matrices = self.matrix.nbytes + self._vertex_columns.nbytes + self._vertices.nbytes
        strips = sum(half.storage for half in (*self._columns, *self._rows))
        return matrices + strips + hierarchy_bytes(self._coarse)
