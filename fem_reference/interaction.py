r"""Surface forces of a rigid punch: the traction at the place of a point of the surface.

Atoms attract each other through all directions.  A point of the solid at the radius rho and at the vertical gap H to
the punch has the potential of the whole punch there, and an incompressible solid of uniform density moves as under this
potential as a pressure p(rho, H) on its deformed surface.  For atoms of a 12-6 potential over a half-space it is the
9-3 law of the distance.

* "derjaguin": p is the law at the vertical gap, as over a plane surface whose facing parts are parallel.  The energy of
  adhesion is then counted for the projected area.
* "body": p is the potential of the punch itself.  It is counted for the true area.

For a ball the pair potentials d^-(m+3) of the powers d^-m of the law are integrated in closed form: with the distance s
of its centre, d = s - R and D = s + R,

    p_m = z0^m { d^-m - D^-m - m/((m-1) s) [d^(1-m) - D^(1-m)] },

which is (z0/d)^m for R -> infinity, and [(s^2 - R^2)/(2 R z0)]^-3 for m = 3.  With c = R - f(rho), the height of the
centre above the face of the punch, s^2 - R^2 = (z0 + H)(2 c + z0 + H) on the sphere, which does not cancel.  That of
any other shape is in `fem_reference._body_of_revolution`.

A law p(d) that is no difference of two powers, as one from a table, belongs to a pair potential, too.  Over a ball it
is integrated in closed form (`fem_reference._ball_under_law`), over another shape by distance and curvatures
(`fem_reference._curved_face`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

import numpy as np

from fem_reference._ball_under_law import face_gap, rate_of_ball, traction_of_ball
from fem_reference._body_of_revolution import BodyOfRevolution
from fem_reference._curved_face import CurvedFace, check_curvature
from fem_reference._roots import root_between
from fem_reference._surface_force import Interaction
from fem_reference._typing import Array
from fem_reference.laws import LennardJones, Mie, SurfaceLaw
from fem_reference.profiles import Ball
from fem_reference.punch import Punch

__all__ = ["INTERACTIONS", "Body", "Derjaguin", "Interaction", "InteractionName", "interaction_of"]

#: Names of the interactions; "auto" is "body" for a ball.
InteractionName = Literal["auto", "body", "derjaguin"]
INTERACTIONS: tuple[InteractionName, ...] = ("auto", "body", "derjaguin")

#: Radius of the ball over the distance of its centre below which the powers are summed as a series: the closed form
#: cancels to the third power of it.
_SERIES_BELOW = 0.1

#: Terms of that series: the next one is below 1e-16 of the first for exponents up to 12.
_TERMS = 26

#: Quadrature of the energy, over distances that grow by the ratio from one piece to the next, up to this height in
#: radii, beyond which a ball has 1e-20 of its energy.
_GAUSS = np.polynomial.legendre.leggauss(16)
_RATIO, _FARTHEST = 2.0, 1e5

#: The distance of the largest tension is a length of the law, up to this factor.
_WIDEST = 10.0

#: Distance in radii beyond which a ball is a point to 1e-6.
_POINT = 1e3


@dataclass(frozen=True, slots=True)
class Derjaguin(Interaction):
    """The law at the vertical gap.

    Parameters
    ----------
    punch : Punch
    law : SurfaceLaw

    Examples
    --------
    >>> facing = Derjaguin(Ball(R=5.0), LennardJones(work_of_adhesion=1.0, z0=1.0))
    >>> float(facing.traction(np.array(3.0), np.array(0.0)))
    0.0
    """

    punch: Punch
    law: SurfaceLaw

    def traction(self, rho: Array, gap: Array) -> Array:
        """p(H)."""
        return self.law.traction(gap)

    def slopes(self, rho: Array, gap: Array) -> tuple[Array, Array]:
        """0 and p'(H)."""
        return np.zeros_like(gap), self.law.slope(gap)

    def energy(self, rho: Array, gap: Array) -> Array:
        """e(H)."""
        return self.law.energy(gap)

    def peak_gap(self, rho: Array) -> float:
        """That of the law."""
        return self.law.peak_gap

    def peak_slope(self, rho: Array) -> float:
        """Zero."""
        return 0.0

    def fall(self, r: float) -> float:
        """Exponent of the law times that of the height."""
        at = np.array(r)
        return self.law.decay[1] * float(r * self.punch.slope(at) / self.punch.height(at))


