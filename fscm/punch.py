"""Punch shapes f(r), in any consistent units; dimensionless with heights in z0 and radii in (Q z0)^(1/n).

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
from fscm.errors import Failure, NotConverged

__all__ = ["Ball", "Cone", "PowerPunch", "PowerSum", "PunchShape", "RoundedCone", "Sphere"]

#: Least radius in the search for the unit of radii of a custom shape, and number of bisections: the choice of the unit
#: changes no result.
_NEAREST, _HALVINGS = 1e-30, 20


#: Radius, in units of that of a ball, up to which its profile is the sphere.
_REACH = 0.95


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


def joints_of(punch: PunchShape) -> tuple[float, ...]:
    """Radii at which a punch with a continuous slope is less smooth: its attribute `joints`, if it has one.

    Examples
    --------
    >>> joints_of(Ball(R=20.0))
    (19.0,)
    """
    return tuple(getattr(punch, "joints", None) or ())


@dataclass(frozen=True, slots=True)
class PowerPunch:
    """f(r) = r^n / (n Q) (Eq. 24); n = 1 is a cone, n = 2 a paraboloid, n -> infinity a flat punch.

    Parameters
    ----------
    n : float
        Shape index, > 0.
    Q : float
        Shape parameter, a length^(n-1) > 0: the radius of a paraboloid; 1 in a dimensionless problem.

    Raises
    ------
    ValueError
        When a parameter is not a positive finite number.

    Examples
    --------
    >>> PowerPunch(n=2.0, Q=4.0).height(np.array([0.0, 2.0]))
    array([0. , 0.5])
    """

    n: float
    Q: float = 1.0

    def __post_init__(self) -> None:
        n = real_number("shape index n", self.n, low=0.0, high=math.inf, reason="f = r^n / n must grow with r")
        Q = real_number("shape parameter Q", self.Q, low=0.0, high=math.inf, reason="it is a positive quantity")
        object.__setattr__(self, "n", n)
        object.__setattr__(self, "Q", Q)

    def unit_of_radii(self, z0: float) -> tuple[float, float]:
        """Shape index and shape parameter."""
        return self.n, self.Q

    @property
    def growth(self) -> float:
        """The shape index."""
        return self.n

    def height(self, r: Array) -> Array:
        """f(r), infinite where no double holds it."""
        with np.errstate(over="ignore"):
            return np.asarray(r, float) ** self.n / (self.n * self.Q)

    def slope(self, r: Array) -> Array:
        """df/dr = r^(n-1) / Q, infinite at r = 0 for n < 1 and where no double holds it."""
        with np.errstate(divide="ignore", over="ignore"):
            return np.asarray(r, float) ** (self.n - 1.0) / self.Q


def Sphere(R: float, R_solid: float | None = None) -> PowerPunch:
    """The paraboloid r^2 / (2 R) of a sphere, which JKR and DMT mean by one; `Ball` is the exact sphere.

    Parameters
    ----------
    R : float
        Radius of the sphere, a length > 0.
    R_solid : float, optional
        Radius of a spherical solid: the gap is that of a sphere with 1/R + 1/R_solid on a plane.

    Raises
    ------
    ValueError
        When a radius is not a positive finite number.

    Examples
    --------
    >>> Sphere(R=1e-6), Sphere(R=4.0, R_solid=4.0)
    (PowerPunch(n=2.0, Q=1e-06), PowerPunch(n=2.0, Q=2.0))
    """
    R = _radius("R", R)
    if R_solid is None:
        return PowerPunch(2.0, R)
    other = _radius("R_solid", R_solid)
    return PowerPunch(2.0, R * other / (R + other))


def Cone(half_angle: float) -> PowerPunch:
    """The cone r / tan(half_angle).

    Parameters
    ----------
    half_angle : float
        Angle between axis and flank in radians, above 0 and below pi/2; ``math.radians(70)`` for 70 degrees.

    Raises
    ------
    ValueError
        When the angle is outside its range.

    Examples
    --------
    >>> round(float(Cone(half_angle=math.pi / 4).height(np.array(3.0))), 12)
    3.0
    """
    half_angle = real_number(
        "half_angle", half_angle, low=0.0, high=0.5 * math.pi, reason="it is that between axis and flank in radians"
    )
    return PowerPunch(1.0, math.tan(half_angle))


def _radius(name: str, value: object) -> float:
    return real_number(f"radius {name}", value, low=0.0, high=math.inf, reason="it is a positive quantity")


@dataclass(frozen=True, slots=True)
class Ball:
    """An exact sphere f(r) = R - sqrt(R^2 - r^2); `PowerPunch(2, R)` is the paraboloid with the same curvature.

    Beyond 0.95 R a parabola in r continues height, slope and curvature, because a punch has to rise without bound; a
    contact that extends so far is refused.  The surfaces beyond contribute 1e-5 of the load for R = 200 z0.

    Parameters
    ----------
    R : float
        Radius, a length > 0.

    Raises
    ------
    ValueError
        When the radius is not a positive finite number.

    Examples
    --------
    >>> Ball(R=5.0).height(np.array([0.0, 3.0, 4.0]))
    array([0., 1., 2.])
    """

    R: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "R", _radius("R", self.R))

    def unit_of_radii(self, z0: float) -> tuple[float, float]:
        """n and Q of the paraboloid of the tip."""
        return 2.0, self.R

    @property
    def reach(self) -> float:
        """Largest radius of a contact."""
        return _REACH * self.R

    @property
    def joints(self) -> tuple[float, ...]:
        """The reach, where the third derivative jumps."""
        return (self.reach,)

    @property
    def growth(self) -> float:
        """A parabola at infinity."""
        return 2.0

    def _inside(self, r: Array) -> tuple[Array, Array, Array]:
        """Radii on the sphere, distances beyond it, and sqrt(R^2 - r^2)."""
        inside = np.minimum(r, self.reach)
        return inside, r - inside, np.sqrt((self.R - inside) * (self.R + inside))

    def height(self, r: Array) -> Array:
        """f(r), in the form without cancellation at the tip."""
        inside, beyond, root = self._inside(np.asarray(r, float))
        return inside * (inside / (self.R + root)) + beyond * (inside / root + 0.5 * self.R**2 / root**3 * beyond)

    def slope(self, r: Array) -> Array:
        """df/dr = r / sqrt(R^2 - r^2) on the sphere.

        Examples
        --------
        >>> float(Ball(R=5.0).slope(np.array(3.0)))
        0.75
        """
        inside, beyond, root = self._inside(np.asarray(r, float))
        return inside / root + self.R**2 / root**3 * beyond


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

    def unit_of_radii(self, z0: float) -> tuple[float, float]:
        """n and Q of the paraboloid of the tip, or of the cone where the tip is rounded over less than z0."""
        if self.cone_slope * self.rounding < z0:
            return 1.0, 1.0 / self.cone_slope
        return 2.0, self.rounding / self.cone_slope

    def scaled(self, radius: float, height: float) -> RoundedCone:
        """The shape in a unit of radii and one of heights."""
        return RoundedCone(self.rounding / radius, self.cone_slope * radius / height)

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

    def scaled(self, radius: float, height: float) -> PowerSum:
        """The shape in a unit of radii and one of heights."""
        factors = (radius**e / height for e in self.exponents)
        return PowerSum([c * factor for c, factor in zip(self.coefficients, factors, strict=True)], self.exponents)

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


@dataclass(frozen=True, slots=True)
class ScaledPunch:
    """A custom shape in other units of radii and of heights.

    Parameters
    ----------
    punch : PunchShape
    radius, height_unit : float
        The new units in the old ones, > 0.

    Examples
    --------
    >>> ScaledPunch(PowerPunch(2.0), radius=2.0, height_unit=0.5).height(np.array([1.0]))
    array([4.])
    """

    punch: PunchShape
    radius: float
    height_unit: float

    @property
    def growth(self) -> float:
        """That of the shape."""
        return self.punch.growth

    @property
    def kinks(self) -> tuple[float, ...]:
        """Those of the shape."""
        return tuple(r / self.radius for r in kinks_of(self.punch))

    @property
    def joints(self) -> tuple[float, ...]:
        """Those of the shape."""
        return tuple(r / self.radius for r in joints_of(self.punch))

    @property
    def reach(self) -> float:
        """That of the shape, infinite if it has none."""
        return float(getattr(self.punch, "reach", math.inf)) / self.radius

    def height(self, r: Array) -> Array:
        """f(r)."""
        return self.punch.height(np.asarray(r, float) * self.radius) / self.height_unit

    def slope(self, r: Array) -> Array:
        """df/dr."""
        return self.punch.slope(np.asarray(r, float) * self.radius) * (self.radius / self.height_unit)


def check_reach(punch: PunchShape, radius: float) -> None:
    """Raise NotConverged if a contact of this radius is beyond the attribute `reach` of a punch, if it has one.

    Examples
    --------
    >>> check_reach(Ball(R=1.0), 0.5)
    """
    reach = getattr(punch, "reach", math.inf)
    if radius > reach:
        raise NotConverged(
            f"the ball is smaller than the contact, whose radius is {radius / reach * _REACH:.2g} R: the model needs a "
            f"contact within {_REACH:g} R",
            Failure.REACH,
        )


def scaled_punch(punch: PunchShape, radius: float, height: float) -> PunchShape:
    """The shape in a unit of radii and one of heights: by its method `scaled` if it has one."""
    if hasattr(punch, "scaled"):
        shape: PunchShape = punch.scaled(radius, height)
        return shape
    return ScaledPunch(punch, radius, height)


def unit_of_radii(punch: PunchShape, z0: float) -> tuple[float, float]:
    """n and Q of the power law r^n / (n Q) whose (Q z0)^(1/n) is the unit of the radii.

    Any choice gives the same physical results.  A shape states its own by a method `unit_of_radii`; else n is the
    growth, and the unit is the radius at which the shape is z0 / n high, as on a power law.

    Raises
    ------
    ValueError
        When the shape never has this height.

    Examples
    --------
    >>> unit_of_radii(PowerPunch(n=2.0, Q=1e-6), 3e-10)
    (2.0, 1e-06)
    """
    if hasattr(punch, "unit_of_radii"):
        n, Q = punch.unit_of_radii(z0)
        return float(n), float(Q)
    n, r = float(punch.growth), 1.0

    def is_above(r: float) -> bool:
        return float(punch.height(np.array([r]))[0]) > z0 / n

    with np.errstate(over="ignore"):
        while is_above(r) and r > _NEAREST:
            r *= 0.5
        while not is_above(r):
            r *= 2.0
            if r > 1.0 / _NEAREST:
                raise ValueError(f"the punch never reaches the height {z0 / n:g}: it must rise without bound")
        low, high = 0.5 * r, r
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if is_above(middle) else (middle, high)
    return n, high**n / z0
