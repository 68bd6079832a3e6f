"""Events of the equilibrium path, as roots of exact sensitivities.

A sign change of dP, d(delta) or P between two neighbouring points of the completed path brackets an event, and Brent's
method on the derivative from the bordered solve finds it to rounding.  No event is interpolated between points.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from itertools import pairwise

from scipy.optimize import brentq

from fem_reference._contact.completeness import complete_path
from fem_reference._contact.contact import Contact
from fem_reference._contact.cusp import cusp_from, slowest
from fem_reference._contact.path import Point, joined, point_at
from fem_reference.errors import NoSuchEvent, NotConverged

__all__ = [
    "CUSP",
    "EVENTS",
    "JUMP_IN",
    "LANDING",
    "SEPARATED",
    "Pair",
    "PathEvents",
    "anchor_of",
    "beyond_pull_off",
    "event_energy",
    "excess_of",
]

ROOT_TOLERANCE = 1e-11
"""Relative tolerance of the parameter at an event; P is stationary there and delta moves by as little."""

EVENTS = ("pull_off", "jump_in", "jump_out", "zero_load")
"""Events of the path: the deepest minimum of the load, the two folds of displacement control, and the point in contact
where the load changes from tension to compression."""

LANDING = "landing"
"""The point in contact at the displacement of the jump into contact: where that jump ends."""

SEPARATED = "separated"
"""The point out of contact at the displacement of the jump out of contact: where that jump ends."""

JUMP_IN = "jump_in"
"""The first fold on approach."""

STIFF = "the displacement rises all along the path: this solid is too stiff for jumps"

CUSP = "cusp"
"""The point where the two folds merge, at the modulus at which they do; its compliance has that modulus."""

SLOPE_STEP = 1e-4
"""Relative change of the parameter for the slope of a rate: an error of this size slows the secant method only."""

Pair = tuple[Point, Point]


def beyond_pull_off(event: str) -> bool:
    """Whether an event lies on the path beyond the pull-off, where the edge is sharper relative to its radius."""
    return event in ("zero_load", LANDING)


class PathEvents:
    """The events of one traced path, each found once.

    Parameters
    ----------
    samples : sequence of Point
        As `fem_reference._contact.tracing.traced` returns them.
    """

    def __init__(self, samples: Sequence[Point]) -> None:
        self.samples = samples
        self._anchors: dict[str, tuple[Point, float]] = {}

    @property
    def contact(self) -> Contact:
        """The problem on the mesh of the first sample."""
        return self.samples[0].branch.contact

    @cached_property
    def points(self) -> Sequence[Point]:
        """The samples, with others where a pair of turning points could be between two.

        Raises
        ------
        NotConverged
            If such a pair cannot be excluded.
        """
        return tuple(complete_path(self.samples))

    def between(self, a: Point, b: Point, parameter: float) -> Point:
        """Return the state at a parameter from the nearer one of two neighbours."""
        return point_at(min(a, b, key=lambda point: abs(point.parameter - parameter)), parameter)

    def at(self, event: str) -> Point:
        """Return the state at an event.

        Parameters
        ----------
        event : str
            One of `EVENTS`, `LANDING`, `SEPARATED` or `CUSP`.

        Raises
        ------
        ValueError
            For an unknown event.
        NoSuchEvent
            If the path has no such point.
        """
        if event not in (*EVENTS, LANDING, SEPARATED, CUSP):
            raise ValueError(f"event {event!r} is unknown; choose one of {', '.join(EVENTS)}")
        point: Point = getattr(self, event)
        return point

    def anchor(self, event: str) -> tuple[Point, float]:
        """Return the state at an event, and the slope there of the function that vanishes (see `excess_of`)."""
        if event not in self._anchors:
            self._anchors[event] = anchor_of(event, self.at(event))
        return self._anchors[event]

    def minima(self, event: str) -> list[Point]:
        """Return every minimum of the load ("pull_off") or of the displacement ("jump_out") along the path."""
        excess = excess_of(event)
        return [self.root(pair, excess) for pair in _sign_changes(self.points, excess, rising=True)]

    @cached_property
    def pull_off(self) -> Point:
        """The deepest minimum of the load along the path."""
        minima = self.minima("pull_off")
        if not minima:
            raise NoSuchEvent("the load has no minimum along the path")
        return min(minima, key=lambda p: p.state.load)

    @cached_property
    def jump_in(self) -> Point:
        """The first fold on approach, where displacement control jumps into contact."""
        maxima = _sign_changes(self.points, _displacement_rate, rising=False)
        if not maxima:
            raise NoSuchEvent(STIFF)
        return self.root(maxima[0], _displacement_rate)

    @cached_property
    def jump_out(self) -> Point:
        """The lowest fold, the last on retreat, where displacement control jumps out of contact."""
        minima = self.minima("jump_out")
        if not minima:
            raise NoSuchEvent(STIFF)
        return min(minima, key=lambda p: p.state.displacement)

    @cached_property
    def zero_load(self) -> Point:
        """The point in contact where the load changes from tension to compression."""
        found = self._rise_through(_load, _load_rate, 0.0, last=True)
        if found is None:
            raise NoSuchEvent("the load does not become compressive on the path")
        return found

    @cached_property
    def landing(self) -> Point:
        """The point in contact where the jump into contact ends."""
        return self._at_displacement(self.jump_in.state.displacement, last=True)

    @cached_property
    def separated(self) -> Point:
        """The point where the jump out of contact ends."""
        return self._at_displacement(self.jump_out.state.displacement, last=False)

    @cached_property
    def cusp(self) -> Point:
        """The point where the two folds merge, at the modulus at which they do; the path is one without folds.

        Raises
        ------
        NotConverged
            If the cusp is not found, or the path has a fold.
        """
        folds = [point for point in self.points if point.displacement_rate <= 0.0]
        if folds:
            raise NotConverged(
                f"the displacement has a fold near {folds[0].state.displacement:.6g}, where none should be"
            )
        return cusp_from(slowest(self.samples))

    @cached_property
    def jump_in_loss(self) -> float:
        """Energy lost by the jump into contact."""
        return event_energy(self.jump_in) - event_energy(self.landing)

    @cached_property
    def jump_out_loss(self) -> float:
        """Energy lost by the jump out of contact."""
        return event_energy(self.jump_out) - event_energy(self.separated)

    def _at_displacement(self, delta: float, last: bool) -> Point:
        """Return the first or the last point where the displacement rises through a value."""
        found = self._rise_through(_displacement, _displacement_rate, delta, last)
        if found is None:
            raise NoSuchEvent(f"the path does not reach the displacement {delta:.6g} on both branches")
        return found

    def _rise_through(
        self, value: Callable[[Point], float], rate: Callable[[Point], float], level: float, last: bool
    ) -> Point | None:
        """Find the first or the last point of a complete path where a value rises through a level.

        Between two neighbours is one turning point at most; where it may reach the level, it is located too.
        """

        def excess(point: Point) -> float:
            return value(point) - level

        pairs = _neighbours(self.points)
        for a, b in reversed(pairs) if last else pairs:
            before, after = excess(a), excess(b)
            if before < 0 <= after:
                return self.root((a, b), excess)
            if last and before >= 0 and after >= 0 and rate(a) < 0 <= rate(b):
                lowest = self.root((a, b), rate)
                if excess(lowest) < 0:
                    return self.root((lowest, b), excess)
            if not last and before < 0 and after < 0 and rate(a) > 0 >= rate(b):
                highest = self.root((a, b), rate)
                if excess(highest) >= 0:
                    return self.root((a, highest), excess)
        return None

    def root(self, pair: Pair, function: Callable[[Point], float]) -> Point:
        """Find the point between two neighbours where the function vanishes."""
        known = {pair[0].parameter: pair[0], pair[1].parameter: pair[1]}

        def value(parameter: float) -> float:
            if parameter not in known:
                nearest, second = sorted(known.values(), key=lambda p: abs(p.parameter - parameter))[:2]
                known[parameter] = self.between(nearest, second, parameter)
            return function(known[parameter])

        scale = max(abs(pair[0].parameter), abs(pair[1].parameter))
        root = float(
            brentq(value, pair[0].parameter, pair[1].parameter, xtol=ROOT_TOLERANCE * scale, rtol=4 * ROOT_TOLERANCE)
        )
        value(root)
        return known[root]


def anchor_of(event: str, point: Point) -> tuple[Point, float]:
    """Return the state at an event, and the slope there of the function that vanishes (see `excess_of`)."""
    if event in (LANDING, SEPARATED):
        return point, point.state.displacement_rate
    if event == "zero_load":
        return point, point.state.load_rate
    unit = point.parameter if point.branch.touching else point.branch.contact.law.z0
    near = point_at(point, point.parameter + SLOPE_STEP * unit)
    excess = excess_of(event)
    return point, (excess(near) - excess(point)) / (near.parameter - point.parameter)


def excess_of(event: str, level: float = 0.0) -> Callable[[Point], float]:
    """Return the function of a point that vanishes at an event.

    Parameters
    ----------
    event : str
        One of `EVENTS`, `LANDING` or `SEPARATED`.
    level : float
        Displacement at a landing or separation.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> excess_of("landing", level=1.0)(SimpleNamespace(state=SimpleNamespace(displacement=3.0)))
    2.0
    """
    value = {"pull_off": _load_rate, "jump_in": _displacement_rate, "jump_out": _displacement_rate, "zero_load": _load}
    rate = value.get(event, _displacement)
    return lambda point: rate(point) - level


def event_energy(point: Point) -> float:
    """Elastic plus surface energy at a point."""
    return point.branch.contact.energy(point.state.y)


def _load(point: Point) -> float:
    return point.state.load


def _load_rate(point: Point) -> float:
    return point.load_rate


def _displacement(point: Point) -> float:
    return point.state.displacement


def _displacement_rate(point: Point) -> float:
    return point.displacement_rate


def _neighbours(points: Sequence[Point]) -> list[Pair]:
    """Neighbours between which the path is smooth."""
    return [(a, b) for a, b in pairwise(points) if joined(a, b)]


def _sign_changes(points: Sequence[Point], sign: Callable[[Point], float], rising: bool) -> list[Pair]:
    """Neighbours between which `sign` changes from negative to positive (or back)."""
    factor = 1.0 if rising else -1.0
    return [(a, b) for a, b in _neighbours(points) if factor * sign(a) < 0 <= factor * sign(b)]
