"""Linear solvers of the half-space: conjugate gradients, a direct solve, and GMRES for a bordered tangent.

Each returns a solution whose residual was recomputed at the end, or raises.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, cg

from fem_reference._elastic.assembly import HalfSpace
from fem_reference._linear.algebraic_multigrid import pyamg
from fem_reference._linear.preconditioner import ElasticPreconditioner, factorise, unit_scaling
from fem_reference._typing import Array
from fem_reference.errors import NotConverged

__all__ = ["LinearResult", "solve_bordered", "solve_cg", "solve_direct"]


TOLERANCE = 1e-10
"""Relative residual: the displacement is then good to 1e-9, below the discretisation of any fine mesh."""

ITERATIONS = 60
"""Three times the most ever needed; more means that the preconditioner does not fit the matrix."""

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
        Bytes of the factors (0 for conjugate gradients, whose preconditioner has its own).
    """

    solution: Array
    iterations: int
    residual: float
    seconds: float
    storage: int = 0


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
        If the residual does not fall to the tolerance.
    """
    preconditioner = ElasticPreconditioner(half_space) if preconditioner is None else preconditioner
    begin = time.perf_counter()
    b = preconditioner.scale * load[half_space.free]
    count = 0

    def counted(_: Array) -> None:
        nonlocal count
        count += 1

    # The recursive residual differs from the true one by rounding, so half the tolerance is required of it.
    x, _ = cg(
        preconditioner.matrix,
        b,
        rtol=0.5 * tolerance,
        atol=0.0,
        M=preconditioner.operator(),
        maxiter=iterations,
        callback=counted,
    )
    seconds = time.perf_counter() - begin
    norm = float(np.linalg.norm(b))
    residual = float(np.linalg.norm(b - preconditioner.matrix @ x)) / norm if norm > 0 else 0.0
    if not residual <= tolerance:
        raise NotConverged(
            f"conjugate gradients reached a residual of {residual:.1e} in {count} iterations, not "
            f"{tolerance:.1e}; allow more iterations, or use the direct solver"
        )
    return LinearResult(_expand(half_space, preconditioner.scale * x), count, residual, seconds)


def solve_direct(half_space: HalfSpace, load: Array) -> LinearResult:
    """Solve A u = load by a symmetric sparse factorisation; the time includes the factorisation.

    Parameters
    ----------
    half_space : HalfSpace
        The assembled half-space.
    load : ndarray, shape (2 N,)
        Right-hand side; fixed rows are ignored.

    Returns
    -------
    LinearResult

    Raises
    ------
    NotConverged
        If the matrix is singular, or so nearly that the residual is not that of a factorisation.
    """
    begin = time.perf_counter()
    free = half_space.free
    A = half_space.matrix[free][:, free].tocsr()
    scale = unit_scaling(A.diagonal())
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
    preconditioner: ElasticPreconditioner,
    factor: float,
    tolerance: float = TOLERANCE,
) -> tuple[Array, int]:
    """Solve an indefinite bordered system by GMRES with the elastic preconditioner on its leading block.

    Parameters
    ----------
    matrix : LinearOperator, shape (f + 1, f + 1)
        Tangent on the scaled free rows, bordered by one control.
    b : ndarray, shape (f + 1,)
        Right-hand side.
    preconditioner : ElasticPreconditioner
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
        return np.append(factor * preconditioner(v[:-1]), v[-1])

    history: list[float] = []
    operator = LinearOperator(matrix.shape, apply, dtype=float)
    # Flexible GMRES preconditions from the right: its residual is the true one.
    x, _ = pyamg.krylov.fgmres(matrix, b, tol=0.5 * tolerance, maxiter=DIRECTIONS, M=operator, residuals=history)
    count = len(history)
    residual = float(np.linalg.norm(b - matrix @ x)) / max(float(np.linalg.norm(b)), 1e-300)
    if not residual <= tolerance:
        raise NotConverged(f"GMRES reached a residual of {residual:.1e} in {count} steps, not {tolerance:.1e}")
    return x, count


def _expand(half_space: HalfSpace, x: Array) -> Array:
    full = np.zeros(half_space.matrix.shape[0])
    full[half_space.free] = x
    return full
