r"""Potential of the atoms of a punch without end as an interaction of the surface.

The powers of the law are those of `fscm._potential_table`, in which each is an integral over the face of the punch
(`fscm._potential`).  The errors of the tables belong to the sizes of the terms.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from fscm._potential_table import energy_table, power_table
from fscm._typing import Array
from fscm._whole_punch import WholePunchUnderMie
from fscm.laws import LennardJones, Mie
from fscm.punch import PunchShape

if TYPE_CHECKING:
    from fscm._potential_table import PotentialTable

__all__ = ["BodyOfRevolution"]

#: Steps of the secant method for the largest tension, whose equation is almost linear in log v: 1e-15 after four.
_SECANTS = 5
#: Step of log r for the drift of that; it moves the mesh alone.
_STEP = 1e-4
#: Rounding of a size in the bounds (`fscm._bound.defect`), and safety for points that were not compared.
_ROUNDING, _SAFETY = 2.0**-49, 4.0


@dataclass(frozen=True, slots=True)
class BodyOfRevolution(WholePunchUnderMie):
    """The potential of a punch without end (see the module): an `fscm.interaction.Interaction`.

    Parameters
    ----------
    punch : PunchShape
    law : LennardJones or Mie
        Law of the same atoms over a half-space.

    Examples
    --------
    Far above a large paraboloid the traction on its axis is that of a plane:

    >>> from fscm.punch import PowerPunch
    >>> body = BodyOfRevolution(PowerPunch(2.0, 1e9), LennardJones())
    >>> round(float(body.traction(np.array(0.0), np.array(0.5)) / LennardJones().traction(np.array(0.5))), 6)
    1.0
    """

    punch: PunchShape
    law: LennardJones | Mie

    def falls_as(self, r: float) -> float:
        """Exponent q of p ~ r^-q far away, where the punch is a slender body of the cross-section ~ z^(2/growth)."""
        return self.exponents[1] + 2.0 - 2.0 / self.punch.growth

    @property
    def _unit(self) -> Array:
        """Powers of z0 of both terms."""
        return np.log(self.law.z0) * np.array(self.exponents)[:, None]

    def _powers(self, r: Array, H: Array) -> tuple[Array, Array, Array]:
        """Logarithms of both powers (z0/d)^m and their derivatives; of shape (2, *shape)."""
        r, H = np.broadcast_arrays(np.asarray(r, float), np.asarray(H, float))
        return _evaluated(self, r.shape, r.tobytes(), H.tobytes())

    def traction(self, r: Array, H: Array) -> Array:
        """p(r, H)."""
        (repulsion, attraction), _, _ = self._powers(r, H)
        return np.asarray(self._strength * np.exp(attraction) * np.expm1(repulsion - attraction))

    def slope(self, r: Array, H: Array) -> Array:
        """dp/dH at a fixed radius."""
        value, by_depth, _ = self._powers(r, H)
        return self._difference(np.exp(value) * by_depth)

    def drift(self, r: Array, H: Array) -> Array:
        """r dp/dr at a fixed gap."""
        value, _, by_radius = self._powers(r, H)
        return self._difference(np.exp(value) * by_radius)

    def _difference(self, terms: Array) -> Array:
        return np.asarray(self._strength * (terms[0] - terms[1]))

    def size(self, r: Array, H: Array) -> Array:
        """Repulsion and attraction, what the rounding of the height at the point makes of them, and of their table."""
        r, H = np.broadcast_arrays(np.asarray(r, float), np.asarray(H, float))
        value, by_depth, _ = self._powers(r, H)
        powers, table = np.exp(value), power_table(self.punch, self.exponents)
        error = _SAFETY / _ROUNDING * table.error(r.ravel(), self.law.z0 + H.ravel()).reshape(r.shape)
        terms = powers * (1.0 + error) - self.punch.height(r) * powers * by_depth
        return np.asarray(self._strength * np.sum(terms, axis=0))

    def peak_gap(self, r: Array) -> Array:
        """Gap of the largest tension at a radius."""
        r = np.asarray(r, float)
        return np.array(_peak(self, float(r))) if r.ndim == 0 else self._peaks(r)

    def _peaks(self, r: Array) -> Array:
        m, n = self.exponents

        def log_ratio(u: Array) -> Array:
            value, by_depth, _ = self._powers(r, self.law.z0 * np.expm1(u))
            return np.asarray(value[0] - value[1] + np.log(by_depth[0] / by_depth[1]))

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
        return (_peak(self, r * float(np.exp(_STEP))) - _peak(self, r * float(np.exp(-_STEP)))) / (2.0 * _STEP)

    def energy(self, r: Array, H: Array) -> Array:
        """Integral of p from H to infinity at a fixed radius."""
        r, H = np.broadcast_arrays(np.asarray(r, float), np.asarray(H, float))
        values = _logarithms(energy_table(self.punch, self.exponents), r, self.law.z0 + H)[0]
        return self._difference(np.exp(values + self._unit.reshape(2, *(1,) * r.ndim)))


def _logarithms(table: PotentialTable, r: Array, v: Array) -> tuple[Array, Array, Array]:
    values = table(r.ravel(), v.ravel())
    first, by_depth, by_radius = (part.reshape(-1, *r.shape) for part in values)
    return first, by_depth, by_radius


@lru_cache(maxsize=16)
def _evaluated(body: BodyOfRevolution, shape: tuple[int, ...], r: bytes, H: bytes) -> tuple[Array, Array, Array]:
    """Powers and derivatives: traction, slope and drift are asked for one after the other."""
    radius, gap = (np.frombuffer(values).reshape(shape) for values in (r, H))
    value, by_depth, by_radius = _logarithms(power_table(body.punch, body.exponents), radius, body.law.z0 + gap)
    return value + body._unit.reshape(2, *(1,) * len(shape)), by_depth, by_radius


@lru_cache(maxsize=4096)
def _peak(body: BodyOfRevolution, r: float) -> float:
    return float(body._peaks(np.array([r]))[0])
