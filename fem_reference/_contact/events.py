"""Events of the equilibrium path, as roots of exact sensitivities.

A sign change of dP, d(delta) or P between two neighbouring points brackets an event, and Brent's method on the
derivative from the bordered solve finds it to rounding.  No event is interpolated between points.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property
from itertools import pairwise

from scipy.optimize import brentq

from fem_reference._contact.path import Point, continuation
from fem_reference.errors import NoSuchEvent

__all__ = ["EVENTS", "LANDING", "PathEvents", "beyond_pull_off"]

ROOT_TOLERANCE = 1e-11
"""Relative tolerance of the parameter at an event; P is stationary there and delta moves by as little."""

EVENTS = ("pull_off", "jump_in", "jump_out", "zero_load")
"""Events of the path: the deepest minimum of the load, the two folds of displacement control, and the point in contact
where the load changes from tension to compression."""

LANDING = "landing"
"""The point in contact at the displacement of the jump into contact: where that jump ends."""

Pair = tuple[Point, Point]


def beyond_pull_off(event: str) -> bool:
    """Whether an event lies on the path beyond the pull-off, where the edge is sharper relative to its radius."""
    return event in ("zero_load", LANDING)


class PathEvents:
    """The events of one traced path, each found once.

    Parameters
    ----------
    points : sequence of Point
        As `fem_reference._contact.path.traced` returns them.
    """

    def __init__(self, points: Sequence[Point]) -> None:
        self.points = points

    def at(self, event: str) -> Point:
        """Return the state at an event.

        Parameters
        ----------
        event : str
            One of `EVENTS`, or `LANDING`.

        Raises
        ------
        ValueError
            For an unknown event.
        NoSuchEvent
            If the path has no such point.
        """
        if event not in (*EVENTS, LANDING):
            raise ValueError(f"event {event!r} is unknown; choose one of {', '.join(EVENTS)}")
        point: Point = getattr(self, event)
        return point

    @cached_property
    def pull_off(self) -> Point:
        """The deepest minimum of the load along the path."""
        minima = [_root(pair, lambda p: p.load_rate) for pair in self._pairs(lambda p: p.load_rate, True)]
        if not minima:
            raise NoSuchEvent("the load has no minimum along the path")
        return min(minima, key=lambda p: p.state.load)

    @cached_property
    def _folds(self) -> tuple[list[Pair], list[Pair]]:
        """Brackets of the maxima and the minima of the displacement."""
        maxima = self._pairs(lambda p: p.displacement_rate, False)
        minima = self._pairs(lambda p: p.displacement_rate, True)
        if not maxima or not minima:
            raise NoSuchEvent("the displacement rises all along the path: this solid is too stiff for jumps")
        return maxima, minima

    @cached_property
    def jump_in(self) -> Point:
        """The fold where displacement control jumps into contact."""
        return _root(self._folds[0][0], lambda p: p.displacement_rate)

    @cached_property
    def jump_out(self) -> Point:
        """The fold where displacement control jumps out of contact."""
        minima = [_root(pair, lambda p: p.displacement_rate) for pair in self._folds[1]]
        return min(minima, key=lambda p: p.state.displacement)

    @cached_property
    def zero_load(self) -> Point:
        """The point in contact where the load changes from tension to compression."""
        pairs = self._pairs(lambda p: p.state.load, True)
        if not pairs:
            raise NoSuchEvent("the load does not become compressive on the path")
        return _root(pairs[-1], lambda p: p.state.load)

    @cached_property
    def landing(self) -> Point:
        """The point in contact where the jump into contact ends."""
        return self._at_displacement(self.jump_in.state.displacement, last=True)

    @cached_property
    def jump_in_loss(self) -> float:
        """Energy lost by the jump into contact."""
        return _energy(self.jump_in) - _energy(self.landing)

    @cached_property
    def jump_out_loss(self) -> float:
        """Energy lost by the jump out of contact."""
        return _energy(self.jump_out) - _energy(self._at_displacement(self.jump_out.state.displacement, last=False))

    def _at_displacement(self, delta: float, last: bool) -> Point:
        """Return the first or the last point of the path at a displacement."""
        pairs = self._pairs(lambda p: p.state.displacement - delta, True)
        if not pairs:
            raise NoSuchEvent(f"the path does not reach the displacement {delta:.6g} on both branches")
        return _root(pairs[-1 if last else 0], lambda p: p.state.displacement - delta)

    def _pairs(self, sign: Callable[[Point], float], rising: bool) -> list[Pair]:
        """Neighbours on one branch between which `sign` changes from negative to positive (or back)."""
        pairs = []
        for a, b in pairwise(self.points):
            if a.branch is not b.branch:
                continue
            before, after = (sign(a), sign(b)) if rising else (-sign(a), -sign(b))
            if before < 0 <= after:
                pairs.append((a, b))
        return pairs


def _root(pair: Pair, function: Callable[[Point], float]) -> Point:
    """Find the point between two neighbours where the function vanishes."""
    known = {pair[0].parameter: pair[0], pair[1].parameter: pair[1]}

    def value(parameter: float) -> float:
        if parameter not in known:
            nearest = min(known.values(), key=lambda p: abs(p.parameter - parameter))
            step = parameter - nearest.parameter
            *_, known[parameter] = continuation(nearest, step, parameter)
        return function(known[parameter])

    scale = max(abs(pair[0].parameter), abs(pair[1].parameter))
    root = float(
        brentq(value, pair[0].parameter, pair[1].parameter, xtol=ROOT_TOLERANCE * scale, rtol=4 * ROOT_TOLERANCE)
    )
    value(root)
    return known[root]


def _energy(point: Point) -> float:
    return point.branch.contact.energy(point.state.y)
