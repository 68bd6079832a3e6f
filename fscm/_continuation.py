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
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import scipy

from fscm._adaptivity import end_radius, fit, initial_mesh, resolved
from fscm._arc_length import ArcLength, Point, parameter_control, parameter_of, rate_of
from fscm._branches import SURPRISE, checked_sense, edge_elsewhere, follow_edge, joined, predicted, turned
from fscm._equilibrium import Control, Discretisation, Rates, State
from fscm._meshes import Meshes
from fscm._newton import STEP_TOLERANCE, newton
from fscm._path_end import depth
from fscm.errors import NotConverged
from fscm.problem import Problem
from fscm.punch import PowerPunch, kinks_of

__all__ = ["EDGE", "Tracking", "equilibrium_path", "moved", "usual_start"]

_FIRST_STEP = 0.5
_SMALLEST_STEP = 1e-6
# Newton iterations after which the next step is longer or shorter.
_EASY, _HARD = 6, 10
# Iterations of a step of the path after which a shorter one is taken.
_MOST_ITERATIONS = 14
_NEWTON_MARGIN = 0.01  # Newton error beside the error of the mesh
_LONGER, _SHORTER, _RETRY = 2.0, 0.7, 0.4
# A step over which the tangent turns by more than this cosine is taken again, shorter: a fold pair turns
# the path twice and must not be stepped over.  Steps below _BLIND_STEP are taken whatever the turn.
_LARGEST_TURN, _BLIND_STEP = 0.85, 0.02
# The same for any punch but a power law: a cavity that snaps shut turns the path within 0.01 (measured).
_BLIND_STEP_OF_ASPERITIES = 0.002
# Before contact, once the displacement makes up less than this share of the tangent, steps are at most this long:
# the path may then run flat through several shallow folds, over which the tangent hardly turns.  Measured: n = 2,
# k = 0.6, mu = 3 has three folds within 0.015 of displacement, and steps of 0.5 missed the first two.
_FLAT_SHARE, _FLAT_STEP = 0.5, 0.2
# The width of the cohesive edge is (1.03 M)^(-1/(1-k)) for the 9-3 law; decimal logarithm of the least width, relative
# to a contact radius, that is computed.  Measured: 26 s of CPU at 10^-16 (n = 2, k = 0.98, mu = 1) and 55 s and 3 GB at
# 10^-21 (k = 0.985; half the memory since); the number of panels grows with the logarithm.
EDGE, _NARROWEST = 1.03, -22.0
# Where its parameter turns, the path goes on in another one, until that one makes up less than this share of the
# tangent.
_LEAST_SHARE = 0.3
# Share of the tangent from which on it is prescribed, not the arc length, where the mesh moves with kinks.
_GIVEN_SHARE = 0.05
# The edge is followed from where the central gap has fallen below the gap of largest tension by this fraction
# of that gap's distance to the singular gap: nearer to it the edge radius is a poor variable (it starts as a
# root).
_HAND_OVER = 0.05
# Above this k a contact begins as a nucleus many decades smaller than the punch, whose own gap is above the gap of
# largest tension until it has grown: its edge is followed from where it grows.  Below, the nucleus passes within the
# 80 points above.
_NUCLEUS = 0.8
# The nucleus lies within a part of the radius at which the punch is this high, its gap is below the one there by this
# share of its distance to the singular gap, and its radius grows at this rate of log c per arc length.
_FLAT_HEIGHT, _SMALL, _DEEP, _GROWING = 0.02, 0.05, 0.2, 0.3
# Beyond the last kink by this factor of its radius, the edge is followed: a fixed mesh allows steps of its width only.
# Measured: 800 points in place of over 1800 where the path has to go on to a displacement of 91 (random punch 24).
_BEYOND_KINKS = 1.2
# A path that comes back to the central gap of its first state and this much more has turned round.
_RETURNED = 1.0
# Changes of the parameter without a step between them, after which the path is at its end.
_MOST_TURNS = 6


@dataclass(frozen=True)
class Tracking:
    """How a path is tracked.

    Attributes
    ----------
    follow : bool
        Whether the mesh follows the contact edge; if not, its scale stays fixed.
    surprise : float
        Largest deviation of a step from the trapezoidal rule, relative to the distance of a gap to the singular gap.
    longest_step : float
        Of the arc length.
    newton : float, optional
        Tolerance of Newton's method; by default so small that its error is negligible beside that of the mesh.
    largest_turn : float
        Cosine of the angle of two tangents below which a step is taken again, shorter.
    given : bool
        Whether a step prescribes the continuation parameter in place of the arc length, unless that hardly changes.
    """

    follow: bool = True
    surprise: float = SURPRISE
    longest_step: float = math.inf
    newton: float | None = None
    largest_turn: float = _LARGEST_TURN
    given: bool = False


