r"""The potential of all atoms of a ball as an interaction of the surface.

Atoms whose law over a half-space has the powers (v/z0)^-m, v = z0 + H, attract each other with pair potentials of the
powers m + 3.  Their integral over a ball of the radius R, at the distance s of its center, d = s - R of its surface and
D = s + R of its far pole, is

    (z0/d)^m k_m,   k_m = 1 - u^m - (m/(m - 1)) (d/s) (1 - u^(m-1)),   u = d/D.

On the sphere f(r) the distances follow from the vertical gap without cancellation, with c = R - f:

    s^2 = R^2 + v (2 c + v),   d = v (2 c + v)/(s + R).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fscm._ball_under_law import ball_under_law
from fscm._roots import bracketed_root
from fscm._typing import Array
from fscm._whole_punch import WholePunchUnderMie
from fscm.laws import LennardJones, Mie
from fscm.punch import Ball, ScaledPunch

__all__ = ["BallUnderLaw", "BallUnderMie"]

#: Radius over distance of the center below which k_m is summed: the closed form cancels to the third power of it.
_FAR = 0.1
#: Largest power of the sum: the next term is below 1e-16 of the first for m up to 20.
_LAST_POWER = 33
#: Quadrature of the energy along the vertical line, over pieces on which the distance grows by _FARTHER; the last one
#: begins at _FARTHEST sizes of ball and radius, beyond which the traction is a power of the distance.
_GAUSS = np.polynomial.legendre.leggauss(20)
_FARTHER, _FARTHEST = 4.0, 40.0
#: The traction is a power of the radius beyond this many radii of the ball.
_BALL_RADII = 300.0
#: Logarithm of the distance of the largest tension in lengths of the law: between these.
_LOG_PEAK = -2.5, 2.5


@dataclass(frozen=True, slots=True)
class BallUnderMie(WholePunchUnderMie):
    """The potential of a ball whose atoms fill its radius.

    Parameters
    ----------
    punch : PunchShape
        `Ball`, or one in other units of radii and heights.
    law : LennardJones or Mie
        Law of the same atoms over a half-space.

    Examples
    --------
    Atoms of the 12-6 potential, at H = 0.5 below the apex:

    >>> body, q = BallUnderMie(Ball(R=20.0), LennardJones()), (21.5**2 - 20.0**2) / 40.0
    >>> x = 21.5 / 20.0
    >>> exact = 8 / 3 * (q**-9 * (5 + 45 * x**2 + 63 * x**4 + 15 * x**6) / 128 - q**-3)
    >>> bool(abs(body.traction(np.array(0.0), np.array(0.5)) - exact) < 1e-14)
    True
    """

    punch: Ball | ScaledPunch
    law: LennardJones | Mie

    @property
    def ball_radius(self) -> float:
        """R in the unit of heights."""
        if isinstance(self.punch, ScaledPunch):
            return float(getattr(self.punch.punch, "R")) / self.punch.height_unit  # noqa: B009  # another shape has none
        return self.punch.R

    def falls_as(self, r: float) -> float:
        """Exponent of p ~ r^-q far away, at which the ball is a point."""
        return self.exponents[1] + 3.0

    @property
    def slope_falls_by(self) -> float:
        """Exponent by which dp/dH falls faster: p depends on the distance of a point."""
        return 2.0

    @property
    def far_radius(self) -> float:
        """Radius beyond which the traction is nearly a power."""
        return _BALL_RADII * self.ball_radius / self.aspect

    @property
    def size_of_punch(self) -> float:
        """Its radius in the unit of heights."""
        return self.ball_radius

    def _distances(self, r: Array, H: Array) -> _Distances:
        R, v = self.ball_radius, np.asarray(H, float) - self.law.singular_gap
        x, c = self.aspect * np.asarray(r, float), R - self.punch.height(r)
        rise = np.asarray(r, float) * self.punch.slope(r)
        on_sphere = np.asarray(r) <= self.punch.reach
        with np.errstate(invalid="ignore"):
            outside = np.where(on_sphere, v * (2.0 * c + v), (x - R) * (x + R) + (c + v) ** 2)
            s = np.sqrt(R * R + outside)
            d = np.where(outside > 0.0, outside / (s + R), np.nan)
        return _Distances(R, self.law.z0, s, d, c + v, np.where(on_sphere, -v * rise, x * x - (c + v) * rise))

    def traction(self, r: Array, H: Array) -> Array:
        """p(r, H)."""
        m, n = self.exponents
        at = self._distances(r, H)
        ratio = -(m - n) * np.log(at.d / at.z0) + np.log(at.share(m) / at.share(n))
        return self._strength * at.power(n) * np.expm1(ratio)

    def size(self, r: Array, H: Array) -> Array:
        """Repulsion and attraction: the logarithm of their ratio is rounded."""
        at = self._distances(r, H)
        return self._strength * (at.power(self.exponents[0]) + at.power(self.exponents[1]))

    def _rate(self, at: _Distances) -> Array:
        """Derivative of p by the distance of the center, over that distance."""
        m, n = self.exponents
        return self._strength * (at.rate(m) - at.rate(n)) / at.s

    def slope(self, r: Array, H: Array) -> Array:
        """dp/dH at a fixed radius."""
        at = self._distances(r, H)
        return self._rate(at) * at.below_center

    def drift(self, r: Array, H: Array) -> Array:
        """r dp/dr at a fixed gap."""
        at = self._distances(r, H)
        return self._rate(at) * at.nearer

    def _peak(self, r: Array) -> Array:
        """Height of the center above the sphere around it on which the tension is largest; 0 outside of that."""
        return np.sqrt(np.maximum(_peak_distance(self) ** 2 - (self.aspect * np.asarray(r)) ** 2, 0.0))

    def peak_gap(self, r: Array) -> Array:
        """Gap on the sphere around the ball on which the tension is largest; outside of it the one at its height."""
        return self._peak(r) - (self.ball_radius - self.punch.height(r)) + self.law.singular_gap

    def peak_drift(self, r: float) -> float:
        """Its derivative by the logarithm of the radius."""
        height, x = float(self._peak(np.array(r))), self.aspect * r
        return float(r * self.punch.slope(np.array(r))) - (x * x / height if height > 0.0 else 0.0)

    def energy(self, r: Array, H: Array) -> Array:
        """Integral of p from H to infinity at a fixed radius, by quadrature over 1/(distance of the surface)."""
        r, H = np.broadcast_arrays(np.asarray(r, float), np.asarray(H, float))
        d = self._distances(r, H).d
        largest = self.ball_radius + self.aspect * float(np.max(r)) + float(np.max(np.abs(H)))
        # A gap below the singular one has no energy: nan.
        pieces = math.ceil(math.log(max(_FARTHEST * largest / np.nanmin(d), 1.0)) / math.log(_FARTHER))
        ends = np.append(_FARTHER ** -np.arange(pieces + 1.0), 0.0)
        x, w = _GAUSS
        half = 0.5 * (ends[:-1] - ends[1:])
        t = (ends[1:] + half)[:, None] + half[:, None] * x
        total = np.zeros_like(d)
        for inverse, weight in zip(t.ravel(), (half[:, None] * w).ravel(), strict=True):
            total += weight / inverse**2 * self.traction(r, H + d * (1.0 / inverse - 1.0))
        return total * d


@dataclass(frozen=True, slots=True)
class _Distances:
    """Distances of points from a ball, all in one unit, and the powers of the law there.

    Attributes
    ----------
    R, z0 : float
    s, d : ndarray
        From its center and from its surface; d is nan inside.
    below_center : ndarray
        s ds/dH.
    nearer : ndarray
        s r ds/dr at a fixed gap.
    """

    R: float
    z0: float
    s: Array
    d: Array
    below_center: Array
    nearer: Array

    def share(self, m: float) -> Array:
        """k_m, the power relative to that over a half-space at the distance d."""
        u = self.d / (self.s + self.R)
        near = -np.expm1(m * np.log(u)) + m / (m - 1.0) * (self.d / self.s) * np.expm1((m - 1.0) * np.log(u))
        return self._or_far(near, lambda t, s: (1.0 - t) ** m * _far(t, m))

    def power(self, m: float) -> Array:
        """Power m of the law."""
        return (self.z0 / self.d) ** m * self.share(m)

    def rate(self, m: float) -> Array:
        """Derivative of the power by s."""
        d, D, s = self.d, self.s + self.R, self.s
        near, far = (self.z0 / d) ** m, (self.z0 / D) ** m
        value = -m * (near / d - far / D) + m / s * (near - far) + m / (m - 1.0) * (near * d - far * D) / s**2
        return self._or_far(value, lambda t, s: -((self.z0 / s) ** m) / s * _far(t, m, rate=True))

    def _or_far(self, near: Array, far: Callable[[Array, Array], Array]) -> Array:
        t = np.asarray(self.R / self.s)
        distant = t < _FAR
        if not np.any(distant):
            return near
        values = np.array(near)
        values[distant] = far(t[distant], np.broadcast_to(self.s, t.shape)[distant])
        return values


def _far(t: Array, m: float, rate: bool = False) -> Array:
    """(s/z0)^m times the power m at t = R/s, by its series; or -s (s/z0)^m times its derivative by s."""
    coefficients = np.zeros(_LAST_POWER + 1)
    factor = 1.0
    for i in range(2, _LAST_POWER + 1):
        factor *= (m + i - 2.0) / i  # Pochhammer symbol (m)_(i-1) over i!
        if i % 2:
            coefficients[i] = 2.0 * factor * (i - 1.0) * (m + i if rate else 1.0)
    return np.asarray(t * np.polynomial.polynomial.polyval(t * t, coefficients[1::2]))


@dataclass(frozen=True, slots=True)
class BallUnderLaw(BallUnderMie):
    """The potential of a ball under any law, through the pair potential of that.

    Parameters
    ----------
    punch : PunchShape
        `Ball`, or one in other units of radii and heights.
    law : SurfaceLaw

    Examples
    --------
    >>> exact, at = BallUnderMie(Ball(R=20.0), LennardJones()), (np.array(3.0), np.array(0.5))
    >>> bool(abs(BallUnderLaw(exact.punch, exact.law).traction(*at) - exact.traction(*at)) < 1e-14)
    True
    """

    @property
    def exponents(self) -> tuple[float, float]:
        """Of the attraction of the law, for both of its terms."""
        return self.law.decay[1], self.law.decay[1]

    def traction(self, r: Array, H: Array) -> Array:
        """p(r, H)."""
        return ball_under_law(self.law, self._distances(r, H).d, np.array(self.ball_radius))[0]

    def size(self, r: Array, H: Array) -> Array:
        """That of both faces and their energies, which cancel."""
        d, R = self._distances(r, H).d, self.ball_radius
        p, e = self.law.traction(d + self.law.singular_gap), self.law.energy(d + self.law.singular_gap)
        return np.asarray((R * np.abs(p) + np.abs(e)) / (R + d))

    def _rate(self, at: _Distances) -> Array:
        return ball_under_law(self.law, at.d, np.array(self.ball_radius))[1] / at.s


@lru_cache(maxsize=64)
def _peak_distance(body: BallUnderMie) -> float:
    """Distance of the center of a ball at which the tension is largest."""

    def rate(log_d: float) -> float:
        d = np.array(body.law.z0 * math.exp(log_d))
        unknown = np.zeros(())
        at = _Distances(body.ball_radius, body.law.z0, body.ball_radius + d, d, unknown, unknown)
        return float(body._rate(at))

    return body.ball_radius + body.law.z0 * math.exp(bracketed_root(rate, *_LOG_PEAK, 1e-15))
