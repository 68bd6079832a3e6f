r"""Potential of all atoms of a punch of any profile, at points below its face.

The pair potential |y|^-(m+3) is the divergence of -y |y|^-(m+3)/m, so that its integral over the punch is the flux of
that through its face, and the force on an atom is the integral of the potential over the face.  For a point at the
radius x and a ring of the face of the radius t, h above the point, with A = (t - x)^2 + h^2, B = (t + x)^2 + h^2 and
the functions g and k of s = (m + 3)/2 (`fem_reference._azimuth`),

    J = A^(1/2-s) B^(-1/2) g(A/B),   K = A^(1/2-s) B^(-1/2) (1 - A/B) k(A/B),

the power (z0/v)^m of the law over a half-space at the depth v becomes

    p_m = (m+1) z0^m int [(h - f' t) J + f' x K] t dt,

its derivative by the depth -m (m+1) z0^m int J t dt, and that by the radius at a fixed place of the face
-m (m+1) z0^m int f' K t dt.  The integrals over t are on panels (`fem_reference._face`).
"""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import cast

import numpy as np

from fem_reference._azimuth import azimuth
from fem_reference._face import Face, Fineness, face_of
from fem_reference._surface_force import Interaction, secant_root
from fem_reference._typing import Array, Index
from fem_reference._vertical_line import energy_above
from fem_reference.laws import LennardJones, Mie
from fem_reference.punch import Punch

__all__ = ["BodyOfRevolution"]

#: The quadrature, and a finer one that tells its error.  Measured between both: powers of paraboloids, cones and
#: rounded cones change by less than 3e-11 of themselves.
_FINENESS = Fineness(nodes=14, ratio=1.0, roughness=1e-9, beyond=1e-12)
_FINER = Fineness(nodes=20, ratio=1.3, roughness=1e-11, beyond=1e-14)

#: Pairs of a point and a panel in one batch, so that its arrays stay in the cache.
_BATCH = 400

#: Heights that differ by less than this share are equal: far away a point level with the apex is at the height 0.
_LEVEL = 8.0 * np.finfo(float).eps

#: Steps of the secant method for the largest tension, whose equation is almost linear in the logarithm of the depth.
_SECANTS = 4


@dataclass(frozen=True, slots=True)
class BodyOfRevolution(Interaction):
    """The potential of a punch.

    Parameters
    ----------
    punch : Punch
    law : LennardJones or Mie
        Law of the same atoms over a half-space.
    fineness : Fineness
        Of the quadrature.

    Examples
    --------
    >>> from fem_reference.punch import PowerPunch
    >>> body = BodyOfRevolution(PowerPunch(2.0, 1e9), LennardJones(1.0, 1.0))
    >>> float(body.traction(np.array(0.0), np.array(0.5)) / LennardJones(1.0, 1.0).traction(np.array(0.5)))
    0.999999...
    """

    punch: Punch
    law: LennardJones | Mie
    fineness: Fineness = _FINENESS

    @property
    def finer(self) -> BodyOfRevolution:
        """The same by a finer quadrature."""
        return replace(self, fineness=_FINER)

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
        rho = np.asarray(rho, float)
        return _peak_gap(self, rho.shape, rho.tobytes())

    def energy(self, rho: Array, gap: Array) -> Array:
        """Integral of p from H to infinity, by quadrature along the vertical line."""
        return energy_above(self, rho, gap, -self.law.z0)


@lru_cache(maxsize=64)
def _peak_gap(body: BodyOfRevolution, shape: tuple[int, ...], rho: bytes) -> Array:
    """Gap of the largest tension."""
    x, z0, ((A, m), (B, n)) = np.frombuffer(rho), body.law.z0, body.law.powers

    def excess(log_depth: Array) -> Array:
        # The slopes of the powers are almost powers themselves, of m + 1 and n + 1.
        repulsion, attraction = body._powers(x, np.exp(log_depth) - z0)
        return np.asarray(np.log(-A * repulsion[2] / (B * attraction[2])) / (m - n))

    first = np.log((z0 + body.law.peak_gap) * np.hypot(1.0, body.punch.slope(x)))
    left = excess(first)
    return np.asarray(np.exp(secant_root(excess, first, left, first + left, _SECANTS)) - z0).reshape(shape)


