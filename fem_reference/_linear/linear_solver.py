"""Linear solvers of the half-space: conjugate gradients and a direct solve.

Each returns a solution whose residual was recomputed at the end, or raises.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from fem_reference._elastic.assembly import HalfSpace
from fem_reference._elastic.scaling import unit_scaling
from fem_reference._linear.conjugate_gradients import conjugate_gradients, definite_products, products
from fem_reference._linear.preconditioner import ElasticPreconditioner
from fem_reference._linear.strips import factorise
from fem_reference._typing import Array, Index
from fem_reference.errors import Failure, NotConverged

__all__ = ["LinearResult", "relative_residual", "solve_cg", "solve_direct"]


#: Relative residual: the displacement is then good to 1e-9, below the discretisation of any fine mesh.
TOLERANCE = 1e-10

#: Residual at which rounding may keep a solution (measured: 1e-13 is reached on elements of a millionth of the radius).
ROUNDING = 1e-9

#: Nearly three times the most ever needed, 22; more means that the preconditioner does not fit the matrix.
ITERATIONS = 60

#: Share of the residual that is left, from which on it is rounding that leaves it.
STALLED = 0.5


@dataclass(frozen=True, slots=True, eq=False)
class LinearResult:
    """Solution of a linear system on the free rows.

    Attributes
    ----------
    solution : ndarray, shape (2 N,) or (2 N, q)
        Displacement, zero on the fixed rows.
    remainder : ndarray, like `solution`
        Load minus stiffness times displacement, recomputed at the end.
    norm : ndarray, shape (q,)
        Squares of the norms of the loads, in which the residual of conjugate gradients is measured; those of the
        Euclidean one for the direct solve.
    iterations : ndarray of int, shape (q,)
        Krylov iterations of each load (0 for the direct solve).
    residual : float
        Relative residual, recomputed at the end; that of conjugate gradients in the norm of the preconditioner.
    seconds : float
        Time of the solve; without the set-up of the preconditioner, with the factorisation of a direct solve.
    storage : int
        Bytes of the factors (0 for conjugate gradients, whose preconditioner has its own).
    """

    solution: Array
    remainder: Array
    norm: Array
    iterations: Index
    residual: float
    seconds: float
    storage: int = 0


def solve_cg(
    half_space: HalfSpace,
    load: Array,
    preconditioner: ElasticPreconditioner | None = None,
    tolerance: float = TOLERANCE,
    iterations: int = ITERATIONS,
    norm: Array | None = None,
    rounding: float = ROUNDING,
) -> LinearResult:
    """Solve A u = load by preconditioned conjugate gradients, for one or several loads.

    The residual that the iteration believes in differs by rounding from the true one, which is computed anew; the
    iteration begins again with what is left of the load, until that is below the tolerance (iterative refinement).

    Parameters
    ----------
    half_space : HalfSpace
        The assembled half-space.
    load : ndarray, shape (2 N,) or (2 N, q)
        Right-hand sides; fixed rows are ignored.  Each has its own iteration; they share the passes through the
        preconditioner, which are then several times cheaper.
    preconditioner : ElasticPreconditioner, optional
        Of this half-space; built when absent.
    tolerance : float
        Residual to reach in every column, relative in the norm of the preconditioner: the root of r P r / (b P b).
        The eigenvalues of P A lie between 0.5 and 1 (measured, but for single ones on films 1e5 times as stiff as what
        is below), so it is the relative error in energy to within a factor of 1.4; rounding on small elements is large
        in other norms and does not matter.
    iterations : int
        Iterations allowed.
    norm : ndarray, shape (q,), optional
        Squares b P b of the norms to which the residual is relative; those of the loads by default.
    rounding : float
        Residual, larger than the tolerance, at which it may stay because of rounding.

    Returns
    -------
    LinearResult

    Raises
    ------
    NotConverged
        If the residual does not fall to the tolerance, or the preconditioner is found not to be one
        (`fem_reference._linear.conjugate_gradients`).
    """
    preconditioner = ElasticPreconditioner(half_space) if preconditioner is None else preconditioner
    free, scale = half_space.free, preconditioner.scale[:, None]
    begin = time.perf_counter()
    left_over = np.zeros((load.shape[0], load.size // load.shape[0]))
    left_over[free] = load.reshape(left_over.shape)[free]
    r = scale * left_over[free]
    left = preconditioner(r)
    norm = definite_products(r, left) if norm is None else norm
    u, counts = np.zeros_like(left_over), np.zeros(r.shape[1], np.intp)
    before = math.inf
    while True:
        relative = _relative(r, left, norm)
        residual = float(relative.max())
        if residual <= tolerance or not residual <= STALLED * before:
            break
        some = np.flatnonzero(relative > tolerance)
        # The residual of the recursion differs from the true one by rounding, so half the tolerance is required of it.
        goal = (0.5 * tolerance) ** 2 * norm[some]
        allowed = iterations - int(counts.max())
        iterate = conjugate_gradients(preconditioner.matrix, preconditioner, r[:, some], left[:, some], goal, allowed)
        step = _expand(half_space, scale * iterate.solution)
        u[:, some] += step
        counts[some] += iterate.iterations
        # Not load - A u: rounding of u would make forces on thin elements.
        left_over[:, some], before = half_space.remainder(left_over[:, some], step), residual
        r = scale * left_over[free]
        left = preconditioner(r)
    seconds = time.perf_counter() - begin
    if not residual <= max(tolerance, rounding):
        raise NotConverged(
            f"conjugate gradients reached a residual of {residual:.1e} in {counts.max()} iterations, not "
            f"{max(tolerance, rounding):.1e}",
            Failure.LINEAR,
        )
    return LinearResult(u.reshape(load.shape), left_over.reshape(load.shape), norm, counts, residual, seconds)


def _relative(r: Array, left: Array, norm: Array) -> Array:
    """Norms of residuals, relative to those of loads; of a zero load zero."""
    # Of a residual far below the tolerance, rounding of the preconditioner may change the sign.
    squares = np.abs(products(r, left))
    return np.sqrt(np.divide(squares, norm, out=np.zeros_like(squares), where=norm != 0.0))


def relative_residual(half_space: HalfSpace, left: Array, norm: Array, preconditioner: ElasticPreconditioner) -> Array:
    """Return what is left of loads, shape (2 N, q), relative to a norm of `LinearResult`: shape (q,)."""
    r = preconditioner.scale[:, None] * left[half_space.free]
    return _relative(r, preconditioner(r), norm)


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
        raise NotConverged(f"the stiffness matrix is singular ({error})", Failure.STIFFNESS) from error
    seconds = time.perf_counter() - begin
    norm, r = float(np.linalg.norm(b)), b - A @ x
    residual = float(np.linalg.norm(r)) / norm if norm > 0 else 0.0
    if not residual <= TOLERANCE:
        raise NotConverged(
            f"the factorisation leaves a residual of {residual:.1e}, not {TOLERANCE:.1e}: the stiffness matrix is "
            "nearly singular",
            Failure.STIFFNESS,
        )
    storage = 12 * factors.nnz
    displacement, left_over = _expand(half_space, scale * x), _expand(half_space, r / scale)
    squares, iterations = np.array([norm**2]), np.zeros(1, np.intp)
    return LinearResult(displacement, left_over, squares, iterations, residual, seconds, storage)


def _expand(half_space: HalfSpace, x: Array) -> Array:
    full = np.zeros((half_space.elements.size, *x.shape[1:]))
    full[half_space.free] = x
    return full