@dataclass(frozen=True, slots=True)
class Body(Interaction):
    """The potential of a ball whose atoms fill its radius.

    Parameters
    ----------
    punch : Ball
    law : LennardJones or Mie
        Law of the same atoms over a half-space.

    Examples
    --------
    >>> body = Body(Ball(R=20.0), LennardJones(work_of_adhesion=1.0, z0=1.0))
    >>> q = 1.0 * (1.0 + 1.0 / 40.0)  # at H = 0 and rho = 0
    >>> x = 21.0 / 20.0
    >>> exact = 8 / 3 * (q**-9 * (5 + 45 * x**2 + 63 * x**4 + 15 * x**6) / 128 - q**-3)
    >>> bool(abs(body.traction(np.array(0.0), np.array(0.0)) - exact) < 1e-13)
    True
    """

    punch: Ball
    law: LennardJones | Mie

    def _distances(self, rho: Array, gap: Array) -> tuple[Array, Array, Array]:
        """Distances of the centre and of the surface of the ball, and the vertical one of the centre."""
        R, x, facing = self.punch.R, np.asarray(rho, float), np.asarray(gap, float) - face_gap(self.law)
        above = R - self.punch.height(x)  # of the centre, from the face of the punch
        vertical = above + facing
        between = np.where(x <= self.punch.reach, facing * (above + vertical), x * x - R * R + vertical**2)
        s = np.sqrt(np.maximum(R * R + between, 0.0))
        return s, between / (s + R), vertical

    def traction(self, rho: Array, gap: Array) -> Array:
        """p(rho, H), shape of both."""
        s, d, _ = self._distances(rho, gap)
        return self._at(s, d)

    def slopes(self, rho: Array, gap: Array) -> tuple[Array, Array]:
        """dp/drho at a fixed gap, and dp/dH."""
        s, d, vertical = self._distances(rho, gap)
        rate = self._rate(s, d) / s
        return np.asarray(rate * (rho - vertical * self.punch.slope(rho))), np.asarray(rate * vertical)

    def peak_gap(self, rho: Array) -> Array:
        """Gap on the sphere around the centre where the tension is largest; outside of it the one level with that."""
        above = self.punch.R - self.punch.height(rho)
        return np.sqrt(np.maximum(_peak_distance(self) ** 2 - np.square(rho), 0.0)) - above + face_gap(self.law)

    def peak_slope(self, rho: Array) -> Array:
        """Its derivative by the radius."""
        root = np.sqrt(np.maximum(_peak_distance(self) ** 2 - np.square(rho), 0.0))
        falling = np.where(root > 0.0, rho / np.where(root > 0.0, root, 1.0), 0.0)
        return np.asarray(self.punch.slope(rho) - falling)

    def fall(self, r: float) -> float:
        """That of the potential where the surface is level with the apex; far away the ball is a point."""
        if r > _POINT * self.punch.R:
            return self.law.decay[1] + 3.0
        return Interaction.fall(self, r)

    def energy(self, rho: Array, gap: Array) -> Array:
        """Integral of p from H to infinity, by quadrature along the vertical line."""
        s, d, vertical = self._distances(rho, gap)
        x, weights = _GAUSS
        # From the least distance on, in pieces whose lengths grow with it.
        nearest = np.maximum(d, np.finfo(float).tiny)
        pieces = np.ceil(np.log(_FARTHEST * self.punch.R / nearest.min()) / np.log(_RATIO))
        total = np.zeros_like(s)
        for piece in range(int(pieces)):
            start, stop = nearest * _RATIO**piece, nearest * _RATIO ** (piece + 1)
            beyond = start + 0.5 * (stop - start) * (1.0 + x.reshape(-1, *[1] * s.ndim)) - nearest
            farther = np.hypot(rho, vertical + beyond)
            distance = d + beyond * (2.0 * vertical + beyond) / (farther + s)
            values = self._at(farther, distance)
            total += 0.5 * (stop - start) * np.tensordot(weights, values, 1)
        return total

    def _at(self, s: Array, d: Array) -> Array:
        return np.asarray(sum(strength * self._power(s, d, m) for strength, m in self.law.powers))

    def _rate(self, s: Array, d: Array) -> Array:
        """Derivative of p by the distance of the centre."""
        return np.asarray(sum(strength * self._power_rate(s, d, m) for strength, m in self.law.powers))

    def _power(self, s: Array, d: Array, m: float) -> Array:
        """p_m at distances of the centre and of the surface, in units of its strength."""
        R, z0 = self.punch.R, self.law.z0
        D = s + R
        far = R / s < _SERIES_BELOW
        with np.errstate(divide="ignore", invalid="ignore"):
            power = (z0 / d) ** m * -np.expm1(m * np.log(d / D))
            rest = m / ((m - 1.0) * s) * d * (z0 / d) ** m * -np.expm1((m - 1.0) * np.log(d / D))
        if not np.any(far):
            return np.asarray(power - rest)
        return np.where(far, (z0 / s) ** m * _far_series(np.where(far, R / s, 0.0), m), power - rest)

    def _power_rate(self, s: Array, d: Array, m: float) -> Array:
        """Derivative of p_m by the distance of the centre."""
        R, z0 = self.punch.R, self.law.z0
        D = s + R
        far = R / s < _SERIES_BELOW
        with np.errstate(divide="ignore", invalid="ignore"):
            power = -m * ((z0 / d) ** m / d - (z0 / D) ** m / D)
            rest = m / (m - 1.0) * (d * (z0 / d) ** m - D * (z0 / D) ** m)
            rate = power + rest / s**2 + m / s * ((z0 / d) ** m - (z0 / D) ** m)
        if not np.any(far):
            return np.asarray(rate)
        x = np.where(far, R / s, 0.0)
        return np.where(far, -((z0 / s) ** m) / s * _far_series(x, m, rate=True), rate)


