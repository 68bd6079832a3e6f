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
from scipy import sparse

from fem_reference._elastic.assembly import HalfSpace
from fem_reference._elastic.scaling import unit_scaling
from fem_reference._linear.algebraic_multigrid import pyamg
from fem_reference._linear.block_tridiagonal import Border, border_of
from fem_reference._linear.hierarchy import hierarchy_bytes, vertex_hierarchy
from fem_reference._linear.strips import sparse_bytes, strips_of
from fem_reference._typing import Array, Index
from fem_reference.errors import Failure, NotConverged

__all__ = ["ElasticPreconditioner"]


#: Cycles of smoothed aggregation a correction: with one, the outer iterations grow by one or two, and with more they do
#: not fall (measured for 8e3 to 3e5 unknowns; at a Tabor number of 300 they are 19, 14 and, with four, 11).
COARSE_CYCLES = 2


#: Least work of the residual on a correction by pyamg, in energies of the correction: 1 but for rounding.
SMALLEST_WORK = 0.9


def _grid_positions(half_space: HalfSpace) -> tuple[Index, Index]:
    """Column and row of every vertex and edge function, shape (N,): even on grid lines, odd between them."""
    dofs, grid = half_space.dofs, half_space.grid
    mesh = dofs.topo
    places = 2 * np.searchsorted(grid.r, mesh.p[0]), 2 * np.searchsorted(grid.z, mesh.p[1])
    column, row = np.zeros(dofs.N, np.intp), np.zeros(dofs.N, np.intp)
    for position, value in zip((column, row), places, strict=True):
        position[dofs.nodal_dofs[0]] = value
        position[dofs.facet_dofs] = value[mesh.facets].sum(axis=0) // 2
    return column, row


class ElasticPreconditioner:
    """Symmetric positive definite approximate inverse of the scaled stiffness on the free rows.

    Parameters
    ----------
    half_space : HalfSpace
        The assembled half-space.

    Attributes
    ----------
    matrix : csr_array
        The scaled stiffness D A D on the free rows.
    scale : ndarray
        The diagonal of D.

    Raises
    ------
    NotConverged
        If a strip of the mesh is singular, or the diagonal not positive.
    """

    def __init__(self, half_space: HalfSpace) -> None:
        free = half_space.free
        A = half_space.matrix[free][:, free].tocsr()
        self.scale: Array = unit_scaling(A.diagonal())
        A.data *= np.repeat(self.scale, np.diff(A.indptr))
        A.data *= self.scale[A.indices]
        self.matrix: sparse.csr_array = A
        columns, rows = (np.repeat(index, 2)[free] for index in _grid_positions(half_space))
        border = self._border(half_space)
        self._columns = strips_of(self.matrix, columns, rows, border)
        self._rows = strips_of(self.matrix, rows, columns, border)
        self._vertices, self._coarse = self._build_coarse(half_space)
        self._vertex_columns = self.matrix[:, self._vertices[self._vertices >= 0]].tocsr()

    def _border(self, half_space: HalfSpace) -> Border:
        """The exterior, scaled, on the free rows of the boundary."""
        present = np.isin(half_space.boundary, half_space.free)
        rows = np.searchsorted(half_space.free, half_space.boundary[present])
        scale = self.scale[rows]
        return border_of(rows, scale[:, None] * half_space.exterior[np.ix_(present, present)] * scale)

    def _build_coarse(self, half_space: HalfSpace) -> tuple[Index, pyamg.MultilevelSolver]:
        """Galerkin matrix of the vertex functions, in 2 x 2 blocks, and its aggregation hierarchy."""
        dofs, free = half_space.dofs, half_space.free
        rows = 2 * dofs.nodal_dofs[0][:, None] + np.arange(2)
        position = np.full(half_space.matrix.shape[0], -1)
        position[free] = np.arange(free.size)
        vertices = position[rows.ravel()]
        present = vertices >= 0
        free_vertices = vertices[present]
        size = vertices.size
        # A vertex on the axis has no u_r: a unit row keeps the blocks whole.
        injection = sparse.csr_array(
            (np.ones(free_vertices.size), (np.flatnonzero(present), np.arange(free_vertices.size))),
            (size, free_vertices.size),
        )
        padding = sparse.diags_array((~present).astype(float))
        coarse = injection @ self.matrix[free_vertices][:, free_vertices] @ injection.T + padding
        unit = np.zeros(size)
        unit[present] = 1.0 / self.scale[free_vertices]
        candidates = np.zeros((size, 2))
        candidates[0::2, 0], candidates[1::2, 1] = unit[0::2], unit[1::2]
        # Grid lines have even positions.
        places = [index[dofs.nodal_dofs[0]] // 2 for index in _grid_positions(half_space)]
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
            image = self._vertex_columns @ correction
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
        matrices = sparse_bytes(self.matrix) + sparse_bytes(self._vertex_columns) + self._vertices.nbytes
        strips = sum(half.storage for half in (*self._columns, *self._rows))
        return matrices + strips + hierarchy_bytes(self._coarse)
