"""States of the equilibrium path: a point with its branch, the continuation of a branch, the edge of a contact.

Before contact the parameter of a branch is the central gap, and in contact the radius of the edge.  Each changes in one
sense only along the path, and load and displacement are smooth functions of it, through both folds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np

from fem_reference._contact.contact import Contact
from fem_reference._contact.controls import Control, EdgeGap, EdgeRadius, Size, mesh_control
from fem_reference._contact.newton import State, newton
from fem_reference._typing import Array
from fem_reference.errors import NotConverged
from fem_reference.punch import kinks_of

__all__ = [
    "NARROWER",
    "SIZE_STEP",
    "WIDTH_SHARE",
    "Branch",
    "Point",
    "branches_of",
    "contact_branch",
    "continuation",
    "edge_is_resolved",
    "edge_width",
    "element_length",
    "joined",
    "point_at",
]

#: Largest step of the central gap, relative to the length of the law plus H0.
GAP_STEP = 0.2

#: Largest relative step of the edge radius: P and delta change by a few per cent of their range.
SIZE_STEP = 0.1

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
    pinned : bool
        Whether the parameter is kept on other meshes.  The point is an extremum by the values of its neighbours on
        similar meshes, where its own rate, of a narrow edge that moves over elements, does not tell; or a jump ends
        there that begins at an edge for which the mesh is not fine.
    """

    branch: Branch
    parameter: float
    state: State
    rates: tuple[float, float] | None = None
    pinned: bool = False

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


def contact_branch(contact: Contact) -> Branch:
    """Return the branch of the radius of the edge: the mesh follows the edge, or the edge moves over it."""
    family = Size if contact.compliance.scales else EdgeRadius
    return Branch(contact, mesh_control(contact, EdgeGap()), family, touching=True)


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
                    f"{point.state.displacement:.6g}: {error.reason}",
                    error.failure,
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


# A state is asked for it as the neighbour of each that is sought from it, and for the mesh of the events.
@lru_cache(maxsize=128)
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
    """Length of the element inside a radius on the mesh of a state, which follows the edge there if it can."""
    size, nodes = point.state.size, point.branch.contact.compliance.trace.nodes
    if point.branch.contact.compliance.scales:
        size = radius
    outer = min(max(int(np.searchsorted(nodes, radius / size)), 1), nodes.size - 1)
    return float(size * (nodes[outer] - nodes[outer - 1]))


def edge_is_resolved(point: Point, share: float = 1.0) -> bool:
    """Whether the elements at the contact edge are at most `share` times as long as it asks for, or there is none."""
    if not point.branch.touching:
        return True
    radius = point.edge_radius
    return element_length(point, radius) <= share * WIDTH_SHARE * edge_width(point) * radius


def joined(a: Point, b: Point) -> bool:
    """Whether the path is smooth between two neighbours: one branch or mesh for each, without a kink between."""
    low, high = sorted((a.edge_radius, b.edge_radius))
    kinked = any(low < kink < high for kink in kinks_of(a.branch.contact.punch))
    return not kinked and (a.branch is b.branch or low > 0.0)


def branches_of(points: Sequence[Point]) -> list[list[Point]]:
    """Parts of a path in each of which neighbours are joined."""
    branches = [list(points[:1])]
    for a, b in pairwise(points):
        if joined(a, b):
            branches[-1].append(b)
        else:
            branches.append([b])
    return branches
