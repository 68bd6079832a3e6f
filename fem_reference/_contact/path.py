"""The equilibrium path: before contact on one mesh, then in contact by the radius of the edge.

Before contact the central gap H0 falls, and the mesh is scaled so that the gap at its node s = 1 is a little larger
than H0: it follows the bottom of the gap even where contact nucleates on a spot much smaller than the punch.  When the
gap at s = 1 has fallen to the gap of the largest tension, a contact edge has formed at that node.  A solid whose
compliance holds at one size has one mesh before contact, and the edge is formed between its nodes.

In contact each radius of the edge has a state on a mesh that resolves its edge: it is that of the problem.  Where the
meshes scale, they share one compliance and have exact rates.  Otherwise the neighbours of a state tell its rates.  Two
states decide whether there are turning points between them.  The path goes on until load and displacement rise, the
load is compressive, and neither can turn back at a larger radius (`fem_reference._contact.jkr_tension`): a stiff layer
on a soft solid has one minimum of the load where the layer alone feels the contact, and another where the solid does.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from fem_reference._contact.completeness import ROUNDS, complete_branch, displacement_range, load_scale
from fem_reference._contact.contact import Contact
from fem_reference._contact.controls import CentralGap, GapRise, mesh_control
from fem_reference._contact.hermite import Interval, Sample
from fem_reference._contact.mesh_lengths import EDGE_RISE
from fem_reference._contact.states import (
    SIZE_STEP,
    Branch,
    Point,
    branches_of,
    contact_branch,
    continuation,
    edge_width,
    point_at,
)
from fem_reference._roots import root_between
from fem_reference._typing import Array
from fem_reference._wells import outermost_turn
from fem_reference.errors import Failure, NotConverged
from fem_reference.punch import kinks_of, radius_at_height

__all__ = [
    "BEYOND_LAST_TURN",
    "EDGE_RISE",
    "approach",
    "beginning",
    "completed",
    "contact_points",
    "filled",
    "interpolated",
    "separate_points",
    "traced",
    "with_rates",
]

#: Central gap where a path begins, in lengths of the law: the tension there is 1e-3 of its peak, Newton starts from no
#: load. A very soft solid has no equilibrium there that Newton reaches (measured: from a Tabor number of 2e4 on).
FARTHEST_GAP = 12.0

#: A law with a barrier has another well beyond: a path begins farther out by this multiple of its distance.
BEYOND_WELLS = 3.0

#: Ratio of one central gap to the next at which a path is begun, and the largest of them in lengths of the law: a few
#: Tabor numbers are enough, and those of 1e5 have edges that no mesh resolves.
FARTHER_START, FARTHEST_START = 4.0, 1e6

#: Lengths of the law by which a path begins below the displacement of its jump out of contact.
FARTHER = 2.0

#: Change of the logarithm of the radius from one state to the next, where each may need a mesh. The test of turning
#: points asks for none between on cones at mu = 3 whose modulus falls to a fifth below the surface, and each state is
#: found from the last.
LOG_STEP = 0.2

#: Least share of a step between the first radius and the next one, of a grid.
LEAST_STEP = 0.3

#: Change of delta in lengths of the law, and of P relative to the largest tension, below which two turning points are
#: not told from none. It is above what the meshes of the search leave of a state: at most 6e-5 of the largest tension
#: (measured between the degrees 4 and 6 under a cone at mu = 3 on a solid whose modulus falls to a third).
LARGEST_CHANGE = 1e-4

#: States that give the rate of one of them: the polynomial through five at a step of 0.2 has it to 4e-3 of the largest
#: tension (measured as for `with_rates`).
RATE_POINTS = 5

#: Ratio of the last radius to that beyond which neither load nor displacement turns back in the limit of a short range
#: of the law: its elements are a third of it long, and the range of the law moves the extremes by less.
BEYOND_LAST_TURN = 1.5

#: Distances of states from a kink, in widths of the edge: there the load changes within a width (under six rows and a
#: cohesive trapezoid, w/(E* R) = 0.3, by 0.3 of 49.8 within 0.2 of a radius of 13.3; the minimum was missed).
BESIDE_KINKS = 1.0, 3.0, 9.0

#: Distance from a kink of the punch, relative to its radius, at which a branch ends and the next begins.
BESIDE = 1e-9


def separate_points(contact: Contact) -> Iterator[Point]:
    """Trace the branch of the central gap from far away to the first contact edge."""
    length = contact.law.z0
    rise = EDGE_RISE * length
    size = radius_at_height(contact.punch, rise) if contact.compliance.scales else contact.compliance.size
    point = _farthest(Branch(contact, mesh_control(contact, GapRise(rise)), CentralGap, touching=False), size)
    yield point
    yield from continuation(point, -0.5 * length, contact.law.peak_gap - rise)


def _farthest(branch: Branch, size: float) -> Point:
    """The first state of a path: where the solid is hardly displaced."""
    law = branch.contact.law
    start = FARTHEST_GAP + BEYOND_WELLS * (outermost_turn(law) - law.peak_gap) / law.z0
    while True:
        gap = start * law.z0
        y = np.zeros(branch.contact.unknowns + 2)
        y[-2:] = -gap, size
        try:
            return branch.solve(gap, y)
        except NotConverged as error:
            start *= FARTHER_START
            if start > FARTHEST_START:
                raise NotConverged(
                    f"no equilibrium was found at central gaps of up to {FARTHEST_START:g} lengths of the law, where "
                    "the approach begins: the solid is too soft for the adhesion",
                    Failure.START,
                ) from error


def first_edge_radius(point: Point) -> float:
    """Innermost radius where the gap rises through the gap of peak tension.

    Raises
    ------
    NotConverged
        If the central gap is above it, or the edge is inside the innermost Gauss point.
    """
    contact, y = point.branch.contact, point.state.y
    trace, force = contact.compliance.trace, contact.force
    above = np.flatnonzero(contact.gap(y) > force.peak_gap(y[-1] * trace.s))
    if above.size == 0 or above[0] == 0:
        raise NotConverged("contact begins on a spot smaller than the mesh resolves", Failure.MESH)

    def excess(s: float) -> float:
        w = float(trace.evaluate(np.array([s]))[0] @ y[:-2])
        r = np.array(y[-1] * s)
        return -float(y[-2]) + float(contact.punch.height(r)) + w - float(force.peak_gap(r))

    return float(y[-1]) * root_between(excess, trace.s[above[0] - 1], trace.s[above[0]], 1e-14)


def approach(contact: Contact) -> tuple[list[Point], Point]:
    """Trace the path on one mesh from far away: return its points before contact, and the first one in contact.

    Raises
    ------
    NotConverged
        If the path cannot be followed.
    """
    points = list(separate_points(contact))
    last, radius = points[-1], points[-1].state.size
    if not contact.compliance.scales:
        radius = first_edge_radius(last)
    return points, contact_branch(contact).solve(radius, last.state.y)


def traced(contact: Contact) -> list[Point]:
    """Trace the path on one mesh until the load is compressive and every fold is on it, with the ends of the jumps.

    Raises
    ------
    NotConverged
        If the path cannot be followed.
    """
    separate, start = approach(contact)
    points = {start.parameter: start}

    def at(radius: float) -> Point:
        nearest = min(points.values(), key=lambda point: abs(point.parameter - radius))
        return points.setdefault(radius, point_at(nearest, radius))

    highest = displacement_range(separate)[1]
    touching = contact_points(at, start.parameter, kinks_of(contact.punch), highest, exact_rates=True)
    return [*beginning(separate, touching), *separate, *touching]


def contact_points(
    at: Callable[[float], Point],
    inner: float,
    kinks: Sequence[float],
    highest: float,
    last_turn: float = 0.0,
    exact_rates: bool = False,
    unit: float = math.nan,
) -> list[Point]:
    """Return states in contact, from the first edge until neither load nor displacement can turn back.

    Parameters
    ----------
    at : callable
        Returns the state with the contact edge at a radius.
    inner : float
        Radius of the first contact edge.
    kinks : sequence of float
        Radii where the slope of the punch jumps, and with it the rates along the path.
    highest : float
        Largest displacement before contact: the path goes on beyond it, where a jump from there ends.
    last_turn : float
        Radius beyond which neither load nor displacement can turn back.
    exact_rates : bool
        Whether the rates of a state are those of the path; otherwise its neighbours tell them.
    unit : float, optional
        A length of the problem: behind the first, radii are those of its grid, which is the same for another adhesion.

    Raises
    ------
    NotConverged
        If a state is not found.
    """
    points: list[Point] = []
    for radius in _radii(inner, kinks, math.log1p(SIZE_STEP) if exact_rates else LOG_STEP, unit):
        points.append(at(radius))
        if radius >= BEYOND_LAST_TURN * last_turn and len(points) >= RATE_POINTS and _settled(points, highest):
            break
    return points


def completed(at: Callable[[float], Point], points: Sequence[Point], exact_rates: bool = False) -> list[Point]:
    """Return states in contact with others between, so close that no pair of turning points is between two.

    Parameters
    ----------
    at, exact_rates
        As for `contact_points`.
    points : sequence of Point
        As it returns them.

    Raises
    ------
    NotConverged
        If a state is not found, or turning points cannot be excluded.
    """
    rates = list if exact_rates else with_rates
    length = points[0].branch.contact.law.z0
    scales = LARGEST_CHANGE * length, LARGEST_CHANGE * load_scale(points)
    tests = tuple(zip((_log_displacement_sample, _log_load_sample), scales, strict=True))

    def complete(branch: list[Point]) -> list[Point]:
        return complete_branch(rates(branch), tests, lambda _, log_radius: at(math.exp(log_radius)), rates)

    branches = [list(branch) for branch in branches_of(points)]
    if not exact_rates:
        last = len(branches) - 1
        branches = [_beside_kinks(at, filled(at, branch), i > 0, i < last) for i, branch in enumerate(branches)]
    branches = [complete(branch) for branch in branches]
    for _ in range(ROUNDS):
        turning = set() if exact_rates else _turning(branches, scales)
        if not turning:
            return [point for branch in branches for point in branch]
        branches = [
            complete(_halved(at, branch, (i - 1) in turning, i in turning)) for i, branch in enumerate(branches)
        ]
    radius = branches[min(turning)][-1].parameter
    raise NotConverged(
        f"it cannot be decided whether the path turns where the contact edge is at {radius:.6g}, next to a kink of the "
        "punch",
        Failure.FOLDS,
    )


def _turning(branches: Sequence[Sequence[Point]], scales: tuple[float, float]) -> set[int]:
    """Branches at the end of which the rates change their sign: that state is the first of the next branch, too.

    The edge passes a kink at another rate, so that rates change there, but not their signs.
    """
    turning = set()
    for i, (before, after) in enumerate(pairwise(branches)):
        for name, scale in zip(("displacement_rate", "load_rate"), scales, strict=True):
            left, right = (getattr(point, name) for point in (before[-1], after[0]))
            lengths = [
                abs(branch[j].parameter - branch[k].parameter) for branch, j, k in ((before, -1, -2), (after, 0, 1))
            ]
            if left * right < 0.0 and max(abs(left) * lengths[0], abs(right) * lengths[1]) > scale:
                turning.add(i)
    return turning


def _halved(at: Callable[[float], Point], branch: list[Point], first: bool, last: bool) -> list[Point]:
    """The branch with another state in its first or in its last interval."""
    if last and len(branch) > 1:
        branch = [*branch[:-1], at(_middle(branch[-2], branch[-1])), branch[-1]]
    if first and len(branch) > 1:
        branch = [branch[0], at(_middle(branch[0], branch[1])), *branch[1:]]
    return branch


def _middle(a: Point, b: Point) -> float:
    return math.sqrt(a.parameter * b.parameter)


def _log_displacement_sample(point: Point) -> Sample:
    """Displacement and its rate along the path in the logarithm of the radius."""
    return Sample(math.log(point.parameter), point.state.displacement, point.displacement_rate * point.parameter)


def _log_load_sample(point: Point) -> Sample:
    """Load and its rate along the path in the logarithm of the radius."""
    return Sample(math.log(point.parameter), point.state.load, point.load_rate * point.parameter)


def filled(at: Callable[[float], Point], branch: list[Point]) -> list[Point]:
    """Return a branch, or between two kinks that are close one with as many states as its rates need.

    Rates of three have the wrong sign where the load falls to a minimum near a kink: under a paraboloid of R = 20 z0 by
    12 rows at mu = 1 no minimum was seen at all.
    """
    low, high = math.log(branch[0].parameter), math.log(branch[-1].parameter)
    if len(branch) >= RATE_POINTS or low == high:
        return branch
    return [branch[0], *(at(math.exp(x)) for x in np.linspace(low, high, RATE_POINTS)[1:-1]), branch[-1]]


def _beside_kinks(at: Callable[[float], Point], branch: list[Point], first: bool, last: bool) -> list[Point]:
    """The branch with states beside the kinks at its ends, at multiples of the width of the edge.

    Within that width the edge feels what is beyond the kink, and the load may turn (see `BESIDE_KINKS`).
    """
    added = []
    for is_kink, end, neighbour in ((first, 0, 1), (last, -1, -2)):
        if is_kink and len(branch) > 1:
            span = math.log(branch[neighbour].parameter / branch[end].parameter)
            shares = [multiple * max(edge_width(branch[end]), 0.0) / abs(span) for multiple in BESIDE_KINKS]
            added += [at(branch[end].parameter * math.exp(share * span)) for share in shares if 0.0 < share < 0.5]
    return sorted([*branch, *added], key=lambda point: point.parameter)


def with_rates(points: list[Point]) -> list[Point]:
    """Give the states of one branch the rates of the polynomial through each and its neighbours.

    The rates of a state on its own mesh are those of an edge that moves over the elements: 1e-5 of a load within an
    element, which is a hundredth of the radius or less, are 1e-2 of its rate (measured: 0.16 for a coating of 1 GPa and
    100 nm on 1.5 MPa, whose loads follow each other to 4e-3).
    """
    x = np.log([point.parameter for point in points])
    values = np.array([[point.state.load, point.state.displacement] for point in points])
    renewed = []
    for i, point in enumerate(points):
        start = min(max(i - RATE_POINTS // 2, 0), max(len(points) - RATE_POINTS, 0))
        stencil = slice(start, start + RATE_POINTS)
        rates = _derivative_weights(x[stencil], x[i]) @ values[stencil] / point.parameter
        renewed.append(replace(point, rates=(float(rates[0]), float(rates[1]))))
    return renewed


def _derivative_weights(x: Array, at: float) -> Array:
    """Weights of values at x in the derivative of the polynomial through them."""
    unit = float(np.ptp(x)) or 1.0
    powers = np.vander((x - at) / unit, increasing=True).T
    return np.linalg.solve(powers, np.eye(x.size)[min(1, x.size - 1)] * (x.size > 1)) / unit


def _radii(inner: float, kinks: Sequence[float], step: float, unit: float) -> Iterator[float]:
    """Radii from the first contact edge on, and both sides of each kink."""
    radius, on_grid = inner, math.isfinite(unit)
    number = math.ceil(math.log(inner / unit) / step - 1.0 + LEAST_STEP) if on_grid else 0
    while True:
        yield radius
        number += 1
        following = unit * math.exp(step * number) if on_grid else radius * math.exp(step)
        for kink in sorted(kink for kink in kinks if radius * (1.0 + 2.0 * BESIDE) < kink < following):
            yield kink * (1.0 - BESIDE)
            yield kink * (1.0 + BESIDE)
        radius = following


def _settled(points: Sequence[Point], highest: float) -> bool:
    """Whether the load is compressive, and load and displacement have risen beyond every fold."""
    previous, newest = points[-2].state, points[-1].state
    rising = newest.load > max(previous.load, 0.0) and newest.displacement > previous.displacement
    folds = [a.state.displacement for a, b in pairwise(points) if b.state.displacement < a.state.displacement]
    return rising and newest.displacement >= max(highest, *folds, previous.displacement)


def interpolated(a: Point, b: Point, x: float) -> Point:
    """A point with the load and displacement between two neighbours, and their rates."""
    load, displacement = (Interval(sample(a), sample(b), []) for sample in (_log_load_sample, _log_displacement_sample))
    y, radius = a.state.y.copy(), math.exp(x)
    y[-2] = displacement.value_at(x)
    rates = load.rate_at(x) / radius, displacement.rate_at(x) / radius
    return replace(a, parameter=radius, state=replace(a.state, y=y, load=load.value_at(x)), rates=rates)


def beginning(approach: Sequence[Point], touching: Sequence[Point]) -> list[Point]:
    """Points before the first, out to the displacement where a jump out of contact ends."""
    outermost, length = approach[0], approach[0].branch.contact.law.z0
    falling = [i for i, point in enumerate(approach) if point.displacement_rate < 0]
    segments = (approach[falling[0] :] if falling else approach[-1:], touching)
    lowest = min(displacement_range(segment)[0] for segment in segments if segment)
    if lowest > outermost.state.displacement:
        return []
    # The solid rises under tension: the displacement is below -H0.
    farthest = FARTHER * length - lowest
    return list(continuation(outermost, farthest - outermost.parameter, farthest))[::-1]
