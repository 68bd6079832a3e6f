"""Linear systems of the half-space: conjugate gradients, a direct solve, and GMRES for a bordered tangent.

Each returns a solution whose residual was recomputed at the end, or raises.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, cg

from fem_reference.algebraic_multigrid import pyamg
from fem_reference.assembly import HalfSpace
from fem_reference.errors import NotConverged
from fem_reference.preconditioner import ElasticPreconditioner, factorise, unit_scaling

__all__ = ["LinearResult", "solve_bordered", "solve_cg", "solve_direct"]

Array = NDArray[np.float64]

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
        Bytes of the factors (0 for conjugate gradients, whose preconditioner knows its own).

    Examples
    --------
    >>> from fem_reference.assembly import assemble_half_space
    >>> from fem_reference.mesh import graded_grid
    >>> from fem_reference.modulus import PowerLaw
    >>> grid = graded_grid(edge_width=0.2, extent=8.0, density=1.2)
    >>> half_space = assemble_half_space(grid, PowerLaw(1.0, 1.0, 0.4), nu=0.3, order=3)
    >>> load = np.zeros(half_space.matrix.shape[0])
    >>> load[half_space.surface[0]] = 1.0
    >>> result = solve_direct(half_space, load)
    >>> result.iterations, result.residual < TOLERANCE, result.storage > 0
    (0, True, True)
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
        If the residual asked for is not reached.

    Examples
    --------
    >>> from fem_reference.assembly import assemble_half_space
    >>> from fem_reference.mesh import graded_grid
    >>> from fem_reference.modulus import PowerLaw
    >>> grid = graded_grid(edge_width=0.2, extent=8.0, density=1.2)
    >>> half_space = assemble_half_space(grid, PowerLaw(1.0, 1.0, 0.4), nu=0.3, order=3)
    >>> load = np.zeros(half_space.matrix.shape[0])
    >>> load[half_space.surface[0]] = 1.0
    >>> result, direct = solve_cg(half_space, load), solve_direct(half_space, load)
    >>> result.iterations < 20, bool(np.allclose(result.solution, direct.solution, atol=1e-8))
    (True, True)
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

    Examples
    --------
    >>> from fem_reference.assembly import assemble_half_space
    >>> from fem_reference.mesh import graded_grid
    >>> from fem_reference.modulus import PowerLaw
    >>> grid = graded_grid(edge_width=0.2, extent=8.0, density=1.2)
    >>> half_space = assemble_half_space(grid, PowerLaw(1.0, 1.0, 0.4), nu=0.3, order=3)
    >>> load = np.zeros(half_space.matrix.shape[0])
    >>> load[half_space.surface[0]] = 1.0
    >>> u = solve_direct(half_space, load).solution
    >>> round(float(u @ load / (u @ half_space.matrix @ u)), 9)  # work of the load over twice the strain energy
    1.0
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

    Examples
    --------
    >>> from fem_reference.assembly import assemble_half_space
    >>> from fem_reference.mesh import graded_grid
    >>> from fem_reference.modulus import PowerLaw
    >>> grid = graded_grid(edge_width=0.2, extent=8.0, density=1.2)
    >>> half_space = assemble_half_space(grid, PowerLaw(1.0, 1.0, 0.4), nu=0.3, order=3)
    >>> cycle = ElasticPreconditioner(half_space)
    >>> b = np.ones(half_space.free.size + 1)
    >>> bordered = LinearOperator(
    ...     (b.size, b.size), lambda x: np.append(cycle.matrix @ x[:-1] - 1e-3 * x[-1], x[0] - x[-1]), dtype=float
    ... )
    >>> x, iterations = solve_bordered(bordered, b, cycle, factor=1.0)
    >>> bool(np.linalg.norm(b - bordered @ x) < 1e-9 * np.linalg.norm(b)), iterations < 40
    (True, True)
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


def _expand(half_space: HalfSpace, x: Array) -> Array:
    full = np.zeros(half_space.matrix.shape[0])
    full[half_space.free] = x
    return full
