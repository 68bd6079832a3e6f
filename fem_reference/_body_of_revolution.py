r"""Potential of all atoms of a paraboloid that has no end, at points below it.

The pair potential |y|^-(m+3) is the divergence of -y |y|^-(m+3)/m, so that its integral over the punch is the flux of
that through its face.  For a point on the axis of x at the radius rho and z below the apex, a face f(t) and an azimuth
phi, with A = (t - rho)^2 + (f + z)^2 and B = (t + rho)^2 + (f + z)^2,

    I_s = int_0^2pi |y|^(-2s) dphi = 2 pi (A B)^(-s/2) P_(s-1)(cosh),   cosh = (A + B)/(2 sqrt(A B)),

where P are Legendre polynomials for the integers s = (m + 3)/2, and int cos(phi) |y|^(-2s) dphi follows from I_s and
I_(s-1).  What is left is an integral over t; the force on an atom is the integral of the potential over the face.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fem_reference._typing import Array
from fem_reference.laws import LennardJones, Mie
from fem_reference.punch import PowerPunch

__all__ = ["BodyOfRevolution"]

#: Nodes of an integral over the face, for each unit of the logarithm of distances, and in addition.  Measured on
#: paraboloids of 3 to 1e4 lengths of the law: 3e-11 of the potential.
_DENSITY, _LEAST = 4.0, 16

#: Radii are resolved to this share of the nearest one at the axis; the face is followed to this many distances.
_INNER, _OUTER = 0.03, 1e4

#: Bisections for the nearest radius.
_BISECTIONS = 22

#: Points in one batch.
_BATCH = 250

#: Quadrature of the energy: nodes of a piece, over depths that grow by a ratio, to this many radii.
_GAUSS = np.polynomial.legendre.leggauss(12)
_RATIO, _FARTHEST = 2.0, 1e4

#: Steps of Newton's method for the largest tension, each of which leaves a tenth of the error or less; relative step of
#: the difference for its slope.
_STEPS, _BESIDE = 9, 1e-4

#: Radii of the paraboloid beyond which the traction is a power to 1e-3.
_SLENDER = 1e3


@dataclass(frozen=True, slots=True)
class BodyOfRevolution:
    """The potential of a paraboloid.

    Parameters
    ----------
    punch : PowerPunch
        n = 2.
    law : LennardJones or Mie
        Law of the same atoms over a half-space, of odd exponents.

    Examples
    --------
    >>> body = BodyOfRevolution(PowerPunch(2.0, 1e9), LennardJones(1.0, 1.0))
    >>> float(body.traction(np.array(0.0), np.array(0.5)) / LennardJones(1.0, 1.0).traction(np.array(0.5)))
    0.999999...
    """

    punch: PowerPunch
    law: LennardJones | Mie

    def traction(self, rho: Array, gap: Array) -> Array:
        """p(rho, H), shape of both."""
        return self._sum(rho, gap, 0)

    def slopes(self, rho: Array, gap: Array) -> tuple[Array, Array]:
        """dp/drho at a fixed gap, and dp/dH."""
        return self._sum(rho, gap, 1), self._sum(rho, gap, 2)

    def _sum(self, rho: Array, gap: Array, part: int) -> Array:
        powers = self._powers(rho, gap)
        return np.asarray(
            sum(strength * power[part] for (strength, _), power in zip(self.law.powers, powers, strict=True))
        )

    def _powers(self, rho: Array, gap: Array) -> Array:
        """Powers of the law, and their derivatives by radius and gap, shape (2, 3, ...)."""
        rho, gap = np.broadcast_arrays(np.asarray(rho, float), np.asarray(gap, float))
        return _potentials(self, rho.shape, rho.tobytes(), gap.tobytes())

    def peak_gap(self, rho: Array) -> Array:
        """Gap of the largest tension at a radius."""
        rho, z0 = np.asarray(rho, float), self.law.z0
        (_, m), (_, n) = self.law.powers
        depth = (z0 + self.law.peak_gap) * np.hypot(1.0, self.punch.slope(rho))
        for _ in range(_STEPS):
            # The slopes of the powers are almost powers themselves, of m + 1 and n + 1.
            (repulsion, attraction) = self._powers(rho, depth - z0)
            ratio = repulsion[2] * self.law.powers[0][0] / (-attraction[2] * self.law.powers[1][0])
            depth = depth * ratio ** (1.0 / (m - n))
        return np.asarray(depth - z0)

    def peak_slope(self, rho: Array) -> Array:
        """Its derivative by the radius."""
        rho = np.asarray(rho, float)
        ends = [self.peak_gap(rho * (1.0 + side * _BESIDE)) for side in (1.0, -1.0)]
        return np.asarray((ends[0] - ends[1]) / (2.0 * _BESIDE * rho))

    def fall(self, r: float) -> float:
        """That of the potential where the surface is level with the apex; far away it is that of a slender body."""
        if r > _SLENDER * self.punch.Q:
            return self.law.decay[1] + 1.0
        at = np.array(r)
        level = np.array(self.punch.height(at))
        by_radius, by_gap = self.slopes(at, level)
        return -r * float((by_radius + by_gap * self.punch.slope(at)) / self.traction(at, level))

    def energy(self, rho: Array, gap: Array) -> Array:
        """Integral of p from H to infinity, by quadrature along the vertical line."""
        rho, gap = np.broadcast_arrays(np.asarray(rho, float), np.asarray(gap, float))
        depth = self.law.z0 + gap
        x, weights = _GAUSS
        farthest = _FARTHEST * (self.punch.Q + float(np.max(rho)))
        count = max(1, math.ceil(math.log(farthest / float(np.nanmin(depth))) / math.log(_RATIO)))
        total = np.zeros_like(depth)
        for piece in range(count):
            start, stop = depth * _RATIO**piece, depth * _RATIO ** (piece + 1)
            for node, weight in zip(x, weights, strict=True):
                at = 0.5 * (start + stop) + 0.5 * (stop - start) * node
                total += 0.5 * (stop - start) * weight * self.traction(rho, at - self.law.z0)
        return total


@lru_cache(maxsize=8)
def _potentials(body: BodyOfRevolution, shape: tuple[int, ...], rho: bytes, gap: bytes) -> Array:
    """Powers and slopes: those who need the traction need its slopes next."""
    z0, R = body.law.z0, body.punch.Q / body.law.z0
    x = np.frombuffer(rho).ravel() / z0
    depth = 1.0 + np.frombuffer(gap).ravel() / z0
    values = np.full((2, 3, x.size), np.nan)
    below = np.flatnonzero(depth > 0.0)
    for start in range(0, below.size, _BATCH):
        at = below[start : start + _BATCH]
        for i, power in enumerate(_of_batch(R, [round(m) for _, m in body.law.powers], x[at], depth[at])):
            values[i][:, at] = power
    values[:, 1:] /= z0
    return values.reshape(2, 3, *shape)


def _of_batch(R: float, exponents: list[int], x: Array, depth: Array) -> Iterator[Array]:
    """Power and its derivatives by x, at a fixed depth, and by the depth, of each exponent; lengths in z0."""
    t, weight = _face(R, x, depth)
    x = x[:, None]
    # Height of the face above the point, without the cancellation of its two heights.
    above = (t - x) * (t + x) / (2.0 * R) + depth[:, None]
    A, B = (t - x) ** 2 + above**2, (t + x) ** 2 + above**2
    slope, area = t / R, weight * t
    for m in exponents:
        first, second = _legendre(A, B, (m + 3) // 2)
        # The integral with cos(phi), times x.
        cosine = ((A + B) * second / 2.0 - first) / (2.0 * t)
        strength = m * (m + 1.0) / (2.0 * math.pi)
        flux = strength / m * np.sum(area * ((above - slope * t) * second + slope * cosine), axis=1)
        along = -strength * np.sum(area * slope * cosine, axis=1)  # times x
        down = -strength * np.sum(area * second, axis=1)
        at = x[:, 0]
        radial = np.divide(along, at, out=np.zeros_like(at), where=at > 0.0) - at / R * down
        yield np.stack([flux, radial, down])


def _legendre(A: Array, B: Array, s: int) -> tuple[Array, Array]:
    """I_(s-1) and I_s, s >= 3."""
    root = np.sqrt(A * B)
    cosh = 0.5 * (A + B) / root
    lower, upper = np.ones_like(cosh), cosh
    for i in range(1, s - 1):
        lower, upper = upper, ((2 * i + 1) * cosh * upper - i * lower) / (i + 1)
    factor = 2.0 * math.pi * root ** (1 - s)
    return factor * lower, factor / root * upper


def _face(R: float, x: Array, depth: Array) -> tuple[Array, Array]:
    """Radii of the face and weights, shapes (points, nodes), finest at the radius nearest to a point."""
    low, high = np.zeros_like(x), x
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        rising = middle - x + ((middle - x) * (middle + x) / (2.0 * R) + depth) * middle / R > 0.0
        low, high = np.where(rising, low, middle), np.where(rising, middle, high)
    distance = np.hypot(high - x, (high - x) * (high + x) / (2.0 * R) + depth)
    scale = np.minimum(distance / np.hypot(1.0, high / R), np.hypot(high, R))
    least = np.finfo(float).tiny
    radii, weights = [], []
    for origin, side, size, extent in (
        (0.0 * x, 1.0, _INNER * high + least, 0.5 * high),
        (high, -1.0, scale, 0.5 * high),
        (high, 1.0, scale, _OUTER * distance),
    ):
        # Distances from the origin are size (e^u - 1).
        longest = np.log1p(extent / size)
        node, weight = np.polynomial.legendre.leggauss(_LEAST + math.ceil(_DENSITY * float(longest.max())))
        u = 0.5 * longest[:, None] * (1.0 + node)
        radii.append(origin[:, None] + side * size[:, None] * np.expm1(u))
        weights.append(0.5 * (longest * size)[:, None] * weight * np.exp(u))
    return np.maximum(np.concatenate(radii, axis=1), least), np.concatenate(weights, axis=1)
