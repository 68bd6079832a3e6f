r"""Potential of the atoms that fill a punch z >= f(rho) without end, at points below its surface.

The integral of the pair potential d^-(m+3) over the punch is one over its surface, because
div(x d^-(m+3)) = -m d^-(m+3) for the vector x from the point.  With a point at the radius r,
h = f(rho) - f(r) + v the height of the surface above it, and over the azimuth

    J = int d^-(m+3) dphi,   K = int (1 - cos phi) d^-(m+3) dphi,   d^2 = C - D cos phi,

the power (z0/v)^m of the law over a half-space becomes, with c = m (m+1) z0^m/(2 pi),

    p_m = (c/m) int { [h - f' (rho - r)] J - f' r K } rho drho.

With w^2 = (C - D)/(C + D), the squares of the least and the largest distance of a ring, and 2 s = m + 3,

    J = 2 pi (C-D)^-s w   F(1 - s, 1/2; 1; 1 - w^2),
    K = 2 pi (C-D)^-s w^3 F(2 - s, 3/2; 2; 1 - w^2).

The hypergeometric functions are polynomials for odd m, and smooth up to w^(m+2) for any other.

The radius is integrated by Gauss rules between the kinks of the punch.  On each of these pieces the variable is finest
at the nearest radius, in the distance of the point, and is the logarithm of the radius towards the axis and far away:
so every feature of the profile is resolved from where it is seen.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np

from fscm._typing import Array
from fscm.punch import PunchShape, joints_of, kinks_of

__all__ = ["Profile", "log_powers"]

#: Largest degree of a polynomial for F, and its smallest coefficient that counts.
_DEGREE, _NEGLIGIBLE = 96, 5e-16
#: Radius, relative to that of the nearest point of the surface or to its distance, up to which the punch is left out.
_INNERMOST = 3e-8
#: Share of the power that is left out beyond the largest radius, where the surface is taken for a plane.
_LEFT = 1e-16
#: Nodes of a Gauss rule: _NODES, and _PER_LENGTH for each unit of its length in the variable of the quadrature, times
#: half the exponent of growth of steep punches, and the whole one beside or below a slender punch: a ray from the point
#: meets the profile of r^n at complex radii of the angles pi/n and pi/(2 n).  Measured under the 12-6 and the 9-3 law
#: against twice and four times as many, for paraboloids, cones and powers of up to 6: 1e-13 beside the rounding of the
#: height.
_NODES, _PER_LENGTH = 16, 4.0
#: Their number is a multiple of it, so that few rules are computed.
_STEP = 8
#: A punch that is seen at twice its distance at this share of the distance from the axis is slender.
_SLENDER = 0.5
#: Halvings of the radius in the search of the nearest point, beside those for the square of the slope, and of the
#: largest radius.
_HALVINGS, _COARSE = 10, 12
#: Points that are treated together, to bound the memory of temporaries.
_BLOCK = 128
#: Heights and slopes are bounded by it, so that the steepest punches do not overflow.
_HIGHEST = 1e70


@dataclass(frozen=True)
class Profile:
    """A punch with radii and heights in one unit.

    Parameters
    ----------
    punch : PunchShape
    aspect : float
        Unit of its radii over that of its heights, which is the unit here.
    """

    punch: PunchShape
    aspect: float

    def height(self, x: Array) -> Array:
        """f(x), bounded."""
        return np.minimum(self.punch.height(x / self.aspect), _HIGHEST)

    def slope(self, x: Array) -> Array:
        """df/dx, bounded."""
        return np.minimum(self.punch.slope(x / self.aspect) / self.aspect, _HIGHEST)

    @property
    def kinks(self) -> tuple[float, ...]:
        """Radii at which the slope or a higher derivative jumps."""
        return tuple(sorted(self.aspect * r for r in kinks_of(self.punch) + joints_of(self.punch)))


def log_powers(
    profile: Profile, exponents: tuple[float, ...], x: Array, z: Array, unit: Array, finer: float = 1.0
) -> Array:
    """log(p_m (unit/z0)^m), zero under a plane at that distance; shape (exponents, N).

    Parameters
    ----------
    profile : Profile
    exponents : tuple of float
        m > 1.
    x, z : ndarray, shape (N,)
        Radius >= 0, and height, of each point; nan is the value for one inside the punch.
    unit : ndarray, shape (N,)
        Length of about the distance of each point from the punch.
    finer : float
        Factor of their density.
    """
    values = np.full((len(exponents), len(x)), np.nan)
    below = np.flatnonzero(profile.height(x) > z)
    for start in range(0, len(below), _BLOCK):
        at = below[start : start + _BLOCK]
        values[:, at] = _block(_Seen(profile, x[at], z[at], unit[at]), exponents, finer)
    return values


def _block(seen: _Seen, exponents: tuple[float, ...], finer: float) -> Array:
    farther = (1.0 / _LEFT) ** (1.0 / min(exponents))
    sums = np.zeros((len(exponents), len(seen.x)))
    ends = np.array([0.0, *seen.profile.kinks, math.inf])
    for a, b in pairwise(ends):
        for rho, weight in seen.rules(a, b, farther, finer):
            sums += seen.fluxes(exponents, rho, weight)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.log(sums))


class _Seen:
    """The surface seen from points: radii from the axis, heights above the points, all in their units."""

    def __init__(self, profile: Profile, x: Array, z: Array, unit: Array) -> None:
        self.profile, self._unit, self._z = profile, unit, z
        self.x = x / unit
        self._depth = (profile.height(x) - z) / unit
        steep = profile.slope(x)
        self._steepest, self._steep = float(np.max(np.abs(steep))), steep > 1.0

    def surface(self, rho: Array) -> tuple[Array, Array]:
        """Height above the points, and slope; shape of `rho`, whose first axis is that of the points."""
        unit, z = (self._unit, self._z) if rho.ndim == 1 else (self._unit[:, None], self._z[:, None])
        radius = rho * unit
        return (self.profile.height(radius) - z) / unit, self.profile.slope(radius)

    def _nearest(self, a: Array, b: Array) -> tuple[Array, Array, Array]:
        """Nearest radius of the surface between two, by the sign of the derivative of the distance; that, its scale."""
        low, high = np.clip(self.x - self._depth, a, b), np.clip(self.x + self._depth, a, b)
        for _ in range(_HALVINGS + math.ceil(2.0 * math.log2(1.0 + self._steepest))):
            middle = 0.5 * (low + high)
            h, steep = self.surface(middle)
            outside = middle - self.x + h * steep > 0.0
            low, high = np.where(outside, low, middle), np.where(outside, middle, high)
        h, steep = self.surface(high)
        distance = np.hypot(high - self.x, h)
        return high, distance, distance / np.hypot(1.0, steep)

    def _farthest(self, nearest: Array, distance: Array) -> Array:
        """Radius of the surface at about that distance from the points or more."""
        low, high = np.log(nearest + np.finfo(float).tiny), np.log(nearest + distance)
        low = np.maximum(low, high - 80.0)
        for _ in range(_COARSE):
            middle = 0.5 * (low + high)
            radius = np.exp(middle)
            outside = np.maximum(radius - self.x, self.surface(radius)[0]) > distance
            low, high = np.where(outside, low, middle), np.where(outside, middle, high)
        return np.exp(high)

    def rules(self, start: float, stop: float, farther: float, finer: float) -> Iterator[tuple[Array, Array]]:
        """Radii and weights, each of shape (N, nodes), on the sections of a piece of the profile."""
        a, b = start / self._unit, stop / self._unit
        nearest, distance, scale = self._nearest(a, b)
        apart = scale < 2.0 * nearest  # else the axis is as near
        inner = np.where(apart, 0.5 * nearest, nearest + scale)
        width = np.where(apart, inner, np.minimum(inner, self._farthest(nearest, 2.0 * distance)))
        first = np.maximum(a, _INNERMOST * width)
        # Nodes for each unit of length.
        slender = np.any(self._steep | ~apart & (width < _SLENDER * distance))
        density = finer * _PER_LENGTH * max(1.0, self.profile.punch.growth * (1.0 if slender else 0.5))
        far = np.minimum(b, self._farthest(nearest, farther * distance))
        if np.any(inner > first):
            top = np.minimum(np.maximum(inner, first), np.maximum(far, first))
            t, weight = _gauss(np.log(top / first), density)
            rho = first[:, None] * np.exp(t)
            yield rho, weight * rho
        middle = np.maximum(np.minimum(inner, b), first)
        for sign, near, away in (
            (-1.0, np.zeros_like(scale), np.where(apart, nearest - middle, 0.0)),
            (1.0, np.where(apart, 0.0, middle - nearest), np.maximum(far - nearest, 0.0)),
        ):
            begin, end = np.arcsinh(near / scale), np.arcsinh(away / scale)
            length = np.maximum(end - begin, 0.0)
            if np.any(length > 0.0):
                t, weight = _gauss(length, density)
                t = t + begin[:, None]
                yield nearest[:, None] + sign * scale[:, None] * np.sinh(t), weight * scale[:, None] * np.cosh(t)

    def fluxes(self, exponents: tuple[float, ...], rho: Array, weight: Array) -> Array:
        """Parts of p_m from rings of the surface, shape (exponents, N)."""
        x = self.x[:, None]
        h, steep = self.surface(rho)
        square = h * h
        near, far = (rho - x) ** 2 + square, (rho + x) ** 2 + square
        w = np.sqrt(near / far)
        area = weight * rho * w
        through, around = (h - steep * (rho - x)) * area, steep * x * area * w
        log_near = np.log(near)
        parts = []
        for m in exponents:
            of_J, of_K = _azimuth(m)
            t = w if m == round(m) else np.sqrt(w)
            bracket = through * _value(of_J, t) - around * _value(of_K, t)
            parts.append((m + 1.0) * np.sum(bracket * np.exp(-0.5 * (m + 3.0) * log_near), axis=1))
        return np.array(parts)


def _gauss(length: Array, density: float) -> tuple[Array, Array]:
    """Nodes and weights of a Gauss rule from 0 to each length."""
    nodes, weights = _legendre(_STEP * math.ceil((_NODES + density * float(np.max(length))) / _STEP))
    half = 0.5 * length[:, None]
    return half * (1.0 + nodes), half * weights


@lru_cache(maxsize=512)
def _legendre(count: int) -> tuple[Array, Array]:
    return np.polynomial.legendre.leggauss(count)


@lru_cache(maxsize=64)
def _azimuth(m: float) -> tuple[Array, Array]:
    """Chebyshev coefficients of F of J, and of w times F of K: over w for an integer m, else over its root."""
    from scipy.fft import dct
    from scipy.special import hyp2f1

    s = 0.5 * (m + 3.0)
    t = 0.5 * (1.0 + np.polynomial.chebyshev.chebpts1(4 * _DEGREE))
    w = t if m == round(m) else t * t
    parts = (
        hyp2f1(1.0 - s, 0.5, 1.0, 1.0 - w * w),
        w * hyp2f1(2.0 - s, 1.5, 2.0, 1.0 - w * w),
    )
    coefficients = []
    for values in parts:
        series = dct(values[::-1], type=2)[: _DEGREE + 1] / values.size
        series[0] *= 0.5
        last = np.flatnonzero(np.abs(series) > _NEGLIGIBLE)[-1]
        coefficients.append(series[: last + 1])
    return coefficients[0], coefficients[1]


def _value(coefficients: Array, w: Array) -> Array:
    """The polynomial at w, by Clenshaw's recurrence in place."""
    twice = 4.0 * w - 2.0
    b1 = np.full_like(w, coefficients[-1])
    b2 = np.zeros_like(w)
    for coefficient in coefficients[-2:0:-1]:
        # b1, b2 = coefficient + twice * b1 - b2, b1
        np.subtract(coefficient, b2, out=b2)
        b2 += twice * b1
        b1, b2 = b2, b1
    return np.asarray(coefficients[0] + 0.5 * twice * b1 - b2 if len(coefficients) > 1 else b1)
