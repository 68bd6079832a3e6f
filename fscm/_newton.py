"""Bordered Newton iteration: the equilibrium state under a control."""

from __future__ import annotations

import math

import numpy as np

from fscm._equilibrium import Control, Linearisation, State
from fscm.errors import NotConverged

__all__ = ["STEP_TOLERANCE", "newton"]

# Newton stops when the last step changes no gap by more than this, relative to 1 + |H|; the step after it
# would be at rounding level, since convergence is quadratic.
STEP_TOLERANCE = 1e-9
_MAX_ITERATIONS = 25
# A gap may fall to this fraction of its distance to the singular gap in one iteration, and not below
# _LOWEST of it: at a quarter of the distance the 9-3 law reaches 7e5 times its strength.
_SHRINK = 0.4
_LOWEST = 0.25
# Largest change of the logarithm of the scale in one iteration: a factor of two.
_LARGEST_GROWTH = 0.7
# Below this fraction of a step the iterations allowed parameter nowhere.
_SMALLEST_DAMPING = 1e-3
# A step that changes a gap by this factor is no correction any more, and the next ones would overflow.
_DIVERGED = 1e6


def newton(guess: State, control: Control, tolerance: float = STEP_TOLERANCE) -> State:
    """Solve for equilibrium under a control, from a guess.

    Parameters
    ----------
    guess : State
        Its discretisation, anchor and (when the scale is fixed) scale are kept.
    control : Control
    tolerance : float
        Largest change of a gap in the last step, relative to 1 + |H|.

    Returns
    -------
    State
        Converged: the last step is below the tolerance relative to 1 + |H|.

    Raises
    ------
    NotConverged
        After too many iterations, or when a gap is driven towards the singular gap.
    """
    law = guess.disc.problem.law
    floor = law.singular_gap
    state = guess
    for iteration in range(1, _MAX_ITERATIONS + 1):
        system = Linearisation(state)
        rhs = np.concatenate([system.residual, [system.anchor, system.violation(control)]])
        if not np.all(np.isfinite(rhs)):
            raise NotConverged("Newton met a residual that is not finite; start from a closer state")
        step = -system.solve(control, rhs)
        N = len(state.gap)
        dH = step[:N]
        clearance = state.gap - floor
        with np.errstate(divide="ignore", invalid="ignore"):
            limit = np.where(dH < 0.0, (clearance - np.maximum(_SHRINK * clearance, _LOWEST * -floor)) / -dH, np.inf)
        damping = float(min(1.0, max(limit.min(), 0.0), _LARGEST_GROWTH / max(abs(step[N + 1]), 1e-300)))
        if damping < _SMALLEST_DAMPING:
            raise NotConverged("Newton is driven into the singular gap of the surface law; take a smaller step")
        state = State(
            state.disc,
            state.scale * math.exp(damping * step[N + 1]),
            state.gap + damping * dH,
            state.displacement + damping * float(step[N]),
            state.follows_edge,
            iteration,
            float(np.max(np.abs(rhs[:N]) / (1.0 + np.abs(state.gap)))),
        )
        change = float(np.max(np.abs(dH) / (1.0 + np.abs(state.gap))))
        if not math.isfinite(change) or change > _DIVERGED:
            raise NotConverged("Newton diverged; take a smaller step")
        if damping == 1.0 and change < tolerance:
            return state
    raise NotConverged(f"Newton did not converge in {_MAX_ITERATIONS} iterations (last change {change:.1e})")
