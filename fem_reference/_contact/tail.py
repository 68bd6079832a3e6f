"""Equilibrium with the displacement that the mesh leaves out: that beyond its end, and that of the traction there.

Beyond the end R of the mesh the surface of a solid with E ~ z^k moves by w(R) (R/r)^(1+k), the response to a load far
away, and the traction there moves the contact by the integral of p(H) G(R) (R/r)^(1+k) 2 pi r dr.  G(R), the
displacement under a unit load at the distance R, is read from the compliance of the mesh.  Terms that are smaller by
(c/R)^2 are left out.  The equations of `fem_reference._contact.contact` leave out both: R is where they are negligible,
and the difference of an event with and without them shows whether they are.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fem_reference._contact.contact import Contact
from fem_reference._contact.far_rule import far_rule
from fem_reference._typing import Array

__all__ = ["TailContact"]

#: Gauss points in t, and least power s, with r = R / t^s: powers of r that are not integers are integrated to 1e-12 of
#: themselves.
POINTS, LEAST_POWER = 96, 4.0


@dataclass(frozen=True, slots=True, eq=False)
class TailContact(Contact):
    """Contact whose surface moves beyond the mesh as well.

    Attributes
    ----------
    depth_exponent : float
        Exponent k of the solid far below the surface.
    """

    depth_exponent: float = 0.0

    @property
    def _last(self) -> int:
        """Index of the vertex at the end of the mesh."""
        return int(self.compliance.trace.nodes.size) - 1

    def _tail(self, y: Array) -> tuple[Array, Array, Array]:
        """Radii, weights of dr, and gaps beyond the mesh."""
        R = self.compliance.trace.extent * float(y[-1])
        r, weight = far_rule(POINTS, self.force, R, least=LEAST_POWER)
        rise = y[self._last] * (R / r) ** (1.0 + self.depth_exponent)
        return r, weight, self.punch.height(r) - y[-2] + rise

    def _shift(self, y: Array) -> float:
        """Displacement of the contact under the traction beyond the mesh."""
        c = float(y[-1])
        trace = self.compliance.trace
        # The ring load of the vertex at s = 1 with the load vector 1 is 2 pi c^2 in P.
        G = self.compliance.factor(c) * float(self.compliance.matrix[self._last, trace.edge]) / (2.0 * math.pi * c**2)
        r, weight, H = self._tail(y)
        decay = (trace.extent * c / r) ** (1.0 + self.depth_exponent)
        return 2.0 * math.pi * G * float((weight * r * decay) @ self.force.traction(r, H))

    def residual(self, y: Array, gap: Array | None = None) -> Array:
        """Return w - factor X F minus the displacement under the traction beyond the mesh, shape (m,)."""
        vertices = np.zeros(self.unknowns)
        vertices[: self._last + 1] = 1.0
        return Contact.residual(self, y, gap) - self._shift(y) * vertices

    def load_gradient(self, y: Array) -> Array:
        """Return the derivative of the load with respect to y, shape (m + 2,)."""
        g = Contact.load_gradient(self, y)
        trace, c, power = self.compliance.trace, float(y[-1]), 1.0 + self.depth_exponent
        R, end = trace.extent * c, float(y[self._last])
        r, weight, H = self._tail(y)
        change = float((weight * r * (R / r) ** power) @ self.force.slopes(r, H)[1])
        edge = float(self.punch.height(np.array(R)) - y[-2])
        at_end = np.array(R)
        dropped = float(self.force.traction(at_end, np.array(edge + end)) - self.force.traction(at_end, np.array(edge)))
        g[self._last] += 2.0 * math.pi * change
        g[-1] += 2.0 * math.pi * (change * end * power / c - R * trace.extent * dropped)
        return g

    def energy(self, y: Array) -> float:
        """Elastic plus surface energy, with the elastic energy of the displacement beyond the mesh."""
        r, weight, H = self._tail(y)
        w = H - self.punch.height(r) + y[-2]
        beyond = 0.5 * float((weight * r * w) @ self.force.traction(r, H))
        return Contact.energy(self, y) + 2.0 * math.pi * beyond
