"""Surface force and surface tension on the deformed surface: residual, tangent, load and energy.

The pressure p(rho, H) of an `Interaction` acts at the current radius rho = r + u_r and the vertical gap
H = f(rho) + u_z - delta.  The energy is the integral of p over the solid, that is of e(rho, H) 2 pi rho d rho over the
surface with de/dH = -p.  Its variation per radian is

    integral of p [rho u_z' du_r - rho rho' du_z] dr,

a pressure normal to the deformed surface; the ends of the surface, where e is negligible, have been left out.
Lengths are in units of the size c of the mesh, and tractions in units of E1, the modulus at the depth c.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fem_reference._contact.far_rule import far_rule
from fem_reference._elastic.trace import Trace
from fem_reference._large_strain.faces import Faces
from fem_reference._large_strain.surface_area import excess, excess_residual, excess_tangent
from fem_reference._typing import Array, Index
from fem_reference.interaction import Interaction
from fem_reference.laws import SurfaceLaw
from fem_reference.punch import Punch

__all__ = ["Surface", "local_slopes"]

#: Gauss points for the load beyond the mesh, in x = R/rho.
TAIL_POINTS = 48


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """Punch, law and surface functions at one size of the mesh.

    Attributes
    ----------
    trace : Trace
    slopes : ndarray, shape (e, q/e, p + 1)
        Derivatives of the functions of each element.
    punch : Punch
    law : SurfaceLaw
    interaction : Interaction
        Of both.
    size, modulus : float
        Units of length and of traction.
    finiteness : float
        Factor of the strains and of the rotation of the surface.
    tension : float
        Surface tension of the solid, in units of both.
    """

    trace: Trace
    slopes: Array
    punch: Punch
    law: SurfaceLaw
    interaction: Interaction
    size: float
    modulus: float
    finiteness: float = 1.0
    tension: float = 0.0

    def faces(self, radial: Array, axial: Array, delta: float) -> Faces:
        """Return the faces under coefficients of u_r and u_z in surface order, and an approach."""
        trace, t = self.trace, self.finiteness
        moved, dropped = radial[trace.functions][:, :, None], axial[trace.functions][:, :, None]
        rho = trace.s + t * (trace.local @ moved).ravel()
        stretch = 1.0 + t * (self.slopes @ moved).ravel()
        tilt = t * (self.slopes @ dropped).ravel()
        height = (trace.local @ dropped).ravel() - delta
        # A trial step may lead beyond the axis.
        shape = self.punch.height(self.size * np.maximum(rho, 0.0)) / self.size
        return Faces(rho, stretch, tilt, shape + height)

    def pressure(self, faces: Faces) -> Array:
        """p at the Gauss points, in units of the modulus."""
        return self._traction(faces.rho, faces.gap)

    def _traction(self, rho: Array, gap: Array) -> Array:
        return self.interaction.traction(self.size * np.maximum(rho, 0.0), self.size * gap) / self.modulus

    def pressure_slopes(self, faces: Faces) -> tuple[Array, Array]:
        """Derivatives of p at the Gauss points by the radius and by the height."""
        rho = self.size * np.maximum(faces.rho, 0.0)
        by_radius, by_gap = self.interaction.slopes(rho, self.size * faces.gap)
        unit = self.size / self.modulus
        return (by_radius + by_gap * self.punch.slope(rho)) * unit, by_gap * unit

    def residual(self, faces: Faces) -> tuple[Array, Array]:
        """Return the derivatives of the energy of the faces and of their area by both components, shape (e, p + 1)."""
        p = self.trace.weight * self.pressure(faces) * faces.rho
        e = self.trace.functions.shape[0]
        across, down = (p * faces.tilt).reshape(e, 1, -1), (p * faces.stretch).reshape(e, 1, -1)
        forces = self.finiteness * (across @ self.trace.local)[:, 0], -(down @ self.trace.local)[:, 0]
        if not self.tension:
            return forces
        of_area = excess_residual(faces, self.trace.weight, self.trace.local, self.slopes, self.finiteness)
        return forces[0] + self.tension * of_area[0], forces[1] + self.tension * of_area[1]

    def stiffness(self, faces: Faces) -> Array:
        """Return the derivative of the forces of the surface tension, as in `tangent`."""
        return self.tension * excess_tangent(faces, self.trace.weight, self.trace.local, self.slopes)

    def tangent(self, faces: Faces) -> tuple[Array, Array]:
        """Return the derivative of the residual by displacements, shape (e, 2 (p + 1), 2 (p + 1)), and by delta.

        Components are interleaved.
        """
        N, dN, t = self.trace.local, self.slopes, self.finiteness
        e, per, n = N.shape
        weight = self.trace.weight
        p = weight * self.pressure(faces)
        across, down = (weight * slope for slope in self.pressure_slopes(faces))
        rho, stretch, tilt = faces.rho, faces.stretch, faces.tilt

        def product(values: Array, functions: Array) -> Array:
            return np.swapaxes(N, 1, 2) @ (values.reshape(e, per, 1) * functions)

        K = np.empty((e, 2 * n, 2 * n))
        K[:, 0::2, 0::2] = t**2 * product(across * rho * tilt + p * tilt, N)
        K[:, 0::2, 1::2] = t * (product(down * rho * tilt, N) + t * product(p * rho, dN))
        K[:, 1::2, 0::2] = -t * (product(across * rho * stretch + p * stretch, N) + product(p * rho, dN))
        K[:, 1::2, 1::2] = -product(down * rho * stretch, N)
        if self.tension:
            K += self.stiffness(faces)
        by_delta = np.empty((e, 2 * n))
        by_delta[:, 0::2] = -t * product(down * rho * tilt, np.ones((1, per, 1)))[:, :, 0]
        by_delta[:, 1::2] = product(down * rho * stretch, np.ones((1, per, 1)))[:, :, 0]
        return K, by_delta

    def _beyond(self, end: float, delta: float) -> tuple[Array, Array, Array]:
        """Current radii, weights of d rho, and gaps beyond the mesh, where u_z is left out."""
        r, weight = far_rule(TAIL_POINTS, self.interaction, end, self.size)
        return r, weight, self.punch.height(self.size * r) / self.size - delta

    def load(self, faces: Faces, end: float, delta: float) -> float:
        """Load P in units of the input, compression positive.

        Parameters
        ----------
        faces : Faces
        end : float
            Current radius of the end of the mesh.
        delta : float
        """
        inside = float((self.trace.weight * self.pressure(faces) * faces.rho) @ faces.stretch)
        r, w, gap = self._beyond(end, delta)
        beyond = float(w * r @ self._traction(r, gap))
        return 2.0 * math.pi * self.size**2 * self.modulus * (inside + beyond)

    def energy(self, faces: Faces, end: float, delta: float) -> float:
        """Energy of the faces, and of the area of the surface of the mesh, in units of the input."""
        density = self.trace.weight * self.interaction.energy(self.size * faces.rho, self.size * faces.gap)
        inside = float((density * faces.rho) @ faces.stretch)
        r, w, gap = self._beyond(end, delta)
        beyond = float(w * r @ self.interaction.energy(self.size * r, self.size * gap))
        area = self.size * self.modulus * self.tension * excess(faces, self.trace.weight, self.finiteness)
        return 2.0 * math.pi * self.size**2 * (inside + beyond + area)


def local_slopes(trace: Trace) -> Array:
    """Derivatives of the surface functions at the Gauss points of each element, shape (e, q/e, p + 1)."""
    slopes: Array = trace.slopes(trace.s)
    elements: Index = trace.functions
    by_element = slopes.reshape(elements.shape[0], -1, slopes.shape[1])
    return np.take_along_axis(by_element, elements[:, None, :], axis=2)
