"""Punch shapes that neither solver has: a flat end with a rounded edge, and a smooth curve through a measured profile.

Both solvers take any shape with `height`, `slope` and `kinks`; the FSCM reads `growth` and `unit_of_radii`, too.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
import scipy

from comparisons.model import Array

#: Rows that a smoothed profile needs: a cubic spline has four coefficients.
FEWEST_ROWS = 8


@dataclass(frozen=True, slots=True)
class RoundedFlat:
    """f = (r - a)^2 / (2 R) outside of the flat end r < a, and 0 inside.

    Parameters
    ----------
    flat_radius, R : float
        Radius a of the flat end, and radius of curvature R of its edge.

    Examples
    --------
    >>> RoundedFlat(flat_radius=1.0, R=2.0).height(np.array([0.5, 3.0]))
    array([0., 1.])
    """

    flat_radius: float
    R: float

    #: A paraboloid at infinity.
    growth: ClassVar[float] = 2.0

    def unit_of_radii(self, z0: float) -> tuple[float, float]:
        """n and Q of the paraboloid of the edge, see `fscm.punch.unit_of_radii`."""
        return 2.0, self.R

    @property
    def kinks(self) -> tuple[float, ...]:
        """The edge of the flat end, where the curvature jumps."""
        return (self.flat_radius,)

    def height(self, r: Array) -> Array:
        """f(r)."""
        return np.maximum(np.asarray(r, float) - self.flat_radius, 0.0) ** 2 / (2.0 * self.R)

    def slope(self, r: Array) -> Array:
        """df/dr."""
        return np.maximum(np.asarray(r, float) - self.flat_radius, 0.0) / self.R


@dataclass(frozen=True, slots=True)
class SmoothedProfile:
    """A smooth curve through the points of a noisy profile, and a power of the radius beyond the last one.

    The curve is a cubic spline in r^2, so that it is smooth at the apex; the mean square of what it leaves of the
    heights is that of their error (the rule of Reinsch).

    Parameters
    ----------
    radii, heights : sequence of float
        The radii rise from 0.
    smoothing : float
        Standard error of the heights, > 0.
    growth : float
        Exponent of the continuation.

    Examples
    --------
    >>> r = np.linspace(0.0, 4.0, 41)
    >>> noisy = r**2 / 2 + 0.01 * np.cos(37.0 * r)
    >>> punch = SmoothedProfile(tuple(r), tuple(noisy), smoothing=0.01)
    >>> float(abs(punch.height(r) - r**2 / 2).max()) < 0.02
    True
    """

    radii: Sequence[float]
    heights: Sequence[float]
    smoothing: float
    growth: float = 2.0
    _curve: scipy.interpolate.UnivariateSpline = field(init=False, repr=False, compare=False)
    _last: float = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        r, f = np.array(self.radii), np.array(self.heights)
        if len(r) < FEWEST_ROWS:
            raise ValueError(f"a smooth profile has {len(r)} rows; it needs at least {FEWEST_ROWS}")
        if r[0] != 0.0:
            raise ValueError(f"the first radius is {r[0]:g} m and not 0; subtract the position of the apex")
        # In units of the last point, where the equations of the spline are well scaled.
        weights = np.full(len(r), abs(f[-1]) / self.smoothing)
        try:
            with warnings.catch_warnings():
                # A curve that misses the rule.
                warnings.simplefilter("error", UserWarning)
                curve = scipy.interpolate.UnivariateSpline((r / r[-1]) ** 2, f / abs(f[-1]), w=weights, k=3, s=len(r))
        except UserWarning:
            raise ValueError(
                f"no smooth curve is as near to heights of {f[-1]:.3g} m as the smoothing {self.smoothing:.3g} m; "
                "check the units of both, or take a larger smoothing"
            ) from None
        last = float(curve(1.0) - curve(0.0)) * abs(float(f[-1]))
        if not last > 0.0:
            raise ValueError(f"the smooth profile ends at the height {last:g}, which is not above its apex")
        object.__setattr__(self, "_curve", curve)
        object.__setattr__(self, "_last", last)

    def unit_of_radii(self, z0: float) -> tuple[float, float]:
        """n and Q of the power beyond the last point, see `fscm.punch.unit_of_radii`."""
        height = self.heights[-1] - self.heights[0]
        return self.growth, self.radii[-1] ** self.growth / (self.growth * height)

    @property
    def kinks(self) -> tuple[float, ...]:
        """The last point, where the power begins."""
        return (self.radii[-1],)

    def height(self, r: Array) -> Array:
        """f(r), 0 at the apex."""
        x = np.asarray(r, float) / self.radii[-1]
        inside = (self._curve(np.minimum(x, 1.0) ** 2) - self._curve(0.0)) * abs(self.heights[-1])
        return np.where(x > 1.0, self._last * np.maximum(x, 1.0) ** self.growth, inside)

    def slope(self, r: Array) -> Array:
        """df/dr; at the last point that of the power."""
        x = np.asarray(r, float) / self.radii[-1]
        inside = self._curve(np.minimum(x, 1.0) ** 2, 1) * 2.0 * x * (abs(self.heights[-1]) / self.radii[-1])
        beyond = self._last * self.growth / self.radii[-1] * np.maximum(x, 1.0) ** (self.growth - 1.0)
        return np.where(x >= 1.0, beyond, inside)
