"""Equilibrium equations of punch, surface law and condensed solid: residual, tangent, load and energy.

Unknowns y = (w, delta, c): surface displacement w (surface order, positive into the solid), approach delta,
size c of the mesh (its node s = 1 is at the radius c).  The gap is H = -delta + f(c s) + w (Eq. 4 of the
paper), the load vector F = integral of p(H) phi s ds, and the m equations are

    w - factor(c) X F(w, delta, c) = 0.

Two controls (`fem_reference._contact.controls`) close the system.  Loads beyond the mesh, where w is negligible,
enter P by a quadrature to infinity.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fem_reference._contact.far_rule import far_rule
from fem_reference._elastic.compliance import Compliance
from fem_reference._typing import Array
from fem_reference.interaction import Interaction
from fem_reference.laws import SurfaceLaw
from fem_reference.punch import Punch

__all__ = ["Contact"]


#: Gauss points for the load beyond the mesh.
TAIL_POINTS = 24


@dataclass(frozen=True, slots=True, eq=False)
class Contact:
    """A punch, a surface law and a solid condensed to its surface.

    Attributes
    ----------
    force : Interaction
        p(r, H) of the punch.
    compliance : Compliance
        Of the solid, on its surface mesh.
    """

    force: Interaction
    compliance: Compliance

    @property
    def punch(self) -> Punch:
        """f(r)."""
        return self.force.punch

    @property
    def law(self) -> SurfaceLaw:
        """p(H) over a half-space."""
        return self.force.law

    @property
    def unknowns(self) -> int:
        """Number m of surface unknowns."""
        return self.compliance.matrix.shape[0]

    def gap(self, y: Array) -> Array:
        """H at the Gauss points."""
        trace = self.compliance.trace
        return -y[-2] + self.punch.height(y[-1] * trace.s) + trace.phi @ y[:-2]

    def pressure(self, y: Array) -> Array:
        """p at the Gauss points."""
        return self._pressure(y, self.gap(y))

    def _pressure(self, y: Array, gap: Array) -> Array:
        return self.force.traction(y[-1] * self.compliance.trace.s, gap)

    def residual(self, y: Array, gap: Array | None = None) -> Array:
        """Return w - factor X F, shape (m,); with the gap at the Gauss points, where that is known."""
        trace = self.compliance.trace
        F = trace.phi.T @ (trace.weight * trace.s * self._pressure(y, self.gap(y) if gap is None else gap))
        return y[:-2] - self.compliance.factor(y[-1]) * (self.compliance.matrix @ F)

    def tangent(self, y: Array, gap: Array | None = None) -> Array:
        """Return the derivative of the residual, shape (m, m + 2); with the gap as for `residual`."""
        trace, X, c = self.compliance.trace, self.compliance.matrix, float(y[-1])
        gap = self.gap(y) if gap is None else gap
        load = trace.weight * trace.s * self._pressure(y, gap)
        change, drift = self._changes(y, gap)
        rise = trace.s * self.punch.slope(c * trace.s)
        factor = self.compliance.factor(c)
        m = self.unknowns
        # X is symmetric: X M is the transpose of M X, and the columns of J are what a factorisation reads.
        J = np.empty((m, m + 2), order="F")
        J[:, :m] = trace.mass_times(-factor * change, X).T
        J[np.arange(m), np.arange(m)] += 1.0
        vectors = trace.phi.T @ np.stack([change, change * rise + drift, load], axis=1)
        J[:, m] = factor * (X @ vectors[:, 0])
        J[:, m + 1] = X @ (-factor * vectors[:, 1] - self.compliance.factor_slope(c) * vectors[:, 2])
        return J

    def _changes(self, y: Array, gap: Array) -> tuple[Array, Array]:
        """Derivatives of p by the gap, and by the size at a fixed gap, times the weights s ds."""
        trace = self.compliance.trace
        by_radius, by_gap = self.force.slopes(y[-1] * trace.s, gap)
        measure = trace.weight * trace.s
        return measure * by_gap, measure * trace.s * by_radius

    def _tail(self, y: Array) -> tuple[Array, Array, Array]:
        """Radii, weights of dr, and gaps beyond the mesh."""
        r, weight = far_rule(TAIL_POINTS, self.force, self.compliance.trace.extent * float(y[-1]))
        return r, weight, self.punch.height(r) - y[-2]

    def load(self, y: Array) -> float:
        """Total load P, compression positive (Eq. 11), with the load beyond the mesh."""
        trace = self.compliance.trace
        inside = float(y[-1]) ** 2 * float(trace.weight * trace.s @ self.pressure(y))
        r, w, H = self._tail(y)
        return 2.0 * math.pi * (inside + float(w * r @ self.force.traction(r, H)))

    def load_beyond(self, y: Array) -> float:
        """Part of the load beyond the mesh."""
        r, w, H = self._tail(y)
        return 2.0 * math.pi * float(w * r @ self.force.traction(r, H))

    def load_gradient(self, y: Array) -> Array:
        """Return the derivative of the load with respect to y, shape (m + 2,)."""
        trace, c = self.compliance.trace, float(y[-1])
        gap = self.gap(y)
        change, drift = self._changes(y, gap)
        r, w, far = self._tail(y)
        R = trace.extent * c
        edge = float(self.force.traction(np.array(R), self.punch.height(np.array(R)) - y[-2]))
        g = np.empty(y.size)
        g[:-2] = c**2 * (change @ trace.phi)
        g[-2] = -(c**2) * change.sum() - float(w * r @ self.force.slopes(r, far)[1])
        g[-1] = (
            2.0 * c * float(trace.weight * trace.s @ self._pressure(y, gap))
            + c**2 * float(change @ (trace.s * self.punch.slope(c * trace.s)) + drift.sum())
            - R * edge * trace.extent
        )
        return 2.0 * math.pi * g

    def energy(self, y: Array) -> float:
        """Elastic plus surface energy, relative to rigid faces at delta = 0; dE = P d(delta) on the path."""
        trace, c = self.compliance.trace, float(y[-1])
        force, H, r = self.force, self.gap(y), c * trace.s
        w = trace.phi @ y[:-2]
        density = 0.5 * self.pressure(y) * w + force.energy(r, H) - force.energy(r, self.punch.height(r))
        r, weight, far = self._tail(y)
        beyond = force.energy(r, far) - force.energy(r, self.punch.height(r))
        return 2.0 * math.pi * (c**2 * float(trace.weight * trace.s @ density) + float(weight * r @ beyond))
