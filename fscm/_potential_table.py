r"""Tables of the potential of a punch and of its integral downwards, as functions of radius and depth.

Tabulated are the logarithms, which are smooth and hold relative accuracy.  The variables are the logarithms of the
radius r and of the depth v below the surface, in which a profile of any size has features of the size one.  Beside the
upper part of a steep punch, where v is nearly the height f, the potential changes with the height z = f - v over the
radius; there asinh(z/r) takes the place of log v.
"""

from __future__ import annotations

import math
from collections.abc import Hashable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from fscm._chebyshev_tree import ChebyshevTree
from fscm._potential import Profile, log_powers
from fscm._typing import Array
from fscm._whole_punch import aspect_of
from fscm.punch import PunchShape, ScaledPunch

__all__ = ["PotentialTable", "energy_table", "power_table"]

#: Radius, in the unit of the punch, below which nothing changes.
_INNERMOST = 1e-30
#: A point is beside a punch where the slope exceeds the first and its depth, in the height of the surface, the second;
#: and not as many radii below its tip as the third, nor as deep below as the surface is high.
_STEEP, _LOW, _BELOW = 1.5, 0.4, 1e3
#: Tolerance of the logarithms of powers and of their integrals; the rounding of a height and a radius, in which the
#: nodes of a quadrature lie, for each unit of slope.
_TOLERANCE, _OF_ENERGY, _NOISE = 2e-13, 1e-12, 1e-15
#: Tolerance for a punch whose slope is by differences, with an error of 1e-11.
_BY_DIFFERENCES = 1e-9
#: Rounding of the fluxes through a punch as wide as the distance.
_SIDES = 5e-15
#: Quadrature of the integral downwards, with the logarithm of the distance for a variable: rule of a piece of the
#: length one and a finer one, share of the whole that is left to the power law beyond, and largest length.
_GAUSS = np.polynomial.legendre.leggauss(12), np.polynomial.legendre.leggauss(20)
_LEFT, _LONGEST = 1e-15, 40


class PotentialTable:
    """Logarithms of p_m, or of its integral from v to infinity, for some exponents m; lengths in the unit of heights.

    Parameters
    ----------
    punch : PunchShape
    exponents : tuple of float
    """

    #: Power of a length that the tabulated number falls by less than m, and tolerance of its logarithm.
    gained, _least = 0.0, _TOLERANCE

    def __init__(self, punch: PunchShape, exponents: tuple[float, ...]) -> None:
        self.punch, self.aspect, self.exponents = punch, aspect_of(punch), np.array(exponents)
        self.profile = Profile(punch, self.aspect)
        shape = punch.punch if isinstance(punch, ScaledPunch) else punch
        self.tolerance = _BY_DIFFERENCES if getattr(shape, "derivative", self) is None else self._least
        breaks = tuple(float(np.log(x / self.aspect)) for x in self.profile.kinks)
        self._below = ChebyshevTree(self._of_depth, self._noise, breaks)
        self._beside = ChebyshevTree(self._of_height, self._cancelled, breaks)

    def error(self, r: Array, v: Array) -> Array:
        """Error of the logarithms, measured near points with v > 0; shape (N,)."""
        errors = np.zeros(len(r))
        r = np.maximum(r, _INNERMOST)
        x, beside = self.aspect * r, self._is_beside(r, v)
        errors[beside] = self._beside.error(
            np.log(r[beside]), np.arcsinh((self.profile.height(x[beside]) - v[beside]) / x[beside])
        )
        errors[~beside] = self._below.error(np.log(r[~beside]), np.log(v[~beside]))
        return errors

    def _is_beside(self, r: Array, v: Array) -> NDArray[np.bool_]:
        """Whether points are beside the upper part of a steep punch."""
        x = self.aspect * r
        f = self.profile.height(x)
        return np.asarray((v > _LOW * f) & (v < f + np.maximum(f, _BELOW * x)) & (self.profile.slope(x) > _STEEP))

    def __call__(self, r: Array, v: Array) -> tuple[Array, Array, Array]:
        """Logarithms, their derivatives by v, and by log r at a fixed v; each of shape (exponents, N).

        Parameters
        ----------
        r, v : ndarray, shape (N,)
            Radius in the unit of the punch; depth, where that is not positive the values are nan.
        """
        values = np.full((3, len(self.exponents), len(r)), np.nan)
        r = np.maximum(r, _INNERMOST)
        f, steep = self.profile.height(self.aspect * r), self.profile.slope(self.aspect * r)
        inside = np.asarray(v > 0.0)
        beside = inside & self._is_beside(r, v)
        for at, chart in ((inside & ~beside, self._at_depth), (beside, self._at_height)):
            if np.any(at):
                values[:, :, at] = chart(r[at], v[at], f[at], steep[at])
        return values[0], values[1], values[2]

    def _at_depth(self, r: Array, v: Array, f: Array, steep: Array) -> tuple[Array, Array, Array]:
        Y, powers = np.log(v), (self.exponents - self.gained)[:, None]
        value, by_X, by_Y = self._below(np.log(r), Y)
        return value - powers * Y, (by_Y - powers) / v, by_X

    def _at_height(self, r: Array, v: Array, f: Array, steep: Array) -> tuple[Array, Array, Array]:
        x, powers = self.aspect * r, (self.exponents - self.gained)[:, None]
        t = (f - v) / x
        value, by_X, by_Z = self._beside(np.log(r), np.arcsinh(t))
        by_t = by_Z / np.hypot(1.0, t)
        return value - powers * np.log(x), -by_t / x, by_X - powers + by_t * (steep - t)

    def _of_depth(self, X: Array, Y: Array, finer: bool) -> Array:
        x, v = self.aspect * np.exp(X), np.exp(Y)
        return self._tabulated(x, self.profile.height(x) - v, v, finer)

    def _of_height(self, X: Array, Z: Array, finer: bool) -> Array:
        x = self.aspect * np.exp(X)
        return self._tabulated(x, x * np.sinh(Z), x, finer)

    def _tabulated(self, x: Array, z: Array, unit: Array, finer: bool) -> Array:
        """Logarithms without the power of a unit of length."""
        return log_powers(self.profile, tuple(self.exponents), x, z, unit, 2.0 if finer else 1.0)

    def _noise(self, X: Array, Y: Array) -> Array:
        x = self.aspect * np.exp(X)
        steep = self.profile.slope(x)
        return self.tolerance + _NOISE * (self.profile.height(x) + x * steep) * (1.0 + steep) * np.exp(-Y)

    def _cancelled(self, X: Array, Z: Array) -> Array:
        """Fluxes through both sides of a slender punch cancel to its width over the distance."""
        x = self.aspect * np.exp(X)
        slender = np.maximum(self.profile.height(x) / x, 1.0) ** (1.0 / self.punch.growth)
        return np.asarray(self.tolerance + _SIDES * slender)


