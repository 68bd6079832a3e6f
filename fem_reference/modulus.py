"""Young's modulus as a function of depth.

Any consistent units; depth z is positive into the solid.  A modulus has the exponents
of its power laws at the surface and at great depth: the mesh resolves the first, the exterior takes the second.  It may
have `interfaces` too: depths where it changes at once or within a short length.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from fem_reference._typing import Array
from fem_reference._validation import check_positive

__all__ = ["Interface", "Modulus", "OffsetPowerLawModulus", "PowerLawModulus", "check_exponent", "interfaces_of"]


@runtime_checkable
class Modulus(Protocol):
    """Young's modulus E(z) with its limiting exponents, and optionally `interfaces` (see `interfaces_of`).

    Examples
    --------
    >>> isinstance(PowerLawModulus(1.0, 1.0, 0.4), Modulus)
    True
    """

    @property
    def surface_exponent(self) -> float:
        """Exponent m of E ~ z^m as z -> 0, in [0, 1)."""
        ...

    @property
    def depth_exponent(self) -> float:
        """Exponent m of E ~ z^m as z -> infinity, in [0, 1)."""
        ...

    @property
    def surface_depth(self) -> float:
        """Depth over which E leaves its surface power law (infinity when it never does)."""
        ...

    def __call__(self, z: Array) -> Array:
        """E(z), shape of `z`."""
        ...


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


@dataclass(frozen=True, slots=True)
class Interface:
    """A depth where the modulus changes.

    Parameters
    ----------
    depth : float
        A mesh line is put there.
    transition : float
        Length over which the modulus changes around that depth; 0 for a sharp interface.

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


def interfaces_of(profile: object) -> tuple[Interface, ...]:
    """Return the declared interfaces of a modulus or of a Poisson ratio, from the surface down.

    Examples
    --------
    >>> interfaces_of(PowerLawModulus(1.0, 1.0, 0.4))
    ()
    """
    declared: tuple[Interface, ...] = getattr(profile, "interfaces", ())
    return tuple(sorted(declared, key=lambda interface: interface.depth))


@dataclass(frozen=True, slots=True)
class PowerLawModulus:
    """E = E0 (z / c0)^k (Eq. 3 of the paper).

    Examples
    --------
    >>> float(PowerLawModulus(E0=2.0, c0=1.0, k=0.5)(np.array(4.0)))
    4.0
    """

    E0: float
    c0: float
    k: float

    def __post_init__(self) -> None:
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

    def __call__(self, z: Array) -> Array:
        """E(z), shape of `z`."""
        return self.E0 * (np.asarray(z, float) / self.c0) ** self.k


@dataclass(frozen=True, slots=True)
class OffsetPowerLawModulus:
    """E = E0 ((z + z_s) / c0)^k: a graded solid whose surface modulus does not vanish.

    Examples
    --------
    >>> float(OffsetPowerLawModulus(E0=2.0, c0=1.0, k=0.5, z_s=4.0)(np.array(0.0)))
    4.0
    """

    E0: float
    c0: float
    k: float
    z_s: float

    def __post_init__(self) -> None:
        check_positive("reference modulus E0", self.E0)
        check_positive("characteristic depth c0", self.c0)
        check_positive("surface offset z_s", self.z_s)
        check_exponent(self.k)

    @property
    def surface_exponent(self) -> float:
        """Zero: the surface modulus is finite."""
        return 0.0

    @property
    def depth_exponent(self) -> float:
        """The gradient exponent."""
        return self.k

    @property
    def surface_depth(self) -> float:
        """The offset z_s."""
        return self.z_s

    def __call__(self, z: Array) -> Array:
        """E(z), shape of `z`."""
        return self.E0 * ((np.asarray(z, float) + self.z_s) / self.c0) ** self.k
