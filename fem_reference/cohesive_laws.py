"""Cohesive laws of fracture mechanics: exponential, and trapezoidal with rounded corners, in physical units."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import scipy

from fem_reference._roots import root_between
from fem_reference._typing import Array
from fem_reference._validation import check_positive

__all__ = ["CohesiveExponential", "CohesiveTrapezoid"]

#: Overlap at which the exponential law ends, over z0: it repels there by 6e5 times its strength.
DEEPEST = 10.0
#: Length over which a corner of the trapezoid is round, over the shorter of rise and fall: a kink of the law would be
#: one of the pressure within an element.
ROUND = 0.1
#: Of the wall, in units of the rise: the overlap where it has the strength, the length over which it grows by e, and
#: the overlap where the law ends, 2e17 times as strong.
WALL, GROWTH, END = 2.0, 0.25, 12.0
#: Most steps of Newton's method to the gap without traction, and the change where it ends, over the rise.
STEPS, CHANGE = 50, 1e-15


@dataclass(frozen=True, slots=True)
class CohesiveExponential:
    """The exponential law p = -(w H / z0^2) exp(-H/z0) of Rose, Ferrante and Smith (1981) and Xu and Needleman (1994).

    Parameters
    ----------
    work_of_adhesion : float
        Energy per area w to separate the faces from H = 0 to infinity.
    z0 : float
        Gap of the largest tension.

    Examples
    --------
    >>> law = CohesiveExponential(work_of_adhesion=2.0, z0=0.5)
    >>> round(float(-law.traction(np.array(0.5))) * law.z0 * math.e, 12), float(law.energy(np.array(0.0)))
    (2.0, -2.0)
    """

    work_of_adhesion: float
    z0: float

    def __post_init__(self) -> None:
        check_positive("work of adhesion", self.work_of_adhesion)
        check_positive("range z0", self.z0)

    @property
    def peak_gap(self) -> float:
        """Gap of the largest tension, z0."""
        return self.z0

    @property
    def singular_gap(self) -> float:
        """Where the law ends; its repulsion is finite there."""
        return -DEEPEST * self.z0

    @property
    def decay(self) -> tuple[float, float]:
        """No power: the tension decays exponentially."""
        return 0.0, math.inf

    def traction(self, H: Array) -> Array:
        """p(H), shape of `H`."""
        H = self._defined(H)
        return -self.work_of_adhesion * H * np.exp(-H / self.z0) / self.z0**2

    def slope(self, H: Array) -> Array:
        """dp/dH, shape of `H`."""
        H = self._defined(H)
        return self.work_of_adhesion * (H - self.z0) * np.exp(-H / self.z0) / self.z0**3

    def energy(self, H: Array) -> Array:
        """Integral of p from H to infinity, the energy per area of the faces at gap H: -w at H = 0."""
        H = self._defined(H)
        return -self.work_of_adhesion * (H + self.z0) * np.exp(-H / self.z0) / self.z0

    def _defined(self, H: Array) -> Array:
        """Gaps; nan below the end of the law, where a step of Newton's method may lead."""
        H = np.asarray(H, float)
        return np.where(self.singular_gap < H, H, np.nan)


