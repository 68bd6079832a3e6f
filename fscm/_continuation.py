"""The equilibrium path from far separation through all folds into contact.

The path has two segments or more.  While the punch is apart the scale is fixed and the central gap is the continuation
parameter.  Once the central gap has passed the gap of largest tension, the mesh is scaled so that this gap sits at
s = 1: the mesh follows the edge, and log c is the parameter.  On both, steps are taken in arc length in the space of
the parameter, delta and P, so folds in any of them are passed.  In the moving mesh the solution changes slowly
however sharp the edge is.  When the gap farther out falls below the gap of largest tension as well, as around a tall
asperity, another segment begins, which follows that edge.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fscm._adaptivity import end_radius, fit, initial_mesh, resolved
from fscm._arc_length import ArcLength, Point, parameter_control, parameter_of, rate_of
from fscm._branches import SURPRISE, checked_sense, edge_elsewhere, follow_edge, joined, predicted, turned
from fscm._contact_initiation import gap_at_first_contact
from fscm._edge_width import check_edge
from fscm._equilibrium import Control, Discretisation, Rates, State
from fscm._meshes import Meshes
from fscm._newton import STEP_TOLERANCE, newton
from fscm._path_end import depth
from fscm._surface_rings import check_rings, ring_limit
from fscm.errors import NotConverged
from fscm.problem import Problem
from fscm.punch import PowerPunch, kinks_of

__all__ = ["Tracking", "equilibrium_path", "moved", "usual_start"]

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
# Where its parameter turns, the path goes on in another one, until that one makes up less than this share of the
# tangent.
_LEAST_SHARE = 0.3
# Share of the tangent from which on it is prescribed, not the arc length, where the mesh moves with kinks.
_GIVEN_SHARE = 0.05
# The edge is followed from where the central gap has fallen below the gap of largest tension by this fraction
# of that gap's distance to the singular gap: nearer to it the edge radius is a poor variable (it starts as a
# root).
_HAND_OVER = 0.05
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


def _beyond_kinks(state: State, hand_over: float) -> bool:
    """Whether the contact edge is outside all kinks of the punch."""
    touching = state.radius[state.gap < hand_over]
    return bool(touching.size and touching[-1] > _BEYOND_KINKS * max(kinks_of(state.disc.problem.punch)))


def usual_start(problem: Problem) -> float:
    """A central gap beyond the far branch at jump-out: JKR's C_out mu is at most sqrt(2 pi) mu (Eq. 55)."""
    return 3.0 + 3.0 * problem.largest_mu


