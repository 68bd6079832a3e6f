"""States in contact by the radius of their edge, each on a mesh that resolves its edge.

On a mesh that is too coarse the contact edge crosses elements that are longer than it is wide, and the load along the
path has minima at the nodes that the problem has not.  Here a state is solved on a mesh that is fine at its own edge,
or on that of a neighbour if that one resolves it: one that scales follows the edge.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import partial
from typing import TypeVar

import numpy as np

from fem_reference._contact.carried import projected
from fem_reference._contact.contact import Contact
from fem_reference._contact.mesh_lengths import check_width
from fem_reference._contact.meshes import Meshes
from fem_reference._contact.states import (
    NARROWER,
    WIDTH_SHARE,
    Point,
    contact_branch,
    edge_is_resolved,
    edge_width,
    element_length,
    point_at,
)
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._typing import Array
from fem_reference.errors import Failure, NotConverged
from fem_reference.laws import SurfaceLaw
from fem_reference.punch import kinks_of

__all__ = ["EdgeStates", "to_root"]

#: Difference of the logarithms of two radii from which on a state is also looked for by way of one between.
CLOSE = 0.02

#: Newton steps after which a state is not taken for the neighbour of the one it was sought from: the iteration has
#: wandered, and where it ends depends on rounding (measured: 3 to 6 steps to a neighbour; 24 to a state that had none).
MOST_STEPS = 15

#: Ratio of an element at the edge to the resolved edge width up to which the mesh of a neighbour is taken: on those of
#: the search it leaves 1e-5 of a load.
SHARED = 2.0

#: Difference of the logarithms of the radii of two states from which both are extrapolated, and its least share of the
#: distance to the third: the difference of states on meshes of their own is divided by it.
APART, APART_SHARE = 1e-3, 0.5

#: Distance of a gap above the singular one, in lengths of the law, below which its logarithm is not extrapolated.
SMALLEST_DISTANCE = 1e-3

#: Largest number of states: 40 are usual where the contact grows to a hundred times the radius at which it begins.
MOST_STATES = 400

#: Largest number of widths of the edge at one radius.
WIDTHS = 8

#: Newton steps for the root of a polynomial of degree 3 that is nearly straight.
POLISHES = 3

#: Largest number of moves of a mesh towards an event; two are usual, from an event that is 0.5 % away.
MOVES = 12

#: Least share of an interval with the event by which it is cut.
LEAST_SHARE = 0.1

#: Largest change of the radius in one of them, relative to it.
LARGEST_MOVE = 0.1

#: Distance between two states, in largest steps of their radius, up to which the cubic through both predicts a third.
CUBIC_STEPS = 1.5

#: Change of the logarithm of the radius between states whose values tell an extremum: the polynomial of degree 4 has it
#: to 3e-7 for a load of the limit of a short range (by its fifth derivative), which changes the load by 2e-13.
EXTREMUM_STEP = 0.02

#: The same, as a share of the distance to the nearest kink of the punch, before which two steps end, and the least,
#: whose values are told apart from rounding; steps of one move.
SHARE_TO_KINK, LEAST_EXTREMUM_STEP, MOST_STEPS_AT_ONCE = 0.4, 1e-4, 5.0


Value = TypeVar("Value", float, Array)


@dataclass(slots=True)
class EdgeStates:
    """Solver of states in contact by the radius of their edge.

    Attributes
    ----------
    meshes : Meshes
    start : Point
        A state with a contact edge on any mesh, to begin with.
    degree : int
        Of the elements.
    density : float
        Of the elements.
    share : float
        Resolved edge width, as `fem_reference._contact.path.WIDTH_SHARE`.
    states : dict of float to Point
        States by the radius of their edge.
    """

    meshes: Meshes
    start: Point
    degree: int
    density: float
    share: float = WIDTH_SHARE
    states: dict[float, Point] = field(default_factory=dict)

    def at(self, radius: float) -> Point:
        """Return the state with the contact edge at a radius, on any mesh that resolves it.

        Raises
        ------
        NotConverged
            If it is not found, or there are too many states.
        """
        if radius not in self.states:
            if len(self.states) >= MOST_STATES:
                raise NotConverged(
                    f"the path in contact needs more than {MOST_STATES} states with edges between "
                    f"{min(self.states):.4g} and {max(self.states):.4g}",
                    Failure.MESH,
                )
            self.states[radius] = self._on_neighbour_mesh(radius) or self.on_fine_mesh(radius)[1]
        return self.states[radius]

    def on_fine_mesh(self, radius: float) -> tuple[MeshSpec, Point]:
        """Return the mesh that is fine at a radius, and the state with the contact edge there.

        Raises
        ------
        NotConverged
            If the state is not found, or its edge is narrower than a mesh can resolve.
        """
        width = self.share * self._expected_width(radius)
        # On the meshes of the accuracy itself the whole system is solved, if an event is there.
        whole = (self.degree, self.density) == (self.meshes.level.order, self.meshes.level.density)
        for _ in range(WIDTHS):
            spec = self.meshes.spec_at(width, radius)
            contact = self.meshes.contact(replace(spec, order=self.degree, density=self.density), radius, whole)
            point = self._reached(contact, radius)
            relative = edge_width(point)
            # The gap falls at the edge of a mesh that is too coarse to tell the width.
            width = self.share * relative if relative > 0.0 else NARROWER * spec.edge_width
            check_width(width)
            if width >= spec.edge_width:
                return spec, point
        raise NotConverged(f"the width of the contact edge was not found at the radius {radius:.4g}", Failure.MESH)

    def located(self, excess: Callable[[Point], float], slope: float) -> tuple[MeshSpec, float]:
        """Return the mesh that is fine at the contact edge of an event near the start, and the radius of that edge.

        Parameters
        ----------
        excess : callable
            What vanishes at the event.
        slope : float
            Its derivative with respect to the radius.

        Raises
        ------
        NotConverged
            As `on_fine_mesh`, or if the event is not found.
        """
        radius = self.start.edge_radius
        known: dict[float, float] = {}
        for _ in range(MOVES):
            spec, self.start = self.on_fine_mesh(radius)
            known[radius] = excess(self.start)
            move = to_root(known, radius, slope)
            if abs(move) <= 0.5 * WIDTH_SHARE * edge_width(self.start) * radius:
                return spec, radius
            radius += float(np.clip(move, -LARGEST_MOVE * radius, LARGEST_MOVE * radius))
        raise NotConverged(f"the contact edge of an event was not found near the radius {radius:.4g}", Failure.EVENT)

    def extremum(self, value: Callable[[Point], float]) -> tuple[float, float]:
        """Return the radius at which a value is stationary near the start, and its second derivative there.

        The states have similar meshes, whose errors change as smoothly with the radius as the value does.

        Parameters
        ----------
        value : callable
            Of a state.

        Raises
        ------
        NotConverged
            As `on_fine_mesh`, or if the extremum is not found.
        """
        radius = self.start.edge_radius
        for _ in range(MOVES):
            step = self._extremum_step(radius)
            steps = step * np.arange(-2, 3)
            spec, self.start = self.on_fine_mesh(radius)
            values = [value(self.similar(spec, radius * math.exp(x))) for x in steps]
            polynomial = np.polynomial.Polynomial.fit(steps, values, steps.size - 1)
            rate, bend = polynomial.deriv(), polynomial.deriv(2)
            x = -float(rate(0.0) / bend(0.0))
            if abs(x) <= step:
                for _ in range(POLISHES):
                    x -= float(rate(x) / bend(x))
                return radius * math.exp(x), float(bend(x)) / radius**2
            radius *= math.exp(float(np.clip(x, -MOST_STEPS_AT_ONCE * step, MOST_STEPS_AT_ONCE * step)))
        raise NotConverged(f"the contact edge of an extremum was not found near the radius {radius:.4g}", Failure.EVENT)

    def _extremum_step(self, radius: float) -> float:
        """Change of the logarithm of the radius between states about an extremum, none of which is beyond a kink."""
        nearest = min((abs(math.log(kink / radius)) for kink in kinks_of(self.meshes.problem.punch)), default=math.inf)
        return min(EXTREMUM_STEP, max(SHARE_TO_KINK * nearest, LEAST_EXTREMUM_STEP))

    def similar(self, spec: MeshSpec, radius: float) -> Point:
        """The state with the contact edge at a radius, on a mesh as fine at its edge as another one."""
        similar = replace(self.meshes.spec_at(spec.edge_width, radius), order=self.degree, density=self.density)
        return self._reached(self.meshes.contact(similar, radius), radius)

    def _expected_width(self, radius: float) -> float:
        """Width of the edge at a radius, relative to it, from those of its neighbours."""
        nearest = self._nearest(radius)
        beside = self._second(nearest, radius)
        if beside is None:
            return edge_width(nearest) * nearest.edge_radius / radius
        widths = [math.log(edge_width(point)) for point in (nearest, beside)]
        return math.exp(_extrapolated(widths, _share(nearest, beside, radius)))

    def _on_neighbour_mesh(self, radius: float) -> Point | None:
        """The state on the mesh of the nearest one, if its elements there are short enough."""
        nearest = self._nearest(radius)
        # Where the meshes scale, theirs tell the width of the edge at the events, and are as fine as it asks for.
        shared = 1.0 if self.meshes.scale else SHARED
        wide = shared * WIDTH_SHARE * edge_width(nearest) * nearest.edge_radius
        if nearest.parameter not in self.states or element_length(nearest, radius) > wide:
            return None
        with suppress(NotConverged):
            point = nearest.branch.solve(radius, nearest.predict(radius, self._beside(nearest, radius)))
            if point.state.iterations <= MOST_STEPS and edge_is_resolved(point, shared):
                return point
        return None

    def _beside(self, nearest: Point, radius: float) -> Point | None:
        """The next nearest state on the mesh of the nearest one, if its edge is within one step."""
        beside = [point for point in self.states.values() if point.branch is nearest.branch and point is not nearest]
        second = min(beside, key=lambda point: abs(math.log(point.parameter / radius)), default=nearest)
        step = abs(second.parameter - nearest.parameter)
        return second if 0.0 < step <= nearest.branch.largest_step(nearest.parameter) * CUBIC_STEPS else None

    def _nearest(self, radius: float) -> Point:
        """The nearest state known."""
        if not self.states:
            return self.start
        return self.states[min(self.states, key=lambda r: abs(math.log(r / radius)))]

    def _second(self, nearest: Point, radius: float) -> Point | None:
        """A state to be extrapolated with the nearest one, if both have a width of the edge."""
        at = nearest.edge_radius
        least = max(APART, APART_SHARE * abs(math.log(radius / at)))
        apart = [point for other, point in self.states.items() if abs(math.log(other / at)) >= least]
        second = min(apart, key=lambda point: abs(math.log(point.edge_radius / at)), default=None)
        return None if second is None or min(edge_width(nearest), edge_width(second)) <= 0.0 else second

    def _reached(self, contact: Contact, radius: float) -> Point:
        """State on a mesh whose edge is at that radius, by way of states between if it is not found at once."""
        while True:
            nearest = self._nearest(radius)
            try:
                return _state_from(nearest, self._second(nearest, radius), contact, radius)
            except NotConverged:
                if abs(math.log(nearest.edge_radius / radius)) <= CLOSE:
                    raise
                self.at(math.sqrt(nearest.edge_radius * radius))


def to_root(known: Mapping[float, float], at: float, slope: float) -> float:
    """Return the distance from the last of some radii to the root of a function with known values at them.

    Next to a kink of the punch the slope is much larger than that between the states of a path, and Newton's method
    with that one swings about the root: between two values of different signs it is where the line through both is 0.
    """
    rising = math.copysign(1.0, slope)
    below = max((radius for radius, value in known.items() if rising * value < 0.0), default=None)
    above = min((radius for radius, value in known.items() if rising * value >= 0.0), default=None)
    if below is None or above is None or below >= above:
        return -known[at] / slope
    share = known[below] / (known[below] - known[above])
    # The line of a bent function has its root near one end again and again.
    return below + min(max(share, LEAST_SHARE), 1.0 - LEAST_SHARE) * (above - below) - at


def _state_from(nearest: Point, beside: Point | None, contact: Contact, radius: float) -> Point:
    """The state with the contact edge at a radius where a mesh is fine, from one or two on other meshes."""
    branch = contact_branch(contact)
    first = partial(_shifted, nearest) if beside is None else partial(_continued, nearest, beside)
    for start in (first, partial(_projected, nearest)):
        with suppress(NotConverged):
            point = branch.solve(radius, start(contact, radius))
            if point.state.iterations <= MOST_STEPS:
                return point
    raise NotConverged(
        f"no equilibrium was found with the contact edge at {radius:.6g}, from that at {nearest.edge_radius:.6g}",
        Failure.ITERATION,
    )


def _projected(point: Point, contact: Contact, radius: float) -> Array:
    return projected(point_at(point, radius), contact, radius)


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


def _continued(nearest: Point, beside: Point, contact: Contact, radius: float) -> Array:
    """Start on a mesh whose edge is at a radius: two other states, extrapolated in the logarithm of the radius.

    Where the gap is narrower than the displacement is large, the logarithm of the gap is extrapolated: the traction is
    like a power of it, and steep.  Beyond, it is the displacement, small against the height of the punch.
    """
    law, trace = contact.law, contact.compliance.trace
    share = _share(nearest, beside, radius)
    displacements, distances = [], []
    for point in (nearest, beside):
        own = point.branch.contact.compliance.trace
        r = point.edge_radius * trace.s
        w = own.evaluate(np.minimum(r / point.state.size, own.extent)) @ point.state.y[:-2]
        gap = contact.punch.height(r) - point.state.displacement + w
        displacements.append(w)
        distances.append(_distance(gap, law))
    approach = _extrapolated([point.state.displacement for point in (nearest, beside)], share)
    w, gap = _extrapolated(displacements, share), _gap_at(_extrapolated(distances, share), law)
    wide = gap**2 / (gap**2 + w**2 + law.z0**2)
    w = (1.0 - wide) * (gap + approach - contact.punch.height(radius * trace.s)) + wide * w
    return np.concatenate([trace.projection(w), [approach, radius]])


def _distance(gap: Array, law: SurfaceLaw) -> Array:
    """Logarithm of the distance of a gap from the singular one, or the gap if there is none."""
    if not math.isfinite(law.singular_gap):
        return gap
    return np.log(np.maximum(gap - law.singular_gap, SMALLEST_DISTANCE * law.z0))


def _gap_at(distance: Array, law: SurfaceLaw) -> Array:
    """The gap of a `_distance`."""
    return law.singular_gap + np.exp(distance) if math.isfinite(law.singular_gap) else distance


def _share(nearest: Point, beside: Point, radius: float) -> float:
    """Place of a radius on a logarithmic scale that is 0 at the edge of one state and 1 at that of another."""
    return math.log(radius / nearest.edge_radius) / math.log(beside.edge_radius / nearest.edge_radius)


def _extrapolated(values: Sequence[Value], share: float) -> Value:
    """Value at a share of the way from the first of two to the second."""
    return values[0] + share * (values[1] - values[0])
