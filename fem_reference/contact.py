"""Equilibrium of punch, surface law and condensed solid: residual, exact tangent, bordered Newton.

Unknowns y = (w, delta, c): surface displacement w (chain order, positive into the solid), approach delta,
size c of the mesh (its node s = 1 is at the radius c).  The gap is H = -delta + f(c s) + w (Eq. 4 of the
paper), the load vector F = integral of p(H) phi s ds, and the m equations are

    w - factor(c) X F(w, delta, c) = 0.

Two controls close the system.  Loads beyond the mesh, where w has died out, enter P in closed quadrature.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy import linalg

from fem_reference.errors import NotConverged
from fem_reference.punch import Punch
from fem_reference.surface import Compliance
from fem_reference.traction import LennardJones

__all__ = [
    "ArcLength",
    "CentralGap",
    "Contact",
    "Control",
    "Displacement",
    "EdgeGap",
    "EdgeRadius",
    "ProfileRise",
    "Size",
    "State",
    "newton",
]

Array = NDArray[np.float64]

NEWTON_TOLERANCE = 1e-12
"""Largest residual, in units of z0 plus the largest displacement: ten times the rounding of X F."""

NEWTON_STEPS = 30
"""Damped steps before a point of the path is given up and the path step halved."""

TAIL_POINTS = 24
"""Gauss points for the load beyond the mesh in x = R/r: the integrand is close to a power of x."""


@dataclass(frozen=True, slots=True, eq=False)
class Contact:
    """A punch, a surface law and a solid condensed to its surface."""

    punch: Punch
    law: LennardJones
    compliance: Compliance

    @property
    def unknowns(self) -> int:
        """Number m of surface unknowns."""
        return self.compliance.matrix.shape[0]

    def gap(self, y: Array) -> Array:
        """H at the Gauss points."""
        trace = self.compliance.trace
        return -y[-2] + self.punch.height(y[-1] * trace.s) + trace.phi @ y[:-2]

    def residual(self, y: Array) -> Array:
        """Return w - factor X F, shape (m,)."""
        trace = self.compliance.trace
        F = trace.phi.T @ (trace.weight * trace.s * self.law.traction(self.gap(y)))
        return y[:-2] - self.compliance.factor(y[-1]) * (self.compliance.matrix @ F)

    def tangent(self, y: Array) -> Array:
        """Return the derivative of the residual, shape (m, m + 2)."""
        trace, X, c = self.compliance.trace, self.compliance.matrix, float(y[-1])
        H = self.gap(y)
        load = trace.weight * trace.s * self.law.traction(H)
        change = trace.weight * trace.s * self.law.slope(H)
        weighted = trace.phi.T * change
        rise = trace.s * self.punch.slope(c * trace.s)
        factor = self.compliance.factor(c)
        m = self.unknowns
        J = np.empty((m, m + 2))
        J[:, :m] = -factor * (X @ (weighted @ trace.phi))
        J[np.arange(m), np.arange(m)] += 1.0
        J[:, m] = factor * (X @ weighted.sum(axis=1))
        J[:, m + 1] = -X @ (factor * (weighted @ rise) + self.compliance.factor_slope(c) * (trace.phi.T @ load))
        return J

    def _tail(self, y: Array) -> tuple[Array, Array, Array]:
        """Radii, weights of dr, and gaps beyond the mesh."""
        x, w = np.polynomial.legendre.leggauss(TAIL_POINTS)
        x, w = 0.5 * (x + 1.0), 0.5 * w
        R = self.compliance.trace.extent * y[-1]
        r = R / x
        return r, w * R / x**2, self.punch.height(r) - y[-2]

    def load(self, y: Array) -> float:
        """Total load P, compression positive (Eq. 11), with the load beyond the mesh."""
        trace = self.compliance.trace
        inside = float(y[-1]) ** 2 * float(trace.weight * trace.s @ self.law.traction(self.gap(y)))
        r, w, H = self._tail(y)
        return 2.0 * math.pi * (inside + float(w * r @ self.law.traction(H)))

    def load_gradient(self, y: Array) -> Array:
        """Return the derivative of the load with respect to y, shape (m + 2,)."""
        trace, c = self.compliance.trace, float(y[-1])
        H = self.gap(y)
        measure = trace.weight * trace.s
        change = measure * self.law.slope(H)
        r, w, far = self._tail(y)
        R = trace.extent * c
        edge = float(self.law.traction(self.punch.height(np.array(R)) - y[-2]))
        g = np.empty(y.size)
        g[:-2] = c**2 * (change @ trace.phi)
        g[-2] = -(c**2) * change.sum() - float(w * r @ self.law.slope(far))
        g[-1] = (
            2.0 * c * float(measure @ self.law.traction(H))
            + c**2 * float(change @ (trace.s * self.punch.slope(c * trace.s)))
            - R * edge * trace.extent
        )
        return 2.0 * math.pi * g

    def energy(self, y: Array) -> float:
        """Elastic plus surface energy, relative to rigid faces at delta = 0; dE = P d(delta) on the path."""
        trace, c = self.compliance.trace, float(y[-1])
        H = self.gap(y)
        w = trace.phi @ y[:-2]
        shape = self.punch.height(c * trace.s)
        density = 0.5 * self.law.traction(H) * w + self.law.energy(H) - self.law.energy(shape)
        r, weight, far = self._tail(y)
        beyond = self.law.energy(far) - self.law.energy(self.punch.height(r))
        return 2.0 * math.pi * (c**2 * float(trace.weight * trace.s @ density) + float(weight * r @ beyond))


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
    """The mesh has the size c."""

    c: float

    def value(self, contact: Contact, y: Array) -> float:
        """Return c(y) - c."""
        return float(y[-1] - self.c)

    def gradient(self, contact: Contact, y: Array) -> Array:
        """Return a unit vector."""
        return _unit(y.size, -1)


@dataclass(frozen=True, slots=True)
class Displacement:
    """The approach is delta."""

    delta: float

    def value(self, contact: Contact, y: Array) -> float:
        """Return delta(y) - delta."""
        return float(y[-2] - self.delta)

    def gradient(self, contact: Contact, y: Array) -> Array:
        """Return a unit vector."""
        return _unit(y.size, -2)


@dataclass(frozen=True, slots=True)
class CentralGap:
    """The gap at r = 0 is H0."""

    H0: float

    def value(self, contact: Contact, y: Array) -> float:
        """Return H(0) - H0."""
        return float(y[0] - y[-2] - self.H0)

    def gradient(self, contact: Contact, y: Array) -> Array:
        """Row of d H(0)."""
        return _unit(y.size, 0) - _unit(y.size, -2)


@dataclass(frozen=True, slots=True)
class EdgeGap:
    """The gap at the mesh node s = 1 is H1: the mesh follows the contact edge."""

    H1: float

    def value(self, contact: Contact, y: Array) -> float:
        """Return H(s = 1) - H1."""
        edge = contact.compliance.trace.edge
        return float(y[edge] - y[-2] + contact.punch.height(y[-1]) - self.H1)

    def gradient(self, contact: Contact, y: Array) -> Array:
        """Row of d H(1)."""
        edge = contact.compliance.trace.edge
        row = _unit(y.size, edge) - _unit(y.size, -2)
        row[-1] = float(contact.punch.slope(y[-1]))
        return row


@dataclass(frozen=True, slots=True)
class EdgeRadius:
    """The gap at the radius `radius`, anywhere on the mesh, is H1: the edge moves over a fixed mesh."""

    H1: float
    radius: float

    def _row(self, contact: Contact, y: Array, shift: float = 0.0) -> Array:
        s = (self.radius + shift) / float(y[-1])
        return contact.compliance.trace.evaluate(np.array([s]))[0]

    def value(self, contact: Contact, y: Array) -> float:
        """Return H(radius) - H1."""
        height = float(contact.punch.height(np.array(self.radius)))
        return float(self._row(contact, y) @ y[:-2]) - float(y[-2]) + height - self.H1

    def gradient(self, contact: Contact, y: Array) -> Array:
        """Row of d H(radius) on a mesh of fixed size."""
        return np.concatenate([self._row(contact, y), [-1.0, 0.0]])

    def pace(self, contact: Contact, y: Array) -> float:
        """Change of the right-hand side per unit radius, -dH/dr, by central differences of the trace."""
        h = 1e-5 * self.radius
        rise = float((self._row(contact, y, h) - self._row(contact, y, -h)) @ y[:-2]) / (2.0 * h)
        return -rise - float(contact.punch.slope(np.array(self.radius)))


@dataclass(frozen=True, slots=True)
class ProfileRise:
    """The gap at the mesh node s = 1 exceeds the central gap by `rise`: the mesh follows the profile."""

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


@dataclass(frozen=True, slots=True, eq=False)
class ArcLength:
    """The point lies in the plane through `centre` normal to `direction` (both in y), `step` ahead."""

    centre: Array
    direction: Array
    step: float

    def value(self, contact: Contact, y: Array) -> float:
        """Return direction . (y - centre) - step."""
        return float(self.direction @ (y - self.centre)) - self.step

    def gradient(self, contact: Contact, y: Array) -> Array:
        """Return the direction."""
        return self.direction


def _unit(size: int, index: int) -> Array:
    row = np.zeros(size)
    row[index] = 1.0
    return row


@dataclass(frozen=True, slots=True, eq=False)
class State:
    """A converged point of the equilibrium path.

    Attributes
    ----------
    y : ndarray, shape (m + 2,)
        Displacement, approach and size.
    load : float
        P, compression positive.
    load_rate : float
        Derivative of P with respect to the parameter of the second control.
    rate : ndarray, shape (m + 2,)
        Derivative of y with respect to it.
    iterations : int
        Newton steps taken.
    residual : float
        Largest residual in units of z0.
    """

    y: Array
    load: float
    load_rate: float
    rate: Array
    iterations: int
    residual: float

    @property
    def displacement(self) -> float:
        """Approach delta."""
        return float(self.y[-2])

    @property
    def displacement_rate(self) -> float:
        """Derivative of delta with respect to the control."""
        return float(self.rate[-2])

    @property
    def size(self) -> float:
        """Size c of the mesh."""
        return float(self.y[-1])

    @property
    def central_gap(self) -> float:
        """Gap at r = 0."""
        return float(self.y[0] - self.y[-2])


def newton(contact: Contact, y: Array, first: Control, second: Control) -> State:
    """Solve the equilibrium equations under two controls.

    Parameters
    ----------
    contact : Contact
        The problem.
    y : ndarray, shape (m + 2,)
        Starting point.
    first, second : Control
        Closing equations; the rates of the returned state are with respect to the second.

    Returns
    -------
    State

    Raises
    ------
    NotConverged
        If the residual does not fall to the tolerance; take a closer starting point.
    """
    law = contact.law
    m = contact.unknowns
    y = np.array(y, float)
    K = np.empty((m + 2, m + 2))
    G = np.empty(m + 2)
    size = math.inf
    for iteration in range(NEWTON_STEPS + 1):
        G[:m] = contact.residual(y)
        G[m:] = first.value(contact, y), second.value(contact, y)
        K[:m] = contact.tangent(y)
        K[m], K[m + 1] = first.gradient(contact, y), second.gradient(contact, y)
        factors = linalg.lu_factor(K, check_finite=False)
        size = float(np.abs(G[:m]).max()) / law.z0
        limit = NEWTON_TOLERANCE * (1.0 + float(np.abs(y[:m]).max()) / law.z0)
        step = linalg.lu_solve(factors, G, check_finite=False)
        if size <= limit and np.abs(step[: m + 1]).max() <= 1e3 * limit * law.z0:
            pace = second.pace(contact, y) if isinstance(second, EdgeRadius) else 1.0
            rate = pace * linalg.lu_solve(factors, _unit(m + 2, -1), check_finite=False)
            slope = float(contact.load_gradient(y) @ rate)
            return State(y, contact.load(y), slope, rate, iteration, size)
        if not np.all(np.isfinite(step)):
            break
        y = y - _damping(contact, y, step) * step
    raise NotConverged(f"Newton stopped at a residual of {size:.1e} z0; start closer to the solution")


def _damping(contact: Contact, y: Array, step: Array) -> float:
    """Largest factor that keeps every gap above the law's floor and the size within 30 %."""
    factor = 1.0
    if abs(step[-1]) > 0.3 * y[-1]:
        factor = 0.3 * y[-1] / abs(step[-1])
    lowest = min(contact.law.floor, 0.5 * (contact.gap(y).min() - contact.law.z0))
    while factor > 1e-3 and contact.gap(y - factor * step).min() < lowest:
        factor *= 0.5
    return factor
