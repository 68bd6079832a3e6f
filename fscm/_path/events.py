"""Events of the equilibrium path, found as roots of exact derivatives.

The coarse path brackets an event; its continuation parameter is found on the coarse mesh and, from there, on finer
meshes.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from fscm._path.arc_length import Point, parameter_control, parameter_of, rates_of
from fscm._path.continuation import moved
from fscm._roots import bracketed_root
from fscm._surface.adaptivity import adapted, balanced, indicator, lengthened, newton_tolerance, on_mesh, resolved
from fscm._surface.breaks import at_joints, off_joints
from fscm._surface.newton import newton
from fscm._surface.state import Rates, State
from fscm.errors import Failure, NotConverged

__all__ = [
    "MISSED_EXTREME",
    "Condition",
    "brackets",
    "crossings",
    "displacement_fold",
    "event_between",
    "extreme",
    "load_fold",
    "locate",
    "root_near",
    "slowest",
    "with_minima",
    "zero_load",
]

Condition = Callable[[State, Rates], float]
Bracket = tuple[Point, Point]

#: The secant method ends with a step of the continuation parameter below this share of the tolerance of the mesh,
#: within these limits: the remaining error is the product of the last two steps.  Unless the condition is the rate at
#: an extreme, one step follows: without it the displacement at zero load was off by 1.5e-11 (n = 3.2, k = 0.06, mu =
#: 6.6).
_PARAMETER_SHARE, _LEAST_PARAMETER, _LARGEST_PARAMETER = 0.1, 1e-9, 1e-6
_SECANT_STEPS = 20
#: An extreme is reached when the functional differs from it by less than this share of 1 + its size; four roundings.  A
#: small step does not suffice: under a flat end with a rounded edge the load, of curvature 2e5, was wrong by 4e-12.
MISSED_EXTREME = 2.0**-51
#: First step of the secant method: large against rounding of the derivative, small against its curvature.
_FIRST_SECANT_STEP = 1e-4
_COARSE_PARAMETER_TOLERANCE = 1e-6
#: The mesh is refined again when the indicator at the root exceeds the tolerance by this factor, at most _REFITS times.
#: Measured: once at n = 300, k = 0, where the force was wrong by 4e-8.
_UNRESOLVED, _REFITS = 10.0, 4
#: Above this tolerance the indicator underestimates the error of a panel next to a much shorter one: meshes are
#: balanced.
#: So they are at any tolerance for edges narrower than _NARROW, relative to their radius (n = 2, k = 0.98, mu = 1).
_SEEN, _NARROW = 1e-6, 1e-9
#: Tolerance of the root on the coarse mesh that is only a starting point.
_ROUGH = 1e-2
#: An end of a bracket is the starting point if the condition is below this share of that at the other end.
_CLOSE = 0.02
#: Largest first step of the secant method that is Newton's with an estimated derivative.
_LARGEST_FIRST = 0.1
#: Step of the continuation parameter after which the mesh is adapted again.
_FAR = 1e-3


def load_fold(state: State, rates: Rates) -> float:
    """dP, zero where the load is extreme."""
    return rates.load


def displacement_fold(state: State, rates: Rates) -> float:
    """d(delta), zero where the displacement is extreme."""
    return rates.displacement


def zero_load(state: State, rates: Rates) -> float:
    """P."""
    return state.load


#: The functional that is extreme where a condition vanishes.
_FUNCTIONALS: dict[Condition, str] = {load_fold: "load", displacement_fold: "displacement"}


def brackets(points: Sequence[Point], condition: Condition, rising: bool) -> list[Bracket]:
    """Neighbouring points between which the condition turns positive (`rising`) or negative."""
    pairs = []
    for a, b in pairwise(points):
        if a.segment != b.segment:
            continue  # the same state on two meshes
        before, after = condition(a.state, a.rates), condition(b.state, b.rates)
        if (before < 0.0 <= after) if rising else (before >= 0.0 > after):
            pairs.append((a, b))
    return pairs


def crossings(points: Sequence[Point], condition: Condition, fold: Condition) -> list[Bracket]:
    """Neighbouring states between which the condition passes zero, in the order of the path.

    Parameters
    ----------
    points : sequence of Point
        Between neighbours the condition has at most one extreme (see `fscm._path.completeness`).
    condition : callable
        State, Rates -> float; a functional less a value.
    fold : callable
        Its derivative: zero at an extreme.
    """
    pairs: list[Bracket] = []
    for a, b in pairwise(points):
        if a.segment != b.segment:
            continue
        before, after = condition(a.state, a.rates), condition(b.state, b.rates)
        if (before < 0.0) != (after < 0.0):
            pairs.append((a, b))
        elif before * fold(a.state, a.rates) < 0.0 and before * fold(b.state, b.rates) > 0.0:
            # The condition approaches zero from both ends: its extreme decides.
            extreme = locate(a, b, fold)
            rates = rates_of(extreme)
            if (condition(extreme, rates) < 0.0) != (before < 0.0):
                at = Point(extreme, rates, a.segment)
                pairs += [(a, at), (at, b)]
    return pairs


class Between:
    """States between two points of the path, as a function of the continuation parameter."""

    def __init__(self, a: Point, b: Point) -> None:
        self._known = {parameter_of(p.state): (p.state, rates_of(p.state)) for p in (a, b)}
        self.low, self.high = sorted(self._known)

    def __call__(self, parameter: float) -> tuple[State, Rates]:
        if parameter not in self._known:
            nearest = sorted(self._known, key=lambda x: abs(x - parameter))
            for i, start in enumerate(nearest):
                try:
                    state = moved(*self._known[start], parameter, _COARSE_PARAMETER_TOLERANCE)
                    break
                except NotConverged:
                    if i == len(nearest) - 1:
                        raise
            self._known[parameter] = (state, rates_of(state))
        return self._known[parameter]


def locate(a: Point, b: Point, condition: Condition, tolerance: float = _COARSE_PARAMETER_TOLERANCE) -> State:
    """Root of the condition between two neighbouring points, on their coarse mesh.

    Parameters
    ----------
    a, b : Point
    condition : callable
    tolerance : float
        Of the continuation parameter.
    """
    between = Between(a, b)
    root = bracketed_root(lambda x: condition(*between(x)), between.low, between.high, tolerance, 1e-12)
    return between(root)[0]


def extreme(a: Point, b: Point, condition: Condition) -> State | None:
    """Approximate extreme of a functional between two points, from the cubic through its values and rates."""
    name = _FUNCTIONALS.get(condition)
    if name is None:
        return None
    start, length = parameter_of(a.state), parameter_of(b.state) - parameter_of(a.state)
    change = getattr(b.state, name) - getattr(a.state, name)
    rate_a, rate_b = (length * getattr(rates_of(point.state), name) for point in (a, b))
    # The rate is the line between both rates plus a bulge that accounts for the change.
    bulge = 6.0 * (change - 0.5 * (rate_a + rate_b))
    roots = np.roots([-bulge, rate_b - rate_a + bulge, rate_a])
    inside = [float(t.real) for t in roots if abs(t.imag) == 0.0 and 0.0 <= t.real <= 1.0]
    if len(inside) == 1:
        share = inside[0]
    elif rate_a * rate_b < 0.0:  # the cubic does not decide
        share = rate_a / (rate_a - rate_b)
    else:
        return None
    nearer, farther = (a, b) if share < 0.5 else (b, a)
    for point in (nearer, farther):
        try:
            return moved(point.state, rates_of(point.state), start + share * length, _COARSE_PARAMETER_TOLERANCE)
        except NotConverged:
            continue
    return None


def with_minima(points: Sequence[Point]) -> list[Point]:
    """The points, with approximate minima of the load inserted."""
    minima = {id(a): extreme(a, b, load_fold) for a, b in brackets(points, load_fold, rising=True)}
    extended = []
    for point in points:
        extended.append(point)
        state = minima.get(id(point))
        if state is not None:
            extended.append(Point(state, rates_of(state).scaled(state.orientation), point.segment))
    return extended


def slowest(points: Sequence[Point]) -> tuple[Point, Point, Point, float]:
    """The point of the path with the least rate of displacement, which is negative between two folds.

    Returns
    -------
    before, at, after : Point
        The point and its neighbours on the same segment.
    rate : float
        Per unit of the continuation parameter, oriented into contact.
    """
    i = min(range(1, len(points) - 1), key=lambda j: points[j].rates.displacement)
    # Two steps to either side, separately on each segment.
    around = points[max(i - 2, 0) : i + 3]
    segments = [[p for p in around if p.segment == segment] for segment in sorted({p.segment for p in around})]
    candidates = [_least_rate(segment[0], segment[-1]) for segment in segments if len(segment) > 1]
    return min(candidates, key=lambda result: result[3])


def _least_rate(a: Point, b: Point) -> tuple[Point, Point, Point, float]:
    from scipy.optimize import minimize_scalar

    between = Between(a, b)
    orientation = a.state.orientation
    best = minimize_scalar(
        lambda x: orientation * between(x)[1].displacement,
        bounds=(between.low, between.high),
        method="bounded",
        options={"xatol": 1e-5 * (between.high - between.low)},
    )
    state, rates = between(float(best.x))
    return a, Point(state, rates.scaled(orientation), a.segment), b, float(best.fun)


def refined(state: State, order: int, tolerance: float, end_height: float | None = None) -> State:
    """The state at the same continuation parameter, on a mesh of the given order refined to the tolerance.

    Parameters
    ----------
    state : State
    order, tolerance
        See `_surface.adaptivity`.
    end_height : float, optional
        Least height of the punch at the end of the mesh.
    """
    if end_height is not None:
        state = lengthened(state, end_height)
    control = parameter_control(state, parameter_of(state))
    mesh = replace(state.disc.mesh, order=order)
    narrow = tolerance > _SEEN or float(np.min(mesh.lengths)) < _NARROW
    if narrow:
        mesh = balanced(mesh)
    mesh = at_joints(state.disc.problem, mesh, state.scale)
    guess = resolved(on_mesh(state, mesh), tolerance)
    return adapted(newton(guess, control, newton_tolerance(tolerance)), control, tolerance, coarsen=not narrow)


def event_between(
    bracket: Bracket, condition: Condition, order: int, tolerance: float, end_height: float | None = None
) -> State:
    """Root of the condition in a bracket, on a mesh of the given order refined to the tolerance.

    Near a critical Tabor number the secant method may leave the bracket for the other fold, which is another event.
    """
    try:
        rough = _rough(bracket, condition)
        root, slope = _root_with_slope(
            rough, condition, order, tolerance, end_height, _slope(bracket, rough, condition)
        )
        if _belongs(root, slope, bracket, condition):
            return root
    except NotConverged:
        pass
    # From a better root on the coarse mesh.
    root, slope = _root_with_slope(locate(*bracket, condition), condition, order, tolerance, end_height)
    if not _belongs(root, slope, bracket, condition):
        raise NotConverged("the secant method left the bracket of an event for another one", Failure.EVENT)
    return root


def _rough(bracket: Bracket, condition: Condition) -> State:
    """Approximate root of a condition in a bracket, on a coarse mesh."""
    sizes = [abs(condition(point.state, rates_of(point.state))) for point in bracket]
    if min(sizes) < _CLOSE * max(sizes):
        return bracket[int(np.argmin(sizes))].state
    rough = extreme(*bracket, condition)
    return locate(*bracket, condition, _ROUGH) if rough is None else rough


def _slope(bracket: Bracket, state: State, condition: Condition) -> float:
    """Derivative of the condition at a state, from the parabola through its values there and at both ends."""
    samples = sorted((bracket[0].state, state, bracket[1].state), key=parameter_of)
    x = [parameter_of(sample) for sample in samples]
    y = [condition(sample, rates_of(sample)) for sample in samples]
    secant = (y[2] - y[0]) / (x[2] - x[0])
    if min(x[1] - x[0], x[2] - x[1]) <= 0.0:  # the state is an end
        return secant
    return (y[1] - y[0]) / (x[1] - x[0]) + (y[2] - y[1]) / (x[2] - x[1]) - secant


def _belongs(state: State, slope: float, bracket: Bracket, condition: Condition) -> bool:
    """Whether a root belongs to a bracket: it lies inside, or its slope has the sign of the change over the bracket.

    The bracket is of a coarser mesh, whose error may move the root outside.
    """
    x_a, x_b = (parameter_of(point.state) for point in bracket)
    x = parameter_of(state)
    if min(x_a, x_b) <= x <= max(x_a, x_b):
        return True
    before, after = (condition(point.state, rates_of(point.state)) for point in bracket)
    return slope * (after - before) * (x_b - x_a) > 0.0


def root_near(
    state: State, condition: Condition, order: int, tolerance: float, end_height: float | None = None
) -> State:
    """Root of the condition near a state, on a mesh of the given order refined to the tolerance.

    Raises
    ------
    NotConverged
        When the secant method does not settle, or the mesh at the root stays too coarse.
    """
    return _root_with_slope(state, condition, order, tolerance, end_height)[0]


def _root_with_slope(
    state: State,
    condition: Condition,
    order: int,
    tolerance: float,
    end_height: float | None,
    slope: float | None = None,
) -> tuple[State, float]:
    """Root of the condition near a state, and its derivative there."""
    state = refined(state, order, tolerance, end_height)
    for _ in range(_REFITS):
        state, slope = _root(state, condition, tolerance, slope)
        if np.max(indicator(state)) <= _UNRESOLVED * tolerance and not off_joints(state):
            return state, slope
        # The steep rise of a flat punch, or a joint, has moved off the panels that resolve it.
        state = refined(state, order, tolerance)
    raise NotConverged(
        "the mesh at an event does not resolve the pressure; the event moves with the mesh", Failure.EVENT
    )


def _root(state: State, condition: Condition, tolerance: float, slope: float | None) -> tuple[State, float]:
    """Root of the condition on the mesh of a state by the secant method, and its derivative there.

    The first step is Newton's if there is a `slope`.
    """
    iterations = state.iterations
    rates = rates_of(state)
    value = condition(state, rates)

    def at_extreme(state: State, rate: float, slope: float) -> bool:
        if condition not in _FUNCTIONALS:
            return True
        size = 1.0 + abs(getattr(state, _FUNCTIONALS[condition]))
        return 0.5 * rate * rate <= MISSED_EXTREME * size * abs(slope)

    enough = min(max(_PARAMETER_SHARE * tolerance, _LEAST_PARAMETER), _LARGEST_PARAMETER)
    step, settled = _FIRST_SECANT_STEP, condition in _FUNCTIONALS
    if slope and abs(value / slope) < _LARGEST_FIRST:
        step = -value / slope
        if abs(step) < enough and settled and at_extreme(state, value, slope):
            return state, slope
    for _ in range(_SECANT_STEPS):
        new = moved(state, rates, parameter_of(state) + step, newton_tolerance(tolerance))
        if abs(step) > _FAR:
            new = adapted(new, parameter_control(new, parameter_of(new)), tolerance)
        new_rates = rates_of(new)
        new_value = condition(new, new_rates)
        change = new_value - value
        state, rates, value = new, new_rates, new_value
        iterations += state.iterations
        small = abs(step) < enough
        if (not small or not slope) and change != 0.0:
            slope = change / step
        if slope and (value == 0.0 or (small and (change == 0.0 or (settled and at_extreme(state, value, slope))))):
            return replace(state, iterations=iterations), slope
        if change == 0.0 or not slope:
            break
        settled = settled or small
        step *= -value / change
    raise NotConverged(
        "the root of an event did not settle on the refined mesh: the event may be about to vanish", Failure.EVENT
    )
