"""Surface laws: traction p(H) between two parallel faces at gap H, dimensionless.

Gaps in z0, tractions in dgamma / z0, energies per area in dgamma.  Compression is positive, tension negative.
Every law is normalised so that H = 0 is the equilibrium gap and the energy there is -1.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from fscm._typing import Array
from fscm._validation import real_number

__all__ = ["LennardJones93", "Mie", "SurfaceLaw"]


@runtime_checkable
class SurfaceLaw(Protocol):
    """What the solver needs to know of a surface law.

    Examples
    --------
    >>> isinstance(LennardJones93(), SurfaceLaw)
    True
    """

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
        """(C, m) of the tail: p H^m -> -C as H -> infinity; C = 0 for a law of finite range."""
        ...

    def traction(self, H: Array) -> Array:
        """p(H), shape of `H`."""
        ...

    def slope(self, H: Array) -> Array:
        """dp/dH, shape of `H`."""
        ...

    def curvature(self, H: Array) -> Array:
        """d2p/dH2, shape of `H`."""
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
    1.02640047...
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
        """Tension -(8/3) H^-3 at large gaps."""
        return 8.0 / 3.0, 3.0

    def traction(self, H: Array) -> Array:
        """p(H), to full relative accuracy also where it vanishes: soft solids keep the contact at H ~ 0."""
        H = np.asarray(H, float)
        q = 1.0 / (H + 1.0)
        q3 = q * q * q
        x = H * q
        one_minus_q3 = x * (x * x + 3.0 * q * (x + q))
        return (-8.0 / 3.0) * q3 * (q3 + 1.0) * one_minus_q3

    def slope(self, H: Array) -> Array:
        """dp/dH."""
        q = 1.0 / (np.asarray(H, float) + 1.0)
        q2 = q * q
        return q2 * q2 * (8.0 - 24.0 * q2 * q2 * q2)

    def curvature(self, H: Array) -> Array:
        """d2p/dH2."""
        q = 1.0 / (np.asarray(H, float) + 1.0)
        q2 = q * q
        return q2 * q2 * q * (240.0 * q2 * q2 * q2 - 32.0)

    def energy(self, H: Array) -> Array:
        """(1/3) (H+1)^-8 - (4/3) (H+1)^-2.

        Examples
        --------
        >>> float(LennardJones93().energy(np.array(0.0)))
        -1.0
        """
        q2 = 1.0 / (np.asarray(H, float) + 1.0) ** 2
        return q2 * (q2 * q2 * q2 - 4.0) / 3.0


@dataclass(frozen=True, slots=True)
class Mie:
    """The m-n law p = A [(H+1)^-m - (H+1)^-n] with A = (m-1)(n-1)/(m-n), of unit work of adhesion.

    Mie(9, 3) is the Lennard-Jones law of Eq. 27.  All forms are written with (H+1)^(n-m) - 1 as one
    quantity, so that they hold down to m -> n, where the law becomes (n-1)^2 log(1/(H+1)) (H+1)^-n.

    Parameters
    ----------
    repulsion : float
        Exponent m of the repulsion.
    attraction : float
        Exponent n of the attraction, 1 < n < m: with n <= 1 the work of adhesion is infinite.

    Raises
    ------
    ValueError
        When the exponents are out of order.

    Examples
    --------
    >>> law = Mie(9, 3)
    >>> float(law.traction(np.array(1.0))) - float(LennardJones93().traction(np.array(1.0)))
    0.0
    """

    repulsion: float
    attraction: float

    def __post_init__(self) -> None:
        n = real_number(
            "attraction exponent n",
            self.attraction,
            low=1.0,
            high=math.inf,
            reason="with n <= 1 the work of adhesion is infinite",
        )
        m = real_number(
            "repulsion exponent m",
            self.repulsion,
            low=n,
            high=math.inf,
            reason="the repulsion must outgrow the attraction at small gaps, or the law has no minimum",
        )
        object.__setattr__(self, "attraction", n)
        object.__setattr__(self, "repulsion", m)

    @property
    def singular_gap(self) -> float:
        """The repulsion diverges at H = -1."""
        return -1.0

    @property
    def peak_gap(self) -> float:
        """Largest tension at H = (m/n)^(1/(m-n)) - 1."""
        d = self.repulsion - self.attraction
        return math.expm1(math.log1p(d / self.attraction) / d)

    @property
    def decay(self) -> tuple[float, float]:
        """Tension -A H^-n at large gaps."""
        return self._amplitude, self.attraction

    @property
    def _amplitude(self) -> float:
        m, n = self.repulsion, self.attraction
        return (m - 1.0) * (n - 1.0) / (m - n)

    def _powers(self, H: Array) -> tuple[Array, Array]:
        """Return q = 1/(H+1) and q^(m-n) - 1."""
        x = np.asarray(H, float)
        return 1.0 / (x + 1.0), np.expm1((self.attraction - self.repulsion) * np.log1p(x))

    def traction(self, H: Array) -> Array:
        """p(H)."""
        q, e = self._powers(H)
        return self._amplitude * q**self.attraction * e

    def slope(self, H: Array) -> Array:
        """dp/dH."""
        q, e = self._powers(H)
        m, n = self.repulsion, self.attraction
        return -self._amplitude * q ** (n + 1.0) * (m * e + (m - n))

    def curvature(self, H: Array) -> Array:
        """d2p/dH2."""
        q, e = self._powers(H)
        m, n = self.repulsion, self.attraction
        return self._amplitude * q ** (n + 2.0) * (m * (m + 1.0) * e + (m - n) * (m + n + 1.0))

    def energy(self, H: Array) -> Array:
        """U = A [(H+1)^(1-m) / (m-1) - (H+1)^(1-n) / (n-1)].

        Examples
        --------
        >>> float(Mie(12, 6).energy(np.array(0.0)))
        -1.0
        """
        q, e = self._powers(H)
        m, n = self.repulsion, self.attraction
        return q ** (n - 1.0) * ((n - 1.0) / (m - n) * e - 1.0)
