"""The equilibrium path from far separation through both folds into contact.

The path has two stretches or more.  While the punch is apart the scale is fixed and the central gap is the continuation
parameter.  Once the central gap has passed the gap of largest tension, the mesh is scaled so that this gap sits at
s = 1: the mesh follows the edge, and log c is the parameter.  On both, steps are taken in arc length in the space of
the parameter, delta and P, so folds in any of them are passed.  In the moving mesh the solution changes slowly
however sharp the edge is.  When the gap farther out falls below the gap of largest tension as well, as around a tall
asperity, another stretch begins, which follows that edge.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from fscm._adaptivity import at_kinks, end_radius, fit, initial_mesh, rescaled_mesh
from fscm._arc_length import ArcLength, Point, parameter_control, parameter_of, rate_of
from fscm._equilibrium import Control, Discretisation, Rates, State
from fscm._meshes import Meshes
from fscm._newton import STEP_TOLERANCE, moved_gap, moves_exactly, newton
from fscm._panels import PanelMesh
from fscm._path_end import PathEnd, depth, displacement_of_compression
from fscm.errors import NotConverged
from fscm.problem import Problem
from fscm.punch import PowerPunch

__all__ = ["MAX_POINTS", "bracketing_path", "equilibrium_path", "moved", "path_end", "path_until"]

# Measured: at most 80 points of a bracketing path for k up to 0.8, but 790 and 1060 at n = 2, k = 0.9, mu = 1 and 2,
# where the nucleus of contact grows in small steps.  Each keeps its matrices: 2 MB on such meshes.
MAX_POINTS = 1500
_FIRST_STEP = 0.25
_SMALLEST_STEP = 1e-6
# Newton iterations after which the next step is longer or shorter.
_EASY, _HARD = 3, 6
_NEWTON_MARGIN = 0.01  # Newton error beside the error of the mesh
_LONGER, _SHORTER, _RETRY = 1.4, 0.7, 0.4
# A step over which the tangent turns by more than this cosine is taken again, shorter: a fold pair turns
# the path twice and must not be stepped over.  Steps below _BLIND_STEP are taken whatever the turn.
_LARGEST_TURN, _BLIND_STEP = 0.85, 0.02
# The same for any punch but a power law: a cavity that snaps shut turns the path within 0.01 (measured).
_BLIND_STEP_OF_ASPERITIES = 0.002
# Before contact, once the displacement makes up less than this share of the tangent, steps are at most this long:
# the path may then run flat through several shallow folds, over which the tangent hardly turns.  Measured: n = 2,
# k = 0.6, mu = 3 has three folds within 0.015 of displacement, and steps of 0.5 missed the first two.
_FLAT_SHARE, _FLAT_STEP = 0.5, 0.1
# The width of the cohesive edge is (1.03 M)^(-1/(1-k)) for the 9-3 law; decimal logarithm of the narrowest that is
# tried: a contact radius has 16 digits, and a law that is ten times less steep has an edge that is as much wider.
_EDGE, _NARROWEST = 1.03, -20.0
# Largest deviation from the trapezoidal rule, relative to the distance of a gap to the singular gap.
_SURPRISE = 0.5
# The gaps within this multiple of the edge radius tell the sense of the path.
_NEAR_EDGE = 2.0
# Where its parameter turns, the path goes on in another one, until that one makes up less than this share of the
# tangent.
_LEAST_SHARE = 0.3
# Share of the tangent from which on it is prescribed, not the arc length, where the mesh moves with kinks.
_GIVEN_SHARE = 0.05
# The edge is followed from where the central gap has fallen below the gap of largest tension by this fraction
# of that gap's distance to the singular gap: nearer to it the edge radius is a poor variable (it starts as a
# root).
_HAND_OVER = 0.05


def _predicted(state: State, rates: Rates, step: float) -> State:
    problem = state.disc.problem
    if step * rates.log_scale != 0.0 and getattr(problem.punch, "kinks", ()):
        return _predicted_with_kinks(state, rates, step)
    return replace(
        state,
        scale=state.scale * math.exp(step * rates.log_scale),
        gap=moved_gap(state, step * rates.gap, step * rates.log_scale),
        displacement=state.displacement + step * rates.displacement,
    )


def _predicted_with_kinks(state: State, rates: Rates, step: float) -> State:
    """The same, on a mesh with its breaks where the kinks are at the new scale."""
    problem, old, log_scale = state.disc.problem, state.disc.mesh, step * rates.log_scale
    scale, shape = state.scale * math.exp(log_scale), problem.punch.height
    smooth = moved_gap(state, step * rates.gap, log_scale) - shape(state.radius * math.exp(log_scale))
    mesh = PanelMesh(at_kinks(problem, old.breaks, state.scale, scale), old.order)
    return replace(
        state,
        disc=Discretisation(problem, mesh, state.disc),
        scale=scale,
        gap=old.transfer(smooth, mesh) + shape(scale * mesh.nodes),
        displacement=state.displacement + step * rates.displacement,
    )


def moved(state: State, rates: Rates, value: float, tolerance: float = STEP_TOLERANCE) -> State:
    """Equilibrium at another value of the continuation parameter, from the tangent predictor.

    Raises
    ------
    NotConverged
        When Newton's method fails.
    """
    return newton(_predicted(state, rates, value - parameter_of(state)), parameter_control(state, value), tolerance)


def _far_state(problem: Problem, central_gap: float, order: int, tolerance: float, end_height: float) -> State:
    """Equilibrium at a large central gap, from the rigid solution."""
    disc = Discretisation(problem, initial_mesh(problem, order, end_height))
    gap = central_gap + problem.punch.height(disc.mesh.nodes)
    control = Control(central_gap, gap=1.0)
    return fit(newton(State(disc, 1.0, gap, -central_gap, False), control), control, tolerance)


def _follow_edge(state: State, end_height: float) -> State:
    """Guess on a mesh scaled so that the outermost gap of largest tension sits at s = 1."""
    problem, mesh = state.disc.problem, state.disc.mesh
    target = problem.law.peak_gap
    outer = int(np.flatnonzero(state.gap < target)[-1]) if np.any(state.gap < target) else -1
    low = 0.0 if outer < 0 else float(mesh.nodes[outer])
    ratio = brentq(lambda s: mesh.evaluate(state.gap, np.array([s]))[0] - target, low, mesh.nodes[outer + 1])
    new = rescaled_mesh(problem, mesh, state.scale, state.scale * ratio, end_height)
    known = np.minimum(new.nodes * ratio, mesh.breaks[-1])
    shape = problem.punch.height
    if not moves_exactly(problem.punch):
        gap = mesh.evaluate(state.gap, known)
        gap += shape(state.scale * ratio * new.nodes) - shape(state.scale * known)
    else:
        gap = mesh.evaluate(state.gap - shape(state.radius), known) + shape(state.scale * ratio * new.nodes)
    return State(Discretisation(problem, new), state.scale * ratio, gap, state.displacement, True)


def _edge_elsewhere(state: State, hand_over: float) -> bool:
    """Whether the outermost contact edge is not the one that the mesh follows."""
    if not state.follows_edge:
        return min(state.central_gap, float(np.min(state.gap))) < hand_over
    return float(np.min(state.gap[state.disc.mesh.nodes > 1.0])) < hand_over


def _turned(arc: ArcLength, point: Point, name: str | None = None) -> Point:
    """The same state, from which the path goes on in the named parameter, or in the other one that changes most."""
    shares = {name: share for name, share in arc.shares(point).items() if name != point.state.parameter}
    name = name or max(shares, key=lambda other: abs(shares[other]))
    state = replace(point.state, turned=(name, math.copysign(1.0, shares[name])))
    return Point(state, arc.tangent(state), point.stretch + 1)


def _checked_sense(a: Point, b: Point, step: float, same: bool | None) -> bool:
    """Whether the gaps go on changing in the same sense; NotConverged when b is on another branch.

    Near a sharp turn of the path, the gaps inside the contact tell its sense when load and displacement do not.
    """
    mesh, other = a.state.disc.mesh, b.state.disc.mesh
    known = np.minimum(other.nodes, mesh.breaks[-1])
    before, rate = mesh.evaluate(a.state.gap, known), mesh.evaluate(a.rates.gap, known)
    clearance = b.state.gap - a.state.disc.problem.law.singular_gap
    near = other.nodes < _NEAR_EDGE
    product = other.weights * other.nodes * rate * b.rates.gap / clearance**2
    if same is None:
        same = bool(np.sum(product[near]) >= 0.0)
    surprise = b.state.gap - before - 0.5 * step * (rate + (1.0 if same else -1.0) * b.rates.gap)
    if np.max(np.abs(surprise) / clearance) > _SURPRISE:
        raise NotConverged("Newton converged to a state that the tangent does not lead to")
    return same


def _joined(arc: ArcLength, before: Point, state: State) -> Point:
    """The state that follows another edge, with load and displacement changing in the same sense as before."""
    point = Point(state, arc.tangent(state), before.stretch + 1)
    old, new = arc.shares(before), arc.shares(point)
    if sum(old[name] * new[name] for name in ("displacement", "load")) >= 0.0:
        return point
    state = replace(state, turned=("log_scale", -1.0))
    return Point(state, arc.tangent(state), before.stretch + 1)


def _check_edge(problem: Problem) -> None:
    """Refuse a cohesive edge, of the width (1.03 M)^(-1/(1-k)), that is far below the rounding of any radius."""
    log_width = -math.log10(_EDGE * problem.compliance) / (1.0 - problem.k)
    if log_width < _NARROWEST:
        raise NotConverged(
            f"the contact edge of {problem} is about 10^{log_width:.0f} wide, below the rounding of its radius: "
            f"k = {problem.k:g} is too close to 1, the Gibson solid, at this Tabor number"
        )


def _start_gap(problem: Problem) -> float:
    """A central gap beyond the far branch at jump-out: JKR's C_out mu is at most sqrt(2 pi) mu (Eq. 55)."""
    return 3.0 + 3.0 * problem.mu


