"""Response of the surfaces of all bodies of a problem: power laws, and the remainder by images.

In units of the power law that all bodies are at short waves (M and k of the problem) the displacement of Eq. 28 is

    w(r) = M (1-k) int p(t) G(r, t) dt,      G = sum_i w_i G_{k_i} + w_0 G_0,

with a term for each body that is one power law, and one, G_0, for all others together: graded solids, and any solid
with surface tension (`response.kernel`).
"""

from __future__ import annotations

import math
from functools import cached_property, lru_cache

import numpy as np

from fscm._surface.kernel import ring_response
from fscm._surface.mesh import PanelMesh
from fscm._surface.response.body import bodies_of
from fscm._surface.response.distant_ring import DistantRing
from fscm._surface.response.images import common_stiffness
from fscm._surface.response.kernel import GradedKernel
from fscm._surface.response.panels import Remainder, remainder
from fscm._surface.response.patches import ImageTable
from fscm._typing import Array
from fscm.bodies import Bodies, ring_rise, wave_factor
from fscm.solids import Solid

__all__ = ["SurfaceResponse", "response_of"]

#: Longest distance for which the images hold, in the unit of the radii: the pressure farther out is that of the tail.
_LONGEST = 1e6
#: Wave numbers for each decade where the error of the kernel is summed.
_POINTS = 12
#: Decades beyond the waves of the fit.
_BEYOND = 4
_BESSEL = 2.0 / math.pi
#: Largest change of log c for which the response is updated by its rate: the error is below that of the table.
_SAME = 1e-12
#: Degree of the table for meshes of up to _COARSE nodes a panel, whose states have errors of 1e-7 and more, and for
#: finer ones.  Its own bound of its error is in that of every value (measured worst 5e-8 and 9e-11 of the largest D).
_COARSE, _LOW_DEGREE, _HIGH_DEGREE = 10, 11, 15


