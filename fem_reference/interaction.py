r"""Surface forces of a rigid punch: the traction at the place of a point of the surface.

Atoms attract each other through all directions.  A point of the solid at the radius rho and at the height h below the
apex of the punch has the potential of the whole punch there, and an incompressible solid of uniform density moves as
under this potential as a pressure p(rho, h) on its deformed surface.  For atoms of a 12-6 potential over a half-space
it is the 9-3 law of the distance.

* "derjaguin": p is the law at the vertical gap H = h + f(rho), as over a plane surface whose facing parts are parallel.
  The energy of adhesion is then counted for the projected area.
* "body": p is the potential of the punch itself.  It is counted for the true area.

For a ball the pair potentials d^-(m+3) of the powers d^-m of the law are integrated in closed form: with the distance s
of its centre, d = s - R and D = s + R,

    p_m = z0^m { d^-m - D^-m - m/((m-1) s) [d^(1-m) - D^(1-m)] },

which is (z0/d)^m for R -> infinity, and [(s^2 - R^2)/(2 R z0)]^-3 for m = 3.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np

from fem_reference._typing import Array
from fem_reference.laws import LennardJones, Mie, SurfaceLaw
from fem_reference.profiles import Ball
from fem_reference.punch import Punch

__all__ = ["INTERACTIONS", "Body", "Derjaguin", "Interaction", "InteractionName", "interaction_of"]

#: Names of the interactions; "auto" is "body" where it is known.
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


class Interaction(Protocol):
    """Traction on the surface of the solid; compression is positive."""

    def traction(self, rho: Array, h: Array) -> Array:
        """p at the radius rho and the height h below the apex, shape of both."""
        ...

    def slopes(self, rho: Array, h: Array) -> tuple[Array, Array]:
        """dp/drho and dp/dh."""
        ...

    def energy(self, rho: Array, h: Array) -> Array:
        """Integral of p from h to infinity, the energy per projected area."""
        ...


@dataclass(frozen=True, slots=True)
class Derjaguin:
    """The law at the vertical gap.

    Parameters
    ----------
    punch : Punch
    law : SurfaceLaw

    Examples
    --------
    >>> facing = Derjaguin(Ball(R=5.0), LennardJones(work_of_adhesion=1.0, z0=1.0))
    >>> float(facing.traction(np.array(3.0), np.array(-1.0)))  # f = 1
    0.0
    """

    punch: Punch
    law: SurfaceLaw

    def _gap(self, rho: Array, h: Array) -> Array:
        return np.asarray(self.punch.height(rho) + h)

    def traction(self, rho: Array, h: Array) -> Array:
        """p(H), shape of both."""
        return np.asarray(self.law.traction(self._gap(rho, h)))

    def slopes(self, rho: Array, h: Array) -> tuple[Array, Array]:
        """dp/drho = p'(H) f'(rho) and dp/dh = p'(H)."""
        slope = np.asarray(self.law.slope(self._gap(rho, h)))
        return slope * np.asarray(self.punch.slope(rho)), slope

    def energy(self, rho: Array, h: Array) -> Array:
        """e(H), shape of both."""
        return np.asarray(self.law.energy(self._gap(rho, h)))