def equilibrium_path(
    problem: Problem,
    order: int,
    tolerance: float,
    longest_step: float = 0.5,
    start_gap: float | None = None,
    end_height: float = Meshes.end_height,
) -> Iterator[Point]:
    """Yield the path, one converged state after another, without end: the caller stops.

    Parameters
    ----------
    problem : Problem
    order : int
        Nodes per panel.
    tolerance : float
        Resolution of the pressure (see `fscm._adaptivity`).
    longest_step : float
        Longest step of arc length, dimensionless.
    start_gap : float, optional
        Gap of the first state at the lowest point of the punch, which is its center unless the tip is concave.
    end_height : float
        Height of the punch at which the mesh ends.

    Yields
    ------
    Point
        At the change of stretch the same state is given twice, before and after.

    Raises
    ------
    NotConverged
        When the step becomes too small.
    """
    _check_edge(problem)
    arc = ArcLength.of(problem)
    gap = _start_gap(problem) if start_gap is None else start_gap
    gap += depth(problem, end_radius(problem, end_height))
    state = _far_state(problem, gap, order, tolerance, end_height)
    peak, singular = problem.law.peak_gap, problem.law.singular_gap
    hand_over = peak - _HAND_OVER * (peak - singular)
    kinked = bool(getattr(problem.punch, "kinks", ()))
    least_share = _GIVEN_SHARE if kinked else _LEAST_SHARE
    shortest = _BLIND_STEP if isinstance(problem.punch, PowerPunch) else _BLIND_STEP_OF_ASPERITIES
    step = min(_FIRST_STEP, longest_step)
    point = Point(state, arc.tangent(state))
    while True:
        yield point
        state = point.state
        if _edge_elsewhere(state, hand_over):
            guess = _follow_edge(state, end_height)
            control = parameter_control(guess, parameter_of(guess))
            state = fit(newton(guess, control), control, tolerance)
            point = _joined(arc, point, state)
            continue
        shares = arc.shares(point)
        usual = "log_scale" if state.follows_edge else "gap"
        # With the scale given, no node passes a kink during an iteration.
        kept = usual if kinked and abs(shares[usual]) > _GIVEN_SHARE else state.parameter
        if state.turned and (kept != state.parameter or abs(shares.get(kept, 0.0)) < least_share):
            point = _turned(arc, point, kept if kept != state.parameter else None)
            state = point.state
            yield point
        if not state.follows_edge and abs(point.rates.displacement) < _FLAT_SHARE * arc.displacement_unit(state):
            step = min(step, _FLAT_STEP)
        while True:
            guess = _predicted(state, point.rates, step)
            control = arc.control(state, point.rates, step)
            if kinked and state.parameter == usual and abs(shares[usual]) > _GIVEN_SHARE:
                control = parameter_control(guess, parameter_of(state) + step * rate_of(point.rates, state.parameter))
            try:
                new = newton(guess, control, _NEWTON_MARGIN * tolerance)
                used = new.iterations
                new = fit(new, control, tolerance, coarsen=True)
                after = Point(new, arc.tangent(new), point.stretch)
                turn, blind = arc.turn(point, after), step <= shortest
                if abs(turn) < _LARGEST_TURN and not blind:
                    step *= _SHORTER
                    continue
                same = turn >= 0.0
                if not isinstance(problem.punch, PowerPunch):
                    same = _checked_sense(point, after, step, same if abs(turn) >= _LARGEST_TURN else None)
                if not same:  # the path goes on, but its parameter turns
                    after = _turned(arc, point)
                break
            except NotConverged as error:
                step *= _RETRY
                if step < _SMALLEST_STEP:
                    raise NotConverged(
                        f"the path of {problem} ends at delta = {state.displacement:.6g}, "
                        f"P = {state.load:.6g}: no step of arc length down to {_SMALLEST_STEP} converges "
                        f"({error})"
                    ) from error
        if used <= _EASY:
            step = min(_LONGER * step, longest_step)
        elif used >= _HARD:
            step *= _SHORTER
        point = after


