"""Conjugate gradients for several right-hand sides, with a preconditioner that is checked while it is used.

The iteration ends at the solution with any preconditioner that is symmetric and positive definite, and somewhere else
with any other.  Its own numbers tell the difference: inner products of residuals with what the preconditioner makes of
others, in both orders, and the Ritz values, which lie between the extreme eigenvalues of preconditioner times matrix.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigvalsh_tridiagonal

from fem_reference._typing import Array, Index
from fem_reference.errors import Failure, NotConverged

__all__ = ["Iterate", "conjugate_gradients", "definite_products", "products"]

#: Asymmetry of the preconditioner, relative to the norms of two residuals, that is taken for rounding (measured: up to
#: 1e-11, and 2e-3 of residuals that are themselves rounding, on elements of a millionth of the radius).
ASYMMETRY = 1e-2

#: Eigenvalues of preconditioner times matrix.  None is above 1: the sweep is its own adjoint about an exact solve, so
#: that it leaves of every error a share of the same sign; the hundredths are for rounding (measured: 0.0015 to 0.005 of
#: residuals that are rounding).  The least is measured: 0.6 to 0.97, and single ones on stiff films: 0.025 on one 1e5
#: times as stiff as what is below, which costs three iterations, and 0.0013 under a bonded jump from 1 GPa to 1.5 MPa.
LEAST_EIGENVALUE, LARGEST_EIGENVALUE = 2e-4, 1.02


@dataclass(frozen=True, slots=True, eq=False)
class Iterate:
    """Where conjugate gradients ended.

    Attributes
    ----------
    solution : ndarray, shape (N, q)
        Solution.
    iterations : ndarray of int, shape (q,)
        Iterations of each column.
    """

    solution: Array
    iterations: Index


def conjugate_gradients(
    matrix: Any, precondition: Callable[[Array], Array], r: Array, left: Array, goal: Array, iterations: int
) -> Iterate:
    """Reduce residuals; each column has its own iteration, and all share the passes through the preconditioner.

    Parameters
    ----------
    matrix : sparse array, shape (N, N)
        Symmetric positive definite.
    precondition : callable
        Applies an approximate inverse of it to columns.
    r, left : ndarray, shape (N, q)
        Right-hand sides, and what the preconditioner makes of them.
    goal : ndarray, shape (q,)
        Largest product of a residual with what the preconditioner makes of it, at the end.
    iterations : int
        Iterations allowed.

    Raises
    ------
    NotConverged
        If the iterations do not suffice, or the preconditioner is not symmetric, not positive definite, or no
        approximate inverse of the matrix.
    """
    x, direction = np.zeros_like(r), left
    product, counts = definite_products(r, left), np.zeros(r.shape[1], np.intp)
    unfinished = product > goal
    history: list[tuple[Array, Array]] = []
    while np.any(unfinished):
        if len(history) == iterations:
            raise NotConverged(
                f"conjugate gradients left {float(np.sqrt(product / goal).max()):.1e} times their tolerance in "
                f"{iterations} iterations",
                Failure.LINEAR,
            )
        image = matrix @ direction
        # A column that is finished stays as it is.
        length = _quotient(product, products(direction, image), unfinished)
        x = x + length * direction
        before, of_before, r = r, left, r - length * image
        left = precondition(r)
        after = definite_products(r, left)
        _check_symmetric((products(before, left) - products(of_before, r))[unfinished], (product * after)[unfinished])
        ratio = _quotient(after, product, unfinished)
        direction = left + ratio * direction
        history.append((length, ratio))
        counts += unfinished
        product = np.where(unfinished, after, product)
        unfinished = product > goal
    for column, count in enumerate(counts):
        if count:
            _check_spectrum(*np.array([(a[column], b[column]) for a, b in history[:count]]).T)
    return Iterate(x, counts)


def products(a: Array, b: Array) -> Array:
    """Inner products of columns."""
    return np.einsum("ij,ij->j", a, b)


def definite_products(r: Array, left: Array) -> Array:
    """Inner products of residuals with what the preconditioner makes of them.

    Raises
    ------
    NotConverged
        If it sends a residual against itself, to nothing, or beyond what numbers hold: it is not positive definite.
    """
    with np.errstate(invalid="ignore", over="ignore"):
        product = products(r, left)
        is_definite = np.isfinite(product) & ((product > 0.0) | np.all(r == 0.0, axis=0))
    if not np.all(is_definite):
        raise NotConverged(
            f"the preconditioner is not positive definite: a residual and what it makes of it have the product "
            f"{product[~is_definite][0]:.1e}",
            Failure.LINEAR,
        )
    return product


def _quotient(numerator: Array, denominator: Array, columns: NDArray[np.bool_]) -> Array:
    """Quotients of some columns, zero of the others."""
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        return np.divide(numerator, denominator, out=np.zeros_like(numerator), where=columns)


def _check_symmetric(difference: Array, squares: Array) -> None:
    """Refuse a preconditioner whose products in one order differ from those in the other."""
    asymmetry = float(np.max(np.abs(difference) / np.sqrt(squares)))
    if not asymmetry <= ASYMMETRY:
        raise NotConverged(
            f"the preconditioner is not symmetric: the products of two residuals differ by {asymmetry:.1e}, not "
            f"{ASYMMETRY:g}, from one order to the other",
            Failure.LINEAR,
        )


def _check_spectrum(lengths: Array, ratios: Array) -> None:
    """Refuse a preconditioner whose Ritz values, from the lengths of the steps and their ratios, are out of range."""
    diagonal = 1.0 / lengths
    diagonal[1:] += ratios[:-1] / lengths[:-1]
    ritz = eigvalsh_tridiagonal(diagonal, np.sqrt(ratios[:-1]) / lengths[:-1])
    if not LEAST_EIGENVALUE <= ritz[0] <= ritz[-1] <= LARGEST_EIGENVALUE:
        raise NotConverged(
            f"the preconditioner is no approximate inverse of the stiffness: its eigenvalues reach from {ritz[0]:.2g} "
            f"to {ritz[-1]:.2g}, outside [{LEAST_EIGENVALUE:g}, {LARGEST_EIGENVALUE:g}]",
            Failure.LINEAR,
        )
