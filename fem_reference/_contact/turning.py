"""Additional points of a path where the drawn curve of load over displacement turns."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from fem_reference._contact.events import PathEvents
from fem_reference._contact.states import Point, joined

__all__ = ["turning_slowly"]

#: Largest number of times that an interval is halved.
HALVINGS = 6

#: The part of the path that is drawn: up to this compression, and from this tension on, relative to the largest one.
SHOWN_COMPRESSION, SHOWN_TENSION = 0.5, 0.05


def turning_slowly(path: PathEvents, degrees: float) -> list[Point]:
    """Insert points where the tangent of load over displacement turns by more from one to the next.

    Parameters
    ----------
    path : PathEvents
    degrees : float
        Largest angle, in a square picture of the part that carries tension.

    Returns
    -------
    list of Point
        With those inserted, in the order of the path.
    """
    points = path.points
    units = _ranges(points)
    denser = [points[0]]
    for a, b in pairwise(points):
        if joined(a, b):
            denser += _inside(path, a, b, math.radians(degrees), units, HALVINGS)
        denser.append(b)
    return denser


def _ranges(points: Sequence[Point]) -> tuple[float, float]:
    """Lengths of the axes of the picture."""
    depth = -min(p.state.load for p in points)
    drawn = [p for p in points if abs(p.state.load) > SHOWN_TENSION * depth > 0.0]
    displacements = [p.state.displacement for p in drawn if p.state.load < SHOWN_COMPRESSION * depth]
    return (max(displacements) - min(displacements)) or 1.0, (1.0 + SHOWN_COMPRESSION) * depth


def _inside(
    path: PathEvents, a: Point, b: Point, angle: float, units: tuple[float, float], halvings: int
) -> list[Point]:
    """Points between two neighbours of one branch."""
    if halvings == 0 or _turn(a, b, units) <= angle:
        return []
    middle = path.between(a, b, 0.5 * (a.parameter + b.parameter))
    before, after = (_inside(path, *ends, angle, units, halvings - 1) for ends in ((a, middle), (middle, b)))
    return [*before, middle, *after]


def _turn(a: Point, b: Point, units: tuple[float, float]) -> float:
    """Angle between the tangents at two points, in [0, pi]."""
    (ax, ay), (bx, by) = ((p.displacement_rate / units[0], p.load_rate / units[1]) for p in (a, b))
    return abs(math.atan2(ax * by - ay * bx, ax * bx + ay * by))
