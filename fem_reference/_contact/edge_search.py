"""Search for the contact edge at an event, with a mesh for each radius that is fine there.

A solid that does not scale has one mesh, over which the edge moves.  Away from the radius where that mesh is fine, its
elements may be longer than the edge is wide.  The load along the path then has minima at the nodes of the mesh, deeper
than that of the problem.  Where a mesh is fine the state is that of the problem: its load or displacement there, on one
mesh after the other, encloses the event.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Protocol

import numpy as np

from fem_reference._contact.contact import Contact
from fem_reference._contact.controls import EdgeRadius, Size
from fem_reference._contact.events import LANDING, excess_of
from fem_reference._contact.mesh_lengths import check_width
from fem_reference._contact.path import Branch, Point, edge_width, point_at
from fem_reference._contact.resolved import projected
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._typing import Array
from fem_reference.errors import NotConverged

__all__ = ["MESHES", "MINIMA", "SEARCHED", "WIDTH_SHARE", "EdgeSearch", "state_at"]

WIDTH_SHARE = 0.18
"""Resolved edge width relative to the length over which the gap rises by the length of the law at the edge."""

SEARCHED = ("pull_off", "jump_out", "zero_load", LANDING)
"""Events whose condition changes from negative to positive where the edge moves outwards."""

MINIMA = ("pull_off", "jump_out")
"""Those where the load or the displacement is smallest."""

STEP = 0.1
"""First change of the logarithm of the radius; it grows by half until the event is enclosed."""

NEAR = 0.1
"""Difference of the logarithms of two radii up to which the state on one mesh is the first start on the other."""

CLOSE = 0.02
"""Difference of the logarithms of two radii from which on a state is also looked for by way of one between."""

CONFIRMING = 4.0
"""Distance, in tolerances, of the radius that confirms a minimum found by the first parabola."""

MESHES = 40
"""Largest number of meshes: three to enclose an event, four to locate it and one for each other minimum are usual."""

WIDTHS = 8
"""Largest number of widths of the edge at one radius."""


class _Meshes(Protocol):
    """What makes meshes of a problem: `fem_reference._contact.mesh_choice.MeshChoice`."""

    def spec(
        self, width: float, size: float, smallest: float, far_share: float = 1.0, apex: float = math.inf
    ) -> MeshSpec: ...

    def contact(self, spec: MeshSpec, size: float) -> Contact: ...


@dataclass(slots=True)
class EdgeSearch:
    """A search for the radius of the contact edge at an event.

    Attributes
    ----------
    meshes : MeshChoice
        Of a solid that does not scale.
    event : str
        One of `SEARCHED`.
    samples : sequence of Point
        The path on any mesh: where the states on other meshes begin.
    width : float
        Relative width of the edge to begin with.
    smallest : float
        As for `MeshChoice.spec`.
    degree : int
        Of the elements.
    level : float
        Displacement at a landing.
    apex : float
        As for `MeshChoice.spec`.
    known : dict of float to Point
        States by the radius of their edge, each on its own mesh.
    most : int
        Largest number of them.
    """

    meshes: _Meshes
    event: str
    samples: Sequence[Point]
    width: float
    smallest: float
    degree: int
    level: float = 0.0
    apex: float = math.inf
    known: dict[float, Point] = field(default_factory=dict)
    most: int = MESHES

    def found(self, radius: float) -> tuple[MeshSpec, float]:
        """Return the mesh that is fine at the contact edge of the event, and the radius of that edge.

        Parameters
        ----------
        radius : float
            To begin with.

        Raises
        ------
        NotConverged
            If the event is not enclosed, or the edge is narrower than a mesh can resolve.
        """
        radius = self._located(radius)
        for other in self._lower_minima(self.known[radius]):
            if any(abs(math.log(known / other)) <= NEAR for known in self.known):
                continue
            point = self.at(other)
            if self._height(point) < self._height(self.known[radius]):
                radius = self._located(other)
        return self.spec(radius), radius

    def lowest(self, radii: Sequence[float], degree: int) -> tuple[MeshSpec, float]:
        """Return the mesh and the radius of the lowest event that a search from one of the radii finds.

        Parameters
        ----------
        radii : sequence of float
        degree : int
            Of elements on which the radius is located at the end.  Elements of the search alone would put it 0.5 %
            beside the event (measured with a degree of 4 under a cone at mu = 3 where the modulus falls to a third).

        Raises
        ------
        NotConverged
            As `found`.
        """
        radius = min((self._located(radius) for radius in radii), key=lambda r: self._height(self.known[r]))
        last = replace(self, degree=degree, samples=list(self.known.values()), known={}, most=MESHES)
        radius = last.root(radius)
        self.known[radius] = last.known[radius]
        return last.spec(radius), radius

    def _located(self, radius: float) -> float:
        """Radius of a mesh whose event is on its finest elements."""
        return self._minimum(radius) if self.event in MINIMA else self.root(radius)

    def _minimum(self, radius: float) -> float:
        """Radius where load or displacement is smallest, by parabolas in the logarithm of the radius."""
        # The rate on one mesh tells the direction far away; near the event it is less certain than the values are.
        first = self.at(radius)
        middle = math.log(radius), self._height(first)
        direction = -math.copysign(1.0, excess_of(self.event)(first))
        step = STEP
        following = self._point(middle[0] + direction * step)
        if following[1] > middle[1]:
            middle, following, direction = following, middle, -direction
        last = middle
        while following[1] <= middle[1]:
            last, middle, step = middle, following, 1.5 * step
            following = self._point(middle[0] + direction * step)
        low, high = sorted((last, following))
        wide = True
        while True:
            x, tolerance = _vertex(low, middle, high), self._tolerance(math.exp(middle[0]))
            if abs(x - middle[0]) <= tolerance:
                if not wide:
                    return min(self.known, key=lambda r: abs(math.log(r) - middle[0]))
                # The vertex of a wide parabola may be at the middle by chance.
                x = middle[0] + math.copysign(CONFIRMING * tolerance, x - middle[0])
            wide = False
            point = self._point(x)
            inside, outside = sorted((point, middle), key=lambda p: p[1])
            low, high = (outside, high) if outside[0] < inside[0] else (low, outside)
            middle = inside

    def _point(self, x: float) -> tuple[float, float]:
        """The logarithm of a radius, and load or displacement there."""
        return x, self._height(self.at(math.exp(x)))

    def root(self, radius: float) -> float:
        """Radius where the condition of the event changes its sign."""
        excess = excess_of(self.event, self.level)
        low: tuple[float, float] | None = None
        high: tuple[float, float] | None = None
        x, step = math.log(radius), STEP
        while True:
            value = excess(self.at(math.exp(x)))
            if value < 0.0:
                # A side that is kept twice loses half of its value, so that both sides move.
                low, high = (x, value), high and (high[0], 0.5 * high[1] if low else high[1])
            else:
                low, high = low and (low[0], 0.5 * low[1] if high else low[1]), (x, value)
            if low is None or high is None:
                x, step = x + math.copysign(step, -value), 1.5 * step
                continue
            x = low[0] + (high[0] - low[0]) * low[1] / (low[1] - high[1])
            nearest = min(self.known, key=lambda r: abs(math.log(r) - x))
            if abs(math.log(nearest) - x) <= self._tolerance(nearest):
                return nearest

    def _tolerance(self, radius: float) -> float:
        """Distance from the event, relative to the radius, within which its elements are short enough."""
        return 0.5 * WIDTH_SHARE * edge_width(self.known[min(self.known, key=lambda r: abs(r - radius))])

    def _lower_minima(self, point: Point) -> list[float]:
        """Radii where the path on one mesh is lower than at the event, which may be due to that mesh."""
        touching = [p for p in self.samples if p.branch.touching]
        rate = excess_of(self.event)
        pairs = [pair for pair in pairwise(touching) if rate(pair[0]) < 0.0 <= rate(pair[1])]
        lowest = [min(pair, key=self._height) for pair in pairs] if self.event in MINIMA else []
        return [p.edge_radius for p in sorted(lowest, key=self._height) if self._height(p) < self._height(point)]

    def _height(self, point: Point) -> float:
        """Load or displacement, which is smallest at an event of `MINIMA`."""
        return point.state.load if self.event == "pull_off" else point.state.displacement

    def spec(self, radius: float) -> MeshSpec:
        """Mesh that is fine at a radius, for the edge as wide as it is found so far."""
        return self.meshes.spec(self.width, radius, self.smallest, apex=self.apex)

    def at(self, radius: float) -> Point:
        """Return the state with the contact edge at a radius, on a mesh that resolves the edge there.

        Raises
        ------
        NotConverged
            If it is not found, or on too many meshes.
        """
        if len(self.known) >= self.most:
            raise NotConverged(
                f"the contact edge of {self.event} was not found on {self.most} meshes, each fine at another radius, "
                f"between {min(self.known):.4g} and {max(self.known):.4g}; take a finer accuracy"
            )
        for _ in range(WIDTHS):
            spec = self.spec(radius)
            contact = self.meshes.contact(replace(spec, order=self.degree), radius)
            point = self._reached(contact, radius)
            relative = edge_width(point)
            width = WIDTH_SHARE * relative if relative > 0.0 else 0.25 * spec.edge_width
            check_width(width)
            if width >= spec.edge_width:
                self.known[radius] = point
                return point
            self.width = width
        raise NotConverged(f"the width of the contact edge was not found at the radius {radius:.4g}")

    def _reached(self, contact: Contact, radius: float) -> Point:
        """State on a mesh whose edge is at that radius, by way of states between if it is not found at once."""
        while True:
            try:
                return self._state(contact, radius)
            except NotConverged:
                nearest = min(self.known, key=lambda r: abs(math.log(r / radius)), default=radius)
                if abs(math.log(nearest / radius)) <= CLOSE:
                    raise
                self.at(math.sqrt(nearest * radius))

    def _state(self, contact: Contact, radius: float) -> Point:
        """State on a mesh whose edge is at that radius, from the nearest one known."""

        def away(point: Point) -> float:
            return abs(math.log(point.edge_radius / radius))

        starts = [min((p for p in self.samples if p.branch.touching), key=away)]
        known = min(self.known.values(), key=away, default=None)
        if known is not None:
            starts.insert(0 if away(known) <= max(NEAR, away(starts[0])) else 1, known)
        return state_at(contact, radius, starts)


def state_at(contact: Contact, radius: float, starts: Sequence[Point]) -> Point:
    """Return the state with the contact edge at a radius where a mesh is fine, from states on other meshes.

    Parameters
    ----------
    contact : Contact
        The problem on the mesh.
    radius : float
        Of its edge.
    starts : sequence of Point
        In the order in which they are tried.

    Raises
    ------
    NotConverged
        If the state is not found from any of them.
    """
    branch = Branch(contact, Size(radius), lambda r: EdgeRadius(contact.law.peak_gap, r), touching=True)
    for start in starts:
        with suppress(NotConverged):
            return branch.solve(radius, _shifted(start, contact, radius))
        with suppress(NotConverged):
            return branch.solve(radius, projected(point_at(start, radius), contact, radius))
    raise NotConverged(f"no equilibrium was found with the contact edge at {radius:.6g}; take a finer accuracy")


def _shifted(point: Point, contact: Contact, radius: float) -> Array:
    """Start on a mesh whose edge is at a radius: the gap of another state, moved with its edge.

    The edge keeps its shape where it moves.  The displacement that belongs to the gap is no equilibrium, but the first
    Newton step finds it: it depends linearly on the traction, which changes little.
    """
    trace, target, y, size = (
        point.branch.contact.compliance.trace,
        contact.compliance.trace,
        point.state.y,
        point.state.size,
    )
    move, r = radius - point.edge_radius, radius * target.s
    s = np.clip((r - move) / size, 0.0, trace.extent)
    gap = -y[-2] + contact.punch.height(size * s) + trace.evaluate(s) @ y[:-2]
    approach = point.state.displacement + move * point.displacement_rate
    w = target.projection(gap + approach - contact.punch.height(r))
    return np.concatenate([w, [approach, radius]])


def _vertex(low: tuple[float, float], middle: tuple[float, float], high: tuple[float, float]) -> float:
    """Place of the extreme value of the parabola through three points."""
    before, after = middle[0] - low[0], high[0] - middle[0]
    fall, rise = (middle[1] - low[1]) / before, (high[1] - middle[1]) / after
    return middle[0] - 0.5 * (after * fall + before * rise) / (rise - fall)
