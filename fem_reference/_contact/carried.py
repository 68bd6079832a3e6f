"""Events of a path solved again on another mesh, from the equilibria of that path.

The path on the finest mesh finds each event.  On another mesh a few Newton steps from there find the same event: the
surface displacement is projected, and the secant method, begun with the slope known on the finest mesh, finds the
parameter.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fem_reference._contact.contact import Contact
from fem_reference._contact.controls import Control, EdgeGap, GapRise, Size
from fem_reference._contact.cusp import cusp_from
from fem_reference._contact.event_kinds import CUSP, Anchor, beginning_of, excess_of, slope_at
from fem_reference._contact.events import PathEvents
from fem_reference._contact.states import WIDTH_SHARE, Branch, Point, edge_width, point_at
from fem_reference._typing import Array
from fem_reference.errors import Failure, NotConverged

__all__ = ["CarriedEvents", "carried", "projected", "projected_rate"]

#: Largest number of secant steps; two are usual, from an event that differs by 1e-6.
SECANT_STEPS = 12

#: Relative change of the parameter at which the secant method ends: the last step is linear in what is left, 1e-12.
SECANT_TOLERANCE = 1e-9

#: Relative change of the parameter, and ratio of it to the one before, from which on rounding keeps the steps from
#: falling: they fall by 1e2 or more (measured: 1e-7 under a coating of 1 GPa on 1.5 MPa, 1e-13 of the load there).
ROUNDING_STEP, SLOWEST = 1e-6, 0.5

#: Distance from the event of the finest mesh, in resolved edge widths, within which that of another mesh is sought.
RESOLVED_SHIFTS = 0.5

#: Share of the resolved edge width within which an event on a coarser mesh is where its rate says it is.
ELEMENT_SHARE = 0.5

#: Largest relative change of the parameter, or of the central gap in lengths of the law, in one secant step.
LARGEST_SHIFT = 0.3


class CarriedEvents:
    """The events of a path on another mesh, each solved once.

    Parameters
    ----------
    path : PathEvents or CarriedEvents
        The complete path on the finest mesh, or on a mesh for each radius; or its events on the finest mesh.
    contact : Contact
        The same problem on another mesh.
    placement : float
        Where the contact edge is put, in halves of the element beyond the node s = 1: with 1 the node s = 1 lies half
        an element beyond the edge.
    beside : float
        Distance from the edge of an event at which the event is solved, in errors of the radius of that edge.
    """

    def __init__(
        self, path: PathEvents | CarriedEvents, contact: Contact, placement: float = 0.0, beside: float = 0.0
    ) -> None:
        self._path, self.contact, self._placement, self._beside = path, contact, placement, beside
        self._points: dict[str, Point] = {}

    def at(self, event: str) -> Point:
        """Return the state at an event of the path.

        Raises
        ------
        NoSuchEvent
            If the path has no such point.
        NotConverged
            If the event cannot be found on this mesh.
        """
        if event not in self._points:
            if event == CUSP:
                return self._points.setdefault(event, self._cusp())
            anchor = self._path.anchor(event)
            beginning = None if anchor.point.pinned else beginning_of(event)
            level = 0.0 if beginning is None else self.at(beginning).state.displacement
            point = self._solved(anchor.point, anchor.slope, excess_of(event, level))
            if self._beside:
                shift = self._beside * anchor.radius_error
                point = replace(point_at(point, (1.0 + shift) * point.parameter), pinned=point.pinned)
            self._points[event] = point
        return self._points[event]

    def anchor(self, event: str) -> Anchor:
        """Return an event as other meshes begin with it."""
        point, of_path = self.at(event), self._path.anchor(event)
        return Anchor(point, of_path.slope if point.pinned else slope_at(event, point), of_path.radius_error)

    def _cusp(self) -> Point:
        """Find the cusp from that of the path."""
        original = self._path.at(CUSP)
        compliance = self.contact.compliance.stiffened(original.branch.contact.compliance.stiffness)
        branch, parameter, y = carried(original, replace(self.contact, compliance=compliance), self._placement)
        return cusp_from(branch.solve(parameter, y))

    def _solved(self, original: Point, slope: float, excess: Callable[[Point], float]) -> Point:
        """Find the root of `excess` from the point of the path where it vanishes."""
        branch, parameter, y = carried(original, self.contact, self._placement)
        if original.parameter != 0.0 and branch.touching:
            slope *= original.parameter / parameter
        unit = abs(parameter) if branch.touching else self.contact.law.z0
        point = branch.solve(parameter, y)
        if original.pinned:
            return replace(point, pinned=True)
        value, before = excess(point), math.inf
        nearest, moved = (math.inf, point), 0.0
        for _ in range(SECANT_STEPS):
            shift = _largest_shift(point)
            step = float(np.clip(-value / slope if slope else 0.0, -shift, shift))
            if _moves_over_elements(point):
                # Farther away the elements do not resolve the edge.
                step = float(np.clip(step, -RESOLVED_SHIFTS * shift - moved, RESOLVED_SHIFTS * shift - moved))
                moved += step
            if step == 0.0:
                return point
            nearest = min(nearest, (abs(step), point), key=lambda pair: pair[0])
            following = point_at(point, point.parameter + step)
            change = excess(following) - value
            point, value = following, value + change
            stalled = SLOWEST * before < abs(step) <= ROUNDING_STEP * unit
            if stalled or abs(step) <= SECANT_TOLERANCE * unit:
                return point
            before = abs(step)
            # Below rounding the difference says nothing about the slope.
            if abs(step) > 1e-6 * unit and change != 0.0:
                slope = change / step
        # On a coarser mesh a rate may have several roots within an element, which are all the event there.
        if nearest[0] > ELEMENT_SHARE * _largest_shift(nearest[1]) or not _moves_over_elements(nearest[1]):
            raise NotConverged(
                f"an event near delta = {original.state.displacement:.6g} was not found on another mesh", Failure.EVENT
            )
        return nearest[1]


def _largest_shift(point: Point) -> float:
    """Largest step of the parameter: it stays on the elements that resolve the edge."""
    if not point.branch.touching:
        return LARGEST_SHIFT * point.branch.contact.law.z0
    if _moves_over_elements(point):
        return min(LARGEST_SHIFT, WIDTH_SHARE * abs(edge_width(point))) * point.parameter
    return LARGEST_SHIFT * abs(point.parameter)


def _moves_over_elements(point: Point) -> bool:
    """Whether the mesh stays where it is when the contact edge moves."""
    return point.branch.touching and not point.branch.contact.compliance.scales


def carried(point: Point, contact: Contact, placement: float = 0.0) -> tuple[Branch, float, Array]:
    """Branch, parameter and starting vector on another mesh for a point of the path."""
    trace, y = point.branch.contact.compliance.trace, point.state.y
    branch = point.branch
    c, parameter = point.state.size, point.parameter
    fixed: Control = branch.fixed
    if not contact.compliance.scales:
        c = contact.compliance.size
        fixed = Size(c)
    elif placement:
        s = 1.0 + 0.5 * placement * float(trace.nodes[trace.edge + 1] - 1.0)
        w = float(trace.evaluate(np.array([s]))[0] @ y[:-2])
        gap = float(contact.punch.height(np.array(c * s))) - point.state.displacement + w
        c *= s
        if isinstance(fixed, EdgeGap):
            fixed, parameter = EdgeGap(gap), c
        elif isinstance(fixed, GapRise):
            fixed = GapRise(gap - point.state.central_gap)
    return replace(branch, contact=contact, fixed=fixed), parameter, projected(point, contact, c)


def projected(point: Point, contact: Contact, c: float) -> Array:
    """Project the surface displacement onto the functions of another mesh.

    Parameters
    ----------
    point : Point
        State on its own mesh.
    contact : Contact
        The problem on the other mesh.
    c : float
        Size of the other mesh.

    Returns
    -------
    ndarray
        Displacement, approach and size on the other mesh.
    """
    return np.append(_on_other_surface(point.state.y, point, contact, c), [point.state.displacement, c])


def projected_rate(point: Point, contact: Contact, c: float) -> Array:
    """Project the rate of a state, as `projected` the state."""
    rate = point.state.rate
    return np.append(_on_other_surface(rate, point, contact, c), rate[-2:])


def _on_other_surface(values: Array, point: Point, contact: Contact, c: float) -> Array:
    trace, target = point.branch.contact.compliance.trace, contact.compliance.trace
    s = np.minimum(target.s * c / point.state.size, trace.extent)
    return target.projection(trace.evaluate(s) @ values[:-2])
