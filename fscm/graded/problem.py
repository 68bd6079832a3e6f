"""Dimensionless problem of a punch on a solid whose modulus is any function of the depth."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fscm._panels import PanelMesh
from fscm._typing import Array
from fscm.graded.kernel import GradedKernel
from fscm.graded.panels import Remainder, remainder
from fscm.graded.patches import ImageTable
from fscm.graded.solids import GradedHalfSpace
from fscm.laws import SurfaceLaw
from fscm.problem import Problem
from fscm.punch import PunchShape

__all__ = ["GradedProblem", "GradedResponse", "response_of"]

# The images serve distances up to this one, in the unit of the radii: the pressure farther out is that of the tail.
_LONGEST = 1e6
# Wave numbers for each decade where the error of the kernel is summed.
_POINTS = 12
# Decades beyond the waves of the fit.
_BEYOND = 4
_BESSEL = 2.0 / math.pi
# Largest change of log c for which the response is moved by its rate: that changes by as much, less than the table's
# error.
_SAME = 1e-12


class GradedResponse:
    """What distinguishes the response of a graded solid from that of its surface.

    Parameters
    ----------
    solid : GradedHalfSpace
        Depths in the unit of the radii.
    """

    def __init__(self, solid: GradedHalfSpace) -> None:
        self.kernel = GradedKernel(solid, _LONGEST)
        self._table = ImageTable(self.kernel.images, solid.length)
        self._length = min([solid.length, *solid.interfaces])

    @property
    def softest(self) -> float:
        """Largest compliance at any wave number, in units of that of the surface, at least 1."""
        return self.kernel.images.largest

    def remainder(
        self, mesh: PanelMesh, c: float, known: tuple[PanelMesh, float, Remainder] | None = None
    ) -> Remainder:
        """R(c) of `fscm.graded.panels`; what is known of another mesh at the same c is kept."""
        previous = None
        if known is not None and abs(math.log(c / known[1])) <= _SAME:
            previous = known[0], known[2].moved(math.log(c / known[1]))
        return remainder(self._table, self._length, mesh, c, previous)

    def far(self, radius: float) -> float:
        """Response at the center to a distant ring, in units of that of a homogeneous solid."""
        return float(self.kernel.response(np.zeros(1), np.array([radius]))[0])

    def error(self, mesh: PanelMesh, c: float, pressure: Array) -> tuple[Array, float]:
        """Bound of the error of (W p) at the nodes and on the axis by the kernel, from the sizes of the pressures."""
        images = self.kernel.images
        first, last = images.waves[0] * 10.0**-_BEYOND, images.waves[-1] * 10.0**_BEYOND
        xi = np.geomspace(first, last, int(math.log10(last / first) * _POINTS))
        weights = images.error(xi) * xi * math.log(xi[1] / xi[0])
        # W = (1/c) G, and the radii are c s.
        bessel = np.sqrt(np.minimum(1.0, _BESSEL / (c * mesh.nodes[:, None] * xi)))
        strength = np.abs(pressure) * mesh.weights * mesh.nodes
        seen = c * weights * (strength @ bessel)
        table = self._table.error * np.abs(pressure) * mesh.weights
        shares = mesh.nodes / (mesh.nodes[:, None] + mesh.nodes)
        return bessel @ seen + shares @ table, float(np.sum(seen) + np.sum(table))


@lru_cache(maxsize=8)
def response_of(solid: GradedHalfSpace) -> GradedResponse:
    """The response of a solid, made once."""
    return GradedResponse(solid)


@dataclass(frozen=True, slots=True, init=False)
class GradedProblem(Problem):
    """Adhesive contact of a rigid punch with a solid of any E(z) and nu(z), dimensionless.

    Everything is measured as on the homogeneous solid with the constants of the surface, k = 0: the Tabor number is
    that of E(0)/(1 - nu(0)^2), heights are in z0 and radii in (Q z0)^(1/n).

    Parameters
    ----------
    n : float
        Shape index of the punch, > 1/2; it also enters the definition of `mu`.
    mu : float
        Tabor number with the modulus of the surface (Eq. 29 at k = 0).
    solid : GradedHalfSpace
        Depths in the unit of the radii, (Q z0)^(1/n); the unit of the modulus does not matter.
    punch, law
        As for `Problem`.
    k : float, optional
        Exponent of the modulus at the surface: 0.

    Examples
    --------
    >>> from fscm import solve
    >>> from fscm.graded import Exponential
    >>> problem = GradedProblem(2, 1.0, Exponential(E_surface=1.0, E_depth=4.0, length=1.0, nu=0.3))
    >>> round(solve(problem, "pull_off_force").value, 8)
    1.83389676
    """

    solid: GradedHalfSpace

    def __init__(
        self,
        n: float,
        mu: float,
        solid: GradedHalfSpace,
        punch: PunchShape | None = None,
        law: SurfaceLaw | None = None,
        k: float = 0.0,
    ) -> None:
        if k != 0.0:
            raise ValueError(f"gradient exponent k = {k} is outside [0, 0]: the modulus at the surface is finite")
        if not isinstance(solid, GradedHalfSpace):
            raise ValueError(
                f"solid = {solid!r} is no graded solid: it needs modulus(z), poisson(z), length, interfaces"
            )
        Problem.__init__(self, n, 0.0, mu, punch, law)
        object.__setattr__(self, "solid", solid)

    @property
    def response(self) -> GradedResponse:
        """The response of the solid."""
        return response_of(self.solid)

    @property
    def largest_mu(self) -> float:
        """The Tabor number with the largest compliance at any wave number."""
        return self.mu * self.response.softest ** (self.n / (2.0 * self.n - 1.0))