def moved(state: State, rates: Rates, value: float, tolerance: float = STEP_TOLERANCE) -> State:
    """Equilibrium at another value of the continuation parameter, from the tangent predictor.

    Raises
    ------
    NotConverged
        When Newton's method fails.
    """
    return newton(predicted(state, rates, value - parameter_of(state)), parameter_control(state, value), tolerance)


def _far_state(problem: Problem, central_gap: float, order: int, tolerance: float, end_height: float) -> State:
    """Equilibrium at a large central gap, from the rigid solution."""
    disc = Discretisation(problem, initial_mesh(problem, order, end_height))
    gap = central_gap + disc.height(disc.mesh.nodes)
    control = Control(central_gap, gap=1.0)
    lift = np.zeros(disc.mesh.size) if disc.steep else None
    guess = resolved(State(disc, 1.0, gap, -central_gap, False, lift=lift), tolerance)
    return fit(newton(guess, control), control, tolerance)


def _nucleus_gap(state: State, rates: Rates) -> float | None:
    """The gap at the edge of a small growing nucleus of contact, if there is such a nucleus."""
    problem, mesh = state.disc.problem, state.disc.mesh
    if state.follows_edge or problem.k <= _NUCLEUS:
        return None
    flat = int(np.argmax(problem.punch.height(state.radius) >= _FLAT_HEIGHT)) - 1
    inner = state.central_gap
    if flat < 1 or state.gap[flat] - inner < _DEEP * (inner - problem.law.singular_gap):
        return None
    # The front is where the gap is steepest in log r: it decays slowly farther out.
    gap, log_r = state.gap[: flat + 1], np.log(mesh.nodes[: flat + 1])
    slopes = np.diff(gap) / np.diff(log_r)
    i = int(np.argmax(slopes))
    if mesh.nodes[i + 1] > _SMALL * mesh.nodes[flat]:
        return None
    front = 0.5 * float(gap[i] + gap[i + 1])
    # Growth at a fixed share of the depth: the radius of a fixed gap grows as well when the nucleus forms, and shrinks
    # later.
    share = (front - inner) / (float(gap[flat]) - inner)
    change = (1.0 - share) * rates.central_gap + share * rates.gap[flat] - 0.5 * (rates.gap[i] + rates.gap[i + 1])
    return front if change > _GROWING * slopes[i] else None


def _beyond_kinks(state: State, hand_over: float) -> bool:
    """Whether the contact edge is outside all kinks of the punch."""
    touching = state.radius[state.gap < hand_over]
    return bool(touching.size and touching[-1] > _BEYOND_KINKS * max(kinks_of(state.disc.problem.punch)))


def _log_width(problem: Problem, log_mu: float) -> float:
    """Decimal logarithm of the width of the cohesive edge over the contact radius, about (n mu)^(1/n), at log10 mu."""
    n, k = problem.n, problem.k
    log_M = math.log10(2.0) + (2.0 * n + k - 1.0) / n * log_mu
    radius = max(math.log10(n) + log_mu, 0.0) / n
    return -(math.log10(EDGE) + log_M) / (1.0 - k) - radius


def _check_edge(problem: Problem) -> None:
    """Refuse a cohesive edge that needs too many panels."""
    log_mu = math.log10(problem.mu)
    if _log_width(problem, log_mu) < _NARROWEST:
        largest = scipy.optimize.brentq(lambda x: _log_width(problem, x) - _NARROWEST, -400.0, log_mu)
        raise NotConverged(
            f"the contact edge of {problem} is about 10^{_log_width(problem, log_mu):.0f} of its radius wide, below "
            f"10^{_NARROWEST:.0f}, which needs too much memory: the largest Tabor number at n = {problem.n:g}, "
            f"k = {problem.k:g} is mu = {10.0**largest:.3g}"
        )


def usual_start(problem: Problem) -> float:
    """A central gap beyond the far branch at jump-out: JKR's C_out mu is at most sqrt(2 pi) mu (Eq. 55)."""
    return 3.0 + 3.0 * problem.largest_mu


