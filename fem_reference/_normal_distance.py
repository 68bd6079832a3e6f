r"""A law at the normal distance of a point of the surface to the face of the punch.

Of a law that is no sum of powers the pair potential of the atoms is not known.  It acts here as between parallel faces
at the shortest distance d from the point to the face, so that it counts for the true area of the contact, as the
potential of the punch does.  Left out is what the curvature of the face changes: a face of the mean curvature C (of
1/R for a ball) takes C (d p + e) from the pressure p at d, to first order, where e is the energy of the law there: of
a power d^-m the share C d m/(m - 1).  That may exceed what the true area adds: the pull-off force of a paraboloid of
R = 100 z0 at w/(E* R) = 1e-3 is 3.4 % above that under the potential of the atoms, and at vertical gaps 0.4 % below it.

The face is where the repulsion diverges: d and the vertical depth v of the point are those of `singular_gap`, or, for a
law without one, of a gap of -z0.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fem_reference._typing import Array
from fem_reference._vertical_line import energy_above
from fem_reference.laws import SurfaceLaw
from fem_reference.punch import Punch, kinks_of

__all__ = ["NormalDistance"]

#: Radii on each side at which the nearest one is looked for, and halvings between the neighbours of the best.
_RADII, _HALVINGS = 24, 52

#: Steps of Newton's method for the depth of a distance, which has a slope of cos(slope of the face) by the depth.
_STEPS = 30

#: Relative step of the difference for the slope of the largest tension.
_BESIDE = 1e-4


@dataclass(frozen=True, slots=True)
class NormalDistance:
    """A law at the shortest distance.

    Parameters
    ----------
    punch : Punch
    law : SurfaceLaw

    Examples
    --------
    >>> from fem_reference import LennardJones, PowerPunch
    >>> cone = NormalDistance(PowerPunch(1.0, 1.0), LennardJones(1.0, 1.0))  # of a slope of 45 degrees
    >>> bool(abs(cone.traction(np.array(9.0), np.array(1.0)) - cone.law.traction(np.sqrt(2.0) - 1.0)) < 1e-14)
    True
    """

    punch: Punch
    law: SurfaceLaw

    @property
    def finer(self) -> NormalDistance:
        """Itself: there is no quadrature."""
        return self

    @property
    def _face(self) -> float:
        """Vertical gap at which a point is on the face."""
        return self.law.singular_gap if math.isfinite(self.law.singular_gap) else -self.law.z0

    def _distance(self, rho: Array, gap: Array) -> tuple[Array, Array, Array]:
        """Gap of the law, and its derivatives by the radius at a fixed place of the face and by the vertical gap."""
        rho, gap = np.broadcast_arrays(np.asarray(rho, float), np.asarray(gap, float))
        return _nearest(self, rho.shape, rho.tobytes(), gap.tobytes())

    def traction(self, rho: Array, gap: Array) -> Array:
        """p of the distance, shape of both."""
        return self.law.traction(self._distance(rho, gap)[0])

    def slopes(self, rho: Array, gap: Array) -> tuple[Array, Array]:
        """dp/drho at a fixed gap, and dp/dH."""
        normal, by_radius, by_gap = self._distance(rho, gap)
        rate = self.law.slope(normal)
        return rate * (by_radius - by_gap * self.punch.slope(rho)), rate * by_gap

    def peak_gap(self, rho: Array) -> Array:
        """Vertical gap at which the distance is that of the largest tension."""
        rho, peak = np.asarray(rho, float), self.law.peak_gap
        depth = (peak - self._face) * np.hypot(1.0, self.punch.slope(rho))
        for _ in range(_STEPS):
            normal, _, by_gap = self._distance(rho, depth + self._face)
            depth = np.maximum(depth + (peak - normal) / by_gap, 0.25 * depth)
        return np.asarray(depth + self._face)

    def peak_slope(self, rho: Array) -> Array:
        """Its derivative by the radius."""
        rho = np.asarray(rho, float)
        ends = [self.peak_gap(rho * (1.0 + side * _BESIDE)) for side in (1.0, -1.0)]
        return np.asarray((ends[0] - ends[1]) / (2.0 * _BESIDE * rho))

    def fall(self, r: float) -> float:
        """That of the law where the surface is level with the apex."""
        at = np.array(r)
        level = np.array(self.punch.height(at))
        traction = float(self.traction(at, level))
        if traction == 0.0:
            return math.inf
        by_radius, by_gap = self.slopes(at, level)
        return -r * float(by_radius + by_gap * self.punch.slope(at)) / traction

    def energy(self, rho: Array, gap: Array) -> Array:
        """Integral of p from H to infinity, by quadrature along the vertical line."""
        return energy_above(self, rho, gap, self._face, smooth=False)


@lru_cache(maxsize=8)
def _nearest(interaction: NormalDistance, shape: tuple[int, ...], rho: bytes, gap: bytes) -> tuple[Array, Array, Array]:
    """The distance and its slopes: those who need the traction need its slopes next."""
    punch, face = interaction.punch, interaction._face
    x, v = np.frombuffer(rho), np.frombuffer(gap) - face
    z = punch.height(x) - v
    t = _nearest_radius(punch, x, z, v)
    above = punch.height(t) - z
    d = np.hypot(t - x, above)
    # Behind the face, where a law without a singular gap has values as well, the distance is the vertical one.
    inside = v <= 0.0
    unit = np.where(inside | (d == 0.0), 1.0, d)
    by_radius = np.where(inside, 0.0, (x - t) / unit)
    by_gap = np.where(inside, 1.0, above / unit)
    normal = np.where(inside, v, d) + face
    return normal.reshape(shape), by_radius.reshape(shape), by_gap.reshape(shape)


def _nearest_radius(punch: Punch, x: Array, z: Array, v: Array) -> Array:
    """Radius of the face that is nearest to each point at the depth v, and so within v of its own radius."""
    depth = np.maximum(v, 0.0)
    share = (np.arange(_RADII + 1) / _RADII) ** 3
    radii = np.concatenate([x - np.minimum(x, depth) * share[::-1, None], x + depth * share[1:, None]])
    kinks = np.array(kinks_of(punch))
    if kinks.size:
        radii = np.sort(np.concatenate([radii, np.clip(kinks[:, None], radii[0], radii[-1])]), axis=0)
    with np.errstate(over="ignore"):
        best = np.argmin(np.hypot(radii - x, punch.height(radii) - z), axis=0)
    column = np.arange(x.size)
    low, high = radii[np.maximum(best - 1, 0), column], radii[np.minimum(best + 1, len(radii) - 1), column]
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        outside = middle - x + (punch.height(middle) - z) * punch.slope(middle) > 0.0
        low, high = np.where(outside, low, middle), np.where(outside, middle, high)
    return np.asarray(0.5 * (low + high))
