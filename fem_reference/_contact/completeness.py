"""Completeness of a traced path: samples so close that no pair of turning points of delta or P is between two.

The parameter, delta, P and the derivatives of both are known at each sample.  `fem_reference._contact.hermite` decides
from them, and from the neighbours on the same branch, how many turning points an interval has.  A sample is inserted
where it cannot decide, and between two turning points; then a change of sign of the derivative marks each of them.
What is assumed: the fourth derivative inside an interval is at most twice the one that its neighbours show.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

from fem_reference._contact.hermite import Interval, Sample
from fem_reference._contact.states import Point, branches_of, point_at
from fem_reference._wells import work_of_tension
from fem_reference.errors import Failure, NotConverged
from fem_reference.punch import radius_at_height

__all__ = [
    "ROUNDS",
    "complete_branch",
    "complete_path",
    "displacement_range",
    "displacement_sample",
    "load_sample",
    "load_scale",
]

#: Change of delta in lengths of the law, and of P in units of its largest tension, below which two turning points are
#: not told from none: ten times the rounding of a state.
SMALLEST_CHANGE = 1e-9

#: Tension of a path, relative to that of the law over the area where the punch is below its range, that is rounding:
#: a barrier may press on the whole path.
NO_TENSION = 1e-9

#: Largest number of passes over the path; each halves the intervals that are undecided.
ROUNDS = 14


def displacement_sample(point: Point) -> Sample:
    """Displacement and its rate along the path at a point."""
    return Sample(point.parameter, point.state.displacement, point.orientation * point.displacement_rate)


def load_sample(point: Point) -> Sample:
    """Load and its rate along the path at a point."""
    return Sample(point.parameter, point.state.load, point.orientation * point.load_rate)


def load_scale(points: Sequence[Point]) -> float:
    """Return the largest tension of a path; where none of its states carries tension, that of the law over a spot."""
    contact = points[0].branch.contact
    law, tension = contact.law, -min(point.state.load for point in points)
    area = math.pi * radius_at_height(contact.punch, law.z0) ** 2
    unit = area * work_of_tension(law) / law.z0
    return tension if tension > NO_TENSION * unit else unit


def _intervals(points: Sequence[Point], sample: Callable[[Point], Sample]) -> list[Interval]:
    """Intervals between neighbours of one branch."""
    samples = [sample(point) for point in points]
    return [
        Interval(a, b, [*samples[max(i - 1, 0) : i], *samples[i + 2 : i + 3]])
        for i, (a, b) in enumerate(pairwise(samples))
    ]


def displacement_range(points: Sequence[Point]) -> tuple[float, float]:
    """Return the smallest and the largest displacement along a part of a path, between its samples as well.

    Parameters
    ----------
    points : sequence of Point
        Neighbours, at least one.
    """
    ranges = [
        interval.range() for branch in branches_of(points) for interval in _intervals(branch, displacement_sample)
    ]
    end = points[-1].state.displacement
    return min([end, *(low for low, _ in ranges)]), max([end, *(high for _, high in ranges)])


def _missing(interval: Interval, tolerance: float) -> float | None:
    """Return where a sample is needed, or None."""
    middle = 0.5 * (interval.first.parameter + interval.second.parameter)
    if not interval.decided(tolerance):
        return middle
    turns = interval.turns()
    if len(turns) == 2:
        rise = abs(interval.value_at(turns[1]) - interval.value_at(turns[0]))
        return 0.5 * float(turns[0] + turns[1]) if rise > tolerance else None
    return None


def complete_path(points: Sequence[Point]) -> list[Point]:
    """Insert samples until a pair of turning points of delta or P between two neighbours is excluded.

    Parameters
    ----------
    points : sequence of Point
        A path, as `fem_reference._contact.path.traced` returns it.

    Returns
    -------
    list of Point
        The samples with those inserted, in the order of the path.

    Raises
    ------
    NotConverged
        If that needs more than `ROUNDS` passes, or if the load or the displacement turns where two branches meet.
    """
    length = points[0].branch.contact.law.z0
    scale = load_scale(points)
    tests = ((displacement_sample, SMALLEST_CHANGE * length), (load_sample, SMALLEST_CHANGE * scale))
    branches = branches_of(points)
    for before, after in pairwise(branches):
        a, b = before[-1], after[0]
        # Turning points are sought within the branches: one between them would be missed.
        if a.load_rate * b.load_rate < 0.0 or a.displacement_rate * b.displacement_rate < 0.0:
            raise NotConverged(
                f"the path turns at delta = {a.state.displacement:.6g}, where the contact edge is formed and this mesh "
                "does not resolve it",
                Failure.MESH,
            )
    return [point for branch in branches for point in complete_branch(branch, tests)]


def complete_branch(
    points: list[Point],
    tests: Sequence[tuple[Callable[[Point], Sample], float]],
    inserted: Callable[[Point, float], Point] = point_at,
    renewed: Callable[[list[Point]], list[Point]] = list,
) -> list[Point]:
    """Insert samples in one branch.

    Parameters
    ----------
    points : list of Point
        With one kind of parameter.
    tests : sequence of (callable, float)
        What must have no pair of turning points between two samples, and the change that is none.
    inserted : callable
        Returns the point at a parameter from the nearest sample.
    renewed : callable
        Returns the points with the rates that follow from them.

    Raises
    ------
    NotConverged
        If that needs more than `ROUNDS` passes.
    """
    for _ in range(ROUNDS):
        inserted_at: dict[int, float] = {}
        for sample, tolerance in tests:
            for i, interval in enumerate(_intervals(points, sample)):
                parameter = _missing(interval, tolerance)
                if parameter is not None:
                    inserted_at.setdefault(i, parameter)
        if not inserted_at:
            return points
        refined: list[Point] = []
        for i, point in enumerate(points):
            refined.append(point)
            if i in inserted_at:
                nearest = min(points[i : i + 2], key=lambda end: abs(end.parameter - inserted_at[i]))
                refined.append(inserted(nearest, inserted_at[i]))
        points = renewed(refined)
    at = points[min(inserted_at)].state.displacement
    raise NotConverged(
        f"near delta = {at:.6g} it cannot be decided whether the path has a pair of turning points, although "
        f"{len(points)} samples were taken",
        Failure.FOLDS,
    )
