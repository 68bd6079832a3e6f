"""Critical Tabor number, at which the two folds of the displacement merge and hysteresis begins.

At fixed n and k the smallest rate of displacement along the path, d(delta)/d(parameter), decreases with the Tabor
number; it is zero at the critical one.  The rate is exact, so that the root is as accurate as the path.
"""

from __future__ import annotations

import math
import time
from dataclasses import replace

from fscm._bound.parts import EventErrors, bounds
from fscm._path.arc_length import parameter_control, parameter_of, rates_of
from fscm._path.continuation import moved
from fscm._path.events import refined, slowest
from fscm._path.whole_path import path_end, path_until
from fscm._roots import bracketed_root
from fscm._surface.discretisation import Discretisation
from fscm._surface.newton import newton
from fscm._surface.state import State
from fscm._threads import one_thread
from fscm.accuracy import Accuracy, Meshes
from fscm.errors import Failure, NoSuchEvent, NotConverged
from fscm.problem import Problem
from fscm.solution import Parts, Solution

__all__ = ["critical_tabor_number"]

#: Start of the search, its growth and its limit; critical Tabor numbers of power-law punches are near 0.7.
_FIRST_GUESS, _WIDEN, _WIDEST = 0.75, 1.25, 30.0
#: Tolerance of log mu on the coarse mesh, which only selects the mesh.
_COARSE_ROOT_TOLERANCE = 1e-3
_FIRST_SECANT_STEP, _SECANT_STEPS, _TOLERANCE = 1e-4, 15, 1e-9
#: Spacing of the three rates in the continuation parameter; measured: halving it moves mu by at most 4e-11
#: (n = 1, k = 0).
_SPACING = 2e-4
_VERTEX_TOLERANCE = 1e-4


def _coarse_root(problem: Problem, meshes: Meshes) -> State:
    """State with the least rate of displacement, at about the critical Tabor number."""
    states: dict[float, State] = {}

    def rate(log_mu: float) -> float:
        coarse, height = replace(problem, mu=math.exp(log_mu)), meshes.end_height
        points = path_until(coarse, *meshes.path, path_end(coarse, height), "a compressive load", end_height=height)
        _, point, _, value = slowest(points)
        states[log_mu] = point.state
        return value

    low = high = math.log(_FIRST_GUESS)
    while rate(high) > 0.0:
        low, high = high, high + math.log(_WIDEN)
        if high > math.log(_WIDEST):
            raise NoSuchEvent(f"no jump up to mu = {_WIDEST} at n = {problem.n}, k = {problem.k}")
    while low == high or rate(low) < 0.0:
        low, high = low - math.log(_WIDEN), low
        if low < -math.log(_WIDEST):
            raise NoSuchEvent(f"jumps persist down to mu = {1 / _WIDEST:.3g} at n = {problem.n}, k = {problem.k}")
    root = bracketed_root(rate, low, high, _COARSE_ROOT_TOLERANCE)
    return states[min(states, key=lambda x: abs(x - root))]


def _at_tabor_number(state: State, mu: float) -> State:
    """The state at the same continuation parameter and mesh for another Tabor number."""
    problem = replace(state.disc.problem, mu=mu)
    disc = Discretisation(problem, state.disc.mesh, state.disc)
    return newton(replace(state, disc=disc), parameter_control(state, parameter_of(state)))


def _least_rate(state: State) -> tuple[State, float, float]:
    """Vertex of the parabola through three exact rates around a state.

    Returns
    -------
    state : State
        Moved to the vertex.
    rate : float
        Value at the vertex.
    step : float
        Distance of the vertex in the continuation parameter.
    """
    rates = rates_of(state)
    x = parameter_of(state)
    before, after = (rates_of(moved(state, rates, x + h)).displacement for h in (-_SPACING, _SPACING))
    slope = (after - before) / (2.0 * _SPACING)
    curvature = (after - 2.0 * rates.displacement + before) / _SPACING**2
    step = -slope / curvature
    return moved(state, rates, x + step), rates.displacement + 0.5 * slope * step, step


def _on_mesh(state: State) -> tuple[float, State, float]:
    """Root in mu of the least rate on the mesh of a state, by the secant method, the state, and the slope in mu."""
    mu = state.disc.problem.mu
    state, rate, _ = _least_rate(state)
    step, slope = _FIRST_SECANT_STEP * mu, 0.0
    for _ in range(_SECANT_STEPS):
        mu += step
        state, new, off = _least_rate(_at_tabor_number(state, mu))
        # Once mu has settled, further rounds only improve the vertex.
        moving = abs(step) > 0.1 * _TOLERANCE * mu
        slope = (new - rate) / step if moving else slope
        if abs(step) < _TOLERANCE * mu and abs(off) < _VERTEX_TOLERANCE:
            return mu, state, slope
        step = -new / slope if moving else step
        rate = new
    raise NotConverged("the secant method for the critical Tabor number did not settle", Failure.EVENT)


def _bounds(state: State, slope: float) -> Parts:
    """Bounds on the error of the root: the error of the rate over its derivative by mu.

    The rate is at a minimum along the path, so that it does not change, to first order, with its location.
    """
    rate = EventErrors(state).rate("displacement")
    # The vertex of the parabola adds the difference of two rates, times its distance over twice their spacing.
    rounding = (1.0 + 0.5 * _VERTEX_TOLERANCE / _SPACING) * rate.rounding
    return bounds(replace(rate, rounding=rounding), 1.0 / abs(slope))


@one_thread()
def critical_tabor_number(problem: Problem, accuracy: Accuracy = "default") -> Solution:
    """The Tabor number above which approach under displacement control jumps; `problem.mu` is not used.

    Parameters
    ----------
    problem : Problem
    accuracy : float or str
        As for `fscm.solve`.

    Returns
    -------
    Solution
        Dimensionless.

    Raises
    ------
    NoSuchEvent
        When no jump begins between mu = 1/30 and 30.
    NotConverged

    Examples
    --------
    >>> round(critical_tabor_number(Problem(n=2, k=0, mu=1)).value, 2)      # 0.70 in Sec. 3.3
    0.7
    """
    start = time.perf_counter()
    meshes = Meshes.of(accuracy)
    value, state, slope = _on_mesh(refined(_coarse_root(problem, meshes), *meshes.value))
    return Solution(
        value,
        _bounds(state, slope),
        len(state.gap) + 2,
        state.iterations,
        state.residual,
        time.perf_counter() - start,
    )