def equilibrium_path(
    problem: Problem,
    order: int,
    tolerance: float,
    longest_step: float = 0.5,
    start_gap: float | None = None,
    end_height: float = Meshes.end_height,
    tracking: Tracking | None = None,
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
    tracking : Tracking, optional
        By default the mesh follows the contact edge.

    Yields
    ------
    Point
        At the change of stretch the same state is given twice, before and after.

    Raises
    ------
    NotConverged
        When the step becomes too small, or the path turns back.
    """
    _check_edge(problem)
    arc, tracking = ArcLength.of(problem), tracking or Tracking()
    step_tolerance = _NEWTON_MARGIN * tolerance if tracking.newton is None else tracking.newton
    longest_step = min(longest_step, tracking.longest_step)
    gap = usual_start(problem) if start_gap is None else start_gap
    gap += depth(problem, end_radius(problem, end_height))
    state = _far_state(problem, gap, order, tolerance, end_height)
    peak, singular = problem.law.peak_gap, problem.law.singular_gap
    hand_over = peak - _HAND_OVER * (peak - singular)
    kinked = bool(kinks_of(problem.punch))
    least_share = _GIVEN_SHARE if kinked else _LEAST_SHARE
    shortest = _BLIND_STEP if isinstance(problem.punch, PowerPunch) else _BLIND_STEP_OF_ASPERITIES
    step, turns, farthest = min(_FIRST_STEP, longest_step), 0, _RETURNED + state.central_gap
    point = Point(state, arc.tangent(state))
    while True:
        yield point
        state = point.state
        follow = tracking.follow or (kinked and _beyond_kinks(state, hand_over))
        nucleus = _nucleus_gap(state, point.rates) if follow else None
        if follow and (nucleus is not None or edge_elsewhere(state, hand_over)):
            guess = follow_edge(state, end_height, tolerance, nucleus)
            control = parameter_control(guess, parameter_of(guess))
            if nucleus is not None:  # it grows slowly at first: its gap tells states apart better than its radius
                control = Control(state.central_gap, gap=1.0)
            state = newton(guess, control, tracking.newton or STEP_TOLERANCE)
            state = fit(state, control, tolerance, step_tolerance=tracking.newton)
            point = joined(arc, point, state)
            continue
        if state.central_gap > farthest:
            raise NotConverged(f"the path of {problem} came back to separation: a sharp turn of it was not resolved")
        if turns > _MOST_TURNS:
            raise NotConverged(
                f"the path of {problem} ends at delta = {state.displacement:.6g}, P = {state.load:.6g}: "
                f"in none of its parameters a step goes on"
            )
        shares = arc.shares(point)
        usual = "log_scale" if state.follows_edge else "gap"
        # With the scale given, no node passes a kink during an iteration.
        kept = usual if kinked and abs(shares[usual]) > _GIVEN_SHARE else state.parameter
        if state.turned and (kept != state.parameter or abs(shares.get(kept, 0.0)) < least_share):
            point = turned(arc, point, kept if kept != state.parameter else None)
            state = point.state
            yield point
        if not state.follows_edge and abs(point.rates.displacement) < _FLAT_SHARE * arc.displacement_unit(state):
            step = min(step, _FLAT_STEP)
        while True:
            guess = resolved(predicted(state, point.rates, step), tolerance)
            control = arc.control(state, point.rates, step)
            if (tracking.given or kinked) and state.parameter == usual and abs(shares[usual]) > _GIVEN_SHARE:
                control = parameter_control(guess, parameter_of(state) + step * rate_of(point.rates, state.parameter))
            try:
                new = newton(guess, control, step_tolerance, _MOST_ITERATIONS)
                used = new.iterations
                new = fit(new, control, tolerance, True, tracking.newton)
                after = Point(new, arc.tangent(new), point.stretch)
                turn, blind = arc.turn(point, after), step <= shortest
                power = isinstance(problem.punch, PowerPunch)
                if (turn if power else abs(turn)) < tracking.largest_turn and not blind:
                    step *= _SHORTER
                    continue
                same = turn >= 0.0
                if not power:
                    same = checked_sense(
                        point, after, step, same if abs(turn) >= tracking.largest_turn else None, tracking.surprise
                    )
                if not same:  # the path goes on, but its parameter turns
                    after = turned(arc, point)
                turns = 0 if same else turns + 1
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