def _far_series(x: Array, m: float, rate: bool = False) -> Array:
    """Sum over i = 3, 5, ... of 2 (m)_(i-1) (i-1)/i! x^i: (s/z0)^m p_m with x = R/s; with `rate`, -s dp_m/ds of it."""
    total, factor = np.zeros_like(x), 1.0
    for i in range(2, _TERMS):
        factor *= (m + i - 2.0) / i  # (m)_(i-1)/i!
        if i % 2:
            total += 2.0 * factor * (i - 1.0) * x**i * (m + i if rate else 1.0)
    return total


@lru_cache(maxsize=32)
def _peak_distance(body: Body) -> float:
    """Distance of the centre at which the tension is largest."""
    R, length = body.punch.R, body.law.z0

    def rate(log_d: float) -> float:
        d = np.array(length * np.exp(log_d))
        return float(body._rate(R + d, d)) * float(d)

    return R + length * math.exp(root_between(rate, -math.log(_WIDEST), math.log(_WIDEST), 1e-14))


@dataclass(frozen=True, slots=True)
class BodyUnderTable(Body):
    """The potential of a ball under any law, through the pair potential of that.

    Parameters
    ----------
    punch : Ball
    law : SurfaceLaw
        Of the same atoms over a half-space.

    Examples
    --------
    >>> ball, law = Ball(R=20.0), LennardJones(work_of_adhesion=1.0, z0=1.0)
    >>> exact, at = Body(ball, law), (np.array(3.0), np.array(0.5))
    >>> bool(abs(BodyUnderTable(ball, law).traction(*at) - exact.traction(*at)) < 1e-14)
    True
    """

    def _at(self, s: Array, d: Array) -> Array:
        return traction_of_ball(self.law, d, np.array(self.punch.R))

    def _rate(self, s: Array, d: Array) -> Array:
        return rate_of_ball(self.law, d, np.array(self.punch.R), self._at(s, d))


def interaction_of(punch: Punch, law: SurfaceLaw, name: InteractionName) -> Interaction:
    """Return the interaction of a punch and a law.

    Parameters
    ----------
    punch : Punch
    law : SurfaceLaw
    name : {"auto", "body", "derjaguin"}
        "auto" is "body" for a `Ball` under a `LennardJones` or `Mie` law.  Under another law "body" of another shape
        is by the distance of the face and its curvatures.

    Raises
    ------
    ValueError
        If the name is unknown, or under a law from a table for a face with kinks or a sharp tip.

    Examples
    --------
    >>> type(interaction_of(Ball(R=1.0), LennardJones(1.0, 1e-3), "auto")).__name__
    'Body'
    """
    if name not in INTERACTIONS:
        raise ValueError(f"interaction {name!r} is unknown; choose one of {', '.join(INTERACTIONS)}")
    if name != "derjaguin" and isinstance(punch, Ball) and isinstance(law, LennardJones | Mie):
        return Body(punch, law)
    if name != "body":
        return Derjaguin(punch, law)
    if isinstance(law, LennardJones | Mie):
        return BodyOfRevolution(punch, law)
    if isinstance(punch, Ball):
        return BodyUnderTable(punch, law)  # type: ignore[arg-type]  # any law, see there
    check_curvature(punch, law)
    return CurvedFace(punch, law)
