"""Punch shapes f(r), dimensionless: heights in z0, radii in the transverse length (Q z0)^(1/n).

A profile is smooth enough to be differentiated, vanishes at r = 0 and grows like a power of r at infinity:
the solver closes its infinite domain with that power.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

__all__ = ["PowerLaw", "Profile"]

Array = NDArray[np.float64]


@runtime_checkable
class Profile(Protocol):
    """An axisymmetric punch shape; `growth` is the exponent g of f ~ r^g at infinity."""

    @property
    def growth(self) -> float:
        """Exponent of growth at infinity."""
        ...

    def height(self, r: Array) -> Array:
        """f(r), shape of `r`."""
        ...

    def slope(self, r: Array) -> Array:
        """df/dr, shape of `r`."""
        ...


@dataclass(frozen=True, slots=True)
class PowerLaw:
    """f(r) = r^n / n (Eq. 26); n = 1 is a cone, n = 2 a paraboloid, n -> infinity a flat punch.

    Examples
    --------
    >>> PowerLaw(2.0).height(np.array([0.0, 2.0]))
    array([0., 2.])
    """

    n: float

    def __post_init__(self) -> None:
        if not (math.isfinite(self.n) and self.n > 0):
            raise ValueError(f"shape index n = {self.n} is outside (0, infinity): f = r^n / n must grow with r")

    @property
    def growth(self) -> float:
        """The shape index."""
        return self.n

    def height(self, r: Array) -> Array:
        """f(r) = r^n / n."""
        return np.asarray(r, float) ** self.n / self.n

    def slope(self, r: Array) -> Array:
        """df/dr = r^(n-1)."""
        return np.asarray(r, float) ** (self.n - 1.0)
