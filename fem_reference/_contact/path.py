"""Continuation of the equilibrium path in one parameter, which changes in one sense only.

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
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq

from fem_reference._contact.contact import Contact
from fem_reference._contact.controls import CentralGap, Control, EdgeGap, EdgeRadius, GapRise, Size
from fem_reference._contact.newton import State, newton
from fem_reference._elastic.compliance import FixedCompliance
from fem_reference._typing import Array
from fem_reference.errors import NotConverged
from fem_reference.punch import kinks_of, radius_at_height

__all__ = [
    "BESIDE",
    "EDGE_RISE",
    "NARROWER",
    "WIDTH_SHARE",
    "Branch",
    "Point",
    "approach_branch",
    "branches_of",
    "contact_branch",
    "continuation",
    "edge_is_resolved",
    "edge_width",
    "element_length",
    "equilibrium_points",
    "first_edge_radius",
    "joined",
    "point_at",
]


#: Central gap where a path begins, in lengths of the law: the tension there is 1e-3 of its peak, Newton starts from no
#: load. A very soft solid has no equilibrium there that Newton reaches (measured: from a Tabor number of 2e4 on).
FARTHEST_GAP = 12.0

#: Ratio of one central gap to the next at which a path is begun, and the largest of them in lengths of the law: a few
#: Tabor numbers are enough, and those of 1e5 have edges that no mesh resolves.
FARTHER_START, FARTHEST_START = 4.0, 1e6

#: Gap at the node s = 1 above the central gap before contact, in lengths of the law: small, so that the edge is the
#: parameter before any pull-off (a flat punch, n = 5 and more, pulls off 0.1 z0 below the gap of peak tension).
EDGE_RISE = 0.05

#: Largest step of the central gap, relative to the length of the law plus H0.
GAP_STEP = 0.2

#: Largest relative step of the edge radius: P and delta change by a few per cent of their range.
SIZE_STEP = 0.1

#: Distance from a kink of the punch, relative to its radius, at which a branch ends and the next begins.
BESIDE = 1e-9

#: Resolved edge width relative to the length over which the gap rises by the length of the law at the edge.
WIDTH_SHARE = 0.18

#: Ratio of edge widths from one mesh to the next where the width is not known.
NARROWER = 0.25

#: Ratio of the steepest slope of the gap to that at peak tension which the meshes of an edge resolve as they are.
STEEPER = 4.0

#: Step, relative to the largest, below which the path ends with NotConverged.
SMALLEST_STEP = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Branch:
    """A part of the path under one pair of controls: `fixed`, and `family` of the parameter."""

    contact: Contact
    fixed: Control
    family: Callable[[float], Control]
    touching: bool

    def solve(self, parameter: float, y: Array) -> Point:
        """Solve at a parameter from a starting vector."""
        return Point(self, parameter, newton(self.contact, y, self.fixed, self.family(parameter)))

    def largest_step(self, parameter: float) -> float:
        """Largest sensible step of the parameter."""
        if self.touching:
            return SIZE_STEP * parameter
        return GAP_STEP * (self.contact.law.z0 + max(parameter, 0.0))


@dataclass(frozen=True, slots=True, eq=False)
class Point:
    """A state with the branch and the parameter it belongs to.

    Attributes
    ----------
    rates : tuple of (float, float), optional
        Changes of P and delta per unit of the parameter, where those of the state are not taken: along a path over
        several meshes.
    held : bool
        Whether the parameter is kept on other meshes.  The point is an extremum by the values of its neighbours on
        similar meshes, where its own rate, of a narrow edge that moves over elements, does not tell; or a jump ends
        there that begins at an edge for which the mesh is not fine.
    """

    branch: Branch
    parameter: float
    state: State
    rates: tuple[float, float] | None = None
    held: bool = False

    def predict(self, parameter: float, before: Point | None = None) -> Array:
        """Extrapolate the state along its tangent, or by the cubic through it and the point before.

        The size at most halves or doubles.
        """
        step = parameter - self.parameter
        y = self.state.y + step * self.state.rate
        if before is not None:
            # Terms of Newton's form, with both points double.
            length = self.parameter - before.parameter
            chord = (self.state.y - before.state.y) / length
            second = (self.state.rate - chord) / length
            third = (self.state.rate - 2.0 * chord + before.state.rate) / length**2
            y += step**2 * (second + (step + length) * third)
        y[-1] = np.clip(y[-1], 0.5 * self.state.size, 2.0 * self.state.size)
        return y

    @property
    def edge_radius(self) -> float:
        """Radius of the largest tension; 0 before a contact edge exists."""
        return self.parameter if self.branch.touching else 0.0

    @property
    def orientation(self) -> float:
        """Sign of the parameter's change along the path."""
        return 1.0 if self.branch.touching else -1.0

    @property
    def load_rate(self) -> float:
        """Change of P along the path, per unit of the parameter's change."""
        return self.orientation * self.state.load_rate if self.rates is None else self.rates[0]

    @property
    def displacement_rate(self) -> float:
        """Change of delta along the path, per unit of the parameter's change."""
        return self.orientation * self.state.displacement_rate if self.rates is None else self.rates[1]


