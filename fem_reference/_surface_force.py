"""Surface force of a punch: its contract, and what follows from its traction and slopes."""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable

import numpy as np

from fem_reference._typing import Array
from fem_reference.laws import SurfaceLaw
from fem_reference.punch import Punch

__all__ = ["BESIDE", "Interaction", "secant_root"]

#: Relative step of the difference for the slope of the gap of the largest tension.
BESIDE = 1e-4


class Interaction(ABC):
    """Traction on the surface of the solid; compression is positive."""

    __slots__ = ()
    punch: Punch
    #: The law of the same atoms over a half-space.
    law: SurfaceLaw

    @property
    def finer(self) -> Interaction:
        """The same by a finer quadrature, or itself if it has none."""
        return self

    @abstractmethod
    def traction(self, rho: Array, gap: Array) -> Array:
        """p at the radius rho and the vertical gap H, shape of both."""

    @abstractmethod
    def slopes(self, rho: Array, gap: Array) -> tuple[Array, Array]:
        """dp/drho at a fixed gap, and dp/dH."""

    @abstractmethod
    def energy(self, rho: Array, gap: Array) -> Array:
        """Integral of p from H to infinity, the energy per projected area."""

    @abstractmethod
    def peak_gap(self, rho: Array) -> Array | float:
        """Gap of the largest tension at a radius: the one at the contact edge."""

    def peak_slope(self, rho: Array) -> Array | float:
        """Its derivative by the radius."""
        rho = np.asarray(rho, float)
        inner, outer = np.asarray(self.peak_gap(np.stack([rho * (1.0 - BESIDE), rho * (1.0 + BESIDE)])))
        return np.asarray((outer - inner) / (2.0 * BESIDE * rho))

    def fall(self, r: float) -> float:
        """Exponent q of p ~ r^-q where the surface is level with the apex; infinite where nothing is left."""
        at = np.array(r)
        level = np.array(self.punch.height(at))
        traction = float(self.traction(at, level))
        if traction == 0.0:
            return math.inf
        by_radius, by_gap = self.slopes(at, level)
        return -r * float(by_radius + by_gap * self.punch.slope(at)) / traction


def secant_root(function: Callable[[Array], Array], before: Array, last: Array, x: Array, steps: int) -> Array:
    """Root of a function by the secant method from two points, of which `last` is the value at the first.

    Examples
    --------
    >>> at = np.array([1.0, 1.5])
    >>> secant_root(lambda x: x**2 - 2.0, at, at**2 - 2.0, at + 0.1, 8).round(12)
    array([1.41421356, 1.41421356])
    """
    for _ in range(steps):
        value = function(x)
        step = np.divide(x - before, last - value, out=np.zeros_like(value), where=last != value)
        before, last, x = x, value, x + value * step
    return x
