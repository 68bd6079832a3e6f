"""Solids: half-spaces whose modulus is a function of the depth, in any consistent units.

The response of a power law E0 (z/c0)^k, with the homogeneous solid as a special case, is exact.  Every other solid has
the modulus E(z) and Poisson's ratio nu(z), the depths at which they jump or have a kink, and a length over which they
change; its modulus at the surface is positive.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, TypeAlias, runtime_checkable

import numpy as np

from fscm._response_factor import response_factor
from fscm._typing import Array
from fscm._validation import real_number

__all__ = ["Coating", "Exponential", "GradedHalfSpace", "Homogeneous", "OffsetPowerLaw", "PowerLaw"]

#: Reasons of a refused Poisson's ratio, and of a refused number that is not positive.
ELASTIC, POSITIVE = "the solid is elastic, and incompressible at 0.5", "it is a positive quantity"


@runtime_checkable
class GradedHalfSpace(Protocol):
    """A solid whose elastic constants are functions of the depth.

    Examples
    --------
    >>> isinstance(Exponential(E_surface=1.0, E_depth=2.0, length=1.0, nu=0.3), GradedHalfSpace)
    True
    """

    def __hash__(self) -> int:
        """Key of the cached response."""
        ...

    @property
    def length(self) -> float:
        """A depth over which the constants change."""
        ...

    @property
    def interfaces(self) -> tuple[float, ...]:
        """Depths at which E(z), nu(z) or a derivative of them jumps, and those of thin layers."""
        ...

    def modulus(self, z: Array) -> Array:
        """E(z), z >= 0."""
        ...

    def poisson(self, z: Array) -> Array:
        """nu(z), z >= 0."""
        ...


#: A half-space of any kind.
Solid: TypeAlias = "PowerLaw | Homogeneous | GradedHalfSpace"


def _positive(solid: object, *names: str) -> None:
    for name in names:
        value = real_number(name, getattr(solid, name), low=0.0, high=math.inf, reason=POSITIVE)
        object.__setattr__(solid, name, value)


def elastic_ratio(name: str, value: object) -> float:
    """Poisson's ratio as a float.

    Raises
    ------
    ValueError
        When it is outside [0, 1/2].
    """
    return real_number(name, value, low=0.0, high=0.5, closed_low=True, closed_high=True, reason=ELASTIC)


def _elastic(solid: object, *names: str) -> None:
    for name in names:
        object.__setattr__(solid, name, elastic_ratio(name, getattr(solid, name)))


def _not_negative(solid: object, name: str, reason: str, high: float = math.inf) -> None:
    value = real_number(name, getattr(solid, name), low=0.0, high=high, closed_low=True, reason=reason)
    object.__setattr__(solid, name, value)


def checked_tension(value: object) -> float:
    """A surface tension as a float.

    Raises
    ------
    ValueError
        When it is negative or no number.
    """
    reason = "a surface with less energy the larger it is would not stay smooth"
    return real_number("surface_tension", value, low=0.0, high=math.inf, closed_low=True, reason=reason)


def _tension(solid: PowerLaw | Homogeneous | OffsetPowerLaw | Exponential | Coating) -> None:
    object.__setattr__(solid, "surface_tension", checked_tension(solid.surface_tension))


@dataclass(frozen=True, slots=True)
class PowerLaw:
    """E(z) = E0 (z/c0)^k (Eq. 3).

    Parameters
    ----------
    E0, c0 : float
        Modulus, and the depth at which it is reached, > 0.
    k : float
        Gradient exponent, 0 <= k <= 1.
    nu : float
        Poisson's ratio, 0 <= nu <= 1/2; for k = 1 (the Gibson solid) exactly 1/2, or the response is infinite.
    surface_tension : float
        Surface tension, a force per length, >= 0.

    Raises
    ------
    ValueError
        With the value, the admissible range and the reason.

    Examples
    --------
    >>> PowerLaw(E0=3.0, c0=1.0, k=0.5, nu=0.3).modulus(np.array([0.0, 4.0]))
    array([0., 6.])
    >>> PowerLaw(E0=3.0, c0=1.0, k=0, nu=0.5).contact_modulus
    4.0
    """

    E0: float
    c0: float
    k: float
    nu: float
    surface_tension: float = 0.0

    def __post_init__(self) -> None:
        _positive(self, "E0", "c0")
        reason = "E = E0 (z/c0)^k has no finite surface response there"
        k = real_number("k", self.k, low=0.0, high=1.0, closed_low=True, closed_high=True, reason=reason)
        object.__setattr__(self, "k", k)
        _elastic(self, "nu")
        _tension(self)
        if k == 1.0 and self.nu != 0.5:
            raise ValueError(
                f"nu = {self.nu:g} is outside [0.5, 0.5] for k = 1: only the incompressible Gibson solid has "
                "a finite b / (1 - k) in Eq. 29"
            )

    @property
    def power_law(self) -> PowerLaw:
        """The solid itself."""
        return self

    @property
    def contact_modulus(self) -> float:
        """E* = E0 / (1 - nu^2)."""
        return self.E0 / (1.0 - self.nu**2)

    @property
    def response_factor(self) -> float:
        """Factor b of Eq. 7, dimensionless."""
        return response_factor(self.k, self.nu)

    def modulus(self, z: Array) -> Array:
        """E(z)."""
        return self.E0 * (np.asarray(z, float) / self.c0) ** self.k

    def poisson(self, z: Array) -> Array:
        """nu everywhere."""
        return np.full(np.shape(z), self.nu)


@dataclass(frozen=True, slots=True)
class Homogeneous:
    """The modulus E and Poisson's ratio nu at every depth: the power law with k = 0.

    Parameters
    ----------
    E : float
        Modulus, > 0.
    nu : float
        Poisson's ratio, 0 <= nu <= 1/2.
    surface_tension : float
        Surface tension, a force per length, >= 0.

    Examples
    --------
    >>> Homogeneous(E=70e9, nu=0.2).power_law
    PowerLaw(E0=70000000000.0, c0=1.0, k=0.0, nu=0.2, surface_tension=0.0)
    """

    E: float
    nu: float
    surface_tension: float = 0.0

    def __post_init__(self) -> None:
        _positive(self, "E")
        _elastic(self, "nu")
        _tension(self)

    @property
    def power_law(self) -> PowerLaw:
        """The solid as a power law; c0 has no effect for k = 0."""
        return PowerLaw(self.E, 1.0, 0.0, self.nu, self.surface_tension)

    def modulus(self, z: Array) -> Array:
        """E everywhere."""
        return np.full(np.shape(z), self.E)

    def poisson(self, z: Array) -> Array:
        """nu everywhere."""
        return np.full(np.shape(z), self.nu)


@dataclass(frozen=True, slots=True)
class OffsetPowerLaw:
    """E(z) = E0 ((z + z_s)/c0)^k: a power law with a finite modulus at the surface.

    Parameters
    ----------
    E0, c0 : float
        Modulus, and the depth below z = -z_s at which it is reached, > 0.
    k : float
        Exponent, 0 <= k < 1.
    z_s : float
        Offset of the depth, > 0.
    nu : float
        Poisson's ratio, 0 <= nu <= 1/2.
    surface_tension : float
        Surface tension, a force per length, >= 0.

    Examples
    --------
    >>> OffsetPowerLaw(E0=2.0, c0=1.0, k=0.5, z_s=4.0, nu=0.3).modulus(np.array([0.0, 5.0]))
    array([4., 6.])
    """

    E0: float
    c0: float
    k: float
    z_s: float
    nu: float
    surface_tension: float = 0.0

    def __post_init__(self) -> None:
        _positive(self, "E0", "c0", "z_s")
        _not_negative(self, "k", "E = E0 ((z+z_s)/c0)^k has no finite surface response far away", high=1.0)
        _elastic(self, "nu")
        _tension(self)

    @property
    def length(self) -> float:
        """The offset."""
        return self.z_s

    @property
    def interfaces(self) -> tuple[float, ...]:
        """None."""
        return ()

    def modulus(self, z: Array) -> Array:
        """E(z)."""
        return self.E0 * ((np.asarray(z, float) + self.z_s) / self.c0) ** self.k

    def poisson(self, z: Array) -> Array:
        """nu everywhere."""
        return np.full(np.shape(z), self.nu)


@dataclass(frozen=True, slots=True)
class Exponential:
    """E(z) = E_depth + (E_surface - E_depth) exp(-z/length).

    Parameters
    ----------
    E_surface, E_depth : float
        Moduli at the surface and at great depth, > 0.
    length : float
        Length of the decay, > 0.
    nu : float
        Poisson's ratio, 0 <= nu <= 1/2.
    surface_tension : float
        Surface tension, a force per length, >= 0.

    Examples
    --------
    >>> Exponential(E_surface=1.0, E_depth=3.0, length=2.0, nu=0.3).modulus(np.array([0.0, 1e9]))
    array([1., 3.])
    """

    E_surface: float
    E_depth: float
    length: float
    nu: float
    surface_tension: float = 0.0

    def __post_init__(self) -> None:
        _positive(self, "E_surface", "E_depth", "length")
        _elastic(self, "nu")
        _tension(self)

    @property
    def interfaces(self) -> tuple[float, ...]:
        """None."""
        return ()

    def modulus(self, z: Array) -> Array:
        """E(z)."""
        return self.E_depth + (self.E_surface - self.E_depth) * np.exp(-np.asarray(z, float) / self.length)

    def poisson(self, z: Array) -> Array:
        """nu everywhere."""
        return np.full(np.shape(z), self.nu)


@dataclass(frozen=True, slots=True)
class Coating:
    """E_substrate + (E_coating - E_substrate) (1 - tanh((z - thickness)/transition))/2; sharp where transition = 0.

    Parameters
    ----------
    E_coating, E_substrate : float
        Moduli, > 0.
    thickness : float
        Depth of the interface, > 0.
    transition : float
        Length over which the modulus changes there, >= 0.
    nu_coating : float
        Poisson's ratio of the coating, 0 <= nu <= 1/2.
    nu_substrate : float, optional
        That of the substrate, joined in the same way; that of the coating by default.
    surface_tension : float
        Surface tension, a force per length, >= 0.

    Examples
    --------
    >>> Coating(E_coating=1.0, E_substrate=9.0, thickness=1.0, transition=0.0, nu_coating=0.3).modulus(
    ...     np.array([0.9, 1.1])
    ... )
    array([1., 9.])
    """

    E_coating: float
    E_substrate: float
    thickness: float
    transition: float
    nu_coating: float
    nu_substrate: float | None = None
    surface_tension: float = 0.0

    def __post_init__(self) -> None:
        _positive(self, "E_coating", "E_substrate", "thickness")
        _not_negative(self, "transition", "it is a length, zero for a sharp interface")
        if self.nu_substrate is None:
            object.__setattr__(self, "nu_substrate", self.nu_coating)
        _elastic(self, "nu_coating", "nu_substrate")
        _tension(self)

    @property
    def length(self) -> float:
        """The thickness."""
        return self.thickness

    @property
    def interfaces(self) -> tuple[float, ...]:
        """The interface, and both ends of the transition."""
        ends = (self.thickness - self.transition, self.thickness, self.thickness + self.transition)
        return tuple(sorted({z for z in ends if z > 0.0}))

    def _between(self, z: Array, coating: float, substrate: float) -> Array:
        x = np.asarray(z, float) - self.thickness
        with np.errstate(over="ignore"):
            # (1 - tanh x)/2 without its cancellation
            share = (
                np.where(x < 0.0, 1.0, 0.0)
                if self.transition == 0.0
                else 1.0 / (1.0 + np.exp(2.0 * x / self.transition))
            )
        return substrate + (coating - substrate) * share

    def modulus(self, z: Array) -> Array:
        """E(z)."""
        return self._between(z, self.E_coating, self.E_substrate)

    def poisson(self, z: Array) -> Array:
        """nu(z)."""
        return self._between(z, self.nu_coating, float(self.nu_substrate or 0.0))
