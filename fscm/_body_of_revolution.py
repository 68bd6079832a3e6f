r"""Potential of the atoms that fill a paraboloid z >= f(rho) without end, at a point below its surface.

The integral of the pair potential d^-(m+3) over the punch is one over its surface, because
div(x d^-(m+3)) = -m d^-(m+3) for the vector x from the point; gradients are integrals of d^-(m+3) over the surface.
With a point at the radius r, h = f(rho) - f(r) + v the height of the surface above it, and over the azimuth

    J = int d^-(m+3) dphi,   K = int (1 - cos phi) d^-(m+3) dphi,   d^2 = C - D cos phi,

the power (z0/v)^m of the law over a half-space becomes, with c = m (m+1) z0^m/(2 pi),

    p_m = (c/m) int { [h - f' (rho - r)] J - f' r K } rho drho,
    dp_m/dv = -c int J rho drho,   dp_m/dr at a fixed height of the point = -c int f' (J - K) rho drho.

By tan(phi/2) = sqrt((C-D)/(C+D)) tan(psi/2), d^2 = (C^2 - D^2)/(C + D cos psi) and 1 - cos phi =
(C - D) (1 - cos psi)/(C + D cos psi).  For odd m, J and K are integrals of polynomials in cos psi, for which equal
angles are exact.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fscm._typing import Array
from fscm.laws import LennardJones, Mie
from fscm.punch import PunchShape, ScaledPunch

__all__ = ["BodyOfRevolution", "powers_of_body"]

#: Scale near the axis in the radius of the nearest point of the surface: a far point sees the tip of the punch.
_TIP = 0.02
#: Distance from the nearest radius to which the surface is integrated, in that of the point: what is beyond is below
#: 1e-17 of the whole for m >= 3.
_FARTHEST = 3e4
#: Nodes of a piece: _NODES, and _PER_LENGTH for each unit of its length in the variable of the quadrature.  Measured
#: against three times as many on paraboloids of 5 to 1e4 lengths of the law: powers change by less than 3e-13 of
#: themselves up to 100 radii of the tip, and by 1e-7 at 1e6 of them, where 1e-12 of the load is left.
_NODES, _PER_LENGTH = 16, 4.0
#: Halvings of the radius in the search of the nearest point, which only scales the quadrature.
_HALVINGS = 25
#: Points that are treated together, to bound the memory of temporaries.
_BLOCK = 200


#: Steps of the secant method for the largest tension, whose equation is almost linear in log v: 1e-15 after four.
_SECANTS = 5
#: Step of log r for the drift of that; it moves the mesh alone.
_STEP = 1e-4
#: Quadrature of the energy over the inverse depth, on pieces on which it falls by _RATIO; the last one begins at
#: _DEEPEST sizes of the point, beyond which the traction is a power of the depth.
_GAUSS = np.polynomial.legendre.leggauss(16)
_RATIO, _DEEPEST = 6.0, 40.0
#: The traction is a power of the radius, to 1e-2, beyond this many radii of curvature of the tip.
_TIP_RADII = 300.0


@dataclass(frozen=True, slots=True)
class BodyOfRevolution:
    """The potential of a punch without end (see the module): an `fscm.interaction.Interaction`.

    Parameters
    ----------
    punch : PowerPunch or ScaledPunch
        A paraboloid.
    law : LennardJones or Mie
        Law of the same atoms over a half-space, of odd exponents.

    Examples
    --------
    Far above a paraboloid the traction on its axis is that of a plane and of a slender body:

    >>> from fscm.punch import PowerPunch
    >>> body = BodyOfRevolution(PowerPunch(2.0, 1e9), LennardJones())
    >>> round(float(body.traction(np.array(0.0), np.array(0.5)) / LennardJones().traction(np.array(0.5))), 6)
    1.0
    """

    punch: PunchShape
    law: LennardJones | Mie

    @property
    def aspect(self) -> float:
        """Unit of radii over that of heights."""
        return self.punch.radius / self.punch.height_unit if isinstance(self.punch, ScaledPunch) else 1.0

    @property
    def exponents(self) -> tuple[int, int]:
        """Of the repulsion and of the attraction of the law."""
        return (9, 3) if isinstance(self.law, LennardJones) else (round(self.law.m), round(self.law.n))

    @property
    def _strength(self) -> float:
        m, n = self.exponents
        return (m - 1.0) * (n - 1.0) / (m - n) * self.law.work_of_adhesion / self.law.z0

    def falls_as(self, r: float) -> float:
        """Exponent q of p ~ r^-q far away, where the punch is a slender body of the cross-section ~ z^(2/growth)."""
        return self.exponents[1] + 2.0 - 2.0 / self.punch.growth

    @property
    def slope_falls_by(self) -> float:
        """Exponent by which dp/dH falls faster."""
        return 1.0

    @property
    def far_radius(self) -> float:
        """Radius beyond which the traction is nearly a power."""
        return _TIP_RADII * self._tip_radius / self.aspect

    @property
    def _tip_radius(self) -> float:
        """Of the paraboloid, in the unit of heights."""
        return 0.5 * self.aspect**2 / float(self.punch.height(np.array(1.0)))

    @property
    def size_of_punch(self) -> float:
        """Length in the unit of heights beyond which a depth is large."""
        return self._tip_radius

    def _powers(self, r: Array, H: Array) -> tuple[tuple[Array, Array, Array], ...]:
        r, H = np.broadcast_arrays(np.asarray(r, float), np.asarray(H, float))
        return _evaluated(self, r.shape, r.tobytes(), H.tobytes())

    def traction(self, r: Array, H: Array) -> Array:
        """p(r, H)."""
        repulsion, attraction = self._powers(r, H)
        return self._strength * (repulsion[0] - attraction[0])

    def slope(self, r: Array, H: Array) -> Array:
        """dp/dH at a fixed radius."""
        repulsion, attraction = self._powers(r, H)
        return self._strength * (repulsion[1] - attraction[1])

    def drift(self, r: Array, H: Array) -> Array:
        """r dp/dr at a fixed gap."""
        repulsion, attraction = self._powers(r, H)
        return self._strength * (repulsion[2] - attraction[2])

    def size(self, r: Array, H: Array) -> Array:
        """Repulsion and attraction, and what the rounding of the height at the point makes of them."""
        repulsion, attraction = self._powers(r, H)
        by_height = self.punch.height(r) * (repulsion[1] + attraction[1])
        return np.asarray(self._strength * (repulsion[0] + attraction[0] - by_height))

    def peak_gap(self, r: Array) -> Array:
        """Gap of the largest tension at a radius."""
        r = np.asarray(r, float)
        m, n = self.exponents

        def log_ratio(u: Array) -> Array:
            repulsion, attraction = self._powers(r, self.law.z0 * np.expm1(u))
            return np.asarray(np.log(repulsion[1] / attraction[1]))

        stretch = np.hypot(1.0, self.punch.slope(r) / self.aspect)
        u = np.log(stretch * (1.0 + self.law.peak_gap / self.law.z0))
        left = log_ratio(u)
        step = left / (m - n)
        for _ in range(_SECANTS):
            u = u + step
            before, left = left, log_ratio(u)
            with np.errstate(divide="ignore", invalid="ignore"):
                step = np.where(left == before, 0.0, step * left / (before - left))
        return np.asarray(self.law.z0 * np.expm1(u))

    def peak_drift(self, r: float) -> float:
        """Its derivative by the logarithm of the radius."""
        below, above = self.peak_gap(r * np.exp([-_STEP, _STEP]))
        return float(above - below) / (2.0 * _STEP)

    def energy(self, r: Array, H: Array) -> Array:
        """Integral of p from H to infinity at a fixed radius."""
        r, H = np.broadcast_arrays(np.asarray(r, float), np.asarray(H, float))
        v = self.law.z0 + H
        largest = self._tip_radius + self.aspect * float(np.max(r)) + float(np.max(np.abs(H)))
        pieces = math.ceil(math.log(max(_DEEPEST * largest / np.nanmin(v), 1.0)) / math.log(_RATIO))
        ends = np.append(_RATIO ** -np.arange(pieces + 1.0), 0.0)
        x, w = _GAUSS
        half = 0.5 * (ends[:-1] - ends[1:])
        t = (ends[1:] + half)[:, None] + half[:, None] * x
        total = np.zeros_like(v)
        for inverse, weight in zip(t.ravel(), (half[:, None] * w).ravel(), strict=True):
            total += weight / inverse**2 * self.traction(r, v / inverse - self.law.z0)
        return total * v


@lru_cache(maxsize=8)
def _evaluated(
    body: BodyOfRevolution, shape: tuple[int, ...], r: bytes, H: bytes
) -> tuple[tuple[Array, Array, Array], ...]:
    """Powers of the repulsion and of the attraction: traction, slope and drift are asked for one after the other."""
    radius, gap = (np.frombuffer(values).reshape(shape) for values in (r, H))
    z0 = body.law.z0
    return tuple(powers_of_body(body.punch, body.aspect, body._tip_radius, body.exponents, radius, z0 + gap, z0))


def powers_of_body(
    punch: PunchShape, aspect: float, tip: float, exponents: tuple[int, ...], r: Array, v: Array, z0: float
) -> list[tuple[Array, Array, Array]]:
    """p_m, dp_m/dv at a fixed radius, and r dp_m/dr at a fixed v, of each exponent.

    Parameters
    ----------
    punch : PunchShape
    aspect : float
        Unit of radii over that of heights.
    tip : float
        Radius over which the tip is blunt, in the unit of heights: the surface is not smooth over longer distances.
    exponents : tuple of int
        Odd m >= 3.
    r, v : ndarray
        Radius, and depth below the surface; nan where that is not positive.
    z0 : float
        In the unit of heights.
    """
    r, v = np.broadcast_arrays(np.asarray(r, float), np.asarray(v, float))
    values = np.full((len(exponents), 3, r.size), np.nan)
    below = np.flatnonzero(v.ravel() > 0.0)
    for start in range(0, below.size, _BLOCK):
        at = below[start : start + _BLOCK]
        values[:, :, at] = _block(punch, aspect, tip / z0, exponents, r.ravel()[at], v.ravel()[at] / z0, z0)
    return [(p.reshape(r.shape), by_v.reshape(r.shape), by_r.reshape(r.shape)) for p, by_v, by_r in values]


def _block(
    punch: PunchShape, aspect: float, tip: float, exponents: tuple[int, ...], r: Array, v: Array, z0: float
) -> Array:
    """The same for a few points, with lengths in z0."""
    unit = aspect / z0
    x, height, slope = unit * r, punch.height(r) / z0, punch.slope(r) / aspect

    def surface(rho: Array, of: Array, depth: Array) -> tuple[Array, Array]:
        return punch.height(rho / unit) / z0 - of + depth, punch.slope(rho / unit) / aspect

    # The nearest radius, by the sign of the derivative of the distance.
    low, high = np.zeros_like(x), x
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        h, steep = surface(middle, height, v)
        outside = middle - x + h * steep > 0.0
        low, high = np.where(outside, low, middle), np.where(outside, middle, high)
    h, steep = surface(high, height, v)
    distance = np.hypot(high - x, h)
    scale = np.minimum(distance / np.hypot(1.0, steep), np.hypot(high, tip))
    rho, weight = _radii(high, scale, _FARTHEST * distance)
    x = x[:, None]
    h, steep = surface(rho, height[:, None], v[:, None])
    near, far = (rho - x) ** 2 + h**2, (rho + x) ** 2 + h**2
    area, flat = weight * rho, h - steep * (rho - x)
    values = []
    for m in exponents:
        J, K = _azimuth(near, far, m)
        c = m * (m + 1.0) / (2.0 * math.pi)
        p = c / m * np.sum(area * (flat * J - steep * x * K), axis=1)
        by_depth = -c * np.sum(area * J, axis=1)
        by_radius = -c * np.sum(area * steep * (J - K), axis=1)
        # At a fixed depth the point rises with the surface.
        values.append([p, by_depth / z0, x[:, 0] * (by_radius - slope * by_depth)])
    return np.array(values)


def _azimuth(near: Array, far: Array, m: int) -> tuple[Array, Array]:
    """J and K, from d^2 = `near` at phi = 0 and `far` at phi = pi."""
    s = (m + 3) // 2
    J, K = np.zeros_like(near), np.zeros_like(near)
    relative = near / far
    for i in range((s + 1) // 2):  # the other angles are their mirror images
        opposite = math.sin(0.5 * math.pi * (2 * i + 1) / s) ** 2
        weight = 2.0 * math.pi / s * (1.0 if 2 * i + 1 == s else 2.0)
        ratio = 1.0 - opposite * (1.0 - relative)  # (C + D cos psi)/(C + D)
        power = weight * _power(ratio, s - 2)
        J += power * ratio
        K += 2.0 * opposite * power
    factor = np.sqrt(relative) * _power(1.0 / near, s)
    return factor * J, factor * relative * K


def _power(base: Array, exponent: int) -> Array:
    """By multiplications, which are faster than a power of arrays."""
    if exponent < 2:
        return base if exponent else np.ones_like(base)
    half = _power(base, exponent // 2)
    return half * half * base if exponent % 2 else half * half


def _radii(nearest: Array, scale: Array, farthest: Array) -> tuple[Array, Array]:
    """Radii of the surface and weights, finer at the axis and around the nearest one of each point."""
    tip = _TIP * nearest + np.finfo(float).tiny
    radii, all_weights = [], []
    for center, size, sign, extent in (
        (np.zeros_like(nearest), tip, 1.0, 0.5 * nearest),
        (nearest, scale, -1.0, 0.5 * nearest),
        (nearest, scale, 1.0, farthest),
    ):
        length = np.arcsinh(extent / size)
        nodes, weights = np.polynomial.legendre.leggauss(_NODES + math.ceil(_PER_LENGTH * float(length.max())))
        t = 0.5 * length[:, None] * (1.0 + nodes)
        radii.append(center[:, None] + sign * size[:, None] * np.sinh(t))
        all_weights.append(0.5 * (length * size)[:, None] * weights * np.cosh(t))
    return np.concatenate(radii, axis=1), np.concatenate(all_weights, axis=1)
