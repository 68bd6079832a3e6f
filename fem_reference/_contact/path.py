"""The equilibrium path on one mesh, in one parameter, which changes in one sense only.

Before contact the central gap H0 falls, and the mesh is scaled so that the gap at its node s = 1 is a little
larger than H0: it follows the bottom of the gap even where contact nucleates on a spot much smaller than the
punch.  When the gap at s = 1 has fallen to the gap of the largest tension, a contact edge has formed at
that node, and the path continues in the radius c of the edge.  P and delta are smooth functions of H0 and then
of c, through both folds.

A solid whose modulus is not a power law has a compliance for one size only.  There the mesh is fixed, and
the edge moves over it.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
from scipy.optimize import brentq

from fem_reference._contact.completeness import displacement_range
from fem_reference._contact.contact import Contact
from fem_reference._contact.controls import CentralGap, Control, EdgeGap, EdgeRadius, GapRise, Size
from fem_reference._contact.states import Branch, Point, continuation
from fem_reference._elastic.compliance import FixedCompliance
from fem_reference._wells import outermost_turn
from fem_reference.errors import Failure, NotConverged
from fem_reference.punch import kinks_of, radius_at_height

__all__ = ["BESIDE", "EDGE_RISE", "beginning", "equilibrium_points", "traced"]

#: Central gap where a path begins, in lengths of the law: the tension there is 1e-3 of its peak, Newton starts from no
#: load. A very soft solid has no equilibrium there that Newton reaches (measured: from a Tabor number of 2e4 on).
FARTHEST_GAP = 12.0

#: A law with a barrier has another well beyond: a path begins farther out by this multiple of its distance.
BEYOND_WELLS = 3.0

#: Ratio of one central gap to the next at which a path is begun, and the largest of them in lengths of the law: a few
#: Tabor numbers are enough, and those of 1e5 have edges that no mesh resolves.
FARTHER_START, FARTHEST_START = 4.0, 1e6

#: Gap at the node s = 1 above the central gap before contact, in lengths of the law: small, so that the edge is the
#: parameter before any pull-off (a flat punch, n = 5 and more, pulls off 0.1 z0 below the gap of peak tension).
EDGE_RISE = 0.05

#: Distance from a kink of the punch, relative to its radius, at which a branch ends and the next begins.
BESIDE = 1e-9

#: Lengths of the law by which a path begins below the displacement of its jump out of contact.
FARTHER = 2.0


def approach_branch(contact: Contact) -> Iterator[Point]:
    """Trace the branch of the central gap from far away to the first contact edge."""
    length = contact.law.z0
    fixed: Control
    if isinstance(contact.compliance, FixedCompliance):
        size = contact.compliance.size
        fixed = Size(size)
    else:
        size = radius_at_height(contact.punch, EDGE_RISE * length)
        fixed = GapRise(EDGE_RISE * length)
    point = _farthest(Branch(contact, fixed, CentralGap, touching=False), size)
    yield point
    yield from continuation(point, -0.5 * length, contact.law.peak_gap - EDGE_RISE * length)


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


def contact_branch(separate: Point, largest: float) -> Iterator[Point]:
    """Trace the branch of the contact edge from the last point before contact out to the radius `largest`."""
    contact = separate.branch.contact
    if not isinstance(contact.compliance, FixedCompliance):
        point = Branch(contact, EdgeGap(), Size, touching=True).solve(separate.state.size, separate.state.y)
        yield point
        yield from continuation(point, 0.05 * point.parameter, largest)
        return
    size = contact.compliance.size
    largest = min(largest, 0.5 * contact.compliance.trace.extent * size)
    radius, y = first_edge_radius(separate), separate.state.y
    # The path is smooth, but its derivatives with respect to the radius of the edge jump at a kink.
    kinks = [r for r in kinks_of(contact.punch) if radius * (1.0 + 2.0 * BESIDE) < r < largest]
    for end in (*kinks, math.inf):
        branch = Branch(contact, Size(size), EdgeRadius, touching=True)
        point = branch.solve(radius, y)
        yield point
        for following in continuation(point, 0.05 * point.parameter, min(largest, end * (1.0 - BESIDE))):
            yield following
            point = following
        radius, y = end * (1.0 + BESIDE), point.state.y


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

    return float(y[-1]) * float(brentq(excess, trace.s[above[0] - 1], trace.s[above[0]], xtol=1e-14))


def equilibrium_points(contact: Contact) -> Iterator[Point]:
    """Trace the whole equilibrium path from far away into contact, until the consumer stops."""
    point: Point | None = None
    for point in approach_branch(contact):
        yield point
    if point is not None:
        yield from contact_branch(point, 1e3 * radius_at_height(contact.punch, contact.law.z0))


def traced(contact: Contact) -> list[Point]:
    """Trace the path until the load is compressive again and every fold is on it, with the ends of both jumps.

    Parameters
    ----------
    contact : Contact
        The problem on one mesh.

    Returns
    -------
    list of Point
        In the order of the path, from far away into compression.

    Raises
    ------
    NotConverged
        If the path cannot be followed.
    """
    approach: list[Point] = []
    touching: list[Point] = []
    for point in equilibrium_points(contact):
        (touching if point.branch.touching else approach).append(point)
        settled = point.state.load > 0 and point.displacement_rate > 0 and point.load_rate > 0
        # After a jump-in, the contact branch at the displacement of the jump belongs to the hysteresis cycle.
        if touching and settled and point.state.displacement >= _highest_fold(approach, touching):
            break
    return [*beginning(approach, touching), *approach, *touching]


def _highest_fold(approach: Sequence[Point], touching: Sequence[Point]) -> float:
    """Bound of the displacements at which it turns from rising to falling."""
    falling = [i for i, point in enumerate(touching) if point.displacement_rate < 0]
    to_last_fold = touching[: falling[-1] + 1] if falling else touching[:1]
    return max(displacement_range(approach)[1], displacement_range(to_last_fold)[1])


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