def continuation(point: Point, step: float, stop: float) -> Iterator[Point]:
    """Continue a branch from a point towards `stop`, yielding every converged point after the first.

    Raises
    ------
    NotConverged
        When the step size has been reduced to `SMALLEST_STEP`.
    """
    direction = 1.0 if step > 0 else -1.0
    before: Point | None = None
    while (stop - point.parameter) * direction > 0:
        largest = point.branch.largest_step(point.parameter)
        step = direction * min(abs(step), largest, abs(stop - point.parameter))
        target = stop if abs(stop - point.parameter - step) <= 1e-12 * abs(stop) else point.parameter + step
        try:
            new = point.branch.solve(target, point.predict(target, before))
        except NotConverged as error:
            before, step = None, 0.4 * step
            if abs(step) < SMALLEST_STEP * largest:
                raise NotConverged(
                    f"the path stops at H0 = {point.state.central_gap:.6g}, delta = "
                    f"{point.state.displacement:.6g}: {error}"
                ) from error
            continue
        step *= 1.6 if new.state.iterations <= 4 else (0.7 if new.state.iterations > 7 else 1.0)
        before, point = point, new
        yield point


def point_at(nearest: Point, parameter: float) -> Point:
    """Return the point of a branch at a parameter, continued from a point near it."""
    point = nearest
    for following in continuation(nearest, parameter - nearest.parameter, parameter):
        point = following
    return point


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
    start = FARTHEST_GAP
    while True:
        gap = start * branch.contact.law.z0
        y = np.zeros(branch.contact.unknowns + 2)
        y[-2:] = -gap, size
        try:
            return branch.solve(gap, y)
        except NotConverged as error:
            start *= FARTHER_START
            if start > FARTHEST_START:
                raise NotConverged(
                    f"no equilibrium was found at central gaps of up to {FARTHEST_START:g} lengths of the law, where "
                    "the approach begins: the solid is too soft for the adhesion; take a stiffer one"
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
        raise NotConverged(
            "contact begins on a spot smaller than the mesh resolves: take a stiffer surface or less adhesion"
        )

    def excess(s: float) -> float:
        w = float(trace.evaluate(np.array([s]))[0] @ y[:-2])
        r = np.array(y[-1] * s)
        return -float(y[-2]) + float(contact.punch.height(r)) + w - float(force.peak_gap(r))

    return float(y[-1]) * float(brentq(excess, trace.s[above[0] - 1], trace.s[above[0]], xtol=1e-14))


def edge_width(point: Point) -> float:
    """Radial length over which the gap rises by the length of the law at the edge, relative to the edge radius.

    It is that of the slope at the gap of peak tension, or `STEEPER` times that of the steepest slope in the length of
    the law beyond, if that is shorter: for k near 1 the gap rises almost at once there.  Where the computed gap falls
    at the edge, because the mesh is too coarse, the width is negative.
    """
    contact, y = point.branch.contact, point.state.y
    radius, length = point.edge_radius, contact.law.z0
    slope = -EdgeRadius(radius).parameter_rate(contact, y)
    beside = np.flatnonzero(np.abs(y[-1] * contact.compliance.trace.s - radius) < radius)
    s, gap = contact.compliance.trace.s[beside], contact.gap(y)[beside]
    peak = contact.force.peak_gap(y[-1] * s)
    at_edge = (gap > peak) & (gap < peak + length)
    pairs = at_edge[:-1] & at_edge[1:]
    steepest = float(np.max(np.diff(gap)[pairs] / np.diff(s)[pairs], initial=0.0)) / float(y[-1])
    return length / (radius * (max(slope, steepest / STEEPER) if slope > 0.0 else slope))


def element_length(point: Point, radius: float) -> float:
    """Length of the element inside a radius on the mesh of a state."""
    size, nodes = point.state.size, point.branch.contact.compliance.trace.nodes
    outer = min(max(int(np.searchsorted(nodes, radius / size)), 1), nodes.size - 1)
    return float(size * (nodes[outer] - nodes[outer - 1]))


def edge_is_resolved(point: Point, share: float = 1.0) -> bool:
    """Whether the elements at the contact edge are at most `share` times as long as it asks for, or there is none."""
    if not point.branch.touching:
        return True
    radius = point.edge_radius
    return element_length(point, radius) <= share * WIDTH_SHARE * edge_width(point) * radius


def joined(a: Point, b: Point) -> bool:
    """Whether the path is smooth between two neighbours: one branch, or meshes for two edges without a kink between."""
    if a.branch is b.branch:
        return True
    low, high = sorted((a.edge_radius, b.edge_radius))
    return low > 0.0 and not any(low < kink < high for kink in kinks_of(a.branch.contact.punch))


def branches_of(points: Sequence[Point]) -> list[list[Point]]:
    """Parts of a path in each of which neighbours are joined."""
    branches = [list(points[:1])]
    for a, b in pairwise(points):
        if joined(a, b):
            branches[-1].append(b)
        else:
            branches.append([b])
    return branches


def equilibrium_points(contact: Contact) -> Iterator[Point]:
    """Trace the whole equilibrium path from far away into contact, until the consumer stops."""
    point: Point | None = None
    for point in approach_branch(contact):
        yield point
    if point is not None:
        yield from contact_branch(point, 1e3 * radius_at_height(contact.punch, contact.law.z0))
