"""Bordered Newton iteration: the equilibrium state under a control."""

from __future__ import annotations

import math

import numpy as np

from fscm._equilibrium import Control, Linearisation, State
from fscm._typing import Array
from fscm.errors import NotConverged
from fscm.punch import PunchShape, kinks_of

__all__ = ["STEEP", "STEP_TOLERANCE", "moved_gap", "moves_exactly", "newton"]

# Growth of a punch above which its height is no linear function of log c within a step: it is then moved exactly.
STEEP = 10.0

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


def moves_exactly(punch: PunchShape) -> bool:
    """Whether the height of a punch is no linear function of log c within a step: it is steep, or has kinks."""
    return punch.growth > STEEP or bool(kinks_of(punch))


def moved_gap(state: State, change: Array, log_scale: float) -> Array:
    """Gaps after a linear change at a change of log c, with the exact shape in place of its slope for a steep punch."""
    punch, r = state.disc.problem.punch, state.radius
    if not moves_exactly(punch) or log_scale == 0.0:
        return state.gap + change
    exact = punch.height(r * math.exp(log_scale)) - punch.height(r)
    return state.gap + (change - r * punch.slope(r) * log_scale) + exact


def _largest_damping(state: State, dH: Array, log_scale: float) -> float:
    """Largest part of a step, at most 1, that keeps the gaps away from the singular one."""
    floor = state.disc.problem.law.singular_gap
    clearance = state.gap - floor
    least = np.maximum(_SHRINK * clearance, _LOWEST * -floor)
    if moves_exactly(state.disc.problem.punch) and log_scale != 0.0:
        damping = min(1.0, _LARGEST_GROWTH / abs(log_scale))
        while damping > _SMALLEST_DAMPING and np.any(
            moved_gap(state, damping * dH, damping * log_scale) - floor < np.minimum(least, clearance)
        ):
            damping *= 0.5
        return damping
    with np.errstate(divide="ignore", invalid="ignore"):
        limit = np.where(dH < 0.0, (clearance - least) / -dH, np.inf)
    return float(min(1.0, max(limit.min(), 0.0)))


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
    state = guess
    for iteration in range(1, _MAX_ITERATIONS + 1):
        system = Linearisation(state)
        rhs = np.concatenate([system.residual, [system.anchor, system.violation(control)]])
        if not np.all(np.isfinite(rhs)):
            raise NotConverged("Newton met a residual that is not finite; start from a closer state")
        step = -system.solve(control, rhs)
        N = len(state.gap)
        dH = step[:N]
        log_scale = float(step[N + 1])
        damping = min(_largest_damping(state, dH, log_scale), _LARGEST_GROWTH / max(abs(log_scale), 1e-300))
        if damping < _SMALLEST_DAMPING:
            raise NotConverged("Newton is driven into the singular gap of the surface law; take a smaller step")
        state = State(
            state.disc,
            state.scale * math.exp(damping * log_scale),
            moved_gap(state, damping * dH, damping * log_scale),
            state.displacement + damping * float(step[N]),
            state.follows_edge,
            iteration,
            float(np.max(np.abs(rhs[:N]) / (1.0 + np.abs(state.gap)))),
            state.turned,
        )
        change = float(np.max(np.abs(dH) / (1.0 + np.abs(state.gap))))
        if not math.isfinite(change) or change > _DIVERGED:
            raise NotConverged("Newton diverged; take a smaller step")
        if damping == 1.0 and change < tolerance:
            return state
    raise NotConverged(f"Newton did not converge in {_MAX_ITERATIONS} iterations (last change {change:.1e})")
