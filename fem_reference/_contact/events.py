"""Events of the equilibrium path, as roots of exact sensitivities.

A sign change of dP, d(delta) or P between two neighbouring points of the completed path brackets an event, and Brent's
method on the derivative from the bordered solve finds it to rounding.  No event is interpolated between points.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property
from itertools import count, pairwise

from fem_reference._contact.completeness import complete_path
from fem_reference._contact.contact import Contact
from fem_reference._contact.cusp import cusp_from, slowest
from fem_reference._contact.event_kinds import (
    CUSP,
    EVENTS,
    JUMP_IN,
    JUMP_OUT,
    LANDING,
    SEPARATED,
    Anchor,
    beginning_of,
    displacement,
    displacement_rate,
    excess_of,
    kind_of,
    load,
    load_rate,
    slope_at,
)
from fem_reference._contact.path import interpolated
from fem_reference._contact.states import Point, joined, point_at
from fem_reference._roots import root_between
from fem_reference.errors import Failure, NoSuchEvent, NotConverged

__all__ = ["Jump", "Pair", "PathEvents"]

#: Relative tolerance of the parameter at an event; P is stationary there and delta moves by as little.
ROOT_TOLERANCE = 1e-11

#: Why a solid has no jumps.
STIFF = "the displacement rises all along the path: this solid is too stiff for jumps"

#: Change of the logarithm of the radius for the slope of an interpolated function: it slows the secant method only.
LOG_SLOPE_STEP = 1e-3

Pair = tuple[Point, Point]

#: Names of the fold where a jump begins and of the point where it ends. Those of a further jump have a number, from 2
#: on and from outside to inside: "jump_in_2" and "landing_2", "jump_out_2" and "separated_2".
Jump = tuple[str, str]


class PathEvents:
    """The events of one traced path, each found once.

    Parameters
    ----------
    samples : sequence of Point
        The path; complete where `state_at` is given.
    state_at : callable, optional
        Returns the state with a radius of the edge, on a mesh that resolves it.
    """

    def __init__(self, samples: Sequence[Point], state_at: Callable[[float], Point] | None = None) -> None:
        self.samples, self._state_at = samples, state_at
        self._anchors: dict[str, Anchor] = {}
        self._slopes: dict[Point, float] = {}

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
        return tuple(complete_path(self.samples)) if self._state_at is None else self.samples

    def between(self, a: Point, b: Point, parameter: float) -> Point:
        """Return the state at a parameter between two neighbours."""
        if self._state_at is not None and a.branch.touching:
            rates = None if a.rates is None else interpolated(a, b, math.log(parameter)).rates
            return replace(self._state_at(parameter), rates=rates)
        return point_at(min(a, b, key=lambda point: abs(point.parameter - parameter)), parameter)

    def at(self, event: str) -> Point:
        """Return the state at an event.

        Parameters
        ----------
        event : str
            One of `EVENTS`, `LANDING`, `SEPARATED` or `CUSP`, or of the names in `jumps`.

        Raises
        ------
        ValueError
            For an unknown event.
        NoSuchEvent
            If the path has no such point.
        """
        if kind_of(event) not in (*EVENTS, LANDING, SEPARATED, CUSP):
            raise ValueError(f"event {event!r} is unknown; choose one of {', '.join(EVENTS)}")
        if event != kind_of(event):
            if event not in self._further:
                raise NoSuchEvent(f"the cycle of approach and retreat has no {event}")
            return self._further[event]
        point: Point = getattr(self, event)
        return point

    def anchor(self, event: str) -> Anchor:
        """Return an event as other meshes begin with it."""
        if event not in self._anchors:
            point = self.at(event)
            self._anchors[event] = Anchor(point, self.slope(event, point))
        return self._anchors[event]

    def slope(self, event: str, point: Point) -> float:
        """Return the derivative, at an event, of the function that vanishes there."""
        return self._slopes[point] if point in self._slopes else slope_at(event, point)

    def relocate(self, event: str, anchor: Anchor) -> None:
        """Move an event to its state on the mesh that is fine at its edge, which the path has within its error."""
        (vars(self) if event == kind_of(event) else self._further)[event] = anchor.point
        self._slopes[anchor.point], self._anchors[event] = anchor.slope, anchor

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
        deepest = min(minima, key=lambda p: p.state.load)
        if not deepest.state.load < 0.0:
            raise NoSuchEvent("no state on the path carries tension: nothing is to be pulled off")
        return deepest

    @cached_property
    def jump_in(self) -> Point:
        """The first fold on approach, where displacement control jumps into contact."""
        maxima = _sign_changes(self.points, displacement_rate, rising=False)
        if not maxima:
            raise NoSuchEvent(STIFF)
        return self.root(maxima[0], displacement_rate)

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
        zero = self._rise_through(_neighbours(self.points), load, load_rate, 0.0, outermost=True)
        if zero is None:
            raise NoSuchEvent("the load does not become compressive on the path")
        return zero

    @cached_property
    def landing(self) -> Point:
        """The point where the jump into contact ends."""
        return self._landing(self.jump_in, inwards=True)

    @cached_property
    def separated(self) -> Point:
        """The point where the jump out of contact ends."""
        return self._landing(self.jump_out, inwards=False)

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
                f"the displacement has a fold near {folds[0].state.displacement:.6g}, where none should be",
                Failure.EVENT,
            )
        return cusp_from(slowest(self.samples))

    @cached_property
    def jumps(self) -> tuple[Jump, ...]:
        """Every jump of a cycle of approach and retreat under displacement control.

        On approach the state lands on the next branch inwards that has the displacement of the fold, and jumps again
        at the end of that branch, if it has one.  On retreat it does the same outwards, from the innermost branch on.
        """
        further = [(begin, name) for name in self._further if (begin := beginning_of(name)) is not None]
        return ((JUMP_IN, LANDING), (JUMP_OUT, SEPARATED), *further)

    @cached_property
    def _further(self) -> dict[str, Point]:
        """Folds and ends of the jumps but the first on approach and the last on retreat, by their names."""
        maxima = _sign_changes(self.points, displacement_rate, rising=False)
        minima = _sign_changes(self.points, displacement_rate, rising=True)
        points: dict[str, Point] = {}
        if len(maxima) > 1:
            for number, (fold, end) in zip(count(2), self._later_on_approach(maxima), strict=False):
                points |= {f"{JUMP_IN}_{number}": fold, f"{LANDING}_{number}": end}
        if len(minima) > 1:
            for number, (fold, end) in zip(count(2), reversed(self._earlier_on_retreat(minima)), strict=False):
                points |= {f"{JUMP_OUT}_{number}": fold, f"{SEPARATED}_{number}": end}
        return points

    def _later_on_approach(self, maxima: Sequence[Pair]) -> list[Pair]:
        """Fold and end of each jump on approach after the first."""
        jumps, end = [], self.landing
        while inside := [pair for pair in maxima if _path_order(pair[1]) > _path_order(end)]:
            fold = self.root(inside[0], displacement_rate)
            end = self._landing(fold, inwards=True)
            jumps.append((fold, end))
        return jumps

    def _earlier_on_retreat(self, minima: Sequence[Pair]) -> list[Pair]:
        """Fold and end of each jump on retreat before the last.

        Raises
        ------
        NotConverged
            If another fold is as low as the last one, within the error of a path over several meshes.
        """
        outermost = min(minima, key=lambda pair: _distance(pair, self.jump_out))
        jumps: list[Pair] = []
        outside = list(minima)
        while outside and outside[-1] != outermost:
            fold = self.root(outside[-1], displacement_rate)
            end = self._landing(fold, inwards=False)
            jumps.append((fold, end))
            outside = [pair for pair in minima if _path_order(pair[0]) < _path_order(end)]
        if not outside:
            raise NotConverged(
                f"two folds near delta = {self.jump_out.state.displacement:.6g} are equally low within the error of "
                "the path: which of them is the last on retreat is not decided",
                Failure.FOLDS,
            )
        return jumps

    def _landing(self, fold: Point, inwards: bool) -> Point:
        """Return the nearest point inwards or outwards of a fold where the displacement rises through that of it."""
        delta, position = fold.state.displacement, _path_order(fold)
        pairs = [
            (a, b)
            for a, b in _neighbours(self.points)
            if (_path_order(a) >= position if inwards else _path_order(b) <= position)
        ]
        landing = self._rise_through(pairs, displacement, displacement_rate, delta, outermost=not inwards)
        if landing is None:
            raise NoSuchEvent(f"the path does not reach the displacement {delta:.6g} on both branches")
        return landing

    def _rise_through(
        self,
        pairs: Sequence[Pair],
        value: Callable[[Point], float],
        rate: Callable[[Point], float],
        level: float,
        outermost: bool,
    ) -> Point | None:
        """Find the first or the last point of a part of a complete path where a value rises through a level.

        Between two neighbours is one turning point at most; where it may reach the level, it is located too.
        """

        def excess(point: Point) -> float:
            return value(point) - level

        for a, b in reversed(pairs) if outermost else pairs:
            before, after = excess(a), excess(b)
            if before < 0 <= after:
                return self.root((a, b), excess)
            if outermost and before >= 0 and after >= 0 and rate(a) < 0 <= rate(b):
                lowest = self.root((a, b), rate)
                if excess(lowest) < 0:
                    return self.root((lowest, b), excess)
            if not outermost and before < 0 and after < 0 and rate(a) > 0 >= rate(b):
                highest = self.root((a, b), rate)
                if excess(highest) >= 0:
                    return self.root((a, highest), excess)
        return None

    def root(self, pair: Pair, function: Callable[[Point], float]) -> Point:
        """Find the point between two neighbours where the function vanishes.

        Where the neighbours tell the rates, the cubic through both has it.
        """
        if pair[0].rates is not None:
            return self._interpolated_root(*pair, function)
        solved = {pair[0].parameter: pair[0], pair[1].parameter: pair[1]}

        def value(parameter: float) -> float:
            if parameter not in solved:
                nearest, second = sorted(solved.values(), key=lambda p: abs(p.parameter - parameter))[:2]
                solved[parameter] = self.between(nearest, second, parameter)
            return function(solved[parameter])

        scale = max(abs(pair[0].parameter), abs(pair[1].parameter))
        root = root_between(value, pair[0].parameter, pair[1].parameter, ROOT_TOLERANCE * scale, 4.0 * ROOT_TOLERANCE)
        value(root)
        return solved[root]

    def _interpolated_root(self, a: Point, b: Point, function: Callable[[Point], float]) -> Point:
        def value(x: float) -> float:
            return function(interpolated(a, b, x))

        x = root_between(value, math.log(a.parameter), math.log(b.parameter))
        point = self.between(a, b, math.exp(x))
        slope = (value(x + LOG_SLOPE_STEP) - value(x - LOG_SLOPE_STEP)) / (2.0 * LOG_SLOPE_STEP)
        self._slopes[point] = slope / point.parameter
        return point


def _path_order(point: Point) -> tuple[bool, float]:
    """Place along the path: it grows from far away into contact."""
    return point.branch.touching, point.orientation * point.parameter


def _distance(pair: Pair, point: Point) -> float:
    """How far outside an interval a point is; 0 inside."""
    (touching, low), (_, high), (at, position) = (_path_order(end) for end in (*pair, point))
    return max(low - position, position - high, 0.0) if touching == at else math.inf


def _neighbours(points: Sequence[Point]) -> list[Pair]:
    """Neighbours between which the path is smooth."""
    return [(a, b) for a, b in pairwise(points) if joined(a, b)]


def _sign_changes(points: Sequence[Point], sign: Callable[[Point], float], rising: bool) -> list[Pair]:
    """Neighbours between which `sign` changes from negative to positive (or back)."""
    factor = 1.0 if rising else -1.0
    return [(a, b) for a, b in _neighbours(points) if factor * sign(a) < 0 <= factor * sign(b)]