@dataclass(frozen=True, slots=True)
class CohesiveTrapezoid:
    """The trapezoidal law of Tvergaard and Hutchinson (1992) with rounded corners.

    The tension rises in proportion to the gap up to `rise_end` d, stays and falls from `fall_start` d to d in
    proportion.  Faces that overlap by more than twice the rise repel exponentially.  Each corner is that of e log(2
    cosh(x/(2 e))) in place of |x|/2; d, a factor of the tractions and the origin of the gaps are such that the work of
    adhesion and the strength are the stated ones and H = 0 has no traction.

    Parameters
    ----------
    work_of_adhesion : float
        Energy per area to separate the faces from H = 0 to infinity.
    strength : float
        Largest tension.
    rise_end, fall_start : float
        Ends of the plateau over d, 0 < `rise_end` <= `fall_start` < 1.

    Raises
    ------
    ValueError
        If a parameter is outside its range.

    Examples
    --------
    >>> law = CohesiveTrapezoid(work_of_adhesion=2.0, strength=4.0, rise_end=0.3, fall_start=0.7)
    >>> law.z0, round(float(law.energy(np.array(0.0))), 12)
    (0.5, -2.0)
    """

    work_of_adhesion: float
    strength: float
    rise_end: float
    fall_start: float
    peak_gap: float = field(init=False, compare=False, repr=False)
    _well: float = field(init=False, compare=False, repr=False)
    _length: float = field(init=False, compare=False, repr=False)
    _stress: float = field(init=False, compare=False, repr=False)

    def __post_init__(self) -> None:
        check_positive("work of adhesion", self.work_of_adhesion)
        check_positive("strength", self.strength)
        for name, highest in (("fall_start", 1.0), ("rise_end", self.fall_start)):
            value = getattr(self, name)
            check_positive(name, value)
            if value > highest or value == 1.0:
                raise ValueError(
                    f"{name} = {value} is outside (0, {highest:g}{')' if name == 'fall_start' else ']'}: it is a share "
                    "of the gap where the tension ends, and the tension rises before it falls"
                )
        well = self._gap_without_traction()
        middle = 0.5 * (1.0 + self.fall_start)
        peak = float(root_between(lambda h: float(self._stiffness(np.array(h))), well, middle, 1e-15))
        stress = self.strength / -float(self._pressure(np.array(peak)))
        length = self.work_of_adhesion / (stress * -float(self._stored(np.array(well))))
        for name, value in (("_well", well), ("_length", length), ("_stress", stress)):
            object.__setattr__(self, name, value)
        object.__setattr__(self, "peak_gap", (peak - well) * length)

    @property
    def z0(self) -> float:
        """Work of adhesion over strength, the range of the law."""
        return self.work_of_adhesion / self.strength

    @property
    def singular_gap(self) -> float:
        """Where the law ends; its repulsion is finite there."""
        return -(END * self.rise_end + self._well) * self._length

    @property
    def decay(self) -> tuple[float, float]:
        """No power: the tension ends."""
        return 0.0, math.inf

    def traction(self, H: Array) -> Array:
        """p(H), shape of `H`."""
        return self._stress * self._pressure(self._shares(H))

    def slope(self, H: Array) -> Array:
        """dp/dH, shape of `H`."""
        return self._stress / self._length * self._stiffness(self._shares(H))

    def energy(self, H: Array) -> Array:
        """Integral of p from H to infinity, the energy per area of the faces at gap H: -w at H = 0."""
        return self._stress * self._length * self._stored(self._shares(H))

    def _shares(self, H: Array) -> Array:
        """Gaps over d, from the origin of the sharp law; nan below the end of the law."""
        h = np.asarray(H, float) / self._length + self._well
        return np.where(h > -END * self.rise_end, h, np.nan)

    @property
    def _corners(self) -> tuple[Array, Array, float]:
        """Places of the corners, changes of the slope of the tension there with their sign, and the rounding."""
        fall = 1.0 - self.fall_start
        places = np.array([self.rise_end, self.fall_start, 1.0])
        return places, np.array([1.0 / self.rise_end, 1.0 / fall, -1.0 / fall]), ROUND * min(self.rise_end, fall)

    def _wall(self, h: Array) -> Array:
        return np.exp(-(h / self.rise_end + WALL) / GROWTH)

    def _pressure(self, h: Array) -> Array:
        places, turns, e = self._corners
        x = (places - np.asarray(h)[..., None]) / e
        rounded = np.maximum(x, 0.0) + np.log1p(np.exp(-np.abs(x)))
        return np.asarray((e * rounded) @ turns + self._wall(h))

    def _stiffness(self, h: Array) -> Array:
        places, turns, e = self._corners
        x = (places - np.asarray(h)[..., None]) / e
        return np.asarray(-(0.5 + 0.5 * np.tanh(0.5 * x)) @ turns - self._wall(h) / (GROWTH * self.rise_end))

    def _stored(self, h: Array) -> Array:
        """Integral of the pressure from h to infinity."""
        places, turns, e = self._corners
        x = (places - np.asarray(h)[..., None]) / e
        beside = scipy.special.spence(1.0 + np.exp(-np.abs(x)))
        below = 0.5 * x * x + math.pi**2 / 6.0 + beside
        return np.asarray((e * e * np.where(x > 0.0, below, -beside)) @ turns + self._wall(h) * GROWTH * self.rise_end)

    def _gap_without_traction(self) -> float:
        """Root of the pressure over d by Newton's method, next to 0."""
        h = 0.0
        for _ in range(STEPS):
            step = float(self._pressure(np.array(h)) / self._stiffness(np.array(h)))
            h -= step
            if abs(step) <= CHANGE * self.rise_end:
                break
        return h
