"""Conjugate gradients for the half-space, preconditioned by a symmetric two-level cycle on pyamg.

The meshes are tensor products with elements of every aspect ratio, thin columns under a contact edge and thin
rows under the surface.  The smoother therefore solves whole strips: all unknowns strictly between two grid
lines two elements apart (overlapping line Schwarz).  Every other strip is independent of the next, so a
direction takes two sparse factorisations ("zebra"), and a sweep is columns, then rows; the reverse sweep
closes the symmetric cycle.  In between, the vertex functions of the hierarchical element, which are exactly
the bilinear space, carry the smooth error to pyamg's smoothed aggregation.

Measured: 6 to 20 iterations to 1e-10 from 4e3 to 3e5 unknowns, k = 0 ... 0.8, nu = 0 ... 0.45, with and
without an edge a thousandth of its radius wide.
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyamg
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, SuperLU, cg, splu

from fem_reference.assembly import HalfSpace
from fem_reference.condensation import grid_positions
from fem_reference.errors import NotConverged

__all__ = ["ElasticPreconditioner", "LinearResult", "factorise", "solve_bordered", "solve_cg", "solve_direct"]

Array = NDArray[np.float64]
Index = NDArray[np.intp]

TOLERANCE = 1e-10
"""Relative residual: the displacement is then good to 1e-9, below the discretisation of any fine mesh."""

ITERATIONS = 60
"""Three times the most ever needed; more means that the preconditioner does not fit the matrix."""

COARSE_CYCLES = 2
"""V-cycles of smoothed aggregation a correction: one costs up to 8 more outer iterations, three gain none."""

COARSEST = 300
"""Unknowns pyamg solves directly."""

DIRECTIONS = 150
"""Krylov directions for an indefinite tangent: each negative direction of the surface law costs a few."""


@dataclass(frozen=True, slots=True, eq=False)
class LinearResult:
    """Solution of a linear system on the free rows.

    Attributes
    ----------
    solution : ndarray, shape (2 N,)
        Displacement, zero on the fixed rows.
    iterations : int
        Krylov iterations (0 for the direct solve).
    residual : float
        Relative residual of the scaled system, recomputed at the end.
    seconds : float
        Time of the solve; without the set-up of the preconditioner, with the factorisation of a direct solve.
    storage : int
        Bytes of the factors (0 for conjugate gradients, whose preconditioner knows its own).
    """

    solution: Array
    iterations: int
    residual: float
    seconds: float
    storage: int = 0


def factorise(matrix: Any) -> SuperLU:
    """Factorise by SuperLU in its symmetric mode, ten times faster here than its default."""
    return splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})


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
    """

    def __init__(self, half_space: HalfSpace) -> None:
        free = half_space.free
        A = half_space.matrix[free][:, free].tocsr()
        self.scale: Array = _scaling(A.diagonal())
        D = sparse.diags_array(self.scale)
        self.matrix: sparse.csr_array = (D @ A @ D).tocsr()
        self._strips = self._factor_strips(half_space)
        self._vertices, self._coarse = self._build_coarse(half_space)

    def _factor_strips(self, half_space: HalfSpace) -> list[tuple[Index, SuperLU, sparse.csr_array]]:
        strips = []
        for position in grid_positions(half_space):
            place = np.repeat(position, 2)[half_space.free]
            for dropped in (2, 0):
                inside = np.flatnonzero(place % 4 != dropped)
                rows = self.matrix[inside]
                try:
                    factors = factorise(rows[:, inside])
                except RuntimeError as error:
                    raise NotConverged(f"a strip of the mesh is singular ({error}); check modulus and mesh") from error
                strips.append((inside, factors, rows))
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
        spread = sparse.csr_array(
            (np.ones(kept.size), (np.flatnonzero(present), np.arange(kept.size))), (size, kept.size)
        )
        padding = sparse.diags_array((~present).astype(float))
        coarse = spread @ self.matrix[kept][:, kept] @ spread.T + padding
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
        """Apply the cycle to a right-hand side of the scaled system, shape (free,)."""
        b = np.asarray(b, float).ravel()
        x = np.zeros_like(b)
        first, factors, _ = self._strips[0]
        x[first] = factors.solve(b[first])
        for inside, factors, rows in self._strips[1:]:
            x[inside] += factors.solve(b[inside] - rows @ x)
        present = self._vertices >= 0
        residual = np.zeros(self._vertices.size)
        residual[present] = (b - self.matrix @ x)[self._vertices[present]]
        correction = self._coarse.solve(residual, tol=1e-300, maxiter=COARSE_CYCLES, cycle="V")
        x[self._vertices[present]] += correction[present]
        for inside, factors, rows in reversed(self._strips):
            x[inside] += factors.solve(b[inside] - rows @ x)
        return x

    @property
    def storage(self) -> int:
        """Bytes of the factors, the scaled matrix and the strips' rows."""
        factors = sum(12 * lu.nnz for _, lu, _ in self._strips)
        rows = sum(12 * part.nnz for _, _, part in self._strips)
        return factors + rows + 12 * self.matrix.nnz

    def operator(self) -> LinearOperator:
        """Return the cycle as a scipy operator."""
        return LinearOperator(self.matrix.shape, self.__call__, dtype=float)


