"""Laws with a barrier and a work of adhesion of either sign, in closed form, as a law of one's own of both references.

    p = a exp(-9 H) - (a + c) exp(-4 H) + c exp(-3 H/2)

is a wall, an attraction and the repulsion of a layer that both surfaces carry.  H = 0 is a well, and the work of
adhesion is (5/36) a - (5/12) c: a strong layer takes more on approach than the attraction gives.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.optimize import brentq

Array = np.ndarray

RATES = (9.0, 4.0, 1.5)


@dataclass(frozen=True)
class Layered:
    """The law with the strengths a of the wall and c of the layer."""

    wall: float
    layer: float
    z0: float = 1.0
    singular_gap: float = -3.0
    decay: tuple[float, float] = (0.0, math.inf)

    @property
    def work_of_adhesion(self) -> float:
        return -float(self.energy(np.array(0.0)))

    @property
    def peak_gap(self) -> float:
        return _peak(self)

    @property
    def top(self) -> float:
        """Largest energy, where the barrier begins."""
        return float(self.energy(np.array(brentq(self.traction, self.peak_gap, 5.0))))

    @property
    def depth(self) -> float:
        """Energy from H = 0 to the top of the barrier."""
        return self.top + self.work_of_adhesion

    def traction(self, H: Array) -> Array:
        return self._sum(H, 0)

    def slope(self, H: Array) -> Array:
        return self._sum(H, 1)

    def curvature(self, H: Array) -> Array:
        return self._sum(H, 2)

    def energy(self, H: Array) -> Array:
        return -self._sum(H, -1)

    def _sum(self, H: Array, order: int) -> Array:
        strengths = (self.wall, -self.wall - self.layer, self.layer)
        return np.asarray(
            sum(A * (-b) ** order * np.exp(-b * np.asarray(H)) for A, b in zip(strengths, RATES, strict=True))
        )


@lru_cache(maxsize=8)
def _peak(law: Layered) -> float:
    return float(brentq(law.slope, 0.0, 0.5, xtol=1e-15))


ADHESIVE, REPULSIVE = Layered(12.0, 2.0), Layered(12.0, 5.5)
