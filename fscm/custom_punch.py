"""Axisymmetric punch given as a function."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fscm._typing import Array
from fscm._validation import real_number

__all__ = ["CustomPunch"]

#: Height at which the shape has to grow as stated: the tail beyond carries less than 1e-8 of any load integral with
#: m g - 2 >= 1.
_FAR_HEIGHT = 1e8
#: An exponent off by 1 % changes that part by about 1 %.  The exponent of r^2 + r is off by 1e-4 there.
_GROWTH_TOLERANCE = 1e-2
#: Largest number of doublings of the radius up to _FAR_HEIGHT: enough for r^0.17, which a 12th-power tail admits.
_DOUBLINGS = 160
#: Largest height of the tip, by rounding in f: the displacement is measured from there.
_TIP_TOLERANCE = 1e-12
#: Small radii at which the function is evaluated as a check.
_SMALL_RADII = 2.0 ** -np.arange(40.0, 0.0, -1.0)
#: Ridders' extrapolation: steps h = _FIRST_STEP r / _RATIO^i.  At order 10 a power of r is exact to rounding
#: from r / 32 on; 19 reductions resolve features 1e-5 of r wide, beyond which rounding in f dominates
#: anyway.  Steps in the golden ratio cannot all fall on multiples of one wavelength, as dyadic ones do for
#: cos(100 r) at r = 32.
_FIRST_STEP = 1.0 / 32.0
_RATIO = (1.0 + math.sqrt(5.0)) / 2.0
_REDUCTIONS = 19
#: Columns of the extrapolation table: order 2 * 5 = 10 balances truncation and rounding near 1e-12.
_COLUMNS = 5
#: Radii at which a stated derivative is compared with differences; the tolerance is far above their error, and far
#: below that of a wrong formula.
_COMPARED_RADII = 2.0 ** np.arange(-8.0, 4.0)
_DERIVATIVE_TOLERANCE = 1e-3
#: Stands in for r = 0, where only one side exists: there the slope is the secant over this radius.
_TIP_RADIUS = 1e-7


@dataclass(frozen=True, slots=True)
class _InUnits:
    """A function of the radius in a unit of radii and one of its values."""

    function: Callable[[Array], Array]
    radius: float
    unit: float

    def __call__(self, r: Array) -> Array:
        return np.asarray(self.function(r * self.radius), float) / self.unit


@dataclass(frozen=True, slots=True)
class CustomPunch:
    """Any axisymmetric punch f(r), given as a function of an array of radii.

    The function is checked at construction: it has to accept arrays, vanish at r = 0, stay finite, and grow like
    r^growth far away.  Hashable; picklable if the functions are (module-level functions are, lambdas are not).

    Parameters
    ----------
    function : callable
        f(r) for an array r >= 0, array of the same shape, f(0) = 0; lengths in any unit.
    growth : float
        Exponent g > 0 of f ~ r^g at infinity.
    derivative : callable, optional
        df/dr.  Without it, Ridders' extrapolation of central differences is used, with an
        error of about 1e-11 of f(r) / r for a smooth f.
    kinks : sequence of float, optional
        Radii > 0 at which the slope jumps; the meshes have breaks there.

    Raises
    ------
    ValueError
        When a check fails, or `derivative` is not the derivative.

    Examples
    --------
    >>> bumpy = CustomPunch(lambda r: r**2 / 2 + 0.1 * (1 - np.cos(3 * r)), growth=2)
    >>> bool(abs(bumpy.slope(np.array([1.0]))[0] - (1 + 0.3 * np.sin(3))) < 1e-10)
    True
    """

    function: Callable[[Array], Array]
    growth: float
    derivative: Callable[[Array], Array] | None = None
    kinks: Sequence[float] = ()

    def __post_init__(self) -> None:
        growth = real_number("growth", self.growth, low=0.0, high=math.inf, reason="the punch must grow at infinity")
        object.__setattr__(self, "growth", growth)
        kinks = (real_number("kink", r, low=0.0, high=math.inf, reason="it is a radius") for r in self.kinks)
        object.__setattr__(self, "kinks", tuple(sorted(kinks)))
        tip = float(self.height(np.zeros(1))[0])
        if not abs(tip) <= _TIP_TOLERANCE:
            raise ValueError(f"f(0) = {tip:g} is not 0: heights are measured from the tip, subtract f(0)")
        self._check_growth()
        if self.derivative is not None:
            self._check_derivative()

    def scaled(self, radius: float, height: float) -> CustomPunch:
        """The shape in a unit of radii and one of heights, checked again in these units."""
        derivative = None if self.derivative is None else _InUnits(self.derivative, radius, height / radius)
        kinks = [r / radius for r in self.kinks]
        return CustomPunch(_InUnits(self.function, radius, height), self.growth, derivative, kinks)

    def height(self, r: Array) -> Array:
        """f(r), shape of `r`; ValueError when the function does not return finite numbers of that shape."""
        return _evaluate(self.function, r, "f(r)")

    def slope(self, r: Array) -> Array:
        """df/dr, shape of `r`."""
        if self.derivative is not None:
            return _evaluate(self.derivative, r, "df/dr")
        return self._extrapolated_slope(np.asarray(r, float))

    def _extrapolated_slope(self, r: Array) -> Array:
        """Ridders' method at every r: the extrapolate of central differences with the smallest estimated error."""
        flat = np.maximum(r.ravel(), _TIP_RADIUS)
        steps = _FIRST_STEP * flat * _RATIO ** -np.arange(float(_REDUCTIONS))[:, None]
        # The actual step, free of the rounding of r + h.
        right, left = flat + steps, flat - steps
        row = (self.height(right) - self.height(left)) / (right - left)
        best, error = row[0].copy(), np.full(flat.shape, np.inf)
        for column in range(1, _COLUMNS + 1):
            factor = _RATIO ** (2 * column)
            finer = (factor * row[1:] - row[:-1]) / (factor - 1.0)
            change = np.maximum(np.abs(finer - row[1:]), np.abs(finer - row[:-1]))
            # Two coarse steps may agree by accident on a wavy punch; three in a row do not.
            change = np.maximum(change[1:], np.abs(np.diff(finer, axis=0)))
            for estimate, uncertainty in zip(finer[1:], change, strict=True):
                better = uncertainty < error
                best = np.where(better, estimate, best)
                error = np.where(better, uncertainty, error)
            row = finer
        tip = r.ravel() < _TIP_RADIUS
        if tip.any():
            best[tip] = self.height(np.full(1, _TIP_RADIUS))[0] / _TIP_RADIUS
        return best.reshape(r.shape)

    def _check_growth(self) -> None:
        """Compare the local exponent of f far away with the stated one."""
        self.height(_SMALL_RADII)
        radii, heights = [1.0], [float(self.height(np.ones(1))[0])]
        while heights[-1] < _FAR_HEIGHT or len(radii) < 3:
            if len(radii) > _DOUBLINGS:
                raise ValueError(
                    f"f(r) = {heights[-1]:g} at r = {radii[-1]:g} is below {_FAR_HEIGHT:g}: "
                    "the punch does not grow like a power of r, so the surfaces never part"
                )
            radii.append(2.0 * radii[-1])
            heights.append(float(self.height(np.array(radii[-1:]))[0]))
        far = np.array(heights[-3:])
        # Only the height of the last point is positive for certain.
        local = np.diff(np.log2(np.maximum(far, np.finfo(float).tiny)))
        if not np.all(np.abs(local - self.growth) <= _GROWTH_TOLERANCE * max(1.0, self.growth)):
            raise ValueError(
                f"growth = {self.growth:g} is not the exponent of f at infinity: "
                f"there f grows like r^{local[-1]:.4g} (measured near r = {radii[-1]:g})"
            )

    def _check_derivative(self) -> None:
        """Raise ValueError for a wrong derivative, which would only slow down convergence."""
        r = _COMPARED_RADII
        stated, numerical = self.slope(r), self._extrapolated_slope(r)
        scale = np.maximum(np.abs(numerical), np.abs(self.height(r)) / r)
        worst = int(np.argmax(np.abs(stated - numerical) / np.maximum(scale, np.finfo(float).tiny)))
        if abs(stated[worst] - numerical[worst]) > _DERIVATIVE_TOLERANCE * scale[worst]:
            raise ValueError(
                f"derivative = {stated[worst]:g} at r = {r[worst]:g} is not the slope of f, {numerical[worst]:g}"
            )


def _evaluate(function: Callable[[Array], Array], r: Array, name: str) -> Array:
    r = np.asarray(r, float)
    try:
        with np.errstate(all="ignore"):
            out = np.asarray(function(r), float)
    except (TypeError, ValueError) as error:
        raise ValueError(f"{name} does not accept a numpy array of radii: {error}") from error
    if out.shape != r.shape or not np.all(np.isfinite(out)):
        raise ValueError(f"{name} of radii of shape {r.shape} is not an array of finite numbers of that shape")
    return out
