"""The equilibrium path from far separation through all folds into contact.

The path has two or more segments.  Before contact the scale is fixed, and the central gap is the continuation
parameter.  Once the central gap is below the gap of largest tension, the mesh is scaled so that this gap is at s = 1:
the mesh follows the edge, and log c is the parameter.  On both, steps are taken in arc length in the space of the
parameter, delta and P, so that folds in any of them are passed.  On the moving mesh the solution changes slowly,
however sharp the edge is.  If the gap farther out also falls below the gap of largest tension, as around a tall
asperity, another segment begins, which follows that edge.
"""

from __future__ import annotations

from collections.abc import Iterator

from fscm._path.arc_length import ArcLength, Point, parameter_control, parameter_of, rate_of
from fscm._path.branches import (
    edge_elsewhere,
    follow_edge,
    joined,
    predicted,
    turned,
)
from fscm._path.contact_initiation import gap_at_first_contact
from fscm._path.edge_width import check_edge
from fscm._path.ends import depth
from fscm._path.punch_rules import Tracking, rules_of
from fscm._path.surface_rings import check_rings, ring_limit
from fscm._surface.adaptivity import adapted, resolved
from fscm._surface.breaks import end_radius, initial_mesh
from fscm._surface.discretisation import Discretisation
from fscm._surface.newton import STEP_TOLERANCE, newton
from fscm._surface.response import largest_mu
from fscm._surface.state import Control, Rates, State, rigid_state
from fscm.accuracy import Meshes
from fscm.errors import Failure, NotConverged
from fscm.problem import Problem
from fscm.wells import has_one_well, outermost_turn

__all__ = ["beyond_wells", "equilibrium_path", "moved", "usual_start"]

#: Steps of arc length: the first one, and the smallest one that is tried.
_FIRST_STEP, _SMALLEST_STEP = 0.5, 1e-6
#: Newton iterations after which the next step is longer or shorter.
_EASY, _HARD = 6, 10
#: Largest number of iterations of a step of the path.
_MOST_ITERATIONS = 14
_NEWTON_MARGIN = 0.01  #: Newton error relative to the error of the mesh
_LONGER, _SHORTER, _RETRY = 2.0, 0.7, 0.4
#: Before contact, where the displacement makes up less than this share of the tangent, steps have this largest length:
#: the tangent hardly turns over several shallow folds.  Measured: n = 2, k = 0.6, mu = 3 has three folds within 0.015
#: of displacement, and steps of 0.5 missed the first two.
_FLAT_SHARE, _FLAT_STEP = 0.5, 0.2
#: Where the parameter is prescribed, it is so instead of the arc length above this share of the tangent.
_GIVEN_SHARE = 0.05
#: The edge is followed once the central gap is below the gap of largest tension by this share of its distance to the
#: singular gap: before, the edge radius is a poor variable, since it starts as a square root.
_HAND_OVER = 0.05
#: A path whose central gap exceeds that of its first state by this much runs backwards.
_RETURNED = 1.0
#: Multiple of the gap of the outermost turn of a law at which its path begins: the tension is a small share there.
_BEYOND_WELLS = 3.0
#: Largest number of successive changes of the parameter without a step between them.
_MOST_TURNS = 6


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
    control = Control(central_gap, gap=1.0)
    guess = resolved(rigid_state(disc, central_gap), tolerance)
    return adapted(newton(guess, control), control, tolerance)


def usual_start(problem: Problem) -> float:
    """A central gap beyond the far branch at jump-out: JKR's C_out mu is at most sqrt(2 pi) mu (Eq. 55).

    Under a law with several wells it is beyond the outermost of them, too.
    """
    return 3.0 + 3.0 * largest_mu(problem) + beyond_wells(problem)


def beyond_wells(problem: Problem) -> float:
    """How much farther out a path begins under a law with several wells; zero under any other."""
    return 0.0 if has_one_well(problem.law) else _BEYOND_WELLS * outermost_turn(problem.law)


