"""Surface laws: traction p(H) between two parallel faces at gap H, in any consistent units.

Compression is positive, tension negative.  H = 0 is the equilibrium gap, and the energy there is minus the work of
adhesion.  A dimensionless law has the work of adhesion 1 and the range 1: gaps in z0, tractions in dgamma / z0.  Where
no well adheres, because a barrier returns more than the tension takes, dgamma is the depth of the well.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

import numpy as np

from fscm._typing import Array
from fscm._validation import real_number

__all__ = ["LennardJones", "Mie", "SurfaceLaw"]

#: Gaps at which the top of a barrier is looked for, in distances of the largest tension from the singular gap: 0.5 %
#: apart, so that the top is found to 1e-5 of itself, the second order.
_BEYOND_WELL = np.geomspace(1e-2, 1e6, 4000)


@runtime_checkable
class SurfaceLaw(Protocol):
    """Interface of a surface law: what the solver uses of it.

    Examples
    --------
    >>> isinstance(LennardJones(work_of_adhesion=0.05, z0=3e-10), SurfaceLaw)
    True
    """

    @property
    def work_of_adhesion(self) -> float:
        """Energy per area to separate the faces from H = 0 to infinity; negative where they repel each other more."""
        ...

    @property
    def z0(self) -> float:
        """Range of the law, a length: the unit of gaps in the dimensionless problem."""
        ...

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
        """Integral of p from H to infinity: the surface energy per area, minus the work of adhesion at H = 0."""
        ...


@dataclass(frozen=True, slots=True)
class LennardJones:
    """The 9-3 law p = (8 w / 3 z0) [(H/z0 + 1)^-9 - (H/z0 + 1)^-3] (Eqs. 10 and 27).

    Parameters
    ----------
    work_of_adhesion : float
        Energy per area w to separate the faces from H = 0 to infinity, > 0.
    z0 : float
        Range of the law, a length > 0; both are 1 in a dimensionless problem.

    Raises
    ------
    ValueError
        When a parameter is not positive and finite.

    Examples
    --------
    >>> law = LennardJones()
    >>> float(-law.traction(np.array(law.peak_gap)))  # 16 sqrt(3) / 27 = 1.0264
    1.02640047...
    >>> float(LennardJones(work_of_adhesion=2.0, z0=0.5).energy(np.array(0.0)))
    -2.0
    """

    work_of_adhesion: float = 1.0
    z0: float = 1.0

    def __post_init__(self) -> None:
        _check_scales(self)

    @property
    def dimensionless(self) -> LennardJones:
        """The law with the work of adhesion 1 and the range 1."""
        return LennardJones()

    @property
    def singular_gap(self) -> float:
        """The repulsion diverges at H = -z0."""
        return -self.z0

    @property
    def peak_gap(self) -> float:
        """Largest tension at H = (3^(1/6) - 1) z0."""
        return (3.0 ** (1.0 / 6.0) - 1.0) * self.z0

    @property
    def decay(self) -> tuple[float, float]:
        """Tension -(8/3) w z0^2 H^-3 at large gaps."""
        return 8.0 / 3.0 * (self.work_of_adhesion * self.z0**2), 3.0

    def traction(self, H: Array) -> Array:
        """p(H), to full relative accuracy also where it vanishes: soft solids keep the contact at H ~ 0."""
        h = np.asarray(H, float) / self.z0
        q = 1.0 / (h + 1.0)
        q3 = q * q * q
        x = h * q
        one_minus_q3 = x * (x * x + 3.0 * q * (x + q))
        return (-8.0 / 3.0) * q3 * (q3 + 1.0) * one_minus_q3 * (self.work_of_adhesion / self.z0)

    def slope(self, H: Array) -> Array:
        """dp/dH."""
        q = 1.0 / (np.asarray(H, float) / self.z0 + 1.0)
        q2 = q * q
        return q2 * q2 * (8.0 - 24.0 * q2 * q2 * q2) * (self.work_of_adhesion / self.z0**2)

    def curvature(self, H: Array) -> Array:
        """d2p/dH2."""
        q = 1.0 / (np.asarray(H, float) / self.z0 + 1.0)
        q2 = q * q
        return q2 * q2 * q * (240.0 * q2 * q2 * q2 - 32.0) * (self.work_of_adhesion / self.z0**3)

    def energy(self, H: Array) -> Array:
        """w [(1/3) (H/z0 + 1)^-8 - (4/3) (H/z0 + 1)^-2].

        Examples
        --------
        >>> float(LennardJones().energy(np.array(0.0)))
        -1.0
        """
        q2 = 1.0 / (np.asarray(H, float) / self.z0 + 1.0) ** 2
        return q2 * (q2 * q2 * q2 - 4.0) / 3.0 * self.work_of_adhesion


@dataclass(frozen=True, slots=True)
class Mie:
    """The m-n law p = A (w / z0) [(H/z0 + 1)^-m - (H/z0 + 1)^-n] with A = (m-1)(n-1)/(m-n).

    m = 9 and n = 3 is the Lennard-Jones law of Eq. 27.  All forms are written with (H/z0 + 1)^(n-m) - 1 as one
    quantity, so that they hold down to m -> n, where the law becomes (n-1)^2 log(1/(H+1)) (H+1)^-n.

    Parameters
    ----------
    work_of_adhesion, z0 : float
        As for `LennardJones`.
    m : float
        Exponent of the repulsion.
    n : float
        Exponent of the attraction, 1 < n < m: with n <= 1 the work of adhesion is infinite.

    Raises
    ------
    ValueError
        When a scale is not positive or the exponents are out of order.

    Examples
    --------
    >>> law = Mie(m=9, n=3)
    >>> float(law.traction(np.array(1.0))) - float(LennardJones().traction(np.array(1.0)))
    0.0
    >>> round(float(Mie(2.0, 0.5, m=12, n=6).energy(np.array(0.0))), 12)
    -2.0
    """

    work_of_adhesion: float = 1.0
    z0: float = 1.0
    # Not admissible: both have to be stated.
    m: float = math.nan
    n: float = math.nan

    def __post_init__(self) -> None:
        _check_scales(self)
        n = real_number(
            "attraction exponent n",
            self.n,
            low=1.0,
            high=math.inf,
            reason="with n <= 1 the work of adhesion is infinite",
        )
        m = real_number(
            "repulsion exponent m",
            self.m,
            low=n,
            high=math.inf,
            reason="the repulsion must outgrow the attraction at small gaps, or the law has no minimum",
        )
        object.__setattr__(self, "n", n)
        object.__setattr__(self, "m", m)

    @property
    def dimensionless(self) -> Mie:
        """The law with the work of adhesion 1 and the range 1."""
        return Mie(m=self.m, n=self.n)

    @property
    def singular_gap(self) -> float:
        """The repulsion diverges at H = -z0."""
        return -self.z0

    @property
    def peak_gap(self) -> float:
        """Largest tension at H = ((m/n)^(1/(m-n)) - 1) z0."""
        d = self.m - self.n
        return math.expm1(math.log1p(d / self.n) / d) * self.z0

    @property
    def decay(self) -> tuple[float, float]:
        """Tension -A w z0^(n-1) H^-n at large gaps."""
        return self._amplitude * (self.work_of_adhesion * self.z0 ** (self.n - 1.0)), self.n

    @property
    def _amplitude(self) -> float:
        return (self.m - 1.0) * (self.n - 1.0) / (self.m - self.n)

    def _powers(self, H: Array) -> tuple[Array, Array]:
        """Return q = 1/(H/z0 + 1) and q^(m-n) - 1; nan at the singular gap and below it."""
        x = np.asarray(H, float) / self.z0
        x = np.where(x > -1.0, x, np.nan)
        return 1.0 / (x + 1.0), np.expm1((self.n - self.m) * np.log1p(x))

    def traction(self, H: Array) -> Array:
        """p(H)."""
        q, e = self._powers(H)
        return self._amplitude * q**self.n * e * (self.work_of_adhesion / self.z0)

    def slope(self, H: Array) -> Array:
        """dp/dH."""
        q, e = self._powers(H)
        m, n = self.m, self.n
        return -self._amplitude * q ** (n + 1.0) * (m * e + (m - n)) * (self.work_of_adhesion / self.z0**2)

    def curvature(self, H: Array) -> Array:
        """d2p/dH2."""
        q, e = self._powers(H)
        m, n = self.m, self.n
        bracket = m * (m + 1.0) * e + (m - n) * (m + n + 1.0)
        return self._amplitude * q ** (n + 2.0) * bracket * (self.work_of_adhesion / self.z0**3)

    def energy(self, H: Array) -> Array:
        """U = A w [(H/z0 + 1)^(1-m) / (m-1) - (H/z0 + 1)^(1-n) / (n-1)].

        Examples
        --------
        >>> float(Mie(m=12, n=6).energy(np.array(0.0)))
        -1.0
        """
        q, e = self._powers(H)
        m, n = self.m, self.n
        return q ** (n - 1.0) * ((n - 1.0) / (m - n) * e - 1.0) * self.work_of_adhesion


@dataclass(frozen=True, slots=True)
class ScaledLaw:
    """A law of one's own with gaps in its z0 and tractions in its unit of energy over z0.

    Parameters
    ----------
    law : SurfaceLaw

    Examples
    --------
    >>> law = ScaledLaw(LennardJones(work_of_adhesion=2.0, z0=0.5))
    >>> float(law.traction(np.array(1.0))) == float(LennardJones().traction(np.array(1.0)))
    True
    """

    law: SurfaceLaw
    _unit: float = field(init=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_unit", unit_of_energy(self.law))

    @property
    def work_of_adhesion(self) -> float:
        """One, or zero and less where no well adheres."""
        return self.law.work_of_adhesion / self._unit

    @property
    def z0(self) -> float:
        """One."""
        return 1.0

    @property
    def singular_gap(self) -> float:
        """That of the law in z0."""
        return self.law.singular_gap / self.law.z0

    @property
    def peak_gap(self) -> float:
        """That of the law in z0."""
        return self.law.peak_gap / self.law.z0

    @property
    def decay(self) -> tuple[float, float]:
        """(C, m) of the tail."""
        C, m = self.law.decay
        return (C / (self._unit * self.law.z0 ** (m - 1.0)), m) if C else (C, m)

    def traction(self, H: Array) -> Array:
        """p(H)."""
        return self.law.traction(np.asarray(H, float) * self.law.z0) / (self._unit / self.law.z0)

    def slope(self, H: Array) -> Array:
        """dp/dH."""
        return self.law.slope(np.asarray(H, float) * self.law.z0) / (self._unit / self.law.z0**2)

    def curvature(self, H: Array) -> Array:
        """d2p/dH2."""
        return self.law.curvature(np.asarray(H, float) * self.law.z0) / (self._unit / self.law.z0**3)

    def energy(self, H: Array) -> Array:
        """Integral of p from H to infinity."""
        return self.law.energy(np.asarray(H, float) * self.law.z0) / self._unit


def unit_of_energy(law: SurfaceLaw) -> float:
    """The work of adhesion; the energy from H = 0 to the top of the barriers, the depth of the well, if none adheres.

    Raises
    ------
    ValueError
        When the energy rises nowhere beyond H = 0, so that this is no well.

    Examples
    --------
    >>> unit_of_energy(LennardJones(work_of_adhesion=0.05, z0=3e-10))
    0.05
    """
    w = law.work_of_adhesion
    if w > 0.0:
        return w
    gaps = (law.peak_gap - law.singular_gap) * _BEYOND_WELL
    depth = float(np.max(law.energy(gaps))) + w
    if not depth > 0.0:
        raise ValueError(f"law = {law!r} has the work of adhesion {w:g} and no well at H = 0: it holds no two surfaces")
    return depth


def dimensionless_law(law: SurfaceLaw) -> SurfaceLaw:
    """The law with gaps in its z0 and tractions in its `unit_of_energy` over z0.

    Examples
    --------
    >>> dimensionless_law(LennardJones(work_of_adhesion=0.05, z0=3e-10))
    LennardJones(work_of_adhesion=1.0, z0=1.0)
    """
    if unit_of_energy(law) == law.z0 == 1.0:
        return law
    # A subclass may override anything: that of its base would be another law.
    if "dimensionless" in vars(type(law)):
        scaled: SurfaceLaw = law.dimensionless  # type: ignore[attr-defined]  # looked up above
        return scaled
    return ScaledLaw(law)


def _check_scales(law: LennardJones | Mie) -> None:
    for name in ("work_of_adhesion", "z0"):
        value = real_number(name, getattr(law, name), low=0.0, high=math.inf, reason="it is a positive quantity")
        object.__setattr__(law, name, value)
