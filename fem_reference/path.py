"""The equilibrium path as a function of one control that never turns back.

Before contact the central gap H0 falls on a mesh of fixed size.  Once the gap at the centre is below the gap of
the largest tension a contact edge exists, and the path continues in its radius c: the mesh scales with c and
keeps the edge at its refined node.  P and delta are smooth functions of H0 and then of c through both folds.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fem_reference.contact import CentralGap, Contact, Control, EdgeGap, Size, State, newton
from fem_reference.errors import NotConverged
from fem_reference.punch import radius_at_height

__all__ = ["Leg", "Point", "approach", "contact_leg", "gap_leg", "march", "regrid"]

Array = NDArray[np.float64]

FARTHEST_GAP = 12.0
"""Central gap where a path begins, in z0: the tension there is 1e-3 of its peak, Newton starts from no load."""

EDGE_DEPTH = 0.03
"""The edge takes over the control when the central gap is this far below the gap of peak tension, in z0."""

GAP_STEP = 0.25
"""Largest step of the central gap, in z0 plus half the gap itself."""

SIZE_STEP = 0.12
"""Largest relative step of the edge radius: P and delta change by a few per cent of their range."""

SMALLEST_STEP = 1e-7
"""Relative step below which the path is given up."""


@dataclass(frozen=True, slots=True, eq=False)
class Leg:
    """A part of the path under one pair of controls: `fixed`, and `family` of the parameter."""

    contact: Contact
    fixed: Control
    family: Callable[[float], Control]
    name: str

    def solve(self, parameter: float, y: Array) -> Point:
        """Solve at a parameter from a starting vector."""
        return Point(self, parameter, newton(self.contact, y, self.fixed, self.family(parameter)))


@dataclass(frozen=True, slots=True, eq=False)
class Point:
    """A state with the leg and the parameter it belongs to."""

    leg: Leg
    parameter: float
    state: State

    def predict(self, parameter: float) -> Array:
        """Extrapolate the state along its tangent."""
        return self.state.y + (parameter - self.parameter) * self.state.rate

    @property
    def edge_radius(self) -> float:
        """Radius of the largest tension; 0 before a contact edge exists."""
        return self.state.size if self.leg.name == "edge" else 0.0


def gap_leg(contact: Contact, size: float) -> Leg:
    """The leg controlled by the central gap, on a mesh of one size."""
    return Leg(contact, Size(size), CentralGap, "gap")


def contact_leg(contact: Contact) -> Leg:
    """The leg controlled by the radius of the contact edge, which the mesh follows."""
    return Leg(contact, EdgeGap(contact.law.peak_gap), Size, "edge")


def march(point: Point, step: float, largest: Callable[[float], float], stop: float) -> Iterator[Point]:
    """Walk a leg from a point towards `stop`, yielding every converged point after the first.

    Parameters
    ----------
    point : Point
        Start.
    step : float
        First step of the parameter, signed.
    largest : callable
        Largest size of a step at a parameter.
    stop : float
        Parameter of the last point.

    Raises
    ------
    NotConverged
        When the step has been halved below sense.
    """
    direction = 1.0 if step > 0 else -1.0
    while (stop - point.parameter) * direction > 0:
        step = direction * min(abs(step), largest(point.parameter), abs(stop - point.parameter))
        target = stop if abs(stop - point.parameter - step) <= 1e-12 * abs(stop) else point.parameter + step
        try:
            new = point.leg.solve(target, point.predict(target))
        except NotConverged:
            step *= 0.4
            if abs(step) < SMALLEST_STEP * largest(point.parameter):
                raise
            continue
        step *= 1.6 if new.state.iterations <= 4 else (0.7 if new.state.iterations > 7 else 1.0)
        point = new
        yield point


def approach(contact: Contact, size: float, stop: float | None = None) -> Iterator[Point]:
    """Walk the leg of the central gap from far away down to where an edge can take over.

    Parameters
    ----------
    contact : Contact
        The problem.
    size : float
        Size of the mesh.
    stop : float, optional
        Central gap of the last point; by default a little below the gap of peak tension.
    """
    z0 = contact.law.z0
    leg = gap_leg(contact, size)
    start = FARTHEST_GAP * z0
    y = np.zeros(contact.unknowns + 2)
    y[-2:] = -start, size
    point = leg.solve(start, y)
    yield point
    end = contact.law.peak_gap - EDGE_DEPTH * z0 if stop is None else stop
    yield from march(point, -0.5 * z0, lambda h: GAP_STEP * z0 * (0.4 + 0.5 * abs(h) / z0), end)


def enter_contact(point: Point) -> Point:
    """Hand the path over from the central gap to the contact edge."""
    contact = point.leg.contact
    trace = contact.compliance.trace
    edge = _edge_of(point)
    y = regrid(point, edge)
    leg = contact_leg(contact)
    # The displacement on the new mesh first: gap control keeps the state while the mesh changes under it.
    settled = newton(contact, y, Size(edge), CentralGap(point.parameter))
    start = Point(gap_leg(contact, edge), point.parameter, settled)
    edge = _edge_of(start)
    del trace
    y = settled.y
    return leg.solve(edge, np.append(y[:-1], edge))


def _edge_of(point: Point) -> float:
    """Innermost radius where the gap rises through the gap of peak tension."""
    contact = point.leg.contact
    trace = contact.compliance.trace
    y = point.state.y
    peak = contact.law.peak_gap

    def excess(s: float) -> float:
        w = float(trace.evaluate(np.array([s]))[0] @ y[:-2])
        return -float(y[-2]) + float(contact.punch.height(np.array(y[-1] * s))) + w - peak

    H = contact.gap(y)
    above = np.flatnonzero(H > peak)
    if above.size == 0 or above[0] == 0:
        raise NotConverged("no contact edge: the central gap is not below the gap of peak tension")
    low, high = trace.s[above[0] - 1], trace.s[above[0]]
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(middle) < 0 else (low, middle)
    return float(y[-1]) * float(0.5 * (low + high))


def regrid(point: Point, size: float) -> Array:
    """The state's vector on the mesh of another size (a starting point for Newton)."""
    trace = point.leg.contact.compliance.trace
    y = point.state.y
    inside = np.minimum(trace.s * (size / y[-1]), trace.extent)
    w = trace.evaluate(inside) @ y[:-2]
    root = np.sqrt(trace.weight)
    coefficients = np.linalg.lstsq(root[:, None] * trace.phi, root * w, rcond=None)[0]
    return np.concatenate([coefficients, [y[-2], size]])


def characteristic_radius(contact: Contact) -> float:
    """Radius where the punch has risen by the range of the law: the natural lateral length."""
    return radius_at_height(contact.punch, contact.law.z0)