class _Tracer:
    """Continuation of the path of one problem with an adaptive step length."""

    def __init__(
        self, problem: Problem, tolerance: float, longest_step: float, end_height: float, tracking: Tracking
    ) -> None:
        self._problem, self._tolerance, self._end_height, self._tracking = problem, tolerance, end_height, tracking
        self._arc, self._rings = ArcLength.of(problem), ring_limit(problem)
        self._newton = _NEWTON_MARGIN * tolerance if tracking.newton is None else tracking.newton
        self._longest = min(longest_step, tracking.longest_step)
        self._step = min(_FIRST_STEP, self._longest)
        self._turns, self._tension = 0, 0.0  # largest tension so far
        law = problem.law
        self._hand_over = law.peak_gap - _HAND_OVER * (law.peak_gap - law.singular_gap)
        self._rules = rules_of(problem)
        # The response of a graded solid is computed anew for each scale, so that it has to stay during the iterations.
        self._prescribed = tracking.prescribed or self._rules.prescribes or problem.graded is not None

    def points(self, state: State) -> Iterator[Point]:
        """All points from an initial state on."""
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
        """Raise NotConverged if the path runs backwards or does not advance, or if contact begins in rings."""
        if self._rings is not None:
            check_rings(state, self._rings)
        if state.central_gap > farthest:
            raise NotConverged(
                f"the path of {self._problem} came back to separation: a sharp turn of it was not resolved",
                Failure.STEP,
            )
        if self._turns > _MOST_TURNS:
            raise NotConverged(
                f"the path of {self._problem} ends at delta = {state.displacement:.6g}, P = {state.load:.6g}: "
                f"no continuation parameter allows another step",
                Failure.STEP,
            )

    def _following_edge(self, point: Point) -> Point | None:
        """The same state on a mesh that follows the outermost edge; None if the mesh does so already, or need not."""
        state, tolerance = point.state, self._tracking.newton
        if not self._rules.follows_edge(self._tracking, state, self._hand_over):
            return None
        edge_gap = gap_at_first_contact(state, point.rates)
        if edge_gap is None and not edge_elsewhere(state, self._hand_over):
            return None
        guess = follow_edge(state, self._end_height, self._tolerance, edge_gap)
        control = parameter_control(guess, parameter_of(guess))
        if edge_gap is not None:  # the contact grows slowly at first: its gap identifies the state, not its radius
            control = Control(state.central_gap, gap=1.0)
        state = newton(guess, control, tolerance or STEP_TOLERANCE)
        state = adapted(state, control, self._tolerance, step_tolerance=tolerance)
        return joined(self._arc, point, state)

    def _in_usual_parameter(self, point: Point) -> Point | None:
        """The same state in its usual parameter, or in another one; None if its parameter need not change."""
        state, shares = point.state, self._arc.shares(point)
        if not state.turned:
            return None
        usual = state.anchor.parameter
        wanted = usual if abs(shares[usual]) > self._rules.given_share else state.parameter
        if wanted != state.parameter:
            return turned(self._arc, point, wanted)
        return turned(self._arc, point) if abs(shares.get(wanted, 0.0)) < self._rules.least_share else None

    def _next(self, point: Point) -> Point:
        """The next point; steps are shortened until one is accepted."""
        state = point.state
        longest = self._longest_after(state)
        if not state.anchor.in_contact and abs(point.rates.displacement) < _FLAT_SHARE * self._arc.displacement_unit(
            state
        ):
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
                        f"({error.reason})",
                        Failure.STEP,
                    ) from error
                continue
            if after is None:
                self._step *= _SHORTER
                continue
            if iterations <= _EASY:
                self._step = min(_LONGER * self._step, longest)
            elif iterations >= _HARD:
                self._step *= _SHORTER
            return after

    def _longest_after(self, state: State) -> float:
        """The longest step from a state on."""
        self._tension = max(self._tension, -state.load)
        return self._longest * self._rules.stretch(state.load, self._tension)

    def _attempt(self, point: Point) -> tuple[Point | None, int]:
        """The point after a step, None if the tangent turns too much over it, and the number of iterations."""
        guess = resolved(predicted(point.state, point.rates, self._step), self._tolerance)
        control = self._control(point, guess)
        new = newton(guess, control, self._newton, _MOST_ITERATIONS)
        converged = adapted(new, control, self._tolerance, True, self._tracking.newton)
        after = Point(converged, self._arc.tangent(converged), point.segment)
        turn = self._arc.turn(point, after)
        if self._step > self._rules.unchecked_step and self._rules.turns_too_far(turn, self._tracking):
            return None, new.iterations
        if self._rules.goes_on(point, after, self._step, turn, self._tracking):
            self._turns = 0
            return after, new.iterations
        # A fold of the parameter.
        self._turns += 1
        return turned(self._arc, point), new.iterations

    def _control(self, point: Point, guess: State) -> Control:
        """The condition of a step: on its arc length, or on the continuation parameter where that is prescribed."""
        state = point.state
        if self._prescribed and state.parameter == state.anchor.parameter:
            share = self._arc.shares(point)[state.parameter]
            if abs(share) > _GIVEN_SHARE:
                value = parameter_of(state) + self._step * rate_of(point.rates, state.parameter)
                return parameter_control(guess, value)
        return self._arc.control(state, point.rates, self._step)


def equilibrium_path(
    problem: Problem,
    order: int,
    tolerance: float,
    longest_step: float = 0.5,
    start_gap: float | None = None,
    end_height: float = Meshes.end_height,
    tracking: Tracking | None = None,
) -> Iterator[Point]:
    """Yield the converged states of the path without end: the caller stops.

    Parameters
    ----------
    problem : Problem
    order : int
        Nodes per panel.
    tolerance : float
        Resolution of the pressure (see `_surface.adaptivity`).
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
        At a change of segment the same state comes twice, before and after.

    Raises
    ------
    NotConverged
        When the step becomes too small, or the path runs backwards.
    """
    check_edge(problem)
    tracer = _Tracer(problem, tolerance, longest_step, end_height, tracking or Tracking())
    gap = usual_start(problem) if start_gap is None else start_gap
    gap += depth(problem, end_radius(problem, end_height))
    yield from tracer.points(_far_state(problem, gap, order, tolerance, end_height))