@dataclass(frozen=True, slots=True)
class Body:
    """The potential of a ball whose atoms fill its radius.

    Parameters
    ----------
    ball : Ball
    law : LennardJones or Mie
        Law of the same atoms over a half-space.

    Examples
    --------
    >>> body = Body(Ball(R=20.0), LennardJones(work_of_adhesion=1.0, z0=1.0))
    >>> q = 1.0 * (1.0 + 1.0 / 40.0)  # at h = 0 and rho = 0
    >>> x = 21.0 / 20.0
    >>> exact = 8 / 3 * (q**-9 * (5 + 45 * x**2 + 63 * x**4 + 15 * x**6) / 128 - q**-3)
    >>> bool(abs(body.traction(np.array(0.0), np.array(0.0)) - exact) < 1e-13)
    True
    """

    ball: Ball
    law: LennardJones | Mie

    def _distance(self, rho: Array, h: Array) -> tuple[Array, Array]:
        """Distance of the centre, and its vertical part: faces without traction are z0 apart."""
        vertical = self.ball.R + self.law.z0 + np.asarray(h, float)
        return np.hypot(rho, vertical), vertical

    def traction(self, rho: Array, h: Array) -> Array:
        """p(rho, h), shape of both."""
        s, _ = self._distance(rho, h)
        return self._at(s)

    def slopes(self, rho: Array, h: Array) -> tuple[Array, Array]:
        """dp/drho and dp/dh."""
        s, vertical = self._distance(rho, h)
        rate = sum(strength * self._power_rate(s, m) for strength, m in self.law.powers)
        return np.asarray(rate * rho / s), np.asarray(rate * vertical / s)

    def energy(self, rho: Array, h: Array) -> Array:
        """Integral of p from h to infinity, by quadrature along the vertical line."""
        s, vertical = self._distance(rho, h)
        x, weights = _GAUSS
        # From the least distance on, in pieces whose lengths grow with it.
        nearest = np.maximum(s - self.ball.R, np.finfo(float).tiny)
        pieces = np.ceil(np.log(_FARTHEST * self.ball.R / nearest.min()) / np.log(_RATIO))
        total = np.zeros_like(s)
        for piece in range(int(pieces)):
            start, stop = nearest * _RATIO**piece, nearest * _RATIO ** (piece + 1)
            beyond = start + 0.5 * (stop - start) * (1.0 + x.reshape(-1, *[1] * s.ndim)) - nearest
            values = self._at(np.hypot(rho, vertical + beyond))
            total += 0.5 * (stop - start) * np.tensordot(weights, values, 1)
        return total

    def _at(self, s: Array) -> Array:
        return np.asarray(sum(strength * self._power(s, m) for strength, m in self.law.powers))

    def _power(self, s: Array, m: float) -> Array:
        """p_m at a distance of the centre, in units of its strength."""
        R, z0 = self.ball.R, self.law.z0
        d, D = s - R, s + R
        far = R / s < _SERIES_BELOW
        with np.errstate(divide="ignore", invalid="ignore"):
            power = (z0 / d) ** m * -np.expm1(m * np.log(d / D))
            rest = m / ((m - 1.0) * s) * d * (z0 / d) ** m * -np.expm1((m - 1.0) * np.log(d / D))
        if not np.any(far):
            return np.asarray(power - rest)
        return np.where(far, (z0 / s) ** m * _far_series(np.where(far, R / s, 0.0), m), power - rest)

    def _power_rate(self, s: Array, m: float) -> Array:
        """Derivative of p_m by the distance of the centre."""
        R, z0 = self.ball.R, self.law.z0
        d, D = s - R, s + R
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


def interaction_of(punch: Punch, law: SurfaceLaw, name: InteractionName) -> Interaction:
    """Return the interaction of a punch and a law.

    Parameters
    ----------
    punch : Punch
    law : SurfaceLaw
    name : {"auto", "body", "derjaguin"}
        "auto" is "body" where it is known: for a `Ball` under a `LennardJones` or `Mie` law.

    Raises
    ------
    ValueError
        If the name is unknown, or "body" is not known for these.

    Examples
    --------
    >>> type(interaction_of(Ball(R=1.0), LennardJones(1.0, 1e-3), "auto")).__name__
    'Body'
    """
    if name not in INTERACTIONS:
        raise ValueError(f"interaction {name!r} is unknown; choose one of {', '.join(INTERACTIONS)}")
    if name != "derjaguin" and isinstance(punch, Ball) and isinstance(law, LennardJones | Mie):
        return Body(punch, law)
    if name == "body":
        raise ValueError(
            f"interaction 'body' is known for a Ball under LennardJones or Mie, not for {type(punch).__name__} under "
            f"{type(law).__name__}: take 'derjaguin'"
        )
    return Derjaguin(punch, law)
