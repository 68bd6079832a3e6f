r"""Surface compliance of one body, with its surface tension.

A power law has xi C = A xi^k (Eqs. 6 and 7 with int_0^oo xi^k J0(xi t) d(xi)), any other solid that of
`response.compliance`.  Its surface tension Y makes it

    xi C / (1 + Y xi (xi C)),

1/(Y xi) at waves much shorter than l with l^(1+k) = A Y, whatever the solid is.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from fscm._surface.response.compliance import compliance
from fscm._typing import Array
from fscm.bodies import Bodies, power_law_of, ring_rise, surface_of, tension_length, tension_of, wave_factor
from fscm.solids import GradedHalfSpace, PowerLaw, Solid

__all__ = ["Body", "bodies_of", "compliance_of"]


@dataclass(frozen=True)
class Body:
    """A solid with its surface tension.

    Parameters
    ----------
    solid : Solid
    """

    solid: Solid

    @property
    def tension(self) -> float:
        """Y."""
        return tension_of(self.solid)

    @cached_property
    def surface(self) -> PowerLaw:
        """The power law at short waves, without surface tension."""
        return surface_of(self.solid)

    @property
    def is_power_law(self) -> bool:
        """Whether the response is one G_k."""
        return power_law_of(self.solid) is not None and not self.tension

    @property
    def is_graded(self) -> bool:
        """Whether the modulus or Poisson's ratio is no power of the depth."""
        return power_law_of(self.solid) is None

    @cached_property
    def tension_length(self) -> float:
        """Length l below which the surface tension is stiffer than the solid; 0 without it."""
        return tension_length(self.solid)

    @property
    def stiffness(self) -> float:
        """Inverse of a typical xi C: half the contact modulus for k = 0, l^k / A for k > 0."""
        surface = self.surface
        if surface.k == 0.0:
            return 0.5 * surface.contact_modulus
        return float(self.tension_length**surface.k / (ring_rise(surface) * wave_factor(surface.k)))

    def compliance(self, xi: Array, refinement: int = 1) -> Array:
        """xi C(xi), shape of `xi`; steps of the integration are divided by `refinement`."""
        if isinstance(self.solid, GradedHalfSpace) and self.is_graded:
            elastic = compliance(self.solid, xi, refinement)
        else:
            elastic = ring_rise(self.surface) * wave_factor(self.surface.k) * xi**self.surface.k
        return elastic / (1.0 + self.tension * xi * elastic) if self.tension else elastic

    def elastic_depths(self) -> list[float]:
        """Depths near which the constants change; none of a power law."""
        solid = self.solid
        return [solid.length, *solid.interfaces] if isinstance(solid, GradedHalfSpace) and self.is_graded else []

    def depths(self) -> list[float]:
        """The same, and the length of the surface tension."""
        return self.elastic_depths() + ([self.tension_length] if self.tension else [])


def compliance_of(solids: Bodies | Solid, xi: Array) -> Array:
    """xi C(xi) of a solid or of several, surface tension included.

    Parameters
    ----------
    solids : Bodies or Solid
    xi : ndarray, shape (n,)
        Wave numbers, > 0, of the inverse unit of the depths.

    Examples
    --------
    >>> import numpy as np
    >>> from fscm import Homogeneous
    >>> compliance_of(Homogeneous(E=2.0, nu=0.0, surface_tension=1.0), np.array([1e-9, 1.0])).round(6)
    array([1. , 0.5])
    """
    first, *others = (body.compliance(xi) for body in bodies_of(solids))
    return sum(others, first)


def bodies_of(solids: Bodies | Solid) -> tuple[Body, ...]:
    """The bodies of a solid, or of several."""
    return tuple(Body(solid) for solid in (solids.solids if isinstance(solids, Bodies) else (solids,)))
