r"""Potential of a convex punch under any law, from the distance of its face and the curvatures there.

With the pair potential phi(s) = p''(s)/(2 pi s) of the law (`fscm._ball_under_law`) a gap of the mean height g(rho)
between a tangent plane and the face takes int p''(s) g ds from the traction p of a half-space at the distance d.  Up to
the second order in the curvatures, with their mean C and half of their difference D,

    T = p - (d p + e) {C - d (C^2 + D^2/2)},

as of a ball of the curvature C - d (D^2/2)/(1 + d C), whose exact potential is taken: it stays between zero and that of
the half-space however far the face is.

The rest is estimated, not bounded.  It has the third order of a ball, the far pole, and the variation of C around the
nearest point, over rings on which phi has the moments M(s) = int_s p''(t) (t^2 - d^2) dt.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fscm._ball_under_law import ball_under_law
from fscm._potential import Profile
from fscm._typing import Array
from fscm._whole_punch import WholePunch, aspect_of
from fscm.laws import SurfaceLaw
from fscm.punch import PunchShape, kinks_of

__all__ = ["CurvedFace", "check_face"]

#: Halvings in the search of the nearest point.
_HALVINGS = 62
#: Least radius of it in units of the distance; relative steps for the derivative of a slope, and of a traction by a
#: curvature and by the radius, which changes it little.
_INNERMOST, _STEP, _BESIDE = 1e-6, 2e-3, 1e-4
#: Curvature times distance of a plane.
_PLANE = 1e-14
#: Rings, each twice as wide as the one before, and cosines of the angles on them.
_RINGS, _COSINES = 12, np.cos(np.pi * (np.arange(8) + 0.5) / 8.0)
#: Secants for the largest tension; step of log r for its drift, which moves the mesh alone.
_SECANTS, _DRIFT = 8, 1e-4
#: Radii in z0 at which a face is examined; share of the largest curvature that is rounding.
_EXAMINED, _ROUND = np.geomspace(_INNERMOST, 1e6, 300), 1e-9
#: Ratio of radii over which the power of the traction far away is measured.
_OVER = 4.0
#: Height of a point, relative to that of the face, which is rounding.
_LEVEL = 8.0 * np.finfo(float).eps
#: Quadrature of the energy: pieces on which the distance grows by _FARTHER up to _FARTHEST, fine for the knots of a
#: spline.
_GAUSS = np.polynomial.legendre.leggauss(10)
_FARTHER, _FARTHEST = 1.5, 1e6


def check_face(punch: PunchShape, law: SurfaceLaw) -> None:
    """Refuse a face with kinks or hollows, or with a tip that is sharper than the range of the law."""
    shape = Profile(punch, aspect_of(punch))
    radii = law.z0 * _EXAMINED
    bend, around = _curvatures(shape, radii)
    name = type(getattr(punch, "punch", punch)).__name__
    if kinks_of(punch):
        reason = "a kink"
    elif not max(bend[0], around[0]) * law.z0 <= 1.0:
        reason = "a tip whose radius of curvature is below z0"
    elif not np.all(bend >= -_ROUND * np.max(np.abs(bend))):
        reason = "a hollow"
    else:
        return
    raise ValueError(
        f"interaction 'body' under {type(law).__name__} is known for a ball and a convex face by its curvature; "
        f"{name} has {reason}: take 'derjaguin', or a Mie law"
    )


@dataclass(frozen=True, slots=True)
class CurvedFace(WholePunch):
    """The potential of a punch under a law from a table: an `fscm.interaction.Interaction`.

    Parameters
    ----------
    punch : PunchShape
        Convex.
    law : SurfaceLaw

    Examples
    --------
    >>> from fscm import LennardJones, PowerPunch
    >>> face = CurvedFace(PowerPunch(2.0, 1e9), LennardJones())
    >>> round(float(face.traction(np.array(0.0), np.array(0.5)) / LennardJones().traction(np.array(0.5))), 6)
    1.0
    """

    punch: PunchShape
    law: SurfaceLaw

    @property
    def exponents(self) -> tuple[float, float]:
        """Of the attraction of the law, for both of its terms."""
        return self.law.decay[1], self.law.decay[1]

    def falls_as(self, r: float) -> float:
        """Exponent q of p ~ r^-q far away, as it is there."""
        return _fall(self)

    def _values(self, r: Array, H: Array) -> tuple[Array, Array, Array]:
        r, H = np.broadcast_arrays(np.asarray(r, float), np.asarray(H, float))
        return _evaluated(self, r.shape, r.tobytes(), H.tobytes())

    def traction(self, r: Array, H: Array) -> Array:
        """p(r, H)."""
        return self._values(r, H)[0]

    def slope(self, r: Array, H: Array) -> Array:
        """dp/dH at a fixed radius."""
        return self._values(r, H)[1]

    def drift(self, r: Array, H: Array) -> Array:
        """r dp/dr at a fixed gap."""
        return self._values(r, H)[2]

    def size(self, r: Array, H: Array) -> Array:
        """Size of p, and what the rounding of the height at the point makes of it."""
        value, by_depth, _ = self._values(r, H)
        return np.asarray(np.abs(value) + np.abs(self.punch.height(r) * by_depth))

    def remainder(self, r: Array, H: Array) -> Array:
        """Estimate of what the traction leaves out."""
        r, H = np.broadcast_arrays(np.asarray(r, float), np.asarray(H, float))
        at = _nearest(self, r.ravel(), H.ravel())
        return at.remainder().reshape(r.shape)

    def peak_gap(self, r: Array) -> Array:
        """Gap of the largest tension at a radius."""
        r, face = np.asarray(r, float), self.law.singular_gap
        before = np.log((self.law.peak_gap - face) * np.hypot(1.0, self.punch.slope(r) / self.aspect))
        u, last = before + 0.01, self.slope(r, face + np.exp(before))
        for _ in range(_SECANTS):
            left = self.slope(r, face + np.exp(u))
            with np.errstate(divide="ignore", invalid="ignore"):
                step = np.where(left == last, 0.0, left * (u - before) / (last - left))
            before, last, u = u, left, u + step
        return np.asarray(face + np.exp(u))

    def peak_drift(self, r: float) -> float:
        """Its derivative by the logarithm of the radius."""
        outside, inside = self.peak_gap(r * np.exp(np.array([_DRIFT, -_DRIFT])))
        return float(outside - inside) / (2.0 * _DRIFT)

    def energy(self, r: Array, H: Array) -> Array:
        """Integral of p from H to infinity at a fixed radius, by quadrature over pieces of the depth."""
        r, H = np.broadcast_arrays(np.asarray(r, float), np.asarray(H, float))
        v, total = H - self.law.singular_gap, np.zeros(r.shape)
        half, start = 0.5 * (_FARTHER - 1.0), 1.0
        while start < _FARTHEST:
            for x, weight in zip(*_GAUSS, strict=True):
                total += weight * half * start * self.traction(r, H + v * (start * (1.0 + half * (1.0 + x)) - 1.0))
            start *= _FARTHER
        return total * v


@dataclass(frozen=True, slots=True)
class _Nearest:
    """Points, and the face where it is nearest to them; lengths in the unit of heights.

    Attributes
    ----------
    profile : Profile
    law : SurfaceLaw
    x, t, d : ndarray
        Radii of the points and of the nearest points of the face, and their distance.
    above : ndarray
        Height of the face above the points.
    """

    profile: Profile
    law: SurfaceLaw
    x: Array
    t: Array
    d: Array
    above: Array

    def _of_curvatures(self, bend: Array, around: Array) -> tuple[Array, Array, Array]:
        """Curvature of the ball, its derivative by the distance, and the mean curvature."""
        C, squared = 0.5 * (bend + around), 0.25 * (bend - around) ** 2
        q = 1.0 + self.d * C
        return np.maximum(C - 0.5 * self.d * squared / q, _PLANE / self.d), -0.5 * squared / q**2, C

    def values(self) -> tuple[Array, Array, Array]:
        """Traction, and its derivatives by the depth and by the radius at a fixed height of the point."""
        curvatures = _curvatures(self.profile, self.t)
        ball, by_distance, _ = self._of_curvatures(*curvatures)
        value, rate = ball_under_law(self.law, self.d, 1.0 / ball)
        low, high = (ball_under_law(self.law, self.d, 1.0 / (ball * f))[0] for f in (1.0 - _BESIDE, 1.0 + _BESIDE))
        by_ball = (high - low) / (2.0 * _BESIDE * ball)
        rate = rate + by_ball * by_distance
        inside, outside = (
            self._of_curvatures(*_curvatures(self.profile, self.t * f))[0] for f in (1.0 - _BESIDE, 1.0 + _BESIDE)
        )
        steep = self.profile.slope(self.t)
        # Per length of x at a fixed height; the nearest point moves inwards by f' times as much per depth.
        moved = by_ball * (outside - inside) / (2.0 * _BESIDE * self.t)
        moved /= (1.0 + steep**2) * (1.0 + self.d * curvatures[0])
        by_depth = rate * self.above / self.d - moved * steep
        return value, by_depth, rate * (self.x - self.t) / self.d + moved

    def remainder(self) -> Array:
        """Estimate of the size of what the traction leaves out."""
        d, law = self.d, self.law
        bend, around = _curvatures(self.profile, self.t)
        ball, _, C = self._of_curvatures(bend, around)
        size = np.abs(d * law.traction(d + law.singular_gap)) + np.abs(law.energy(d + law.singular_gap))
        largest, pole = np.maximum(np.abs(bend), np.abs(around)), d + 2.0 / ball + law.singular_gap
        rest = size * (d * largest) ** 2 * largest / (1.0 + d * largest)
        rest += np.abs(law.traction(pole)) + C * np.abs(law.energy(pole))
        before, radius = self._moment(d), d
        for _ in range(_RINGS):
            ring = np.sqrt(self.t**2 + radius**2 + 2.0 * self.t * radius * _COSINES[:, None])
            change = np.abs(0.5 * np.mean(np.sum(_curvatures(self.profile, ring), axis=0), axis=0) - C)
            behind = self._moment(np.hypot(d, radius))
            rest += 0.5 * np.abs(before - behind) * np.minimum(change, 1.0 / radius)
            before, radius = behind, 2.0 * radius
        rest += np.abs(before) / radius
        return np.asarray(np.minimum(rest, size / d))

    def _moment(self, s: Array) -> Array:
        """M(s)."""
        gap, law = s + self.law.singular_gap, self.law
        return 2.0 * (s * law.traction(gap) + law.energy(gap)) - law.slope(gap) * (s - self.d) * (s + self.d)


def _curvatures(profile: Profile, t: Array) -> tuple[Array, Array]:
    """Principal curvatures of the face along the profile and around the axis, shape of `t`."""
    differences = []
    for step in (_STEP, 0.5 * _STEP):
        differences.append((profile.slope(t * (1.0 + step)) - profile.slope(t * (1.0 - step))) / (2.0 * step * t))
    steep = profile.slope(t)
    root = np.hypot(1.0, steep)
    return (4.0 * differences[1] - differences[0]) / 3.0 / root**3, steep / (t * root)


def _nearest(face: CurvedFace, r: Array, H: Array) -> _Nearest:
    """Nearest points of a convex face; a depth has to be positive."""
    profile = Profile(face.punch, aspect_of(face.punch))
    x, v = profile.aspect * r, H - face.law.singular_gap
    height = profile.height(x)
    z = np.where(np.abs(height - v) <= _LEVEL * np.maximum(height, v), 0.0, height - v)
    low, high = np.maximum(x - v, 0.0), x
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        outside = middle - x + (profile.height(middle) - z) * profile.slope(middle) > 0.0
        low, high = np.where(outside, low, middle), np.where(outside, middle, high)
    t = 0.5 * (low + high)
    above = profile.height(t) - z
    d = np.hypot(x - t, above)
    return _Nearest(profile, face.law, x, np.maximum(t, _INNERMOST * d), d, above)


@lru_cache(maxsize=16)
def _evaluated(face: CurvedFace, shape: tuple[int, ...], r: bytes, H: bytes) -> tuple[Array, Array, Array]:
    """Traction, slope and drift, which are asked for one after the other; nan on the face and behind it."""
    radius, gap = np.frombuffer(r), np.frombuffer(H)
    values = np.full((3, radius.size), np.nan)
    below = np.flatnonzero(gap > face.law.singular_gap)
    at = _nearest(face, radius[below], gap[below])
    value, by_depth, by_radius = at.values()
    # At a fixed gap the point rises with the face.
    values[:, below] = value, by_depth, at.x * (by_radius - at.profile.slope(at.x) * by_depth)
    first, second, third = values.reshape(3, *shape)
    return first, second, third


@lru_cache(maxsize=64)
def _fall(face: CurvedFace) -> float:
    r = face.far_radius * np.array([1.0, _OVER])
    near, far = np.abs(face.traction(r, face.punch.height(r)))
    return float(np.log(near / far) / np.log(_OVER))