def solve_cg(
    half_space: HalfSpace,
    load: Array,
    preconditioner: ElasticPreconditioner | None = None,
    tolerance: float = TOLERANCE,
    iterations: int = ITERATIONS,
) -> LinearResult:
    """Solve A u = load by preconditioned conjugate gradients.

    Parameters
    ----------
    half_space : HalfSpace
        The assembled half-space.
    load : ndarray, shape (2 N,)
        Right-hand side; fixed rows are ignored.
    preconditioner : ElasticPreconditioner, optional
        Of this half-space; built when absent.
    tolerance : float
        Relative residual to reach.
    iterations : int
        Iterations allowed.

    Returns
    -------
    LinearResult

    Raises
    ------
    NotConverged
        If the residual asked for is not reached.
    """
    cycle = ElasticPreconditioner(half_space) if preconditioner is None else preconditioner
    begin = time.perf_counter()
    b = cycle.scale * load[half_space.free]
    count = 0

    def counted(_: Array) -> None:
        nonlocal count
        count += 1

    # The recursive residual drifts from the true one by rounding: ask for a little more than is promised.
    x, _ = cg(
        cycle.matrix,
        b,
        rtol=0.5 * tolerance,
        atol=0.0,
        M=cycle.operator(),
        maxiter=iterations,
        callback=counted,
    )
    seconds = time.perf_counter() - begin
    norm = float(np.linalg.norm(b))
    residual = float(np.linalg.norm(b - cycle.matrix @ x)) / norm if norm > 0 else 0.0
    if not residual <= tolerance:
        raise NotConverged(
            f"conjugate gradients reached a residual of {residual:.1e} in {count} iterations, not "
            f"{tolerance:.1e}; allow more iterations, or use the direct solver"
        )
    return LinearResult(_expand(half_space, cycle.scale * x), count, residual, seconds)


def solve_direct(half_space: HalfSpace, load: Array) -> LinearResult:
    """Solve A u = load by a symmetric sparse factorisation; the time includes the factorisation.

    Raises
    ------
    NotConverged
        If the matrix is singular, or so nearly that the residual is not that of a factorisation.
    """
    begin = time.perf_counter()
    free = half_space.free
    A = half_space.matrix[free][:, free].tocsr()
    scale = _scaling(A.diagonal())
    D = sparse.diags_array(scale)
    A = (D @ A @ D).tocsc()
    b = scale * load[free]
    try:
        factors = factorise(A)
        x = factors.solve(b)
    except RuntimeError as error:
        raise NotConverged(f"the stiffness matrix is singular ({error}); check modulus, mesh and nu") from error
    seconds = time.perf_counter() - begin
    norm = float(np.linalg.norm(b))
    residual = float(np.linalg.norm(b - A @ x)) / norm if norm > 0 else 0.0
    if not residual <= TOLERANCE:
        raise NotConverged(
            f"the factorisation leaves a residual of {residual:.1e}, not {TOLERANCE:.1e}: the stiffness matrix is "
            "nearly singular; check modulus, mesh and nu"
        )
    storage = 12 * factors.nnz
    return LinearResult(_expand(half_space, scale * x), 0, residual, seconds, storage)


def solve_bordered(
    matrix: LinearOperator,
    b: Array,
    cycle: ElasticPreconditioner,
    factor: float,
    tolerance: float = TOLERANCE,
) -> tuple[Array, int]:
    """Solve an indefinite bordered system by GMRES with the elastic cycle on its leading block.

    Parameters
    ----------
    matrix : LinearOperator, shape (f + 1, f + 1)
        Tangent on the scaled free rows, bordered by one control.
    b : ndarray, shape (f + 1,)
        Right-hand side.
    cycle : ElasticPreconditioner
        Approximate inverse of the elastic part.
    factor : float
        The elastic part of the leading block is the scaled stiffness divided by this factor.
    tolerance : float
        Relative residual to reach.

    Returns
    -------
    solution : ndarray, shape (f + 1,)
    iterations : int

    Raises
    ------
    NotConverged
        If the residual is not reached within `DIRECTIONS` steps.
    """

    def apply(v: Array) -> Array:
        return np.append(factor * cycle(v[:-1]), v[-1])

    history: list[float] = []
    operator = LinearOperator(matrix.shape, apply, dtype=float)
    # Flexible GMRES preconditions from the right: its residual is the true one.
    x, _ = pyamg.krylov.fgmres(matrix, b, tol=0.5 * tolerance, maxiter=DIRECTIONS, M=operator, residuals=history)
    count = len(history)
    residual = float(np.linalg.norm(b - matrix @ x)) / max(float(np.linalg.norm(b)), 1e-300)
    if not residual <= tolerance:
        raise NotConverged(f"GMRES reached a residual of {residual:.1e} in {count} steps, not {tolerance:.1e}")
    return x, count


def _scaling(diagonal: Array) -> Array:
    """Symmetric scaling to a unit diagonal, which a positive definite matrix has."""
    if not np.all(diagonal > 0):
        raise NotConverged("the stiffness has a non-positive diagonal entry; check modulus, mesh and nu")
    return np.asarray(1.0 / np.sqrt(diagonal))


def _expand(half_space: HalfSpace, x: Array) -> Array:
    full = np.zeros(half_space.matrix.shape[0])
    full[half_space.free] = x
    return full