def path_until(
    problem: Problem,
    order: int,
    tolerance: float,
    ended: Callable[[State], bool],
    end: str,
    most: int = MAX_POINTS,
    longest_step: float = 0.5,
    start_gap: float | None = None,
    end_height: float = Meshes.end_height,
) -> list[Point]:
    """Points of the path up to the first state for which `ended` holds.

    Parameters
    ----------
    problem, order, tolerance, longest_step, start_gap, end_height
        As for `equilibrium_path`.
    ended : callable
        State -> bool; called once for each state, in their order.
    end : str
        Name of the end in the message of `NotConverged`.
    most : int
        Largest number of points.

    Raises
    ------
    NotConverged
        When the end is not reached.
    """
    points: list[Point] = []
    for point in equilibrium_path(problem, order, tolerance, longest_step, start_gap, end_height):
        points.append(point)
        if ended(point.state):
            return points
        if len(points) > most:
            break
    raise NotConverged(f"the path of {problem} has not reached {end} in {most} steps")


def bracketing_path(problem: Problem, meshes: Meshes) -> list[Point]:
    """The coarse path from far separation to a compressive load, which brackets every event."""
    end = path_end(problem, meshes.end_height)
    return path_until(problem, *meshes.path, end, "a compressive load", end_height=meshes.end_height)


def path_end(problem: Problem, end_height: float) -> PathEnd:
    """The end of a path behind which no state carries tension; for one path only, since it keeps its largest delta."""
    displacement = displacement_of_compression(problem, end_radius(problem, end_height))
    if displacement == math.inf:
        raise NotConverged(
            f"of the path of {problem} it cannot be told where its last tension is: "
            "up to the largest displacement that is examined, the attraction can still exceed the compression"
        )
    return PathEnd(displacement)