class _EnergyTable(PotentialTable):
    """The integral, by quadrature of the tabulated powers."""

    gained, _least = 1.0, _OF_ENERGY

    def _tabulated(self, x: Array, z: Array, unit: Array, finer: bool) -> Array:
        v = self.profile.height(x) - z
        values = np.full((len(self.exponents), len(x)), np.nan)
        # Points at one radius share the integral from the deepest of them on.
        order = np.lexsort((v, x))
        order = order[v[order] > 0.0]
        last = np.append(x[order[1:]] != x[order[:-1]], True)[: len(order)]
        deepest = order[last]
        own, unit = unit, unit.copy()
        unit[order] = np.repeat(unit[deepest], np.diff(np.flatnonzero(last), prepend=-1))
        parts = np.zeros((len(self.exponents), len(order)))
        parts[:, last] = self._to_infinity(x[deepest], z[deepest], v[deepest], unit[deepest], finer)
        upper, lower = order[:-1][~last[:-1]], order[1:][~last[:-1]]
        parts[:, ~last] = self._between(x[upper], v[upper], v[lower], unit[upper], finer)
        for column in np.split(np.arange(len(order)), np.flatnonzero(last)[:-1] + 1):
            values[:, order[column]] = np.cumsum(parts[:, column[::-1]], axis=1)[:, ::-1]
        return np.asarray(np.log(values) + (self.exponents - 1.0)[:, None] * np.log(own / unit))

    def _density(self, x: Array, v: Array, unit: Array) -> Array:
        """p_m unit^m."""
        log_p = power_table(self.punch, tuple(self.exponents))(x / self.aspect, v)[0]
        return np.asarray(np.exp(log_p + self.exponents[:, None] * np.log(unit)))

    def _between(self, x: Array, start: Array, stop: Array, unit: Array, finer: bool) -> Array:
        """Integrals of p_m unit^(m-1) between two depths."""
        half, total = 0.5 * (stop - start), np.zeros((len(self.exponents), len(x)))
        for node, weight in zip(*_GAUSS[finer], strict=True):
            total += weight * self._density(x, start + half * (1.0 + node), unit)
        return total * (half / unit)

    def _to_infinity(self, x: Array, z: Array, v: Array, unit: Array, finer: bool) -> Array:
        """Integrals of p_m unit^(m-1) from a depth on; the logarithm of the distance is the variable."""
        # The distance grows from that of the nearest atoms or, beside the punch, from that of its tip.
        start = np.where(unit == x, np.hypot(x, z), v)
        pieces = math.ceil(min(-math.log(_LEFT) / (float(np.min(self.exponents)) - 1.0), _LONGEST))
        total = np.zeros((len(self.exponents), len(x)))
        for piece in range(pieces):
            for node, weight in zip(*_GAUSS[finer], strict=True):
                t = piece + 0.5 * (1.0 + node)
                total += 0.5 * weight * math.exp(t) * self._density(x, v + start * math.expm1(t), unit)
        falls = self.exponents + 2.0 - 2.0 / self.punch.growth
        beyond = self._density(x, v + start * math.expm1(pieces), unit) / (falls - 1.0)[:, None]
        return np.asarray((total + math.exp(pieces) * beyond) * (start / unit))


def power_table(punch: PunchShape, exponents: tuple[float, ...]) -> PotentialTable:
    """Table of p_m, the same one for equal punches."""
    return _table(PotentialTable, _hashable(punch), exponents)


def energy_table(punch: PunchShape, exponents: tuple[float, ...]) -> PotentialTable:
    """Table of the integrals of p_m from a depth to infinity."""
    return _table(_EnergyTable, _hashable(punch), exponents)


def _hashable(punch: PunchShape) -> Hashable:
    assert isinstance(punch, Hashable)  # a problem is hashable, and so are its parts
    return punch


@lru_cache(maxsize=8)
def _table(kind: type[PotentialTable], punch: Hashable, exponents: tuple[float, ...]) -> PotentialTable:
    assert isinstance(punch, PunchShape)
    return kind(punch, exponents)
