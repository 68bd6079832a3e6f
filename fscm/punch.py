"""Punch shapes f(r), dimensionless: heights in z0, radii in the transverse length (Q z0)^(1/n).

A profile is smooth enough to be differentiated, vanishes at r = 0 and grows like a power of r at infinity:
the solver closes its infinite domain with that power.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from fscm._typing import Array
from fscm._validation import real_number

__all__ = ["PowerPunch", "PowerSum", "PunchShape", "RoundedCone", "kinks_of"]


@runtime_checkable
class PunchShape(Protocol):
    """An axisymmetric punch shape; `growth` is the exponent g of f ~ r^g at infinity.

    Examples
    --------
    >>> isinstance(PowerPunch(2.0), PunchShape)
    True
    """

    @property
    def growth(self) -> float:
        """Exponent of growth at infinity."""
        ...

    def height(self, r: Array) -> Array:
        """f(r), shape of `r`."""
        ...

    def slope(self, r: Array) -> Array:
        """df/dr, shape of `r`."""
        ...


def kinks_of(punch: PunchShape) -> tuple[float, ...]:
    """Radii at which the slope of a punch jumps: its attribute `kinks`, if it has one.

    Examples
    --------
    >>> kinks_of(PowerPunch(2.0))
    ()
    """
    return tuple(getattr(punch, "kinks", None) or ())


@dataclass(frozen=True, slots=True)
class PowerPunch:
    """f(r) = r^n / n (Eq. 26); n = 1 is a cone, n = 2 a paraboloid, n -> infinity a flat punch.

    Parameters
    ----------
    n : float
        Shape index, > 0.

    Raises
    ------
    ValueError
        When `n` is not a positive finite number.

    Examples
    --------
    >>> PowerPunch(2.0).height(np.array([0.0, 2.0]))
    array([0., 2.])
    """

    n: float

    def __post_init__(self) -> None:
        n = real_number("shape index n", self.n, low=0.0, high=math.inf, reason="f = r^n / n must grow with r")
        object.__setattr__(self, "n", n)

    @property
    def growth(self) -> float:
        """The shape index."""
        return self.n

    def height(self, r: Array) -> Array:
        """f(r) = r^n / n, infinite where no double holds it."""
        with np.errstate(over="ignore"):
            return np.asarray(r, float) ** self.n / self.n

    def slope(self, r: Array) -> Array:
        """df/dr = r^(n-1), infinite at r = 0 for n < 1 and where no double holds it."""
        with np.errstate(divide="ignore", over="ignore"):
            return np.asarray(r, float) ** (self.n - 1.0)


@dataclass(frozen=True, slots=True)
class RoundedCone:
    """Hyperboloid f(r) = s [sqrt(r^2 + c^2) - c]: a cone of slope s whose tip is rounded over the radius c.

    Parameters
    ----------
    rounding : float
        Radius c > 0 over which the tip is rounded; the radius of curvature of the tip is c / s.
    cone_slope : float, optional
        Slope s > 0 at infinity; 1, the cone of n = 1, by default.

    Raises
    ------
    ValueError
        When a parameter is not a positive finite number.

    Examples
    --------
    >>> RoundedCone(3.0).height(np.array([0.0, 4.0]))
    array([0., 2.])
    """

    rounding: float
    cone_slope: float = 1.0

    def __post_init__(self) -> None:
        reason = "a rounded cone has a positive tip radius and slope"
        for name in ("rounding", "cone_slope"):
            value = real_number(name, getattr(self, name), low=0.0, high=math.inf, reason=reason)
            object.__setattr__(self, name, value)

    @property
    def growth(self) -> float:
        """A cone at infinity."""
        return 1.0

    def height(self, r: Array) -> Array:
        """f(r), in the form without cancellation at the tip."""
        r = np.asarray(r, float)
        return self.cone_slope * r * (r / (np.hypot(r, self.rounding) + self.rounding))

    def slope(self, r: Array) -> Array:
        """df/dr = s r / sqrt(r^2 + c^2).

        Examples
        --------
        >>> float(RoundedCone(3.0).slope(np.array(4.0)))
        0.8
        """
        r = np.asarray(r, float)
        return self.cone_slope * r / np.hypot(r, self.rounding)


@dataclass(frozen=True, slots=True)
class PowerSum:
    """f(r) = sum of c_i r^(e_i): a paraboloid with a fourth-order term, a cone on a blunt tip, and so on.

    Parameters
    ----------
    coefficients : sequence of float
        c_i; the one of the largest exponent has to be > 0, the others may have any sign.
    exponents : sequence of float
        e_i > 0, all different.

    Raises
    ------
    ValueError
        When the two have different lengths or are empty, an exponent is repeated or not positive, or the
        leading coefficient is not positive.

    Examples
    --------
    >>> punch = PowerSum([0.5, 0.125], [2, 4])
    >>> punch.growth, punch.height(np.array([2.0]))
    (4.0, array([4.]))
    """

    coefficients: Sequence[float]
    exponents: Sequence[float]

    def __post_init__(self) -> None:
        inf = math.inf
        c = tuple(
            real_number("coefficient", x, low=-inf, high=inf, reason="heights are finite") for x in self.coefficients
        )
        e = tuple(real_number("exponent", x, low=0.0, high=inf, reason="f(0) = 0") for x in self.exponents)
        if not c or len(c) != len(e) or len(set(e)) != len(e):
            raise ValueError(
                f"coefficients = {c} and exponents = {e} do not pair up: "
                "one coefficient for each of at least one different exponents"
            )
        leading = c[e.index(max(e))]
        if leading <= 0.0:
            raise ValueError(
                f"coefficient {leading:g} of the largest exponent {max(e):g} is outside (0, inf): "
                "the punch must grow at infinity"
            )
        object.__setattr__(self, "coefficients", c)
        object.__setattr__(self, "exponents", e)

    @property
    def growth(self) -> float:
        """The largest exponent."""
        return max(self.exponents)

    def height(self, r: Array) -> Array:
        """f(r)."""
        r = np.asarray(r, float)
        return sum((c * r**e for c, e in zip(self.coefficients, self.exponents, strict=True)), np.zeros_like(r))

    def slope(self, r: Array) -> Array:
        """df/dr, infinite at r = 0 when an exponent is below 1.

        Examples
        --------
        >>> PowerSum([0.5, 0.125], [2, 4]).slope(np.array([2.0]))
        array([6.])
        """
        r = np.asarray(r, float)
        terms = zip(self.coefficients, self.exponents, strict=True)
        with np.errstate(divide="ignore"):
            return sum((c * e * r ** (e - 1.0) for c, e in terms), np.zeros_like(r))
