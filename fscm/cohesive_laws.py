r"""Cohesive laws of fracture mechanics as surface laws: exponential, and trapezoidal with rounded corners.

*Exponential.*  p = -(w/z0^2) H exp(-H/z0), the derivative of the universal binding energy -w (1 + H/z0) exp(-H/z0)
(Rose, Ferrante & Smith, Phys. Rev. Lett. 47 (1981) 675, https://doi.org/10.1103/PhysRevLett.47.675; normal separation
of Xu & Needleman, J. Mech. Phys. Solids 42 (1994) 1397, https://doi.org/10.1016/0022-5096(94)90003-5).

*Trapezoidal.*  The tension rises to the strength at l1 d, stays until l2 d and falls to zero at the separation d
(Tvergaard & Hutchinson, J. Mech. Phys. Solids 40 (1992) 1377, https://doi.org/10.1016/0022-5096(92)90020-3), so that
w = strength d (1 - l1 + l2)/2.  Both solvers need smooth laws.  With h = H/d and f(x) = e log(1 + exp(x/e)) in place
of max(x, 0) it is

    p / strength = f(l1 - h)/l1 + [f(l2 - h) - f(1 - h)]/(1 - l2) + exp(-4 (h/l1 + 2)).

The last term is a wall: faces that overlap by more than twice the rise repel exponentially, by less in proportion.
Unit of the gap, factor and origin are then moved, by about the last term, so that work of adhesion and strength are
those stated and H = 0 is without traction.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import scipy

from fscm._roots import bracketed_root
from fscm._typing import Array
from fscm._validation import real_number

__all__ = ["CohesiveExponential", "CohesiveTrapezoid"]

#: Overlap at which the exponential law ends, in z0: its repulsion there is 6e5 times its strength.
_END_OF_EXPONENTIAL = 10.0
#: Rounding e of the corners over the shorter of rise and fall, which lowers the traction at a corner by 7 % of the
#: strength.  Sharp corners would be kinks of the pressure that move with the state.
_ROUNDING = 0.1
#: The wall: overlap in units of the rise where it is the strength, and its steepness there, per rise.
_WALL, _STEEPNESS = 2.0, 4.0
#: Overlap at which the trapezoid ends, in units of the rise: its wall there is 2e17 times the strength.
_END_OF_TRAPEZOID = _WALL + 10.0
#: Absolute tolerance of roots, of any size: the relative one counts.
_NO_FLOOR = 1e-300


@dataclass(frozen=True, slots=True)
class CohesiveExponential:
    """The exponential cohesive law p = -(w/z0^2) H exp(-H/z0).

    Parameters
    ----------
    work_of_adhesion : float
        Energy per area w to separate the faces from H = 0 to infinity, > 0.
    z0 : float
        Gap of the largest tension w/(e z0), a length > 0.

    Raises
    ------
    ValueError
        When a parameter is not positive and finite.

    Examples
    --------
    >>> law = CohesiveExponential()
    >>> round(float(-law.traction(np.array(law.peak_gap))) * math.e, 12), float(law.energy(np.array(0.0)))
    (1.0, -1.0)
    """

    work_of_adhesion: float = 1.0
    z0: float = 1.0

    def __post_init__(self) -> None:
        _check_positive(self, "work_of_adhesion", "z0")

    @property
    def singular_gap(self) -> float:
        """The gap at which the law ends, without a divergence."""
        return -_END_OF_EXPONENTIAL * self.z0

    @property
    def peak_gap(self) -> float:
        """Largest tension at H = z0."""
        return self.z0

    @property
    def decay(self) -> tuple[float, float]:
        """No tail: the tension falls faster than any power."""
        return 0.0, math.inf

    def traction(self, H: Array) -> Array:
        """p(H)."""
        x = self._gaps(H)
        return -x * np.exp(-x) * (self.work_of_adhesion / self.z0)

    def slope(self, H: Array) -> Array:
        """dp/dH."""
        x = self._gaps(H)
        return (x - 1.0) * np.exp(-x) * (self.work_of_adhesion / self.z0**2)

    def curvature(self, H: Array) -> Array:
        """d2p/dH2."""
        x = self._gaps(H)
        return (2.0 - x) * np.exp(-x) * (self.work_of_adhesion / self.z0**3)

    def energy(self, H: Array) -> Array:
        """-w (1 + H/z0) exp(-H/z0)."""
        x = self._gaps(H)
        return -(1.0 + x) * np.exp(-x) * self.work_of_adhesion

    def _gaps(self, H: Array) -> Array:
        """H/z0; nan where the law has ended."""
        x = np.asarray(H, float) / self.z0
        return np.where(x > -_END_OF_EXPONENTIAL, x, np.nan)


@dataclass(frozen=True, slots=True)
class CohesiveTrapezoid:
    """The trapezoidal cohesive law with rounded corners.

    Parameters
    ----------
    work_of_adhesion : float
        Energy per area to separate the faces from H = 0 to infinity, > 0.
    strength : float
        Largest tension, > 0.  The range z0 is the work of adhesion over it.
    rise_end, fall_start : float
        Where the tension reaches the strength, and where it begins to fall, as shares of the gap where it ends:
        0 < `rise_end` <= `fall_start` < 1.

    Raises
    ------
    ValueError
        When a parameter is outside its range.

    Examples
    --------
    >>> law = CohesiveTrapezoid(work_of_adhesion=0.05, strength=50e6, rise_end=0.3, fall_start=0.7)
    >>> round(law.z0 * 1e9, 9), round(float(-law.traction(np.array(law.peak_gap))) / 50e6, 12)
    (1.0, 1.0)
    """

    work_of_adhesion: float = 1.0
    strength: float = 1.0
    rise_end: float = 0.3
    fall_start: float = 0.7
    peak_gap: float = field(init=False, compare=False, repr=False)
    _origin: float = field(init=False, compare=False, repr=False)
    _unit: float = field(init=False, compare=False, repr=False)
    _factor: float = field(init=False, compare=False, repr=False)

    def __post_init__(self) -> None:
        _check_positive(self, "work_of_adhesion", "strength")
        reason = "it is a share of the gap where the tension ends, and the tension rises before it falls"
        end = real_number("fall_start", self.fall_start, low=0.0, high=1.0, reason=reason)
        rise = real_number("rise_end", self.rise_end, low=0.0, high=end, reason=reason, closed_high=True)
        object.__setattr__(self, "rise_end", rise)
        object.__setattr__(self, "fall_start", end)
        # The wall moves the origin outwards by less than a tenth of the rise.
        origin = bracketed_root(lambda h: float(self._shape(h, 0)), 0.0, rise, _NO_FLOOR)
        peak = bracketed_root(self._rising, 0.0, 0.5 * (1.0 + end), _NO_FLOOR)
        factor = -1.0 / float(self._shape(peak, 0))
        unit = self.z0 / (factor * float(self._shape(origin, -1)))
        for name, value in (("_origin", origin), ("_unit", unit), ("_factor", factor)):
            object.__setattr__(self, name, value)
        object.__setattr__(self, "peak_gap", (peak - origin) * unit)

    @property
    def z0(self) -> float:
        """Work of adhesion over strength."""
        return self.work_of_adhesion / self.strength

    @property
    def singular_gap(self) -> float:
        """The gap at which the law ends, without a divergence."""
        return -(_END_OF_TRAPEZOID * self.rise_end + self._origin) * self._unit

    @property
    def decay(self) -> tuple[float, float]:
        """No tail: the tension ends."""
        return 0.0, math.inf

    def traction(self, H: Array) -> Array:
        """p(H)."""
        return self._derivative(H, 0)

    def slope(self, H: Array) -> Array:
        """dp/dH."""
        return self._derivative(H, 1)

    def curvature(self, H: Array) -> Array:
        """d2p/dH2."""
        return self._derivative(H, 2)

    def energy(self, H: Array) -> Array:
        """Integral of p from H to infinity."""
        return -self._derivative(H, -1)

    def _derivative(self, H: Array, order: int) -> Array:
        h = np.asarray(H, float) / self._unit + self._origin
        end = -_END_OF_TRAPEZOID * self.rise_end
        values = self._shape(np.maximum(h, end), order) * (self.strength * self._factor * self._unit**-order)
        return np.where(h > end, values, np.nan)

    @property
    def _rounding(self) -> float:
        return _ROUNDING * min(self.rise_end, 1.0 - self.fall_start)

    def _shape(self, h: Any, order: int) -> Array:
        """Derivative of p over the strength by h; order -1 is the primitive, 0 at infinity."""
        rise, start, e = self.rise_end, self.fall_start, self._rounding
        wall = np.exp(-_STEEPNESS * (np.asarray(h) / rise + _WALL)) * (-_STEEPNESS / rise) ** order
        falling = _corner((start - h) / e, order) - _corner((1.0 - h) / e, order)
        rising = _corner((rise - h) / e, order) / rise
        return np.asarray((rising + falling / (1.0 - start)) * (-1.0) ** order * e ** (1 - order) + wall)

    def _rising(self, h: float) -> float:
        """A function with the sign of dp/dh: logarithm of what falls over what rises, which no plateau extinguishes."""
        rise, start, e = self.rise_end, self.fall_start, self._rounding
        growing = float(_log_logistic((rise - h) / e)) - math.log(rise)
        growing = np.logaddexp(growing, -_STEEPNESS * (h / rise + _WALL) + math.log(_STEEPNESS / rise))
        # logistic(x) - logistic(y) = logistic(x) logistic(-y) (1 - exp(y - x)).
        near, far = (h - start) / e, (h - 1.0) / e
        fading = float(_log_logistic(near) + _log_logistic(-far)) + math.log(-math.expm1(far - near))
        return float(fading - math.log(1.0 - start) - growing)


def _corner(x: Any, order: int) -> Array:
    """Derivative of log(1 + exp(x)); order -1 is the primitive, 0 at minus infinity."""
    x = np.asarray(x, float)
    if order == 0:
        return np.asarray(np.logaddexp(0.0, x))
    if order == 1:
        return np.asarray(scipy.special.expit(x))
    if order == 2:
        return np.asarray(scipy.special.expit(x) * scipy.special.expit(-x))
    # The dilogarithm -Li2(-exp(x)), by its inversion for positive x.
    inner = -scipy.special.spence(1.0 + np.exp(-np.abs(x)))
    return np.where(x > 0.0, 0.5 * x * x + math.pi**2 / 6.0 - inner, inner)


def _log_logistic(x: float) -> Array:
    return np.asarray(-np.logaddexp(0.0, -x))


def _check_positive(law: Any, *names: str) -> None:
    for name in names:
        value = real_number(name, getattr(law, name), low=0.0, high=math.inf, reason="it is a positive quantity")
        object.__setattr__(law, name, value)
