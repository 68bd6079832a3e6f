"""The potential of all atoms of a punch at a point of the surface: what every such interaction is asked."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Hashable
from functools import lru_cache

import numpy as np

from fscm._typing import Array
from fscm.laws import LennardJones, Mie, SurfaceLaw
from fscm.punch import PunchShape, ScaledPunch, kinks_of

__all__ = ["WholePunch", "WholePunchUnderMie", "aspect_of"]

#: The traction is nearly a power of the radius beyond so many sizes of the punch.
_FAR = 1e4
#: Halvings in the search of the size of the punch, between these radii.
_HALVINGS, _LEAST, _LARGEST = 60, 1e-30, 1e30


def aspect_of(punch: PunchShape) -> float:
    """Unit of radii over that of heights."""
    return punch.radius / punch.height_unit if isinstance(punch, ScaledPunch) else 1.0


class WholePunch(ABC):
    """An `fscm.interaction.Interaction` by the potential of a punch, which a subclass knows.

    Attributes
    ----------
    punch : PunchShape
    law : SurfaceLaw
        Law of the same atoms over a half-space.
    """

    __slots__ = ()
    punch: PunchShape
    law: SurfaceLaw

    @property
    def aspect(self) -> float:
        """Unit of radii over that of heights."""
        return aspect_of(self.punch)

    @property
    @abstractmethod
    def exponents(self) -> tuple[float, float]:
        """Of the repulsion and of the attraction of the law; of the attraction alone where it is not a sum of two."""

    @abstractmethod
    def traction(self, r: Array, H: Array) -> Array:
        """p(r, H)."""

    @abstractmethod
    def slope(self, r: Array, H: Array) -> Array:
        """dp/dH at a fixed radius."""

    @abstractmethod
    def energy(self, r: Array, H: Array) -> Array:
        """Integral of p from H to infinity at a fixed radius."""

    @abstractmethod
    def falls_as(self, r: float) -> float:
        """Exponent q of p ~ r^-q far away."""

    @property
    def slope_falls_by(self) -> float:
        """Exponent by which dp/dH falls faster."""
        return 1.0

    @property
    def size_of_punch(self) -> float:
        """Radius at which the punch is as high as wide, or of its last kink, in the unit of heights."""
        assert isinstance(self.punch, Hashable)  # a problem is hashable, and so are its parts
        return _size(self.punch)

    @property
    def far_radius(self) -> float:
        """Radius beyond which the traction is nearly a power."""
        return _FAR * self.size_of_punch / self.aspect

    def remainder(self, r: Array, H: Array) -> Array | None:
        """None: the potential is exact."""
        return None

    def opening(self, r: Array, H: Array) -> Array:
        """Change of the distance to the punch along the surface between points, of shape (2, N).

        It is that of the gap below a flat face, and anywhere at most the distance of the points, at the levels f - H.
        """
        level = self.punch.height(r) - H
        moved = self.aspect * np.abs(r[1] - r[0]) + np.abs(level[1] - level[0])
        return np.asarray(np.minimum(np.abs(H[1] - H[0]), moved))


class WholePunchUnderMie(WholePunch):
    """One whose atoms attract and repel each other by powers of the distance."""

    __slots__ = ()
    law: LennardJones | Mie

    @property
    def exponents(self) -> tuple[float, float]:
        """Of the repulsion and of the attraction of the law."""
        return (9.0, 3.0) if isinstance(self.law, LennardJones) else (self.law.m, self.law.n)

    @property
    def _strength(self) -> float:
        m, n = self.exponents
        return (m - 1.0) * (n - 1.0) / (m - n) * self.law.work_of_adhesion / self.law.z0


@lru_cache(maxsize=64)
def _size(punch: Hashable) -> float:
    assert isinstance(punch, PunchShape)
    aspect, low, high = aspect_of(punch), _LEAST, _LARGEST
    last = aspect * max(kinks_of(punch), default=0.0)
    if punch.growth <= 1.0:
        return max(last, aspect)
    for _ in range(_HALVINGS):
        middle = float(np.sqrt(low * high))
        higher = float(punch.height(np.array(middle / aspect))) > middle
        low, high = (low, middle) if higher else (middle, high)
    return max(last, high)
