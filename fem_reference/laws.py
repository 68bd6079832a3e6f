"""Surface laws: traction p(H) between two faces at gap H, in physical units; compression is positive."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from fem_reference._typing import Array

__all__ = ["LennardJones", "SurfaceLaw"]


@runtime_checkable
class SurfaceLaw(Protocol):
    """A surface law with its scales and limits; frozen, so that it is hashable.

    Examples
    --------
    >>> isinstance(LennardJones(work_of_adhesion=1.0, z0=1.0), SurfaceLaw)
    True
    """

    @property
    def work_of_adhesion(self) -> float:
        """Energy per area to separate the faces from the gap without traction to infinity."""
        ...

    @property
    def length(self) -> float:
        """Range of the law: gaps are resolved and steps are chosen relative to it."""
        ...

    @property
    def peak_gap(self) -> float:
        """Gap of the largest tension, which marks the contact edge."""
        ...

    @property
    def singular_gap(self) -> float:
        """Gap at which the repulsion diverges (-infinity if it does not); every H stays above it."""
        ...

    @property
    def decay(self) -> tuple[float, float]:
        """(C, m) of the tail: p H^m -> -C as H -> infinity; C = 0 for a law of finite range."""
        ...

    def traction(self, H: Array) -> Array:
        """p(H), shape of `H`."""
        ...

    def slope(self, H: Array) -> Array:
        """dp/dH, shape of `H`."""
        ...

    def energy(self, H: Array) -> Array:
        """Integral of p from H to infinity, the energy per area of the faces at gap H."""
        ...


@dataclass(frozen=True, slots=True)
class LennardJones:
    """The 9-3 law p = (8 w / 3 z0) [(1 + H/z0)^-9 - (1 + H/z0)^-3] (Eq. 10 of the paper).

    Parameters
    ----------
    work_of_adhesion : float
        Energy per area w to separate the faces from H = 0 to infinity.
    z0 : float
        Range of the law, a length.

    Examples
    --------
    >>> law = LennardJones(work_of_adhesion=2.0, z0=0.5)
    >>> round(float(-law.traction(np.array(law.peak_gap))) * law.z0 / law.work_of_adhesion, 6)
    1.0264
    >>> float(law.energy(np.array(0.0)))
    -2.0
    """

    work_of_adhesion: float
    z0: float

    def __post_init__(self) -> None:
        for name, value in (("work of adhesion", self.work_of_adhesion), ("range z0", self.z0)):
            if not (math.isfinite(value) and value > 0):
                raise ValueError(f"{name} = {value} is outside (0, infinity)")

    @property
    def length(self) -> float:
        """The range z0."""
        return self.z0

    @property
    def peak_gap(self) -> float:
        """Gap of the largest tension, (3^(1/6) - 1) z0."""
        return (3.0 ** (1.0 / 6.0) - 1.0) * self.z0

    @property
    def singular_gap(self) -> float:
        """The repulsion diverges at H = -z0."""
        return -self.z0

    @property
    def decay(self) -> tuple[float, float]:
        """Tension (8 w z0^2 / 3) H^-3 at large gaps."""
        return 8.0 / 3.0 * self.work_of_adhesion * self.z0**2, 3.0

    def traction(self, H: Array) -> Array:
        """p(H), shape of `H`."""
        q = 1.0 / (1.0 + np.asarray(H, float) / self.z0)
        return (8.0 / 3.0) * self.work_of_adhesion / self.z0 * (q**9 - q**3)

    def slope(self, H: Array) -> Array:
        """dp/dH, shape of `H`."""
        q = 1.0 / (1.0 + np.asarray(H, float) / self.z0)
        return 8.0 * self.work_of_adhesion / self.z0**2 * (q**4 - 3.0 * q**10)

    def energy(self, H: Array) -> Array:
        """Integral of p from H to infinity, the energy per area of the faces at gap H: -w at H = 0."""
        q = 1.0 / (1.0 + np.asarray(H, float) / self.z0)
        return self.work_of_adhesion * (q**8 - 4.0 * q**2) / 3.0
