"""Surface laws: traction p(H) between two faces at gap H, in physical units; compression is positive."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from fem_reference._typing import Array
from fem_reference._validation import check_positive

__all__ = ["LennardJones", "Mie", "SurfaceLaw"]


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
        """Energy per area to separate the faces from the gap without traction; negative if they repel each other."""
        ...

    @property
    def z0(self) -> float:
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
        check_positive("work of adhesion", self.work_of_adhesion)
        check_positive("range z0", self.z0)

    @property
    def peak_gap(self) -> float:
        """Gap of the largest tension, (3^(1/6) - 1) z0."""
        return (3.0 ** (1.0 / 6.0) - 1.0) * self.z0

    @property
    def singular_gap(self) -> float:
        """The repulsion diverges at H = -z0."""
        return -self.z0

    @property
    def powers(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """(A, a) of each power A (1 + H/z0)^-a of the traction."""
        strength = 8.0 / 3.0 * self.work_of_adhesion / self.z0
        return (strength, 9.0), (-strength, 3.0)

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


@dataclass(frozen=True, slots=True)
class Mie:
    """The m-n law p = A (w / z0) [(1 + H/z0)^-m - (1 + H/z0)^-n] with A = (m - 1)(n - 1)/(m - n).

    m = 9 and n = 3 is the Lennard-Jones law.

    Parameters
    ----------
    work_of_adhesion : float
        Energy per area w to separate the faces from H = 0 to infinity.
    z0 : float
        Range of the law, a length.
    m, n : float
        Exponents of the repulsion and of the attraction, 1 < n < m.

    Raises
    ------
    ValueError
        If a parameter is outside its range.

    Examples
    --------
    >>> law, special = Mie(work_of_adhesion=2.0, z0=0.5, m=9.0, n=3.0), LennardJones(2.0, 0.5)
    >>> bool(abs(law.traction(np.array(1.0)) - special.traction(np.array(1.0))) < 1e-14)
    True
    >>> round(float(Mie(2.0, 0.5, m=12.0, n=6.0).energy(np.array(0.0))), 12)
    -2.0
    """

    work_of_adhesion: float
    z0: float
    m: float
    n: float

    def __post_init__(self) -> None:
        check_positive("work of adhesion", self.work_of_adhesion)
        check_positive("range z0", self.z0)
        if not (math.isfinite(self.n) and self.n > 1):
            raise ValueError(
                f"exponent n = {self.n} of the attraction is outside (1, infinity): its energy is infinite"
            )
        if not (math.isfinite(self.m) and self.m > self.n):
            raise ValueError(
                f"exponent m = {self.m} of the repulsion is outside (n = {self.n:g}, infinity): the faces would pass "
                "through each other"
            )

    @property
    def peak_gap(self) -> float:
        """Gap of the largest tension, ((m/n)^(1/(m-n)) - 1) z0."""
        return self.z0 * math.expm1(math.log(self.m / self.n) / (self.m - self.n))

    @property
    def singular_gap(self) -> float:
        """The repulsion diverges at H = -z0."""
        return -self.z0

    @property
    def powers(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """(A, a) of each power A (1 + H/z0)^-a of the traction."""
        return (self._stress, self.m), (-self._stress, self.n)

    @property
    def decay(self) -> tuple[float, float]:
        """Tension A w z0^(n-1) H^-n at large gaps."""
        return self._stress * self.z0**self.n, self.n

    @property
    def _stress(self) -> float:
        return (self.m - 1.0) * (self.n - 1.0) / (self.m - self.n) * self.work_of_adhesion / self.z0

    def _split(self, H: Array) -> tuple[Array, Array]:
        """Logarithm of 1 + H/z0, and the repulsion relative to the attraction less one (exact near H = 0)."""
        x = np.asarray(H, float) / self.z0
        # The powers have no value at or below the singular gap, where a step of Newton's method may lead.
        distance = np.log1p(np.where(x > -1.0, x, np.nan))
        return distance, np.expm1(-(self.m - self.n) * distance)

    def traction(self, H: Array) -> Array:
        """p(H), shape of `H`."""
        distance, excess = self._split(H)
        return self._stress * np.exp(-self.n * distance) * excess

    def slope(self, H: Array) -> Array:
        """dp/dH, shape of `H`."""
        distance, excess = self._split(H)
        inside = self.n - self.m * (1.0 + excess)
        return self._stress / self.z0 * np.exp(-(self.n + 1.0) * distance) * inside

    def energy(self, H: Array) -> Array:
        """Integral of p from H to infinity, the energy per area of the faces at gap H: -w at H = 0."""
        distance, excess = self._split(H)
        inside = (1.0 + excess) / (self.m - 1.0) - 1.0 / (self.n - 1.0)
        return self._stress * self.z0 * np.exp(-(self.n - 1.0) * distance) * inside
