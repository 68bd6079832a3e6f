"""Bordered Newton iteration: the equilibrium state under a control."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from fscm._surface.bordered_factor import BorderedFactor
from fscm._surface.linearisation import linearised
from fscm._surface.state import Control, State
from fscm._typing import Array
from fscm.errors import Failure, NotConverged
from fscm.laws import SurfaceLaw

__all__ = ["STEP_TOLERANCE", "newton"]

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
#: Least fraction of a step.
_SMALLEST_DAMPING = 1e-3
#: A full step that is smaller than the one before by less than this factor, from residuals at the level of rounding, is
#: rounding: at large Tabor numbers it exceeds the tolerance (2.7e-9 at n = 2, k = 0, mu = 5e5).
_STALLED = 4.0
#: Change of a gap by a step, relative to 1 + |H|, above which the iteration diverges.
_DIVERGED = 1e6


def _least_clearance(law: SurfaceLaw) -> float:
    """Least distance from the singular gap."""
    clearance = _LOWEST * -law.singular_gap
    strength = -float(law.traction(np.array(law.peak_gap)))
    while clearance > 0.0 and float(law.traction(np.array(law.singular_gap + clearance))) < _STRONGEST * strength:
        clearance *= 0.5
    return clearance


def _largest_damping(state: State, step: Array, least_clearance: float) -> float:
    """Largest fraction of a step that keeps the gaps away from the singular one."""
    floor = state.disc.problem.law.singular_gap
    clearance = state.gap - floor
    least = np.maximum(_SHRINK * clearance, least_clearance)
    change = step[:-2], float(step[-2]), float(step[-1])
    largest = _LARGEST_GROWTH / max(abs(change[2]), 1e-300)
    if not state.is_linear(change[2]):
        damping = min(1.0, largest)
        while damping > _SMALLEST_DAMPING and np.any(
            state.shifted(*change, damping).gap - floor < np.minimum(least, clearance)
        ):
            damping *= 0.5
        return damping
    dH = change[0]
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        limit = np.where(dH < 0.0, (clearance - least) / -dH, np.inf)
    return min(float(min(1.0, max(limit.min(), 0.0))), largest)


def _change_of_gap(state: State, step: Array) -> Array:
    return state.change_of_gap(step[:-2], step[-2], step[-1])


def _step(state: State, factor: BorderedFactor, rhs: Array, row: Array) -> tuple[Array, float]:
    """Step by the given factors, and its largest change of a gap relative to 1 + |H|."""
    step = -factor.solve(rhs, row)
    return step, _largest(_change_of_gap(state, step), state)


def _largest(values: Array, state: State) -> float:
    """Largest size at a node, relative to 1 + |H|."""
    return float((np.abs(values) / (1.0 + np.abs(state.gap))).max())


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
    state, clearance = guess, _least_clearance(guess.disc.problem.law)
    factor, last_change, full = state.disc.factor, math.inf, math.inf
    for iteration in range(1, most + 1):
        system = linearised(state)
        row = system.row(control)
        rhs = np.concatenate([system.residual, [system.anchor, system.violation(control)]])
        if not np.isfinite(rhs).all():
            raise NotConverged("Newton met a residual that is not finite", Failure.ITERATION)
        if iteration == 1 and factor is not None and not system.near(factor):
            factor = None
        step, change = _step(state, factor, rhs, row) if factor is not None else (rhs, math.inf)
        reused = factor is not None and change < _CONTRACTION * last_change
        if not reused:
            factor = system.factor(control)
            step, change = _step(state, factor, rhs, row)
        damping = _largest_damping(state, step, clearance)
        if damping < _SMALLEST_DAMPING:
            raise NotConverged("Newton is driven into the singular gap of the surface law", Failure.ITERATION)
        residual = _largest(rhs[:-2], state)
        dH = _change_of_gap(state, step)
        state = state.shifted(step[:-2], float(step[-2]), float(step[-1]), damping)
        change = _largest(dH, state)
        if not math.isfinite(change) or change > _DIVERGED:
            raise NotConverged("Newton diverged", Failure.ITERATION)
        if damping == 1.0:
            found = change < tolerance and not reused
            # With old factors convergence is linear.
            ahead = change * min(1.0, change / last_change if math.isfinite(last_change) else 1.0)
            found |= reused and change < tolerance and ahead < tolerance**_REMAINDER
            stalled = not reused and full <= _STALLED * change
            if found or (stalled and np.all(np.abs(system.residual) <= system.rounding())):
                return replace(state, iterations=iteration, residual=residual)
        last_change = change
        full = change if damping == 1.0 and not reused else math.inf
        if damping < 1.0 or change > _CHORD:
            factor, last_change = None, math.inf
    raise NotConverged(f"Newton did not converge in {most} iterations (last change {change:.1e})", Failure.ITERATION)