@lru_cache(maxsize=8)
def _potentials(body: BodyOfRevolution, shape: tuple[int, ...], rho: bytes, gap: bytes) -> Array:
    """Powers and slopes: those who need the traction need its slopes next."""
    z0 = body.law.z0
    x = np.frombuffer(rho)
    depth = z0 + np.frombuffer(gap)
    exponents = [m for _, m in body.law.powers]
    values = np.full((len(exponents), 3, x.size), np.nan)
    below = np.flatnonzero(depth > 0.0)
    if below.size:
        values[:, :, below] = _powers_at(body, exponents, x[below], depth[below])
    return values.reshape(-1, 3, *shape)


def _powers_at(body: BodyOfRevolution, exponents: list[float], x: Array, depth: Array) -> Array:
    """Powers and their slopes at points below the face, shape (powers, 3, points)."""
    above = body.punch.height(x)
    z = above - depth
    z[np.abs(z) <= _LEVEL * np.maximum(above, depth)] = 0.0
    face = face_of(cast(Hashable, body.punch), body.fineness)
    reach = depth * body.fineness.beyond ** (-1.0 / min(exponents))
    point, panel, distance = face.panels(x, z, depth, reach)
    unit = np.full(x.size, np.inf)
    np.minimum.at(unit, point, distance)
    sums = np.empty((len(exponents), 3, point.size))
    for start in range(0, point.size, _BATCH):
        batch = slice(start, start + _BATCH)
        at = point[batch]
        sums[:, :, batch] = _on_panels(face, panel[batch], x[at], z[at], unit[at], exponents)
    values = np.array([[np.bincount(point, weights=column, minlength=x.size) for column in power] for power in sums])
    for power, m in zip(values, exponents, strict=True):
        power *= (m + 1.0) * (body.law.z0 / unit) ** m
        power[1:] *= -m / unit
        power[1] -= body.punch.slope(x) * power[2]  # at a fixed depth the point rises with the face
    return values


def _on_panels(face: Face, panel: Index, x: Array, z: Array, unit: Array, exponents: list[float]) -> Array:
    """Integrals of flux, of f' K and of J on panels, each with lengths in the unit of its point."""
    t, height, slope, weight = face.nodes(panel)
    scale = 1.0 / unit[:, None]
    x, t = x[:, None] * scale, t * scale
    h = (height - z[:, None]) * scale
    A = (t - x) ** 2 + h * h
    ring = 4.0 * x * t
    B = A + ring
    away = ring / B
    area = weight * scale * t
    flat = h - slope * t
    orders = tuple(0.5 * (m + 3.0) for m in exponents)
    cores = _cores(A, B, orders)
    values = azimuth(orders).values(A / B)
    rows = np.empty((len(exponents), 3, x.shape[0]))
    for row, core, (g, k) in zip(rows, cores, values, strict=True):
        core *= area
        J = core * g
        K = core
        K *= away
        K *= k
        K *= slope
        row[0] = np.einsum("ij,ij->i", flat, J) + x[:, 0] * K.sum(axis=1)
        row[1] = K.sum(axis=1)
        row[2] = J.sum(axis=1)
    return rows


def _cores(A: Array, B: Array, orders: tuple[float, ...]) -> list[Array]:
    """A^(1/2-s) B^(-1/2) of each s."""
    if all(s == round(s) for s in orders):
        root, inverse = 1.0 / np.sqrt(A * B), 1.0 / A
        return [root * _power(inverse, round(s) - 1) for s in orders]
    root, logarithm = 1.0 / np.sqrt(B), np.log(A)
    return [root * np.exp((0.5 - s) * logarithm) for s in orders]


def _power(base: Array, exponent: int) -> Array:
    """By multiplications, which are faster than a power of arrays."""
    if exponent == 1:
        return base
    half = _power(base, exponent // 2)
    return half * half * base if exponent % 2 else half * half
