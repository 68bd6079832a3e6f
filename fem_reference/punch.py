"""Shapes of rigid punches: heights f(r) above the apex at r = 0."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from fem_reference._typing import Array
from fem_reference._validation import check_positive
from fem_reference.errors import Failure, NotConverged

__all__ = ["Cone", "CustomPunch", "PowerPunch", "Punch", "Sphere"]

#: Radii in equal ratios at which the shape of a punch is examined: forty in a factor of two over 22 decades.
RADII = 3000

#: Relative fall of r f' that the rounding of a smooth shape may make.
FALL = 1e-9


#: Difference of exponents that is rounding.
SAME_POWER = 1e-6

#: Step of the differences for a slope, relative to the radius.
DIFFERENCE = 1.0 / 64.0

#: Multiples of the step, and their weights in central differences of eighth order.
DIFFERENCES = ((1, 4 / 5), (2, -1 / 5), (3, 4 / 105), (4, -1 / 280))


@runtime_checkable
class Punch(Protocol):
    """An axisymmetric shape with f(0) = 0, rising without bound.

    Examples
    --------
    >>> isinstance(PowerPunch(n=2.0, Q=1.0), Punch)
    True
    """

    def height(self, r: Array) -> Array:
        """f(r), shape of `r`."""
        ...

    def slope(self, r: Array) -> Array:
        """df/dr, shape of `r`."""
        ...


@dataclass(frozen=True, slots=True)
class PowerPunch:
    """f(r) = r^n / (n Q) (Eq. 24 of the paper): n = 1 a cone, n = 2 a paraboloid of radius Q.

    Examples
    --------
    >>> PowerPunch(n=2.0, Q=4.0).height(np.array([0.0, 2.0]))
    array([0. , 0.5])
    """

    n: float
    Q: float

    def __post_init__(self) -> None:
        if not (math.isfinite(self.n) and self.n >= 1):
            raise ValueError(f"shape index n = {self.n} is outside [1, infinity): a cusp has no bounded pressure")
        check_positive("shape parameter Q", self.Q)

    def height(self, r: Array) -> Array:
        """f(r), shape of `r`."""
        return np.asarray(r, float) ** self.n / (self.n * self.Q)

    def slope(self, r: Array) -> Array:
        """df/dr, shape of `r`."""
        return np.asarray(r, float) ** (self.n - 1.0) / self.Q


def Sphere(R: float, R_solid: float | None = None) -> PowerPunch:
    """r^2 / (2 R), which JKR and DMT mean by a sphere; `fem_reference.Ball` is the exact one.

    Parameters
    ----------
    R : float
        Radius of the punch.
    R_solid : float, optional
        Radius of the solid, if it is a sphere, too: their curvatures add.

    Raises
    ------
    ValueError
        If a radius is not positive and finite.

    Examples
    --------
    >>> Sphere(R=1e-6), Sphere(R=4.0, R_solid=4.0)
    (PowerPunch(n=2.0, Q=1e-06), PowerPunch(n=2.0, Q=2.0))
    """
    check_positive("radius R of a sphere", R)
    if R_solid is not None:
        check_positive("radius R_solid of a sphere", R_solid)
        R = R * R_solid / (R + R_solid)
    return PowerPunch(n=2.0, Q=R)


def Cone(half_angle: float) -> PowerPunch:
    """r / tan(half_angle).

    Parameters
    ----------
    half_angle : float
        In radians, between the axis and the flank; ``math.radians(70)`` for 70 degrees.

    Raises
    ------
    ValueError
        If the angle is not above 0 and below pi/2.

    Examples
    --------
    >>> round(float(Cone(half_angle=math.pi / 4).slope(np.array(2.0))), 12)
    1.0
    """
    check_positive("half_angle of a cone", half_angle)
    if half_angle >= 0.5 * math.pi:
        raise ValueError(f"half_angle = {half_angle} is outside (0, pi/2): it is in radians, from axis to flank")
    return PowerPunch(n=1.0, Q=math.tan(half_angle))


@dataclass(frozen=True, slots=True)
class CustomPunch:
    """Any shape, given as a function of the radius.

    Parameters
    ----------
    function : callable
        f(r) of an array of radii, with f(0) = 0.
    growth : float
        Exponent g > 0 of f ~ r^g at infinity; `Problem` compares it with the function.
    derivative : callable, optional
        df/dr.  By default it is that of differences of f, to 1e-11 of f/r where f is smooth over a tenth of r.
    kinks : tuple of float
        Radii at which the slope jumps; mesh lines are put there.  A jump of a higher derivative may be stated, too: the
        bound covers it either way, and is smaller then.

    Examples
    --------
    >>> sphere_like = CustomPunch(lambda r: np.sqrt(1.0 + r**2) - 1.0, 1.0, lambda r: r / np.sqrt(1.0 + r**2))
    >>> float(sphere_like.slope(np.array(0.0)))
    0.0
    """

    function: Callable[[Array], Array]
    growth: float
    derivative: Callable[[Array], Array] | None = None
    kinks: Sequence[float] = ()

    def __post_init__(self) -> None:
        check_positive("growth", self.growth)
        object.__setattr__(self, "kinks", tuple(self.kinks))
        apex = float(self.function(np.array(0.0)))
        if apex != 0:
            raise ValueError(f"the punch has f(0) = {apex}; heights are measured from the apex, f(0) = 0")
        if not all(math.isfinite(r) and r > 0 for r in self.kinks):
            raise ValueError(f"kinks = {self.kinks} are not all radii in (0, infinity)")

    def height(self, r: Array) -> Array:
        """f(r), shape of `r`."""
        return np.asarray(self.function(np.asarray(r, float)), float)

    def slope(self, r: Array) -> Array:
        """df/dr, shape of `r`."""
        x = np.asarray(r, float)
        if self.derivative is not None:
            return np.asarray(self.derivative(x), float)
        h = DIFFERENCE * np.maximum(x, np.finfo(float).tiny)
        return np.asarray(sum(w * (self.height(x + i * h) - self.height(x - i * h)) for i, w in DIFFERENCES) / h)


def kinks_of(punch: Punch) -> tuple[float, ...]:
    """Return the radii at which the slope of a punch jumps: its attribute `kinks`, if it has one.

    Examples
    --------
    >>> kinks_of(PowerPunch(n=2.0, Q=1.0))
    ()
    """
    return tuple(sorted(getattr(punch, "kinks", ())))


def check_contact(punch: Punch, edge_radius: float) -> None:
    """Refuse a contact beyond the radius up to which the shape is the stated one: the attribute `reach` of a ball.

    Raises
    ------
    NotConverged
        If the contact is larger.

    Examples
    --------
    >>> check_contact(PowerPunch(n=2.0, Q=1.0), 7.0)
    """
    reach = getattr(punch, "reach", math.inf)
    if edge_radius > reach:
        raise NotConverged(
            f"the ball is smaller than the contact: it is a sphere up to r = {reach:.4g}, and the contact edge is at "
            f"r = {edge_radius:.4g}",
            Failure.REACH,
        )


def check_without_asperities(punch: Punch, lowest: float, highest: float) -> None:
    """Refuse a punch on which r f'(r) falls between two heights, as outside an asperity or behind a wave.

    Such a punch may come into contact in several places.  Behind the first compressive load the path may then fall to a
    deeper tension, which the paths of this package do not follow.

    Parameters
    ----------
    punch : Punch
    lowest, highest : float
        Heights between which the shape matters.

    Raises
    ------
    NotConverged
        If r f' falls.

    Examples
    --------
    >>> check_without_asperities(PowerPunch(n=2.0, Q=1.0), 1e-6, 1e4)
    """
    r = np.geomspace(radius_at_height(punch, lowest), radius_at_height(punch, highest), RADII)
    rise = r * punch.slope(r)
    falls = np.flatnonzero(np.diff(rise) < -FALL * np.abs(rise[:-1]))
    if not falls.size:
        return
    before, behind = r[falls[0] : falls[0] + 2]
    fall = next((kink for kink in getattr(punch, "kinks", ()) if before < kink <= behind), before)
    unknown = "its path may go on to a deeper tension behind its first compressive load, and is not followed there"
    sides = np.nextafter(fall, [0.0, math.inf])
    inside, outside = sides * punch.slope(sides) / punch.height(sides)
    growth = getattr(punch, "growth", math.nan)
    if abs(outside - growth) < SAME_POWER < inside - growth:
        exponent = math.ceil((inside - SAME_POWER) * 100.0) / 100.0
        raise NotConverged(
            f"the punch bends down at r = {fall:.4g}, its last row: up to there it rises like r^{exponent:g}, and "
            f"beyond like r^{growth:g}, its growth (2 by default); {unknown}; set growth = {exponent:g}",
            Failure.GROWTH,
        )
    raise NotConverged(f"the punch bends down at r = {fall:.4g}, as outside an asperity: {unknown}", Failure.END)


def radius_at_height(punch: Punch, height: float) -> float:
    """Radius where f(r) = height, by bisection in log r.

    Raises
    ------
    ValueError
        If the punch does not reach that height within 1e+-100.

    Examples
    --------
    >>> round(radius_at_height(PowerPunch(n=2.0, Q=2.0), 1.0), 9)
    2.0
    """
    low, high = -100.0, 100.0
    # A shape may overflow far out: infinity is above any height.
    with np.errstate(over="ignore"):
        if not float(punch.height(np.array(10.0**high))) > height:
            raise ValueError(f"the punch never reaches the height {height}: its shape must rise without bound")
        for _ in range(120):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if float(punch.height(np.array(10.0**middle))) > height else (middle, high)
    return float(10.0 ** (0.5 * (low + high)))
