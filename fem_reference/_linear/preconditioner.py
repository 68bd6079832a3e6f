"""Symmetric two-level preconditioner of the stiffness of the half-space, with pyamg on the coarse level.

The meshes are tensor products with elements of every aspect ratio, thin columns under a contact edge and thin
rows under the surface.  The smoother therefore solves whole strips: all unknowns strictly between two grid
lines two elements apart (overlapping line Schwarz).  Every other strip is independent of the next, so a
direction takes two sparse factorisations ("zebra"), and a sweep is columns, then rows; the reverse sweep
closes the symmetric preconditioner.  Strips are solved exactly, so that a residual is left on the lines between them
only: it is kept and changed there, at a tenth of the cost of a product with the whole matrix.  In between, the vertex
functions of the hierarchical element, which are exactly the bilinear space, carry the smooth error to pyamg's smoothed
aggregation.

Measured: conjugate gradients take 6 to 20 iterations to 1e-10 from 4e3 to 3e5 unknowns, k = 0 ... 0.8,
nu = 0 ... 0.45, with and without an edge a thousandth of its radius wide.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, SuperLU, splu

from fem_reference._elastic.assembly import HalfSpace
from fem_reference._elastic.condensation import grid_positions
from fem_reference._linear.algebraic_multigrid import pyamg
from fem_reference._typing import Array, Index
from fem_reference.errors import NotConverged

__all__ = ["ElasticPreconditioner", "factorise", "hierarchy_bytes", "unit_scaling"]


COARSE_CYCLES = 2
"""V-cycles of smoothed aggregation a correction: one costs up to 8 more outer iterations, three gain none."""

COARSEST = 300
"""Unknowns pyamg solves directly."""


def factorise(matrix: Any) -> SuperLU:
    """Factorise by SuperLU in its symmetric mode, ten times faster here than its default.

    Parameters
    ----------
    matrix : sparse array, shape (N, N)
        With a symmetric pattern.

    Raises
    ------
    RuntimeError
        If the matrix is singular.

    Examples
    --------
    >>> factorise(sparse.csr_array(np.array([[2.0, 1.0], [1.0, 2.0]]))).solve(np.array([3.0, 3.0]))
    array([1., 1.])
    """
    return splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})


def unit_scaling(diagonal: Array) -> Array:
    """Symmetric scaling to a unit diagonal, which a positive definite matrix has.

    Parameters
    ----------
    diagonal : ndarray, shape (N,)

    Returns
    -------
    ndarray, shape (N,)
        Its -1/2nd power.

    Raises
    ------
    NotConverged
        If an entry is not positive.

    Examples
    --------
    >>> unit_scaling(np.array([4.0, 25.0]))
    array([0.5, 0.2])
    """
    if not np.all(diagonal > 0):
        raise NotConverged("the stiffness has a non-positive diagonal entry; check modulus, mesh and nu")
    return np.asarray(1.0 / np.sqrt(diagonal))


@dataclass(frozen=True, slots=True, eq=False)
class Strips:
    """Every other strip of the mesh, factorised.

    Attributes
    ----------
    inside, lines : ndarray of int
        Unknowns in the strips, and on the grid lines between them.
    factors : SuperLU
        Of the matrix on `inside`.
    coupling : csr_array
        The matrix, rows `lines` and columns `inside`.
    """

    inside: Index
    lines: Index
    factors: SuperLU
    coupling: sparse.csr_array

    def correct(self, x: Array, residual: Array) -> None:
        """Solve the strips exactly; update x and the residual, shape (free, q), in place."""
        change = self.factors.solve(residual[self.inside])
        x[self.inside] += change
        residual[self.inside] = 0.0
        residual[self.lines] -= self.coupling @ change

    @property
    def storage(self) -> int:
        """Bytes of factors, coupling and indices."""
        return int(self.inside.nbytes + self.lines.nbytes + 12 * self.factors.nnz + _sparse_bytes(self.coupling))


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
        D = sparse.diags_array(self.scale)
        self.matrix: sparse.csr_array = (D @ A @ D).tocsr()
        self._strips = self._factor_strips(half_space)
        self._vertices, self._coarse = self._build_coarse(half_space)
        self._vertex_columns = self.matrix[:, self._vertices[self._vertices >= 0]].tocsr()

    def _factor_strips(self, half_space: HalfSpace) -> list[Strips]:
        strips = []
        for position in grid_positions(half_space):
            place = np.repeat(position, 2)[half_space.free]
            for dropped in (2, 0):
                between = place % 4 == dropped
                inside, lines = np.flatnonzero(~between), np.flatnonzero(between)
                columns = self.matrix[:, inside].tocsr()
                try:
                    factors = factorise(columns[inside])
                except RuntimeError as error:
                    raise NotConverged(f"a strip of the mesh is singular ({error}); check modulus and mesh") from error
                strips.append(Strips(inside, lines, factors, columns[lines]))
        return strips

    def _build_coarse(self, half_space: HalfSpace) -> tuple[Index, pyamg.MultilevelSolver]:
        """Galerkin matrix of the vertex functions, in 2 x 2 blocks, and its aggregation hierarchy."""
        basis, free = half_space.basis, half_space.free
        rows = 2 * basis.nodal_dofs[0][:, None] + np.arange(2)
        position = np.full(half_space.matrix.shape[0], -1)
        position[free] = np.arange(free.size)
        vertices = position[rows.ravel()]
        present = vertices >= 0
        kept = vertices[present]
        size = vertices.size
        # A vertex on the axis has no u_r: a unit row keeps the blocks whole.
        injection = sparse.csr_array(
            (np.ones(kept.size), (np.flatnonzero(present), np.arange(kept.size))), (size, kept.size)
        )
        padding = sparse.diags_array((~present).astype(float))
        coarse = injection @ self.matrix[kept][:, kept] @ injection.T + padding
        unit = np.zeros(size)
        unit[present] = 1.0 / self.scale[kept]
        candidates = np.zeros((size, 2))
        candidates[0::2, 0], candidates[1::2, 1] = unit[0::2], unit[1::2]
        smoother = ("block_gauss_seidel", {"sweep": "symmetric", "iterations": 1})
        hierarchy = pyamg.smoothed_aggregation_solver(
            sparse.bsr_matrix(sparse.csr_matrix(coarse), blocksize=(2, 2)),
            B=candidates,
            strength=("evolution", {"epsilon": 4.0, "k": 2}),
            smooth=("energy", {"krylov": "cg", "maxiter": 3}),
            presmoother=smoother,
            postsmoother=smoother,
            max_coarse=COARSEST,
        )
        return vertices, hierarchy

    def __call__(self, b: Array) -> Array:
        """Apply the preconditioner to right-hand sides of the scaled system, shape (free,) or (free, q)."""
        b = np.asarray(b, float)
        residual = b.reshape(b.shape[0], -1).copy()
        x = np.zeros_like(residual)
        for strips in self._strips:
            strips.correct(x, residual)
        present = self._vertices >= 0
        vertices = self._vertices[present]
        for column, left in zip(x.T, residual.T, strict=True):
            coarse = np.zeros(self._vertices.size)
            coarse[present] = left[vertices]
            correction = self._coarse.solve(coarse, tol=1e-300, maxiter=COARSE_CYCLES, cycle="V")[present]
            column[vertices] += correction
            left -= self._vertex_columns @ correction
        for strips in reversed(self._strips):
            strips.correct(x, residual)
        return x.reshape(b.shape)

    @property
    def storage(self) -> int:
        """Bytes of the scaled matrix, of the strips with their factors, and of pyamg's hierarchy."""
        own = _sparse_bytes(self.matrix) + _sparse_bytes(self._vertex_columns) + self._vertices.nbytes
        return own + sum(strips.storage for strips in self._strips) + hierarchy_bytes(self._coarse)

    def operator(self) -> LinearOperator:
        """Return the preconditioner as a scipy operator."""
        return LinearOperator(self.matrix.shape, self.__call__, dtype=float)


def hierarchy_bytes(hierarchy: pyamg.MultilevelSolver) -> int:
    """Bytes of a hierarchy: its matrices, candidates and smoothers, and the dense inverse on the coarsest level.

    Examples
    --------
    >>> hierarchy = pyamg.smoothed_aggregation_solver(sparse.csr_array(np.eye(10)))  # one level: 10 x 10 inverse
    >>> hierarchy_bytes(hierarchy) - 8 * 10**2  # values and indices of the matrix 164, candidates 80
    244
    """
    total = 8 * hierarchy.levels[-1].A.shape[0] ** 2
    for level in hierarchy.levels:
        total += sum(_sparse_bytes(getattr(level, name)) for name in ("A", "P", "R") if hasattr(level, name))
        total += level.B.nbytes
        if hasattr(level, "presmoother"):
            # Both smoothers share the inverses of the diagonal blocks.
            blocks = getattr(level.presmoother, "keywords", {}).get("Dinv")
            total += 0 if blocks is None else blocks.nbytes
    return total


def _sparse_bytes(matrix: Any) -> int:
    """Values and both index arrays of a compressed matrix."""
    return int(matrix.data.nbytes + matrix.indices.nbytes + matrix.indptr.nbytes)
