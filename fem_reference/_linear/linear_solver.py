"""Linear solvers of the half-space: conjugate gradients and a direct solve.

Each returns a solution whose residual was recomputed at the end, or raises.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from fem_reference._elastic.assembly import HalfSpace
from fem_reference._elastic.scaling import unit_scaling
from fem_reference._linear.preconditioner import ElasticPreconditioner
from fem_reference._linear.strips import factorise
from fem_reference._typing import Array
from fem_reference.errors import NotConverged

__all__ = ["LinearResult", "relative_residual", "solve_cg", "solve_direct"]


#: Relative residual: the displacement is then good to 1e-9, below the discretisation of any fine mesh.
TOLERANCE = 1e-10

#: Residual that rounding of the displacement leaves, whatever the tolerance: measured 2e-10 for 5e5 unknowns; a
#: factorisation leaves 2e-10 for 1e5. Steep cones on graded solids have elements so thin that a machine without
#: extended precision leaves 1e-7, which is refused.
ROUNDING = 1e-9

#: Five times the most ever needed; more means that the preconditioner does not fit the matrix.
ITERATIONS = 60


@dataclass(frozen=True, slots=True, eq=False)
class LinearResult:
    """Solution of a linear system on the free rows.

    Attributes
    ----------
    solution : ndarray, shape (2 N,) or (2 N, q)
        Displacement, zero on the fixed rows.
    error : ndarray, like `solution`
        Last step of conjugate gradients, several times the error that is left, plus the preconditioner applied to the
        last residual, which has that of rounding; zero for the direct solve.
    remainder : ndarray, like `solution`
        Load minus stiffness times displacement, recomputed at the end.
    norm : ndarray, shape (q,)
        Squares of the norms of the loads, in which the residual of conjugate gradients is measured; those of the
        Euclidean one for the direct solve.
    iterations : int
        Krylov iterations (0 for the direct solve).
    residual : float
        Relative residual, recomputed at the end; that of conjugate gradients in the norm of the preconditioner.
    seconds : float
        Time of the solve; without the set-up of the preconditioner, with the factorisation of a direct solve.
    storage : int
        Bytes of the factors (0 for conjugate gradients, whose preconditioner has its own).
    """

    solution: Array
    error: Array
    remainder: Array
    norm: Array
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
    start: Array | None = None,
    rounding: float = ROUNDING,
) -> LinearResult:
    """Solve A u = load by preconditioned conjugate gradients, for one or several loads.

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
        The eigenvalues of P A lie between 0.5 and 1 (measured: 0.56 to 1), so it is the relative error in energy to
        within a factor of 1.4; rounding on small elements is large in other norms and does not matter.
    iterations : int
        Iterations allowed.
    start : ndarray, like `load`, optional
        Displacement to begin with; zero by default.
    rounding : float
        Residual that rounding may leave, larger than the tolerance: the iteration ends at the tolerance by its own
        recursion, and the residual recomputed at the end is only refused above this one.

    Returns
    -------
    LinearResult

    Raises
    ------
    NotConverged
        If the residual does not fall to the tolerance.
    """
    preconditioner = ElasticPreconditioner(half_space) if preconditioner is None else preconditioner
    free, scale = half_space.free, preconditioner.scale[:, None]
    begin = time.perf_counter()
    b = scale * load.reshape(load.shape[0], -1)[free]
    if start is None:
        x, r = np.zeros_like(b), b.copy()
    else:
        x = start.reshape(start.shape[0], -1)[free] / scale
        r = preconditioner.residual(b, x)
    count = 0
    with np.errstate(invalid="ignore", over="ignore"):
        # Residuals and loads pass through the preconditioner together.
        left, of_load = np.split(preconditioner(np.concatenate([r, b], axis=1)), 2, axis=1)
        direction, product, step = left.copy(), _products(r, left), left
        norm = _products(b, of_load)
        # The recursive residual differs from the true one by rounding, so half the tolerance is required of it.
        # One that is not finite ends the iteration; it is refused below.
        while np.any(product > (0.5 * tolerance) ** 2 * norm) and count < iterations:
            image = -preconditioner.residual(np.zeros_like(b), direction)
            length = _ratio(product, _products(direction, image))
            step = length * direction
            x += step
            r -= length * image
            left = preconditioner(r)
            before, product = product, _products(r, left)
            direction = left + _ratio(product, before) * direction
            count += 1
        if count:
            r = preconditioner.residual(b, x)
            left = preconditioner(r)
        # Of a residual far below the tolerance, rounding of the preconditioner may change the sign.
        residual = float(np.sqrt(np.abs(_ratio(_products(r, left), norm))).max())
    seconds = time.perf_counter() - begin
    # An iteration that ended early has left more than rounding.
    largest = max(tolerance, rounding if count < iterations else min(rounding, ROUNDING))
    if not residual <= largest:
        raise NotConverged(
            f"conjugate gradients reached a residual of {residual:.1e} in {count} iterations, not "
            f"{largest:.1e}; allow more iterations, or use the direct solver"
        )
    return LinearResult(
        _expand(half_space, scale * x).reshape(load.shape),
        _expand(half_space, scale * (step + left)).reshape(load.shape),
        _expand(half_space, r / scale).reshape(load.shape),
        norm,
        count,
        residual,
        seconds,
    )


def relative_residual(half_space: HalfSpace, left: Array, norm: Array, preconditioner: ElasticPreconditioner) -> Array:
    """Return what is left of loads, shape (2 N, q), relative to a norm of `LinearResult`: shape (q,)."""
    r = preconditioner.scale[:, None] * left[half_space.free]
    return np.asarray(np.sqrt(np.abs(_products(r, preconditioner(r)) / norm)))


def _products(a: Array, b: Array) -> Array:
    """Inner products of columns."""
    return np.einsum("ij,ij->j", a, b)


def _ratio(numerator: Array, denominator: Array) -> Array:
    """Quotients; zero where the denominator is."""
    return np.divide(numerator, denominator, out=np.zeros_like(numerator), where=denominator != 0.0)


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
    norm, r = float(np.linalg.norm(b)), b - A @ x
    residual = float(np.linalg.norm(r)) / norm if norm > 0 else 0.0
    if not residual <= TOLERANCE:
        raise NotConverged(
            f"the factorisation leaves a residual of {residual:.1e}, not {TOLERANCE:.1e}: the stiffness matrix is "
            "nearly singular; check modulus, mesh and nu"
        )
    storage = 12 * factors.nnz
    displacement, remainder = _expand(half_space, scale * x), _expand(half_space, r / scale)
    return LinearResult(
        displacement, np.zeros_like(load), remainder, np.array([norm**2]), 0, residual, seconds, storage
    )


def _expand(half_space: HalfSpace, x: Array) -> Array:
    full = np.zeros((half_space.matrix.shape[0], *x.shape[1:]))
    full[half_space.free] = x
    return full
