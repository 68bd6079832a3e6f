"""Difference of the response of a graded solid from that of a homogeneous one with the constants of its surface."""

from __future__ import annotations

import math
from functools import cached_property, lru_cache

import numpy as np

from fscm._panels import PanelMesh
from fscm._typing import Array
from fscm.graded.distant_ring import DistantRing
from fscm.graded.kernel import GradedKernel
from fscm.graded.panels import Remainder, remainder
from fscm.graded.patches import ImageTable
from fscm.solids import GradedHalfSpace

__all__ = ["GradedResponse", "response_of"]

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


class GradedResponse:
    """Difference of the response of a graded solid from that of a homogeneous one with the constants of its surface.

    Parameters
    ----------
    solid : GradedHalfSpace
        Depths in the unit of the radii.
    """

    def __init__(self, solid: GradedHalfSpace) -> None:
        self.kernel = GradedKernel(solid, _LONGEST)
        self._tables: dict[int, ImageTable] = {}
        self._depth = solid.length
        self._length = min([solid.length, *solid.interfaces])

    @property
    def softest(self) -> float:
        """Largest compliance at any wave number, in units of that of the surface, at least 1."""
        return self.kernel.images.largest

    def _table(self, order: int) -> ImageTable:
        """The table for meshes of so many nodes a panel."""
        degree = _LOW_DEGREE if order <= _COARSE else _HIGH_DEGREE
        if degree not in self._tables:
            self._tables[degree] = ImageTable(self.kernel.images, self._depth, degree)
        return self._tables[degree]

    def remainder(
        self, mesh: PanelMesh, c: float, reusable: tuple[PanelMesh, float, Remainder] | None = None
    ) -> Remainder:
        """R(c) of `fscm.graded.panels`; that on another mesh at the same c is reused."""
        previous = None
        if reusable is not None and abs(math.log(c / reusable[1])) <= _SAME:
            previous = reusable[0], reusable[2].moved(math.log(c / reusable[1]))
        return remainder(self._table(mesh.order), self._length, mesh, c, previous)

    @cached_property
    def distant(self) -> DistantRing:
        """Response at the center to distant rings, in units of that of a homogeneous solid."""
        return DistantRing(self.kernel)

    def error(self, mesh: PanelMesh, c: float, pressure: Array) -> tuple[Array, float]:
        """Bound of the error of W p at the nodes and on the axis by the kernel, from the sizes of the pressures."""
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
        return bessel @ seen + shares @ table, float(np.sum(seen) + np.sum(table))


@lru_cache(maxsize=8)
def response_of(solid: GradedHalfSpace) -> GradedResponse:
    """The response of a solid, cached."""
    return GradedResponse(solid)
