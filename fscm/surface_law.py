"""Surface laws: traction p(H) between two parallel faces at gap H, dimensionless.

Gaps in z0, tractions in dgamma / z0, energies per area in dgamma.  Compression is positive, tension negative.
Every law is normalised so that H = 0 is the equilibrium gap and the energy there is -1.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

__all__ = ["LennardJones93", "SurfaceLaw"]

Array = NDArray[np.float64]


@runtime_checkable
class SurfaceLaw(Protocol):
    """What the solver needs to know of a surface law."""

    @property
    def singular_gap(self) -> float:
        """Gap at which the repulsion diverges (or the law stops being defined); every H stays above it."""
        ...

    @property
    def peak_gap(self) -> float:
        """Gap of the largest tension."""
        ...

    @property
    def decay(self) -> tuple[float, float]:
        """(C, m) of the tail p ~ -C (H - singular_gap)^(-m); C = 0 for a law of finite range."""
        ...

    def traction(self, H: Array) -> Array:
        """p(H), shape of `H`."""
        ...

    def slope(self, H: Array) -> Array:
        """dp/dH, shape of `H`."""
        ...

    def energy(self, H: Array) -> Array:
        """Integral of p from H to infinity: the surface energy per area, -1 at H = 0, 0 at infinity."""
        ...


@dataclass(frozen=True, slots=True)
class LennardJones93:
    """The 9-3 law p = (8/3) [(H+1)^-9 - (H+1)^-3] (Eq. 27).

    Examples
    --------
    >>> law = LennardJones93()
    >>> float(-law.traction(np.array(law.peak_gap)))  # 16 sqrt(3) / 27 = 1.0264
    1.0264003...
    """

    @property
    def singular_gap(self) -> float:
        """The repulsion diverges at H = -1."""
        return -1.0

    @property
    def peak_gap(self) -> float:
        """Largest tension at H = 3^(1/6) - 1."""
        return 3.0 ** (1.0 / 6.0) - 1.0

    @property
    def decay(self) -> tuple[float, float]:
        """Tension -(8/3) (H+1)^-3 at large gaps."""
        return 8.0 / 3.0, 3.0

    def traction(self, H: Array) -> Array:
        """p(H)."""
        q = 1.0 / (np.asarray(H, float) + 1.0)
        q3 = q * q * q
        return (8.0 / 3.0) * q3 * (q3 * q3 - 1.0)

    def slope(self, H: Array) -> Array:
        """dp/dH."""
        q = 1.0 / (np.asarray(H, float) + 1.0)
        q2 = q * q
        return q2 * q2 * (8.0 - 24.0 * q2 * q2 * q2)

    def energy(self, H: Array) -> Array:
        """(1/3) (H+1)^-8 - (4/3) (H+1)^-2."""
        q2 = 1.0 / (np.asarray(H, float) + 1.0) ** 2
        return q2 * (q2 * q2 * q2 - 4.0) / 3.0
