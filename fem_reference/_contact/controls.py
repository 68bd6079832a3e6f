"""Controls: single equations that select a point of the equilibrium path, with their derivatives.

Two of them close the equations of `fem_reference._contact.contact`: one sets the size of the mesh, the other is the
parameter of the path.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol

import numpy as np

from fem_reference._contact.contact import Contact
from fem_reference._elastic.trace import Trace
from fem_reference._typing import Array

__all__ = [
    "CentralGap",
    "Control",
    "EdgeGap",
    "EdgeRadius",
    "GapRise",
    "Size",
    "mesh_control",
]


class Control(Protocol):
    """One equation that picks a point of the equilibrium path."""

    def value(self, contact: Contact, y: Array) -> float:
        """Left-hand side, zero at the point."""
        ...

    def gradient(self, contact: Contact, y: Array) -> Array:
        """Its derivative with respect to y."""
        ...


@dataclass(frozen=True, slots=True)
class Size:
    """The mesh has the size c.

    Examples
    --------
    >>> Size(1.5).value(None, np.array([0.0, -10.0, 2.0]))  # w, delta and c; the problem does not matter
    0.5
    """

    c: float

    def value(self, contact: Contact, y: Array) -> float:
        """Return c(y) - c."""
        return float(y[-1] - self.c)

    def gradient(self, contact: Contact, y: Array) -> Array:
        """Return a unit vector."""
        return _unit(y.size, -1)


@dataclass(frozen=True, slots=True)
class CentralGap:
    """The gap at r = 0 is H0.

    Examples
    --------
    >>> CentralGap(9.0).value(None, np.array([0.5, -10.0, 2.0]))  # H(0) = w(0) - delta = 10.5
    1.5
    """

    H0: float

    def value(self, contact: Contact, y: Array) -> float:
        """Return H(0) - H0."""
        return float(y[0] - y[-2] - self.H0)

    def gradient(self, contact: Contact, y: Array) -> Array:
        """Row of d H(0)."""
        return _unit(y.size, 0) - _unit(y.size, -2)


@dataclass(frozen=True, slots=True)
class EdgeGap:
    """The gap at the mesh node s = 1 is H1, by default that of the largest tension: the mesh follows the edge."""

    H1: float | None = None

    def value(self, contact: Contact, y: Array) -> float:
        """Return H(s = 1) - H1."""
        edge = contact.compliance.trace.edge
        H1 = contact.force.peak_gap(y[-1]) if self.H1 is None else self.H1
        return float(y[edge] - y[-2] + contact.punch.height(y[-1]) - H1)

    def gradient(self, contact: Contact, y: Array) -> Array:
        """Row of its change."""
        edge = contact.compliance.trace.edge
        row = _unit(y.size, edge) - _unit(y.size, -2)
        row[-1] = float(contact.punch.slope(y[-1]))
        if self.H1 is None:
            row[-1] -= float(contact.force.peak_slope(y[-1]))
        return row


@dataclass(frozen=True, slots=True)
class EdgeRadius:
    """The gap at the radius, anywhere on the mesh, is that of the largest tension: the edge moves over a fixed mesh."""

    radius: float

    def _row(self, contact: Contact, y: Array) -> Array:
        return _functions_at(contact.compliance.trace, self.radius / float(y[-1]))

    def value(self, contact: Contact, y: Array) -> float:
        """Return H(radius) minus the gap of the largest tension there."""
        height, at = float(contact.punch.height(np.array(self.radius))), np.array(self.radius)
        return float(self._row(contact, y) @ y[:-2]) - float(y[-2]) + height - float(contact.force.peak_gap(at))

    def gradient(self, contact: Contact, y: Array) -> Array:
        """Row of d H(radius) on a mesh of fixed size."""
        return np.concatenate([self._row(contact, y), [-1.0, 0.0]])

    def parameter_rate(self, contact: Contact, y: Array) -> float:
        """Change of the right-hand side per unit radius, -dH/dr (at a mesh line: that of its outer side)."""
        slopes, at = contact.compliance.trace.slopes(np.array([self.radius / float(y[-1])]))[0], np.array(self.radius)
        rise = float(slopes @ y[:-2]) / float(y[-1])
        return -rise - float(contact.punch.slope(at)) + float(contact.force.peak_slope(at))


@dataclass(frozen=True, slots=True)
class GapRise:
    """The gap at the mesh node s = 1 exceeds the central gap by `rise`: the mesh follows the bottom of the gap."""

    rise: float

    def value(self, contact: Contact, y: Array) -> float:
        """Return H(s = 1) - H(0) - rise."""
        edge = contact.compliance.trace.edge
        return float(y[edge] - y[0] + contact.punch.height(y[-1]) - self.rise)

    def gradient(self, contact: Contact, y: Array) -> Array:
        """Row of d (H(1) - H(0))."""
        row = _unit(y.size, contact.compliance.trace.edge) - _unit(y.size, 0)
        row[-1] = float(contact.punch.slope(y[-1]))
        return row


def mesh_control(contact: Contact, following: Control) -> Control:
    """Return the control of a mesh: what it follows, or its size if its compliance holds at one size only."""
    return following if contact.compliance.scales else Size(contact.compliance.size)


# A Newton iteration asks for the same radius at every step, and for its value and its gradient.
@lru_cache(maxsize=8)
def _functions_at(trace: Trace, s: float) -> Array:
    """Function values at one radius, shape (m,); read-only."""
    values = trace.evaluate(np.array([s]))[0]
    values.flags.writeable = False
    return values


def _unit(size: int, index: int) -> Array:
    row = np.zeros(size)
    row[index] = 1.0
    return row
