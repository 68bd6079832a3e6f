r"""Potential of a punch under a law that is known as a function of the gap alone, by distance and curvatures.

A pair potential belongs to any law p(d) over a half-space, phi(s) = p''(s)/(2 pi s).  The part of a face whose mean
height above its tangent plane is g(rho), at the distance d below the plane, takes int p''(s) g ds from p, with
s^2 = d^2 + rho^2.  With the mean C and half of the difference D of both curvatures at the nearest point, and the energy
e of the law, this is to second order

    T = p - (d p + e) {C - d (C^2 + D^2/2)},

which is that of a ball (`fem_reference._ball_under_law`) of the curvature C - (d D^2/2)/(1 + d C).

What is left out is estimated: the third order (d k)^2 k (d p + e)/(1 + d k) with the larger curvature k, the far pole
of the ball, which another shape does not have, and what the curvature changes over rings around the nearest point, with
the moments of phi there.  It is an estimate, no bound.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from fem_reference._ball_under_law import face_gap, rate_of_ball, traction_of_ball
from fem_reference._surface_force import BESIDE, Interaction, secant_root
from fem_reference._typing import Array
from fem_reference._vertical_line import energy_above
from fem_reference.laws import SurfaceLaw
from fem_reference.punch import Punch, kinks_of

__all__ = ["CurvedFace", "check_curvature"]

#: Halvings in the search of the nearest radius.
_HALVINGS = 55

#: Relative steps of the differences: of the slope for a curvature, of fourth order, and of the traction by a curvature
#: and by the radius of the nearest point, to which it is less sensitive by d/R; least radius in distances.
_STEP, _BESIDE, _INNERMOST = 1e-3, BESIDE, 1e-6

#: Least curvature in units of 1/d: that of a plane to rounding.
_FLAT = 1e-14

#: Rings around the nearest point, whose radii are distances times powers of two, and angles on half of a ring.
_RINGS, _ANGLES = 12, math.pi * (np.arange(6) + 0.5) / 6

#: Radii in z0 at which a face is checked, and negative curvature relative to the largest that is rounding.
_CHECKED, _HOLLOW = np.geomspace(_INNERMOST, 1e6, 300), 1e-9

#: Steps of the secant method for the largest tension.
_SECANTS = 8


def check_curvature(punch: Punch, law: SurfaceLaw) -> None:
    """Raise ValueError if the face has kinks, is not convex, or has a tip that is sharper than the range of the law."""
    radii = law.z0 * _CHECKED
    bend, _ = _curvatures(punch, radii)
    sharpness = float(np.max(_curvatures(punch, radii[:1]))) * law.z0
    if kinks_of(punch):
        reason = f"a kink at r = {kinks_of(punch)[0]:g}"
    elif not sharpness <= 1.0:
        reason = "a tip whose radius of curvature is below z0"
    elif not np.all(bend >= -_HOLLOW * np.max(np.abs(bend))):
        reason = f"a hollow at r = {radii[np.argmin(bend)]:.3g}"
    else:
        return
    raise ValueError(
        f"interaction 'body' under {type(law).__name__} takes the curvature of a convex face, and "
        f"{type(punch).__name__} has {reason}: take 'derjaguin', or a Mie law"
    )


@dataclass(frozen=True, slots=True)
class CurvedFace(Interaction):
    """The potential of a punch under a law from a table.

    Parameters
    ----------
    punch : Punch
    law : SurfaceLaw
    with_remainder : bool
        Whether the estimate of what is left out is added to the traction.

    Examples
    --------
    >>> from fem_reference import LennardJones, PowerPunch
    >>> law = LennardJones(1.0, 1.0)
    >>> plane = CurvedFace(PowerPunch(2.0, 1e9), law)
    >>> bool(abs(plane.traction(np.array(9.0), np.array(1.0)) - law.traction(np.array(1.0))) < 1e-8)
    True
    """

    punch: Punch
    law: SurfaceLaw
    with_remainder: bool = False

    @property
    def finer(self) -> CurvedFace:
        """The same with what is left out."""
        return replace(self, with_remainder=True)

    def traction(self, rho: Array, gap: Array) -> Array:
        """p(rho, H), shape of both."""
        return self._values(rho, gap)[0]

    def slopes(self, rho: Array, gap: Array) -> tuple[Array, Array]:
        """dp/drho at a fixed gap, and dp/dH."""
        _, by_radius, by_gap = self._values(rho, gap)
        return by_radius, by_gap

    def _values(self, rho: Array, gap: Array) -> tuple[Array, Array, Array]:
        rho, gap = np.broadcast_arrays(np.asarray(rho, float), np.asarray(gap, float))
        return _tractions(self, rho.shape, rho.tobytes(), gap.tobytes())

    def peak_gap(self, rho: Array) -> Array:
        """Gap of the largest tension at a radius."""
        rho = np.asarray(rho, float)
        face = face_gap(self.law)

        def slope(log_depth: Array) -> Array:
            return self.slopes(rho, np.exp(log_depth) + face)[1]

        first = np.log((self.law.peak_gap - face) * np.hypot(1.0, self.punch.slope(rho)))
        return np.asarray(np.exp(secant_root(slope, first, slope(first), first + 0.01, _SECANTS)) + face)

    def energy(self, rho: Array, gap: Array) -> Array:
        """Integral of p from H to infinity, by quadrature along the vertical line."""
        return energy_above(self, rho, gap, face_gap(self.law), smooth=False)


@lru_cache(maxsize=8)
def _tractions(force: CurvedFace, shape: tuple[int, ...], rho: bytes, gap: bytes) -> tuple[Array, Array, Array]:
    """Traction and slopes by radius and gap: those who need the traction need its slopes next."""
    punch, face = force.punch, face_gap(force.law)
    x, v = np.frombuffer(rho), np.frombuffer(gap) - face
    z = punch.height(x) - v
    t = _nearest_radius(punch, x, z, v)
    above = punch.height(t) - z
    d = np.hypot(t - x, above)
    # Behind the face, where a law without a singular gap has values as well, the distance is the vertical one.
    inside = (v <= 0.0) | (d == 0.0)
    d, unit = np.where(inside, v, d), np.where(inside, 1.0, d)
    steep = punch.slope(t)
    t_face = np.maximum(t, _INNERMOST * np.abs(d))
    curvatures = np.where(inside, 0.0, _curvatures(punch, t_face))
    value, by_distance, by_ball = _of_distance(force.law, d, curvatures)
    # What the curvatures change along the face.
    sides = [
        _curvature_of_ball(d, np.where(inside, 0.0, _curvatures(punch, t_face * (1.0 + side * _BESIDE))))
        for side in (1.0, -1.0)
    ]
    along = by_ball * (sides[0] - sides[1]) / (2.0 * _BESIDE * t_face)
    stretch = (1.0 + steep**2) * (1.0 + d * curvatures[0])  # derivative of t - x + (f - z) f' by t
    if force.with_remainder:
        value = value + np.where(inside, 0.0, _remainder(punch, force.law, t_face, d, curvatures))
    by_radius = by_distance * np.where(inside, 0.0, (x - t) / unit) + along / stretch
    by_depth = by_distance * np.where(inside, 1.0, above / unit) - along * steep / stretch
    # At a fixed gap the point rises with the face.
    by_radius = by_radius - punch.slope(x) * by_depth
    return value.reshape(shape), by_radius.reshape(shape), by_depth.reshape(shape)


def _curvature_of_ball(d: Array, curvatures: Array) -> Array:
    """Curvature of the ball that has the traction to second order."""
    C, D = curvatures.mean(axis=0), 0.5 * (curvatures[0] - curvatures[1])
    return np.maximum(C - 0.5 * d * D**2 / (1.0 + d * C), _FLAT / np.abs(d))


def _of_distance(law: SurfaceLaw, d: Array, curvatures: Array) -> tuple[Array, Array, Array]:
    """T, its derivative by the distance at fixed curvatures, and that by the curvature of the ball."""
    C, D = curvatures.mean(axis=0), 0.5 * (curvatures[0] - curvatures[1])
    ball = _curvature_of_ball(d, curvatures)
    value = traction_of_ball(law, d, 1.0 / ball)
    ends = [traction_of_ball(law, d, 1.0 / (ball * (1.0 + side * _BESIDE))) for side in (1.0, -1.0)]
    by_ball = (ends[0] - ends[1]) / (2.0 * _BESIDE * ball)
    by_distance = rate_of_ball(law, d, 1.0 / ball, value) - by_ball * 0.5 * D**2 / (1.0 + d * C) ** 2
    return value, by_distance, by_ball


def _curvatures(punch: Punch, t: Array) -> Array:
    """Both principal curvatures at a radius, shape (2, ...)."""
    h, slope = _STEP * t, punch.slope
    bend = (8.0 * (slope(t + h) - slope(t - h)) - (slope(t + 2.0 * h) - slope(t - 2.0 * h))) / (12.0 * h)
    q = np.hypot(1.0, slope(t))
    return np.array([bend / q**3, slope(t) / (t * q)])


def _remainder(punch: Punch, law: SurfaceLaw, t: Array, d: Array, curvatures: Array) -> Array:
    """Estimate of the size of what the traction leaves out."""
    face = face_gap(law)
    size = np.abs(d * law.traction(d + face)) + np.abs(law.energy(d + face))
    k, C = np.abs(curvatures).max(axis=0), curvatures.mean(axis=0)
    pole = d + 2.0 / _curvature_of_ball(d, curvatures) + face
    total = size * d**2 * k**3 / (1.0 + d * k) + np.abs(law.traction(pole)) + C * np.abs(law.energy(pole))
    inner = _moment(law, d, d)
    for ring in range(_RINGS):
        radius = d * 2.0**ring
        around = np.sqrt(t**2 + radius**2 + 2.0 * t * radius * np.cos(_ANGLES)[:, None])
        change = np.abs(_curvatures(punch, around).mean(axis=(0, 1)) - C)
        outer = _moment(law, d, np.hypot(d, radius))
        total += 0.5 * np.minimum(change, 1.0 / radius) * np.abs(inner - outer)
        inner = outer
    total += 0.5 * np.abs(inner) / radius
    return np.asarray(np.minimum(total, size / d))


def _moment(law: SurfaceLaw, d: Array, s: Array) -> Array:
    """Integral of p''(s) (s^2 - d^2) from a distance on."""
    gap = s + face_gap(law)
    return -law.slope(gap) * (s**2 - d**2) + 2.0 * (s * law.traction(gap) + law.energy(gap))


def _nearest_radius(punch: Punch, x: Array, z: Array, v: Array) -> Array:
    """Radius of the convex face that is nearest to each point: it is farther in by at most the depth v."""
    low, high = np.maximum(x - np.maximum(v, 0.0), 0.0), x
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        outside = middle - x + (punch.height(middle) - z) * punch.slope(middle) > 0.0
        low, high = np.where(outside, low, middle), np.where(outside, middle, high)
    return np.asarray(0.5 * (low + high))
