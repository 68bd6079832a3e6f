"""Elastic bodies whose surfaces respond together to one pressure.

At small strain the compliances of two bodies in contact add: the approach and the gap contain the displacements of
both.  A surface with the tension Y (force per length) is pressed by p - Y laplacian(u): its compliance C(xi) becomes
C/(1 + Y xi^2 C).  At short wave lengths the body whose modulus vanishes fastest towards the surface is the softest,
and without surface tension all bodies together respond there like one power law.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import cast

import numpy as np

from fscm._response_factor import response_factor, response_factor_per_rest
from fscm._typing import Array
from fscm._validation import real_number
from fscm.solids import GradedHalfSpace, PowerLaw, Solid

__all__ = [
    "Bodies",
    "ScaledSolid",
    "power_law_of",
    "ring_rise",
    "scaled",
    "surface_of",
    "tension_length",
    "tension_of",
    "wave_factor",
]


@dataclass(frozen=True, slots=True)
class ScaledSolid:
    """A solid whose depths are measured in another unit.

    Parameters
    ----------
    solid : GradedHalfSpace
    unit : float
        The new unit in the old one, > 0.

    Examples
    --------
    >>> from fscm import Exponential
    >>> ScaledSolid(Exponential(E_surface=1.0, E_depth=2.0, length=3.0, nu=0.3), unit=6.0).length
    0.5
    """

    solid: GradedHalfSpace
    unit: float

    def __post_init__(self) -> None:
        unit = real_number("unit", self.unit, low=0.0, high=float("inf"), reason="it is a length")
        object.__setattr__(self, "unit", unit)

    @property
    def length(self) -> float:
        """A depth over which the constants change."""
        return self.solid.length / self.unit

    @property
    def interfaces(self) -> tuple[float, ...]:
        """Depths at which the constants or their derivatives jump."""
        return tuple(z / self.unit for z in self.solid.interfaces)

    @property
    def surface_tension(self) -> float:
        """Surface tension: a modulus times a length."""
        return tension_of(self.solid) / self.unit

    def modulus(self, z: Array) -> Array:
        """E(z)."""
        return self.solid.modulus(self.unit * np.asarray(z, float))

    def poisson(self, z: Array) -> Array:
        """nu(z)."""
        return self.solid.poisson(self.unit * np.asarray(z, float))


def power_law_of(solid: object) -> PowerLaw | None:
    """The power law that a solid is; None for any other solid."""
    power_law: PowerLaw | None = getattr(solid, "power_law", None)
    return power_law


def tension_of(solid: Solid) -> float:
    """Surface tension of a solid; 0 for one that has no such attribute."""
    return float(getattr(solid, "surface_tension", 0.0))


def scaled(solid: Solid, unit: float) -> PowerLaw | ScaledSolid:
    """The solid with lengths in another unit."""
    power_law = power_law_of(solid)
    if power_law is None:
        return ScaledSolid(cast(GradedHalfSpace, solid), unit)
    return replace(power_law, c0=power_law.c0 / unit, surface_tension=power_law.surface_tension / unit)


def surface_of(solid: Solid) -> PowerLaw:
    """The power law that a solid is at short wave lengths, without its surface tension.

    Examples
    --------
    >>> from fscm import Exponential
    >>> surface_of(Exponential(E_surface=1.0, E_depth=2.0, length=3.0, nu=0.3)).E0
    1.0
    """
    power_law = power_law_of(solid)
    if power_law is not None:
        return replace(power_law, surface_tension=0.0)
    surface = np.zeros(1)
    return PowerLaw(float(solid.modulus(surface)[0]), 1.0, 0.0, float(solid.poisson(surface)[0]))


def ring_rise(surface: PowerLaw) -> float:
    """2 b c0^k / E* of Eq. 6: a ring of unit pressure lifts the surface by so many G_k."""
    return 2.0 * response_factor(surface.k, surface.nu) * surface.c0**surface.k / surface.contact_modulus


def wave_factor(k: float) -> float:
    """h in G_k(r, t) = h t int_0^oo xi^k J0(xi r) J0(xi t) d(xi).

    Examples
    --------
    >>> wave_factor(0.0)
    1.0
    """
    return math.gamma(0.5 - 0.5 * k) / (2.0**k * math.gamma(0.5 + 0.5 * k))


def tension_length(solid: Solid) -> float:
    """Length l at which surface tension is as stiff as the solid at its surface: Y xi^2 C = (l xi)^(1+k).

    Examples
    --------
    >>> from fscm import Homogeneous
    >>> tension_length(Homogeneous(E=4.0, nu=0.0, surface_tension=6.0))    # 2 Y / E*
    3.0
    """
    surface = surface_of(solid)
    return float((ring_rise(surface) * wave_factor(surface.k) * tension_of(solid)) ** (1.0 / (1.0 + surface.k)))


@dataclass(frozen=True, slots=True)
class Bodies:
    """One or two elastic bodies that feel the same pressure.

    Parameters
    ----------
    solids : tuple of Solid

    Examples
    --------
    Two halves of a modulus:

    >>> from fscm import Homogeneous
    >>> Bodies((Homogeneous(E=2.0, nu=0.0), Homogeneous(E=2.0, nu=0.0))).surface.E0
    1.0
    """

    solids: tuple[Solid, ...]

    @property
    def surface(self) -> PowerLaw:
        """The power law that all bodies together are at short wave lengths, without surface tension."""
        surfaces = [surface_of(solid) for solid in self.solids]
        k = max(surface.k for surface in surfaces)
        first, *others = [surface for surface in surfaces if surface.k == k]
        if not others:
            return first
        # b/(1-k) stays finite as k -> 1.
        rises = [
            response_factor_per_rest(k, surface.nu) * (surface.c0 / first.c0) ** k / surface.contact_modulus
            for surface in (first, *others)
        ]
        return replace(first, E0=first.E0 * rises[0] / sum(rises))

    @property
    def are_one_power_law(self) -> bool:
        """Whether the bodies respond like one power law at all wave lengths."""
        power_laws = [power_law_of(solid) for solid in self.solids]
        exponents = {None if power_law is None else power_law.k for power_law in power_laws}
        return len(exponents) == 1 and None not in exponents and not any(map(tension_of, self.solids))
