"""Other shapes of rigid punches: a ball, a rounded cone, a sum of powers, and a measured profile."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from fem_reference._typing import Array
from fem_reference._validation import check_positive

__all__ = ["Ball", "MeasuredPunch", "PowerSum", "RoundedCone"]

#: Share of the radius of a ball up to which its shape is a sphere.
SPHERICAL = 0.95

#: Relative change of the slope at a point of a profile below which there is no kink.
STRAIGHT = 1e-12


def _tuple_of(name: str, values: Sequence[float]) -> tuple[float, ...]:
    """Finite numbers of a column."""
    try:
        column = np.asarray(values, float)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} = {values!r} is no column of numbers: {error}") from error
    if column.ndim != 1 or not np.all(np.isfinite(column)):
        raise ValueError(f"{name} = {values!r} is no column of finite numbers")
    return tuple(column.tolist())


@dataclass(frozen=True, slots=True)
class Ball:
    """f(r) = R - sqrt(R^2 - r^2), a sphere whose paraboloid is `PowerPunch(2, R)`.

    At 0.95 R the Taylor polynomial of second degree takes over, so that the shape rises without bound.  A contact that
    reaches that radius is refused.

    Parameters
    ----------
    R : float
        Radius of the sphere.

    Raises
    ------
    ValueError
        If the radius is not positive and finite.

    Examples
    --------
    >>> ball = Ball(R=5.0)
    >>> ball.height(np.array([3.0, 4.0])), float(ball.slope(np.array(4.0)).round(12))
    (array([1., 2.]), 1.333333333333)
    """

    R: float

    def __post_init__(self) -> None:
        check_positive("radius R of a ball", self.R)

    @property
    def reach(self) -> float:
        """Radius up to which the shape is a sphere."""
        return SPHERICAL * self.R

    @property
    def kinks(self) -> tuple[float, ...]:
        """The reach: the third derivative jumps there, which inside an element costs more than the bound shows."""
        return (self.reach,)

    def _taylor(self) -> tuple[float, float, float]:
        """Height and its two derivatives at the reach."""
        root = math.sqrt(1.0 - SPHERICAL**2)
        return self.R * (1.0 - root), SPHERICAL / root, 1.0 / (self.R * root**3)

    def height(self, r: Array) -> Array:
        """f(r), shape of `r`; r^2 over a sum does not cancel at the tip."""
        x = np.asarray(r, float)
        s, d, (height, slope, curvature) = np.minimum(x, self.reach), x - self.reach, self._taylor()
        sphere = s * s / (self.R + np.sqrt(self.R**2 - s * s))
        return np.where(d <= 0, sphere, height + d * (slope + 0.5 * curvature * d))

    def slope(self, r: Array) -> Array:
        """df/dr, shape of `r`."""
        x = np.asarray(r, float)
        s, d, (_, slope, curvature) = np.minimum(x, self.reach), x - self.reach, self._taylor()
        return np.where(d <= 0, s / np.sqrt(self.R**2 - s * s), slope + curvature * d)


@dataclass(frozen=True, slots=True)
class RoundedCone:
    """f(r) = s (sqrt(r^2 + c^2) - c): a hyperboloid, whose tip has the radius of curvature c / s.

    Parameters
    ----------
    rounding : float
        Length c over which the tip is rounded.
    cone_slope : float
        Slope s far from the tip.

    Raises
    ------
    ValueError
        If a parameter is not positive and finite.

    Examples
    --------
    >>> RoundedCone(rounding=3.0, cone_slope=2.0).height(np.array([0.0, 4.0]))
    array([0., 4.])
    """

    rounding: float
    cone_slope: float = 1.0

    def __post_init__(self) -> None:
        for name in ("rounding", "cone_slope"):
            check_positive(f"{name} of a rounded cone", getattr(self, name))

    def height(self, r: Array) -> Array:
        """f(r), shape of `r`; r^2 over the sum of both lengths does not cancel at the tip."""
        x = np.asarray(r, float)
        return self.cone_slope * x * x / (self.rounding + np.hypot(x, self.rounding))

    def slope(self, r: Array) -> Array:
        """df/dr, shape of `r`."""
        x = np.asarray(r, float)
        return self.cone_slope * x / np.hypot(x, self.rounding)


@dataclass(frozen=True, slots=True)
class PowerSum:
    """f(r) = sum of c_i r^e_i: a sphere with a term of fourth order, a cone on a flatter tip.

    Parameters
    ----------
    coefficients : sequence of float
        c_i; that of the largest exponent is positive.
    exponents : sequence of float
        e_i, at least 1 and all different.

    Raises
    ------
    ValueError
        If the two do not fit together, or an exponent is below 1.

    Examples
    --------
    >>> punch = PowerSum(coefficients=(0.5, 0.125), exponents=(2.0, 4.0))
    >>> punch.height(np.array([2.0])), punch.slope(np.array([2.0]))
    (array([4.]), array([6.]))
    """

    coefficients: Sequence[float]
    exponents: Sequence[float]

    def __post_init__(self) -> None:
        for name in ("coefficients", "exponents"):
            object.__setattr__(self, name, _tuple_of(name, getattr(self, name)))
        c, e = self.coefficients, self.exponents
        if not c or len(c) != len(e) or len(set(e)) < len(e):
            raise ValueError(
                f"{len(c)} coefficients and the exponents {e} do not form a sum: one for each, all different"
            )
        if min(e) < 1:
            raise ValueError(f"exponent {min(e):g} is outside [1, infinity): a cusp has no bounded pressure")
        if not c[e.index(max(e))] > 0:
            raise ValueError(
                f"the coefficient {c[e.index(max(e))]:g} of the largest exponent {max(e):g} is outside (0, infinity): "
                "the shape must rise without bound"
            )

    def height(self, r: Array) -> Array:
        """f(r), shape of `r`."""
        x = np.asarray(r, float)[..., None]
        return np.asarray((np.array(self.coefficients) * x ** np.array(self.exponents)).sum(axis=-1))

    def slope(self, r: Array) -> Array:
        """df/dr, shape of `r`."""
        x, e = np.asarray(r, float)[..., None], np.array(self.exponents)
        return np.asarray((np.array(self.coefficients) * e * x ** (e - 1.0)).sum(axis=-1))


@dataclass(frozen=True, slots=True)
class MeasuredPunch:
    """A measured profile: straight lines between its points, and a power of the radius beyond the last one.

    The slope jumps at the points; mesh lines are put there.

    Parameters
    ----------
    radii : sequence of float, shape (N,), N >= 2
        Rising from 0.
    heights : sequence of float, shape (N,)
        The first is 0, the last positive.
    growth : float
        Exponent g of the continuation f = f_N (r/r_N)^g.

    Attributes
    ----------
    kinks : tuple of float
        Radii at which the slope jumps.

    Raises
    ------
    ValueError
        If the points do not form a profile.

    Examples
    --------
    >>> punch = MeasuredPunch(radii=(0.0, 1.0, 2.0), heights=(0.0, 0.25, 2.0))
    >>> punch.height(np.array([0.5, 1.5, 4.0])), punch.kinks
    (array([0.125, 1.125, 8.   ]), (1.0, 2.0))
    """

    radii: Sequence[float]
    heights: Sequence[float]
    growth: float = 2.0
    kinks: tuple[float, ...] = field(init=False, compare=False)

    def __post_init__(self) -> None:
        r, f = _tuple_of("radii", self.radii), _tuple_of("heights", self.heights)
        if not (math.isfinite(self.growth) and self.growth > 0):
            raise ValueError(
                f"growth = {self.growth} is outside (0, infinity): the profile rises beyond its last point"
            )
        if len(r) != len(f) or len(r) < 2:
            raise ValueError(
                f"{len(r)} radii and {len(f)} heights do not form a profile: it has a height at each of 2 radii or more"
            )
        if r[0] != 0 or f[0] != 0:
            raise ValueError(f"the profile begins at ({r[0]:g}, {f[0]:g}) and not at (0, 0), its apex")
        falls = [i for i in range(1, len(r)) if not r[i] > r[i - 1]]
        if falls:
            i = falls[0]
            raise ValueError(
                f"the radius {r[i]:g} in row {i} is not above {r[i - 1]:g}, the one before it: radii must rise"
            )
        if not f[-1] > 0:
            raise ValueError(f"the last height {f[-1]:g} is outside (0, infinity): the profile must rise beyond it")
        slopes = [*np.divide(np.diff(f), np.diff(r)), self.growth * f[-1] / r[-1]]
        size = max(map(abs, slopes))
        kinks = (r[i + 1] for i in range(len(slopes) - 1) if abs(slopes[i + 1] - slopes[i]) > STRAIGHT * size)
        for name, value in (("radii", r), ("heights", f), ("kinks", tuple(kinks))):
            object.__setattr__(self, name, value)

    def height(self, r: Array) -> Array:
        """f(r), shape of `r`."""
        x, end = np.asarray(r, float), self.radii[-1]
        return np.interp(x, self.radii, self.heights) * np.maximum(x / end, 1.0) ** self.growth

    def slope(self, r: Array) -> Array:
        """df/dr, shape of `r`; at a kink that of the outer side."""
        x, end = np.asarray(r, float), self.radii[-1]
        slopes = np.append(np.diff(self.heights) / np.diff(self.radii), self.growth * self.heights[-1] / end)
        segment = np.searchsorted(self.radii, x, side="right") - 1
        return slopes[segment] * np.maximum(x / end, 1.0) ** (self.growth - 1.0)
