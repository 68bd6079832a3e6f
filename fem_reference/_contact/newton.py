"""Newton's method for the equilibrium equations under two controls, and the rates along the path."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy import linalg

from fem_reference._contact.contact import Contact
from fem_reference._contact.controls import Control, EdgeRadius
from fem_reference._typing import Array
from fem_reference.errors import Failure, NotConverged

__all__ = ["State", "newton"]


#: Largest residual, in lengths of the law plus the largest displacement: ten times the rounding of X F, unless the
#: traction is steep for the solid (`AMPLIFIED`).
NEWTON_TOLERANCE = 1e-12

#: Largest residual, in units of the largest displacement and of its change under a change of the gap: the gap is
#: rounded by half as much, and where a stiff coating carries a steep traction on a soft substrate the displacement
#: answers with 1e5 times that (measured: 1e-8 lengths of the law, with steps of 5e-11).
AMPLIFIED = 2.0**-52

#: Largest number of damped steps.
NEWTON_STEPS = 30

#: Largest relative change of the size in a step: it stays positive, and the edge on its fine elements.
LARGEST_GROWTH = 0.3

#: Fraction of a step below which none is sought: an iteration that needs it runs out of steps.
SMALLEST_DAMPING = 1e-3

#: Share of the singular gap below which steps are damped, unless the start lies below it.
FLOOR_SHARE = 0.6

#: Largest last step, in units of the largest residual: what the conditioning of the tangent leaves of it.
STEP_SHARE = 1e3


@dataclass(frozen=True, slots=True, eq=False)
class State:
    """A converged point of the equilibrium path.

    Attributes
    ----------
    y : ndarray, shape (m + 2,)
        Displacement, approach and size.
    load : float
        P, compression positive.
    load_rate : float
        Derivative of P with respect to the parameter of the second control.
    rate : ndarray, shape (m + 2,)
        Derivative of y with respect to it.
    iterations : int
        Newton steps taken.
    residual : float
        Largest residual in lengths of the law.
    """

    y: Array
    load: float
    load_rate: float
    rate: Array
    iterations: int
    residual: float

    @property
    def displacement(self) -> float:
        """Approach delta."""
        return float(self.y[-2])

    @property
    def displacement_rate(self) -> float:
        """Derivative of delta with respect to the control."""
        return float(self.rate[-2])

    @property
    def size(self) -> float:
        """Size c of the mesh."""
        return float(self.y[-1])

    @property
    def central_gap(self) -> float:
        """Gap at r = 0."""
        return float(self.y[0] - self.y[-2])


# A trial state may be beyond what numbers hold: a step from it that is not finite is refused.
@np.errstate(over="ignore", invalid="ignore")
def newton(contact: Contact, y: Array, fixed: Control, varied: Control) -> State:
    """Solve the equilibrium equations under two controls.

    Parameters
    ----------
    contact : Contact
        The problem.
    y : ndarray, shape (m + 2,)
        Starting point.
    fixed, varied : Control
        Closing equations; the rates of the returned state are with respect to the second one.

    Returns
    -------
    State

    Raises
    ------
    NotConverged
        If the residual does not fall to the tolerance.
    """
    law = contact.law
    m = contact.unknowns
    y = np.array(y, float)
    K = np.empty((m + 2, m + 2), order="F")
    G = np.empty(m + 2)
    size, gap = math.inf, contact.gap(y)
    for iteration in range(NEWTON_STEPS + 1):
        G[:m] = contact.residual(y, gap)
        G[m:] = fixed.value(contact, y), varied.value(contact, y)
        K[:m] = contact.tangent(y, gap)
        K[m], K[m + 1] = fixed.gradient(contact, y), varied.gradient(contact, y)
        growth = float(linalg.norm(K[:m, :m], np.inf, check_finite=False))
        # Not lu_factor, which warns of a singular matrix: Newton stops there.
        lu, pivots, singular = linalg.lapack.dgetrf(K, overwrite_a=True)
        size = float(np.abs(G[:m]).max()) / law.z0
        largest = float(np.abs(y[:m]).max()) / law.z0
        limit = NEWTON_TOLERANCE * (1.0 + largest)
        if singular:
            break
        step, _ = linalg.lapack.dgetrs(lu, pivots, G)
        settled = np.abs(step[: m + 1]).max() <= STEP_SHARE * limit * law.z0
        if settled and size <= max(limit, AMPLIFIED * largest * growth):
            parameter_rate = varied.parameter_rate(contact, y) if isinstance(varied, EdgeRadius) else 1.0
            G[:] = 0.0
            G[-1] = parameter_rate
            rate, _ = linalg.lapack.dgetrs(lu, pivots, G)
            slope = float(contact.load_gradient(y) @ rate)
            return State(y, contact.load(y), slope, rate, iteration, size)
        if not np.all(np.isfinite(step)):
            break
        y, gap = _damped(contact, y, gap, step)
        if gap.min() <= law.singular_gap:
            break
    raise NotConverged(f"Newton stopped at a residual of {size:.1e} lengths of the law", Failure.ITERATION)


def _damped(contact: Contact, y: Array, gap: Array, step: Array) -> tuple[Array, Array]:
    """Take a step, or as much of it as keeps every gap off the singular one and the size within reach.

    Returns
    -------
    y, gap : ndarray
        The next point, and its gap.
    """
    factor = 1.0
    if abs(step[-1]) > LARGEST_GROWTH * y[-1]:
        factor = LARGEST_GROWTH * y[-1] / abs(step[-1])
    singular = contact.law.singular_gap
    lowest = min(FLOOR_SHARE * singular, 0.5 * (gap.min() + singular))
    while True:
        following = y - factor * step
        gap = contact.gap(following)
        if factor <= SMALLEST_DAMPING or not gap.min() < lowest:
            return following, gap
        factor *= 0.5