class SurfaceResponse:
    """Response of bodies that are not one power law.

    Parameters
    ----------
    solids : Bodies or Solid
        Depths in the unit of the radii.

    Attributes
    ----------
    k : float
        Exponent of the power law that all bodies are at short waves, without surface tension.
    power_laws : dict
        w_i of the bodies that are one power law, by k_i.
    weight : float
        w_0; 0 if there is no other body.
    kernel : GradedKernel or None
        G_0.
    """

    def __init__(self, solids: Bodies | Solid) -> None:
        bodies = bodies_of(solids)
        self.k = max(body.surface.k for body in bodies)
        leading = [body for body in bodies if body.surface.k == self.k]
        if self.k == 0.0:
            stiffness = common_stiffness(bodies)
        else:
            stiffness = 1.0 / sum(ring_rise(body.surface) for body in leading)
        self.power_laws: dict[float, float] = {}
        #: w_i of the bodies with a power law without their surface tension, and w_0 of the others.
        self._elastic: dict[float, float] = {}
        for body in bodies:
            k, weight = body.surface.k, stiffness * ring_rise(body.surface)
            if body.is_power_law:
                self.power_laws[k] = self.power_laws.get(k, 0.0) + weight
            if not body.is_graded:
                self._elastic[k] = self._elastic.get(k, 0.0) + weight
        others = tuple(body for body in bodies if not body.is_power_law)
        self.weight = stiffness / common_stiffness(others) if others else 0.0
        self.kernel: GradedKernel | None = None
        self.has_tension = any(body.tension for body in bodies)
        if others:
            self.kernel = GradedKernel(Bodies(tuple(body.solid for body in others)), _LONGEST)
            self._shallowest = min(length for body in others for length in body.depths())
            if any(body.is_graded for body in others):
                self._elastic[0.0] = self._elastic.get(0.0, 0.0) + self.weight * self.kernel.images.largest
        self._tables: dict[int, ImageTable] = {}

    @cached_property
    def singular_parts(self) -> dict[float, float]:
        """Weights of all G_k by k: w_i, and what G_0 has of the homogeneous solid."""
        parts = dict(self.power_laws)
        shortest = 0.0 if self.kernel is None else self.weight * self.kernel.images.shortest
        if shortest:
            parts[0.0] = parts.get(0.0, 0.0) + shortest
        return parts

    def largest_mu(self, mu: float, n: float) -> float:
        """A Tabor number that is not below that of the softest parts of all bodies.

        Of a power law it is mu; those of several add up to more than that of their sum.  Surface tension stiffens: the
        largest contact of the radius a and the depth a^n whose elastic energy, a^(2n-1) / S(1/a), is that of adhesion.
        """
        k, total = self.k, 0.0
        for k_i, weight in self._elastic.items():
            power = 2.0 * n + k_i - 1.0
            total += mu ** ((2.0 * n + k - 1.0) / power) * ((1.0 - k) / (1.0 - k_i) * weight) ** (n / power)
        if not self.has_tension:
            return total
        waves, softness = self.spectrum
        energy = (1.0 - k) * mu ** ((2.0 * n + k - 1.0) / n) * softness * waves ** (2.0 * n - 1.0)
        possible = waves[energy >= 1.0]
        return min(total, float(possible[0]) ** -n) if possible.size else total

    @cached_property
    def spectrum(self) -> tuple[Array, Array]:
        """Wave numbers, and xi C(xi) there in units of M (1-k)."""
        if self.kernel is None:
            raise ValueError("a sum of power laws has no waves of its own")
        images = self.kernel.images
        softness = self.weight * images.values
        for k, weight in self.power_laws.items():
            softness = softness + weight * wave_factor(k) * images.waves**k
        return images.waves, softness

    def _table(self, order: int) -> ImageTable:
        """The table for meshes of so many nodes a panel."""
        assert self.kernel is not None
        degree = _LOW_DEGREE if order <= _COARSE else _HIGH_DEGREE
        if degree not in self._tables:
            self._tables[degree] = ImageTable(self.kernel.images, degree)
        return self._tables[degree]

    def remainder(
        self, mesh: PanelMesh, c: float, reusable: tuple[PanelMesh, float, Remainder] | None = None
    ) -> Remainder | None:
        """R(c) of `response.panels`; that on another mesh at the same c is reused.  None for power laws alone."""
        if self.kernel is None:
            return None
        previous = None
        if reusable is not None and abs(math.log(c / reusable[1])) <= _SAME:
            previous = reusable[0], reusable[2].moved(math.log(c / reusable[1]))
        return remainder(self._table(mesh.order), self._shallowest, mesh, c, previous)

    def ring(self, r: Array, t: Array, distance: Array) -> Array:
        """G(r, t); `distance` is abs(r - t)."""
        total = np.zeros(np.broadcast_shapes(np.shape(r), np.shape(t)))
        if self.kernel is not None:
            total = self.weight * self.kernel.response(r, t, distance)
        for k, weight in self.power_laws.items():
            total = total + weight * ring_response(k, r, t, distance)
        return total

    @cached_property
    def distant(self) -> DistantRing | None:
        """G_0 at the center, for distant rings."""
        return None if self.kernel is None else DistantRing(self.kernel)

    def at_center(self, t: Array, by_waves: bool = False) -> Array:
        """G(0, t) for distant rings, by the images or without them."""
        t = np.asarray(t, float)
        total = np.zeros(t.shape)
        if self.distant is not None:
            total = self.weight * (self.distant.by_waves(t) if by_waves else self.distant.by_images(t))
        for k, weight in self.power_laws.items():
            total = total + weight * t**-k
        return total

    def error(self, mesh: PanelMesh, c: float, pressure: Array) -> tuple[Array, float]:
        """Bound of the error of W p at the nodes and on the axis by the kernel, from the sizes of the pressures."""
        if self.kernel is None:
            return np.zeros(mesh.size), 0.0
        images = self.kernel.images
        low, high = images.waves[0] * 10.0**-_BEYOND, images.waves[-1] * 10.0**_BEYOND
        xi = np.geomspace(low, high, int(math.log10(high / low) * _POINTS))
        weights = images.error(xi) * xi * math.log(xi[1] / xi[0])
        # W = (1/c) G, and the radii are c s.
        bessel = np.sqrt(np.minimum(1.0, _BESSEL / (c * mesh.nodes[:, None] * xi)))
        strength = np.abs(pressure) * mesh.weights * mesh.nodes
        seen = c * weights * (strength @ bessel)
        table = self._table(mesh.order).error * np.abs(pressure) * mesh.weights
        shares = mesh.nodes / (mesh.nodes[:, None] + mesh.nodes)
        factor = self.weight * c**self.k
        return factor * (bessel @ seen + shares @ table), factor * float(np.sum(seen) + np.sum(table))


@lru_cache(maxsize=8)
def response_of(solids: Bodies | Solid) -> SurfaceResponse:
    """The response of a solid or of several bodies, cached."""
    return SurfaceResponse(solids)
