"""Young's modulus as a function of depth.

The Poisson ratio is constant.  Any consistent units; depth z is positive into the solid.  A modulus has the exponents
of its power laws at the surface and at great depth: the mesh resolves the first, the exterior takes the second.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from fem_reference._typing import Array

__all__ = ["CustomModulus", "Modulus", "OffsetPowerLawModulus", "PowerLawModulus"]


@runtime_checkable
class Modulus(Protocol):
    """Young's modulus E(z) with its limiting exponents.

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


def _check_exponent(k: float) -> None:
    if not 0 <= k < 1:
        raise ValueError(f"gradient exponent k = {k} is outside [0, 1): at k = 1 the surface displacement is unbounded")


def _check_positive(name: str, value: float) -> None:
    if not (math.isfinite(value) and value > 0):
        raise ValueError(f"{name} = {value} is outside (0, infinity)")


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
        _check_positive("reference modulus E0", self.E0)
        _check_positive("characteristic depth c0", self.c0)
        _check_exponent(self.k)

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
        _check_positive("reference modulus E0", self.E0)
        _check_positive("characteristic depth c0", self.c0)
        _check_positive("surface offset z_s", self.z_s)
        _check_exponent(self.k)

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


@dataclass(frozen=True, slots=True)
class CustomModulus:
    """Any positive E(z), with the exponents it has at the surface and at depth.

    Parameters
    ----------
    function : callable
        E(z) of an array of depths.
    surface_exponent, depth_exponent : float
        Exponents of E ~ z^m as z -> 0 and z -> infinity, in [0, 1).
    surface_depth : float
        Depth over which E leaves its surface law.

    Examples
    --------
    >>> stiffening = CustomModulus(lambda z: 1.0 + z**0.5, 0.0, 0.5, surface_depth=0.1)
    >>> float(stiffening(np.array(4.0)))
    3.0
    """

    function: Callable[[Array], Array]
    surface_exponent: float
    depth_exponent: float
    surface_depth: float

    def __post_init__(self) -> None:
        _check_exponent(self.surface_exponent)
        _check_exponent(self.depth_exponent)
        _check_positive("surface depth", self.surface_depth)

    def __call__(self, z: Array) -> Array:
        """E(z), shape of `z`."""
        return np.asarray(self.function(np.asarray(z, float)), float)
