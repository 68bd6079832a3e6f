"""Additional points of a path where the drawn curve of load over displacement turns."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from fscm._path.arc_length import Point, parameter_of
from fscm._path.events import Between
from fscm._surface.state import Rates, State

__all__ = ["turning_slowly"]

#: Largest number of halvings of an interval: the folds of the smallest observed loops need 4.
_MOST_HALVINGS = 6
#: A picture of the contact ends at a compression of this share of the pull-off force, and begins at this tension.
_SHOWN_COMPRESSION, _SHOWN_TENSION = 0.5, 0.05


def turning_slowly(points: Sequence[Point], degrees: float) -> list[Point]:
    """Insert equilibrium states until the tangent of load over displacement turns by less from point to point.

    Angles are those in a square plot of the part that carries tension, up to half the pull-off force.
    """
    units = _ranges([point.state for point in points])
    dense = [points[0]]
    for a, b in pairwise(points):
        if a.segment == b.segment:
            dense += _inside(a, b, Between(a, b), math.radians(degrees), units, _MOST_HALVINGS)
        dense.append(b)
    return dense


def _ranges(states: Sequence[State]) -> tuple[float, float]:
    depth = -min(state.load for state in states)
    drawn = [s for s in states if abs(s.load) > _SHOWN_TENSION * depth and s.load < _SHOWN_COMPRESSION * depth]
    displacements = [state.displacement for state in drawn or states]
    return (max(displacements) - min(displacements)) or 1.0, (1.0 + _SHOWN_COMPRESSION) * depth or 1.0


def _inside(
    a: Point, b: Point, between: Between, angle: float, units: tuple[float, float], halvings: int
) -> list[Point]:
    if halvings == 0 or _turn(a.rates, b.rates, units) <= angle:
        return []
    state, rates = between(0.5 * (parameter_of(a.state) + parameter_of(b.state)))
    middle = Point(state, rates.scaled(state.orientation), a.segment)
    before, after = (_inside(*ends, between, angle, units, halvings - 1) for ends in ((a, middle), (middle, b)))
    return [*before, middle, *after]


def _turn(a: Rates, b: Rates, units: tuple[float, float]) -> float:
    """Angle between two tangents, in [0, pi]."""
    (ax, ay), (bx, by) = ((rates.displacement / units[0], rates.load / units[1]) for rates in (a, b))
    return abs(math.atan2(ax * by - ay * bx, ax * bx + ay * by))
