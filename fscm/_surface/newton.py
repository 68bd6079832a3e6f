"""Bordered Newton iteration: the equilibrium state under a control."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import scipy

from fscm._surface.bordered_factor import BorderedFactor
from fscm._surface.equilibrium import Control, Linearisation, State
from fscm._typing import Array
from fscm.errors import NotConverged
from fscm.laws import SurfaceLaw
from fscm.punch import kinks_of

__all__ = ["STEP_TOLERANCE", "newton", "shifted"]

#: Newton's method ends when a step changes no gap by more than this, relative to 1 + |H|; the next step would be at the
#: level of rounding, since convergence is quadratic.
STEP_TOLERANCE = 1e-9
_MAX_ITERATIONS = 80  #: with old or new factors; measured: 41 at n = 2, k = 0.98, mu = 1
#: After a step below _CHORD the factors are reused, as long as each step is smaller than the one before by
#: _CONTRACTION; such steps end when the remaining error is below this power of the tolerance (its square after a Newton
#: step).
_CHORD, _CONTRACTION, _REMAINDER = 0.5, 0.1, 1.8
#: In one iteration a gap may fall to this fraction of its distance to the singular gap, but not below _LOWEST times the
#: singular gap, or less where the repulsion is not yet _STRONGEST times the strength of the law: that of the 9-3 law is
#: 7e5 times there, while a repulsion that hardly exceeds the attraction, as r^-1.9 beside r^-1.1, has not begun.
_SHRINK = 0.4
_LOWEST, _STRONGEST = 0.25, 5e5
#: Largest change of the logarithm of the scale in one iteration: a factor of two.
_LARGEST_GROWTH = 0.7
#: Bound on any change of log c, against overflow of iterates that Newton's method rejects.
_LARGEST_CHANGE = 50.0
#: Least fraction of a step.
_SMALLEST_DAMPING = 1e-3
#: A full step that is smaller than the one before by less than this factor, from residuals at the level of rounding, is
#: rounding: at large Tabor numbers it exceeds the tolerance (2.7e-9 at n = 2, k = 0, mu = 5e5).
_STALLED = 4.0
#: Change of a gap by a step, relative to 1 + |H|, above which the iteration diverges.
_DIVERGED = 1e6


def _moved_scale(state: State, log_scale: float) -> float:
    """The scale after a linear change of log c, or for a steep punch of log c + f(c), in which its edge is linear."""
    if state.lift is None or kinks_of(state.disc.problem.punch):
        return state.scale * math.exp(log_scale)
    if log_scale == 0.0:
        return state.scale
    log_scale = min(max(log_scale, -_LARGEST_CHANGE), _LARGEST_CHANGE)

    def beyond(log_c: float) -> float:
        return log_c + float(state.disc.height(np.array([math.exp(log_c)]))[0]) - aim

    start, aim = math.log(state.scale), 0.0
    aim = beyond(start) + log_scale * (1.0 + float(state.disc.rise(np.array([state.scale]))[0]))
    # f is convex in log c: the tangent overshoots upwards, and undershoots downwards.
    high = start + log_scale
    low = start if log_scale > 0.0 else high - beyond(high)
    if beyond(low) >= 0.0 or beyond(high) <= 0.0:  # the same to rounding
        return math.exp(high)
    return math.exp(scipy.optimize.brentq(beyond, low, high, xtol=1e-15, rtol=1e-15))


def shifted(state: State, gap: Array, displacement: float, log_scale: float, factor: float = 1.0) -> State:
    """The state after `factor` times a change of its unknowns: gaps (deformations of a steep punch), delta, log c.

    The height of a punch with kinks changes exactly, since it is not linear in log c within a step.
    """
    scale = _moved_scale(state, factor * log_scale)
    displacement = state.displacement + factor * displacement
    if state.lift is not None:
        lift = state.lift + factor * gap
        anchor = state.follows_edge, state.edge_gap, state.turned
        return State.lifted(state.disc, scale, lift, displacement, *anchor)
    moved, disc, r = state.gap + factor * gap, state.disc, state.radius
    if log_scale != 0.0 and kinks_of(disc.problem.punch):
        moved += disc.height(scale * disc.mesh.nodes) - disc.height(r) - disc.rise(r) * (factor * log_scale)
    return replace(state, scale=scale, gap=moved, displacement=displacement)


def _least_clearance(law: SurfaceLaw) -> float:
    """Least distance from the singular gap."""
    clearance = _LOWEST * -law.singular_gap
    strength = -float(law.traction(np.array(law.peak_gap)))
    while clearance > 0.0 and float(law.traction(np.array(law.singular_gap + clearance))) < _STRONGEST * strength:
        clearance *= 0.5
    return clearance


def _largest_damping(state: State, step: Array) -> float:
    """Largest fraction of a step that keeps the gaps away from the singular one."""
    floor = state.disc.problem.law.singular_gap
    clearance = state.gap - floor
    least = np.maximum(_SHRINK * clearance, _least_clearance(state.disc.problem.law))
    dH, log_scale = step[:-2], float(step[-1])
    largest = _LARGEST_GROWTH / max(abs(log_scale), 1e-300)
    if state.lift is not None or (log_scale != 0.0 and kinks_of(state.disc.problem.punch)):
        damping = min(1.0, largest)
        while damping > _SMALLEST_DAMPING and np.any(
            shifted(state, dH, float(step[-2]), log_scale, damping).gap - floor < np.minimum(least, clearance)
        ):
            damping *= 0.5
        return damping
    with np.errstate(divide="ignore", invalid="ignore"):
        limit = np.where(dH < 0.0, (clearance - least) / -dH, np.inf)
    return min(float(min(1.0, max(limit.min(), 0.0))), largest)


def _change_of_gap(state: State, step: Array) -> Array:
    if state.lift is None:
        return step[:-2]
    return step[:-2] - step[-2] + state.disc.rise(state.radius) * step[-1]


def _step(state: State, factor: BorderedFactor, rhs: Array, row: Array) -> tuple[Array, float]:
    """Step by the given factors, and its largest change of a gap relative to 1 + |H|."""
    step = -factor.solve(rhs, row)
    return step, float(np.max(np.abs(_change_of_gap(state, step)) / (1.0 + np.abs(state.gap))))


def newton(guess: State, control: Control, tolerance: float = STEP_TOLERANCE, most: int = _MAX_ITERATIONS) -> State:
    """Solve for equilibrium under a control, from a guess.

    Parameters
    ----------
    guess : State
        Its discretisation, anchor and (when the scale is fixed) scale are kept.
    control : Control
    tolerance : float
        Largest change of a gap in the last step, relative to 1 + |H|.
    most : int
        Largest number of iterations.

    Returns
    -------
    State
        Converged: the last step is below the tolerance relative to 1 + |H|, or all residuals are rounding.

    Raises
    ------
    NotConverged
        After too many iterations, or when a gap approaches the singular gap.
    """
    state = guess
    factor, last_change, full = state.disc.factor, math.inf, math.inf
    for iteration in range(1, most + 1):
        system = Linearisation(state)
        row = system.row(control)
        rhs = np.concatenate([system.residual, [system.anchor, system.violation(control)]])
        if not np.all(np.isfinite(rhs)):
            raise NotConverged("Newton met a residual that is not finite; start from a closer state")
        if iteration == 1 and factor is not None and not system.near(factor):
            factor = None
        step, change = _step(state, factor, rhs, row) if factor is not None else (rhs, math.inf)
        reused = factor is not None and change < _CONTRACTION * last_change
        if not reused:
            factor = system.factor(control)
            step, change = _step(state, factor, rhs, row)
        damping = _largest_damping(state, step)
        if damping < _SMALLEST_DAMPING:
            raise NotConverged("Newton is driven into the singular gap of the surface law; take a smaller step")
        residual = float(np.max(np.abs(rhs[:-2]) / (1.0 + np.abs(state.gap))))
        dH = _change_of_gap(state, step)
        state = replace(
            shifted(state, step[:-2], float(step[-2]), float(step[-1]), damping),
            iterations=iteration,
            residual=residual,
        )
        change = float(np.max(np.abs(dH) / (1.0 + np.abs(state.gap))))
        if not math.isfinite(change) or change > _DIVERGED:
            raise NotConverged("Newton diverged; take a smaller step")
        if damping == 1.0:
            if change < tolerance and not reused:
                return state
            # With old factors convergence is linear.
            ahead = change * min(1.0, change / last_change if math.isfinite(last_change) else 1.0)
            if reused and change < tolerance and ahead < tolerance**_REMAINDER:
                return state
            if not reused and full <= _STALLED * change and np.all(np.abs(system.residual) <= system.rounding()):
                return state
        last_change = change
        full = change if damping == 1.0 and not reused else math.inf
        if damping < 1.0 or change > _CHORD:
            factor, last_change = None, math.inf
    raise NotConverged(f"Newton did not converge in {most} iterations (last change {change:.1e})")
