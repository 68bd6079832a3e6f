"""Surface law through points of traction against gap, in physical units.

Between the points the law is a spline of degree five, through denser points where they are few.  Above
the last point it is a power -C (H - t)^-m, below the first one a wall b + A (H - s)^-9; both have the value, slope and
curvature of the spline there.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, field

import numpy as np
import scipy

from fem_reference._law_between_points import denser_points
from fem_reference._typing import Array, Index
from fem_reference._wells import stable_gaps

__all__ = ["TabulatedLaw"]

#: Smallest number of points: a spline of degree five needs six, and wall, well and tail have some each.
FEWEST = 10

#: Number of points from which on the spline goes through them without denser ones.
SPARSE = 40

#: Exponent of the wall: that of the repulsion between two half-spaces of atoms.
WALL = 9.0

#: Smallest number of points to which the tail is fitted; all above half the largest distance from the wall if more.
FEWEST_IN_TAIL = 4


#: Depth of the shallowest well, relative to the deepest: shallower ones are rounding.
SHALLOWEST = 1e-9

#: Share of the last interval where a root of the slope is its end: a law of finite range ends with a double root.
END_SHARE = 1e-3


@dataclass(frozen=True, slots=True)
class _Power:
    """base + factor (H - origin)^-exponent."""

    base: float
    factor: float
    origin: float
    exponent: float

    def value(self, H: Array) -> Array:
        return self.base + self.factor * (H - self.origin) ** -self.exponent

    def slope(self, H: Array) -> Array:
        return -self.exponent * self.factor * (H - self.origin) ** (-self.exponent - 1.0)

    def curvature(self, H: Array) -> Array:
        rate = self.exponent * (self.exponent + 1.0)
        return rate * self.factor * (H - self.origin) ** (-self.exponent - 2.0)

    def integral(self, low: Array, high: Array) -> Array:
        """Integral from low to high; high may be infinite where base is zero."""
        power = 1.0 - self.exponent
        ends = [(H - self.origin) ** power for H in (low, high)]
        constant = self.base * (high - low) if self.base else 0.0
        return constant + self.factor * (ends[0] - ends[1]) / (self.exponent - 1.0)


@dataclass(frozen=True, slots=True, repr=False)
class TabulatedLaw:
    """Surface law through points, whose gap without traction becomes H = 0.

    Where barriers leave several such gaps, it is the one of the largest work of adhesion.

    Parameters
    ----------
    gaps : sequence of float, shape (N,), N >= 10
        Rising, from any origin; from the repulsion far into the attraction.
    tractions : sequence of float, shape (N,)
        Compression positive: the first is positive, the last negative, or zero for a law of finite range.
    z0 : float
        Range of the law, a length > 0: gaps are resolved and steps are chosen relative to it.
    tail_exponent : float, optional
        Exponent m > 1 of the attraction far away, where it is known; C and t are fitted then.  By default the origin t
        is that of the wall, and C and m are fitted.
    work : float, optional
        Work of adhesion to which the tractions are scaled, > 0.  By default they are not scaled, and their work of
        adhesion may be negative: a barrier may push more than the tension pulls.
    smoothing : float
        Zero: the law passes through every point.

    Raises
    ------
    ValueError
        If the points are not those of a surface law.

    Examples
    --------
    >>> gap = np.geomspace(0.75, 20.0, 100)
    >>> law = TabulatedLaw(gap, 5.0 * (gap**-9 - gap**-3), z0=1.0, tail_exponent=3.0)
    >>> round(law.work_of_adhesion, 4), round(law.peak_gap, 4)  # exact: 5 * 3/8, 3^(1/6) - 1
    (1.875, 0.2009)
    """

    gaps: Sequence[float]
    tractions: Sequence[float]
    z0: float = 1.0
    tail_exponent: float | None = None
    work: float | None = None
    smoothing: float = 0.0
    _spline: scipy.interpolate.PPoly = field(init=False, compare=False)
    _primitive: scipy.interpolate.PPoly = field(init=False, compare=False)
    _wall: _Power = field(init=False, compare=False)
    _tail: _Power | None = field(init=False, compare=False)
    _peak: float = field(init=False, compare=False)
    _stress: float = field(init=False, compare=False)

    def __post_init__(self) -> None:
        for name, value, low in (
            ("z0", self.z0, 0.0),
            ("tail_exponent", self.tail_exponent, 1.0),
            ("work", self.work, 0.0),
        ):
            if value is not None and not low < value < math.inf:
                raise ValueError(f"{name} = {value} is outside ({low:g}, infinity)")
        if self.smoothing != 0.0:
            raise ValueError(
                f"smoothing = {self.smoothing!r} is not 0: the finite elements take a law through every point; smooth "
                "noisy points before"
            )
        columns = _columns(self.gaps, self.tractions)
        # Gaps in lengths of the law and tractions of size 1: the equations of the spline are then well scaled.
        stress = float(np.max(np.abs(columns[1])))
        x, p = columns[0] / self.z0, columns[1] / stress
        spline, wall, tail, peak = _law(x, p, self.tail_exponent)
        beyond = 0.0 if tail is None else float(tail.integral(x[-1:], np.array([math.inf]))[0])
        zero, work = _zero_gap(spline, x, beyond)
        work *= stress * self.z0
        if self.work is not None and not work > 0.0:
            raise ValueError(
                f"the work of adhesion of the points is {work:g}, outside (0, infinity): it cannot be scaled to "
                f"work = {self.work:g}; leave that out"
            )
        pieces = scipy.interpolate.PPoly(spline.c, spline.x - zero)
        for name, new in (
            ("gaps", tuple(columns[0].tolist())),
            ("tractions", tuple(columns[1].tolist())),
            ("_spline", pieces),
            ("_primitive", pieces.antiderivative()),
            ("_wall", _Power(wall.base, wall.factor, wall.origin - zero, WALL)),
            ("_tail", tail and _Power(0.0, tail.factor, tail.origin - zero, tail.exponent)),
            ("_peak", peak - zero),
            ("_stress", stress if self.work is None else stress * self.work / work),
        ):
            object.__setattr__(self, name, new)

    def __repr__(self) -> str:
        return f"TabulatedLaw({len(self.gaps)} points, gaps {self.gaps[0]:g} to {self.gaps[-1]:g})"

    @property
    def work_of_adhesion(self) -> float:
        """Energy per area to separate the faces from H = 0 to infinity."""
        return -float(self.energy(np.array(0.0)))

    @property
    def peak_gap(self) -> float:
        """Gap of the largest tension."""
        return self._peak * self.z0

    @property
    def singular_gap(self) -> float:
        """Gap at which the wall diverges."""
        return self._wall.origin * self.z0

    @property
    def decay(self) -> tuple[float, float]:
        """(C, m) of the attraction C H^-m at large gaps; (0, inf) for a law of finite range."""
        if self._tail is None:
            return 0.0, math.inf
        return -self._tail.factor * self._stress * self.z0**self._tail.exponent, self._tail.exponent

    def _parts(self, H: Array) -> tuple[Array, Array, Array, Index]:
        """Gaps of wall, spline and tail, in lengths of the law and moved to the nearest end, and which of the three."""
        h = np.asarray(H, float) / self.z0
        start, end = self._spline.x[0], self._spline.x[-1]
        where = np.where(h < start, 0, np.where(h > end, 2, 1))
        return np.minimum(h, start), np.clip(h, start, end), np.maximum(h, end), where

    def traction(self, H: Array) -> Array:
        """p(H), shape of `H`."""
        compressed, inside, far, where = self._parts(H)
        tail = np.zeros_like(far) if self._tail is None else self._tail.value(far)
        return self._stress * np.choose(where, [self._wall.value(compressed), self._spline(inside), tail])

    def slope(self, H: Array) -> Array:
        """dp/dH, shape of `H`."""
        compressed, inside, far, where = self._parts(H)
        tail = np.zeros_like(far) if self._tail is None else self._tail.slope(far)
        return self._stress / self.z0 * np.choose(where, [self._wall.slope(compressed), self._spline(inside, 1), tail])

    def energy(self, H: Array) -> Array:
        """Integral of p from H to infinity, the energy per area of the faces at gap H."""
        compressed, inside, far, _ = self._parts(H)
        start, end = self._spline.x[0], self._spline.x[-1]
        tail = np.zeros_like(far) if self._tail is None else self._tail.integral(far, np.array(math.inf))
        middle = self._primitive(end) - self._primitive(inside)
        return np.asarray(self._stress * self.z0 * (tail + middle + self._wall.integral(compressed, start)))


def _zero_gap(spline: scipy.interpolate.PPoly, x: Array, beyond: float) -> tuple[float, float]:
    """Of the gaps without traction where a tension begins: that of the largest work of adhesion, and this work.

    `beyond` is the integral of the traction beyond the last point.
    """
    gaps = np.array(stable_gaps(spline, x))
    primitive = spline.antiderivative()
    energies = primitive(x[-1]) - primitive(np.concatenate([gaps, x])) + beyond
    lows, at_points = energies[: gaps.size], energies[gaps.size :]
    # A repulsion that ends at zero ends in no well: the energy rises nowhere beyond.
    tops = np.where(x > gaps[:, np.newaxis], np.maximum(at_points, 0.0), 0.0).max(axis=1)
    depths = tops - lows
    wells = np.flatnonzero(depths > SHALLOWEST * depths.max())
    lowest = wells[np.argmin(lows[wells])]
    return float(gaps[lowest]), -float(lows[lowest])


def _columns(gaps: Sequence[float], tractions: Sequence[float]) -> tuple[Array, Array]:
    """Gaps and tractions as arrays, if they can be those of a surface law."""
    try:
        x, p = np.asarray(gaps, float), np.asarray(tractions, float)
    except (TypeError, ValueError) as error:
        raise ValueError(f"gaps and tractions are not two columns of numbers: {error}") from error
    if x.ndim != 1 or x.shape != p.shape or x.size < FEWEST:
        raise ValueError(
            f"gaps of the shape {x.shape} and tractions of the shape {p.shape} do not form a table: a law needs a "
            f"traction for each of {FEWEST} gaps or more"
        )
    finite = np.isfinite(x) & np.isfinite(p)
    if not finite.all():
        row = int(np.argmin(finite))
        raise ValueError(f"the point ({x[row]}, {p[row]}) in row {row} is not finite")
    falls = np.flatnonzero(np.diff(x) <= 0)
    if falls.size:
        row = int(falls[0]) + 1
        raise ValueError(
            f"the gap {x[row]:g} in row {row} is not above {x[row - 1]:g}, the one before it: gaps must rise"
        )
    if not p[0] > 0 or not p[-1] <= 0:
        raise ValueError(
            f"the tractions go from {p[0]:g} to {p[-1]:g}: the first must be a compression (> 0), and the last a "
            "tension, or zero where a repulsion has faded"
        )
    if not p.min() < 0 or np.argmin(p) == p.size - 1:
        raise ValueError(
            f"the tractions do not pass a largest tension: the least, {p.min():g}, is the last or none at all"
        )
    return x, p


def _law(x: Array, p: Array, exponent: float | None) -> tuple[scipy.interpolate.PPoly, _Power, _Power | None, float]:
    """Spline, wall and tail, and gap of the largest tension."""
    if len(x) < SPARSE:
        with suppress(ValueError):
            return _through(*denser_points(x, p), exponent, _turns(p))
    return _through(x, p, exponent, _turns(p))


def _through(
    x: Array, p: Array, exponent: float | None, turns: int
) -> tuple[scipy.interpolate.PPoly, _Power, _Power | None, float]:
    free = scipy.interpolate.make_interp_spline(x, p, k=5)
    wall = _wall_of(x[0], p[0], float(free(x[0], 1)), float(free(x[0], 2)))
    tail = _tail_of(x, p, wall.origin, exponent)
    spline = _joined_spline(x, p, wall, tail)
    return spline, wall, tail, _largest_tension(spline, x, turns)


def _turns(p: Array) -> int:
    """Number of times that the points rise after falling, or fall after rising."""
    rises = np.diff(p)
    return int(np.count_nonzero(np.diff(np.sign(rises[rises != 0]))))


def _wall_of(x: float, p: float, slope: float, curvature: float) -> _Power:
    """The wall with a value, slope and curvature at the first gap."""
    if not (slope < 0 and curvature > 0):
        raise ValueError(
            f"at the first gap {x:g} the traction has the slope {slope:g} and the curvature {curvature:g}: a repulsion "
            "falls and is convex; begin the table at a smaller gap"
        )
    away = -slope * (WALL + 1.0) / curvature
    rise = -slope * away / WALL
    return _Power(p - rise, rise * away**WALL, x - away, WALL)


def _tail_of(x: Array, p: Array, origin: float, exponent: float | None) -> _Power | None:
    """The power through the last point that fits the last ones best; none for a law of finite range."""
    if p[-1] == 0:
        return None
    away = x - origin
    count = max(FEWEST_IN_TAIL, int(np.count_nonzero(away >= 0.5 * away[-1])))
    away, end, tension = away[-count:], x[-count:], -p[-count:]
    if not np.all(tension > 0):
        raise ValueError(f"the last {count} tractions are not all tensions: there is no tail to continue")
    if exponent is None:
        run, rise = np.log(away / away[-1]), np.log(tension / tension[-1])
        m = -float(run @ rise) / float(run @ run)
        if not m > 1:
            raise ValueError(
                f"the last tractions fall as H^-{m:.3g}, and a power of 1 or less has an infinite work of adhesion: "
                "continue the table to larger gaps, or state tail_exponent"
            )
    else:
        m = exponent
        run, rise = end - end[-1], tension ** (-1.0 / m) - tension[-1] ** (-1.0 / m)
        steepness = float(run @ rise) / float(run @ run)
        if not steepness > 0:
            raise ValueError(f"the tension rises towards the last gap {x[-1]:g}: there is no tail to continue")
        origin = float(end[-1] - tension[-1] ** (-1.0 / m) / steepness)
    return _Power(0.0, float(p[-1] * (x[-1] - origin) ** m), origin, m)


def _joined_spline(x: Array, p: Array, wall: _Power, tail: _Power | None) -> scipy.interpolate.PPoly:
    """The spline with the slopes and curvatures of wall and tail at its ends."""
    left = [(1, float(wall.slope(x[0]))), (2, float(wall.curvature(x[0])))]
    right = [(1, 0.0), (2, 0.0)]
    if tail is not None:
        right = [(1, float(tail.slope(x[-1]))), (2, float(tail.curvature(x[-1])))]
    spline: scipy.interpolate.BSpline = scipy.interpolate.make_interp_spline(x, p, k=5, bc_type=(left, right))
    return scipy.interpolate.PPoly.from_spline(spline)


def _largest_tension(spline: scipy.interpolate.PPoly, x: Array, turns: int) -> float:
    """Gap of the largest tension; the spline must turn as often as the points."""
    roots = spline.derivative().roots(discontinuity=False, extrapolate=False)
    inside = [r for r in roots if x[0] < r < x[-1] - END_SHARE * (x[-1] - x[-2])]
    if len(inside) != turns:
        raise ValueError(
            f"the spline through the points turns {len(inside)} times and the points {turns} times: they are too far "
            "apart or too noisy; add points or smooth them"
        )
    return float(min(inside, key=lambda r: float(spline(r))))
