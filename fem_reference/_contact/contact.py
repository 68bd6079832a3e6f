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
    punch : Punch
        f(r).
    law : SurfaceLaw
        p(H).
    compliance : Compliance
        Of the solid, on its surface mesh.
    """

    punch: Punch
    law: SurfaceLaw
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
        rise = trace.s * self.punch.slope(c * trace.s)
        factor = self.compliance.factor(c)
        m = self.unknowns
        # X is symmetric: X M is the transpose of M X, and the columns of J are what a factorisation reads.
        J = np.empty((m, m + 2), order="F")
        J[:, :m] = -factor * trace.mass_times(change, X).T
        J[np.arange(m), np.arange(m)] += 1.0
        vectors = trace.phi.T @ np.stack([change, change * rise, load], axis=1)
        J[:, m] = factor * (X @ vectors[:, 0])
        J[:, m + 1] = -X @ (factor * vectors[:, 1] + self.compliance.factor_slope(c) * vectors[:, 2])
        return J

    def _tail(self, y: Array) -> tuple[Array, Array, Array]:
        """Radii, weights of dr, and gaps beyond the mesh."""
        r, weight = far_rule(TAIL_POINTS, self.punch, self.law, self.compliance.trace.extent * float(y[-1]))
        return r, weight, self.punch.height(r) - y[-2]

    def load(self, y: Array) -> float:
        """Total load P, compression positive (Eq. 11), with the load beyond the mesh."""
        trace = self.compliance.trace
        inside = float(y[-1]) ** 2 * float(trace.weight * trace.s @ self.law.traction(self.gap(y)))
        r, w, H = self._tail(y)
        return 2.0 * math.pi * (inside + float(w * r @ self.law.traction(H)))

    def load_beyond(self, y: Array) -> float:
        """Part of the load beyond the mesh."""
        r, w, H = self._tail(y)
        return 2.0 * math.pi * float(w * r @ self.law.traction(H))

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
