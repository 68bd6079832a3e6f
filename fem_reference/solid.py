"""A solid: a half-space with a modulus E(z) and a Poisson ratio nu(z), and the power law.

Any consistent units; depth z is positive into the solid.  A solid states the exponents of its power laws at the surface
and at great depth: the mesh resolves the first, the exterior takes the second.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fem_reference._typing import Array
from fem_reference._validation import check_positive, check_tension

__all__ = [
    "Interface",
    "OneRatio",
    "PowerLaw",
    "ScaledSolid",
    "Solid",
    "check_exponent",
    "check_ratio",
    "positive_modulus",
]


@dataclass(frozen=True, slots=True)
class Interface:
    """A depth where a solid changes.

    Parameters
    ----------
    depth : float
        A mesh line is put there.
    transition : float
        Length over which the solid changes around that depth; 0 for a sharp interface.

    Examples
    --------
    >>> Interface(depth=0.0)
    Traceback (most recent call last):
    ValueError: depth of an interface = 0.0 is outside (0, infinity): it is a real number
    """

    depth: float
    transition: float = 0.0

    def __post_init__(self) -> None:
        check_positive("depth of an interface", self.depth)
        if not (math.isfinite(self.transition) and self.transition >= 0):
            raise ValueError(f"transition = {self.transition} of an interface is outside [0, infinity): it is a length")


class Solid(ABC):
    """A half-space; hashable.

    A solid defines its modulus, its Poisson ratio and the depth over which its modulus leaves its power law at the
    surface.  The rest is that of a solid whose modulus is finite at the surface and at great depth.

    Examples
    --------
    >>> isinstance(PowerLaw(E0=1.0, c0=1.0, k=0.4, nu=0.3), Solid)
    True
    """

    __slots__ = ()

    @property
    @abstractmethod
    def surface_depth(self) -> float:
        """Depth over which E leaves its power law at the surface (infinity when it never does)."""

    @property
    def surface_exponent(self) -> float:
        """Exponent m of E ~ z^m as z -> 0, in [0, 1)."""
        return 0.0

    @property
    def depth_exponent(self) -> float:
        """Exponent m of E ~ z^m as z -> infinity, in [0, 1)."""
        return 0.0

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        """Depths where E or nu changes at once or within a short length, in any order."""
        return ()

    @property
    def surface_tension(self) -> float:
        """Force per length, >= 0."""
        return 0.0

    @property
    def bonded(self) -> bool:
        """Whether points of the surface keep their radius."""
        return False

    @property
    def as_power_law(self) -> PowerLaw | None:
        """The solid as a power law, if it is one."""
        return None

    @abstractmethod
    def modulus(self, z: Array) -> Array:
        """E(z), shape of `z`."""

    @abstractmethod
    def poisson(self, z: Array) -> Array:
        """nu(z) in [0, 0.5), shape of `z`."""

    def in_lengths(self, size: float) -> Solid:
        """Return the solid in lengths of `size`: E(size s) as a function of s.

        Examples
        --------
        >>> float(PowerLaw(E0=1.0, c0=1.0, k=0.5, nu=0.3).in_lengths(4.0).modulus(np.array(1.0)))
        2.0
        """
        return ScaledSolid(self, size, self.bonded)

    def without_tension(self) -> Solid:
        """Return the solid with a surface without tension."""
        return replace(self, surface_tension=0.0) if self.surface_tension else self  # type: ignore[type-var]  # a dataclass


def check_ratio(nu: Any) -> None:
    """Refuse a Poisson ratio outside [0, 0.5).

    Raises
    ------
    ValueError

    Examples
    --------
    >>> check_ratio(0.3)
    """
    if callable(nu):
        raise ValueError(f"nu = {nu!r} depends on depth; take CustomSolid(E, nu, length) for such a solid")
    if isinstance(nu, bool) or not isinstance(nu, (int, float, np.number)) or not 0 <= nu < 0.5:
        raise ValueError(f"Poisson ratio nu = {nu} is outside [0, 0.5): {REMEDY}")


#: What a refused ratio is told.
REMEDY = (
    "displacement elements cannot keep the volume; take nu = 0.499 or less, and for a homogeneous solid E times "
    "(1 - nu^2)/0.75, which leaves the forces on a frictionless surface the same"
)


def check_exponent(k: float) -> None:
    """Refuse a gradient exponent outside [0, 1).

    Raises
    ------
    ValueError

    Examples
    --------
    >>> check_exponent(0.4)
    """
    if not 0 <= k < 1:
        raise ValueError(f"gradient exponent k = {k} is outside [0, 1): at k = 1 the surface displacement is unbounded")


def positive_modulus(solid: Solid, z: Array) -> Array:
    """E(z) of an array of depths, which must be positive and finite.

    Raises
    ------
    ValueError
        With the first depth where it is not, or if its shape is not that of the depths.

    Examples
    --------
    >>> positive_modulus(PowerLaw(1.0, 1.0, 0.5, 0.3), np.array([4.0]))
    array([2.])
    """
    with np.errstate(all="ignore"):
        E = np.asarray(solid.modulus(z), float)
    if E.shape != z.shape:
        raise ValueError(f"the modulus of {z.size} depths has the shape {E.shape}: E(z) must have the shape of z")
    bad = ~(np.isfinite(E) & (E > 0))
    if bad.any():
        raise ValueError(
            f"the modulus is {E[bad][0]:g} at the depth {z[bad][0]:g}, outside (0, infinity): "
            "it must be positive and finite at every depth of the half-space"
        )
    return E


class OneRatio(Solid):
    """A solid with one Poisson ratio `nu` at every depth."""

    __slots__ = ()
    nu: float

    def __post_init__(self) -> None:
        check_ratio(self.nu)
        check_tension(self.surface_tension)

    def poisson(self, z: Array) -> Array:
        """The ratio, shape of `z`."""
        return np.full(np.shape(z), self.nu, float)


@dataclass(frozen=True, slots=True)
class PowerLaw(OneRatio):
    """E = E0 (z / c0)^k (Eq. 3 of the paper).

    Parameters
    ----------
    E0, c0 : float
        Modulus, and the depth at which it is reached, > 0.
    k : float
        Gradient exponent, 0 <= k < 1.
    nu : float
        Poisson's ratio in [0, 0.5).
    surface_tension : float
        Surface tension Y, a force per length, >= 0: the surface bears a pressure less Y times its mean curvature.

    Raises
    ------
    ValueError
        If a parameter is outside its range.

    Examples
    --------
    >>> float(PowerLaw(E0=2.0, c0=1.0, k=0.5, nu=0.3).modulus(np.array(4.0)))
    4.0
    >>> PowerLaw(E0=1.0, c0=1.0, k=0.4, nu=0.5)
    Traceback (most recent call last):
    ValueError: Poisson ratio nu = 0.5 is outside [0, 0.5): ...
    """

    E0: float
    c0: float
    k: float
    nu: float
    surface_tension: float = 0.0

    def __post_init__(self) -> None:
        OneRatio.__post_init__(self)
        check_positive("reference modulus E0", self.E0)
        check_positive("characteristic depth c0", self.c0)
        check_exponent(self.k)

    @property
    def surface_exponent(self) -> float:
        """The gradient exponent."""
        return self.k

    @property
    def depth_exponent(self) -> float:
        """The gradient exponent."""
        return self.k

    @property
    def surface_depth(self) -> float:
        """Infinite: one power law throughout."""
        return math.inf

    @property
    def as_power_law(self) -> PowerLaw:
        """The solid itself."""
        return self

    def modulus(self, z: Array) -> Array:
        """E(z)."""
        return self.E0 * (np.asarray(z, float) / self.c0) ** self.k


@dataclass(frozen=True, slots=True)
class ScaledSolid(Solid):
    """A solid in lengths of `size`, whose surface may be bonded.

    Examples
    --------
    >>> ScaledSolid(PowerLaw(1.0, 3.0, 0.5, 0.3, surface_tension=6.0), 3.0).as_power_law
    PowerLaw(E0=1.0, c0=1.0, k=0.5, nu=0.3, surface_tension=2.0)
    """

    solid: Solid
    size: float = 1.0
    bonded: bool = False

    @property
    def surface_exponent(self) -> float:
        """That of the solid."""
        return self.solid.surface_exponent

    @property
    def depth_exponent(self) -> float:
        """That of the solid."""
        return self.solid.depth_exponent

    @property
    def surface_depth(self) -> float:
        """That of the solid in lengths of the size."""
        return self.solid.surface_depth / self.size

    @property
    def interfaces(self) -> tuple[Interface, ...]:
        """Those of the solid in lengths of the size."""
        return tuple(Interface(i.depth / self.size, i.transition / self.size) for i in self.solid.interfaces)

    @property
    def surface_tension(self) -> float:
        """That of the solid over the size."""
        return self.solid.surface_tension / self.size

    @property
    def as_power_law(self) -> PowerLaw | None:
        """The power law in lengths of the size."""
        law = self.solid.as_power_law
        return law and replace(law, c0=law.c0 / self.size, surface_tension=law.surface_tension / self.size)

    def modulus(self, z: Array) -> Array:
        """E(z)."""
        return self.solid.modulus(np.asarray(z, float) * self.size)

    def poisson(self, z: Array) -> Array:
        """nu(z)."""
        return self.solid.poisson(np.asarray(z, float) * self.size)

    def in_lengths(self, size: float) -> Solid:
        """Return the solid in lengths of `size`."""
        return replace(self, size=size * self.size)

    def without_tension(self) -> Solid:
        """Return the solid with a surface without tension."""
        return replace(self, solid=self.solid.without_tension())