class _Tracer:
    """Steps along the path of one problem; the length of the next step is its state."""

    def __init__(
        self, problem: Problem, tolerance: float, longest_step: float, end_height: float, tracking: Tracking
    ) -> None:
        self._problem, self._tolerance, self._end_height, self._tracking = problem, tolerance, end_height, tracking
        self._arc, self._rings = ArcLength.of(problem), ring_limit(problem)
        self._newton = _NEWTON_MARGIN * tolerance if tracking.newton is None else tracking.newton
        self._longest = min(longest_step, tracking.longest_step)
        self._step = min(_FIRST_STEP, self._longest)
        self._turns = 0
        law = problem.law
        self._hand_over = law.peak_gap - _HAND_OVER * (law.peak_gap - law.singular_gap)
        self._kinked, self._power = bool(kinks_of(problem.punch)), isinstance(problem.punch, PowerPunch)

    def points(self, state: State) -> Iterator[Point]:
        """All points from a first state on."""
        point = Point(state, self._arc.tangent(state))
        farthest = _RETURNED + state.central_gap
        while True:
            yield point
            on_edge = self._following_edge(point)
            if on_edge is not None:
                point = on_edge
                continue
            self._check(point.state, farthest)
            in_other = self._in_usual_parameter(point)
            if in_other is not None:
                point = in_other
                yield point
            point = self._next(point)

    def _check(self, state: State, farthest: float) -> None:
        """Raise NotConverged where the path goes round in circles, or the surface comes into contact in rings."""
        if self._rings is not None:
            check_rings(state, self._rings)
        if state.central_gap > farthest:
            raise NotConverged(
                f"the path of {self._problem} came back to separation: a sharp turn of it was not resolved"
            )
        if self._turns > _MOST_TURNS:
            raise NotConverged(
                f"the path of {self._problem} ends at delta = {state.displacement:.6g}, P = {state.load:.6g}: "
                f"in none of its parameters a step goes on"
            )

    def _following_edge(self, point: Point) -> Point | None:
        """The same state on a mesh that follows the outermost edge; None where the mesh does so, or need not."""
        state, own = point.state, self._tracking.newton
        if not (self._tracking.follow or (self._kinked and _beyond_kinks(state, self._hand_over))):
            return None
        edge_gap = gap_at_first_contact(state, point.rates)
        if edge_gap is None and not edge_elsewhere(state, self._hand_over):
            return None
        guess = follow_edge(state, self._end_height, self._tolerance, edge_gap)
        control = parameter_control(guess, parameter_of(guess))
        if edge_gap is not None:  # it grows slowly at first: its gap tells states apart better than its radius
            control = Control(state.central_gap, gap=1.0)
        state = newton(guess, control, own or STEP_TOLERANCE)
        state = fit(state, control, self._tolerance, step_tolerance=own)
        return joined(self._arc, point, state)

    def _in_usual_parameter(self, point: Point) -> Point | None:
        """The same state in its usual parameter again, or in another one; None where its parameter does."""
        state, shares = point.state, self._arc.shares(point)
        if not state.turned:
            return None
        usual = _usual_parameter(state)
        # With the scale given, no node passes a kink during an iteration.
        wanted = usual if self._kinked and abs(shares[usual]) > _GIVEN_SHARE else state.parameter
        if wanted != state.parameter:
            return turned(self._arc, point, wanted)
        least = _GIVEN_SHARE if self._kinked else _LEAST_SHARE
        return turned(self._arc, point) if abs(shares.get(wanted, 0.0)) < least else None

    def _next(self, point: Point) -> Point:
        """The next point; steps are shortened until one is accepted."""
        state = point.state
        if not state.follows_edge and abs(point.rates.displacement) < _FLAT_SHARE * self._arc.displacement_unit(state):
            self._step = min(self._step, _FLAT_STEP)
        while True:
            try:
                after, iterations = self._attempt(point)
            except NotConverged as error:
                self._step *= _RETRY
                if self._step < _SMALLEST_STEP:
                    raise NotConverged(
                        f"the path of {self._problem} ends at delta = {state.displacement:.6g}, "
                        f"P = {state.load:.6g}: no step of arc length down to {_SMALLEST_STEP} converges "
                        f"({error}); the path of a smaller Tabor number turns less sharply"
                    ) from error
                continue
            if after is None:
                self._step *= _SHORTER
                continue
            if iterations <= _EASY:
                self._step = min(_LONGER * self._step, self._longest)
            elif iterations >= _HARD:
                self._step *= _SHORTER
            return after

    def _attempt(self, point: Point) -> tuple[Point | None, int]:
        """The point after a step, None where the tangent turns too much over it, and the iterations it took."""
        guess = resolved(predicted(point.state, point.rates, self._step), self._tolerance)
        control = self._control(point, guess)
        new = newton(guess, control, self._newton, _MOST_ITERATIONS)
        fitted = fit(new, control, self._tolerance, True, self._tracking.newton)
        after = Point(fitted, self._arc.tangent(fitted), point.stretch)
        turn = self._arc.turn(point, after)
        shortest = _BLIND_STEP if self._power else _BLIND_STEP_OF_ASPERITIES
        if (turn if self._power else abs(turn)) < self._tracking.largest_turn and self._step > shortest:
            return None, new.iterations
        if self._same_orientation(point, after, turn):
            self._turns = 0
            return after, new.iterations
        # The path goes on, but its parameter turns.
        self._turns += 1
        return turned(self._arc, point), new.iterations

    def _control(self, point: Point, guess: State) -> Control:
        """The condition of a step: its arc length, or its continuation parameter where that is prescribed."""
        state = point.state
        if (self._tracking.given or self._kinked) and state.parameter == _usual_parameter(state):
            share = self._arc.shares(point)[state.parameter]
            if abs(share) > _GIVEN_SHARE:
                value = parameter_of(state) + self._step * rate_of(point.rates, state.parameter)
                return parameter_control(guess, value)
        return self._arc.control(state, point.rates, self._step)

    def _same_orientation(self, point: Point, after: Point, turn: float) -> bool:
        """Whether the path goes on as its parameter does.  Raises NotConverged where `after` is on another branch."""
        if self._power:
            return turn >= 0.0
        known = turn >= 0.0 if abs(turn) >= self._tracking.largest_turn else None
        return checked_sense(point, after, self._step, known, self._tracking.surprise)


def _usual_parameter(state: State) -> str:
    return "log_scale" if state.follows_edge else "gap"


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
        At the change of segment the same state is given twice, before and after.

    Raises
    ------
    NotConverged
        When the step becomes too small, or the path turns back.
    """
    check_edge(problem)
    tracer = _Tracer(problem, tolerance, longest_step, end_height, tracking or Tracking())
    gap = usual_start(problem) if start_gap is None else start_gap
    gap += depth(problem, end_radius(problem, end_height))
    yield from tracer.points(_far_state(problem, gap, order, tolerance, end_height))
