"""Surface law through data points of traction against gap, from molecular dynamics or an experiment.

A quintic interpolating spline between the points, or between denser ones if they are few (`fscm._law_curve`), with four
continuous derivatives; a power-law tail p = -C (H - t)^-m
beyond them, and a wall p = c + A (H - s)^-9 below them.  Value, slope and curvature are continuous at both ends.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import numpy as np
import scipy

from fscm._law_curve import law_curve
from fscm._typing import Array
from fscm._validation import real_number
from fscm.laws import unit_of_energy

__all__ = ["TabulatedLaw"]

#: A quintic spline needs six points; four more for wall, well and tail.
_FEWEST_POINTS = 10
#: Below this number of points the spline goes through denser points: through few ones it overshoots on the wall, and
#: its waves reach the tail.  Measured on exact points of the 9-3 law: errors of 8 % of the largest tension through 24,
#: too many turns through 20.
_FEW = 40
#: Repulsion between half-spaces of atoms with an r^-12 pair potential (Eq. 10).
_WALL_EXPONENT = 9.0
#: Fewest points that the tail is fitted to; otherwise all of the last octave of the distance from the wall.
_TAIL_POINTS = 4
#: Largest admissible smoothing of an alternative: the limit itself is excluded.
_LARGEST_SMOOTHING = 0.1 - 1e-9
#: A well whose depth is below this share of that of the deepest is rounding: where a repulsion fades to zero.
_SMALLEST_WELL = 1e-9
#: Rounding of the curve, relative to the largest traction.
_ROUNDOFF = 2.0**-52


class _Curve(NamedTuple):
    """A spline; (c, A, s) of the wall c + A (H - s)^-9; (C, m, t) of the tail -C (H - t)^-m; gap of the peak."""

    spline: scipy.interpolate.PPoly
    wall: tuple[float, float, float]
    tail: tuple[float, float, float]
    peak: float


@dataclass(frozen=True, slots=True, repr=False)
class TabulatedLaw:
    """Surface law through data points, whose gap without traction becomes H = 0.

    Of several such gaps, as with a barrier in a liquid, it is the one from which separation takes the most energy.
    Immutable, hashable, picklable.

    Parameters
    ----------
    gaps : sequence of float, shape (N,), N >= 10
        Gaps from any origin, increasing; from the repulsive wall far into the tail.
    tractions : sequence of float, shape (N,)
        Tractions, compression positive.  First > 0, then one change of sign, or three and more with barriers between
        the wells; a largest tension before the last point; last < 0, or = 0 for a law of finite range.
    z0 : float
        Range of the law in the unit of the gaps, > 0.  It is the user's choice and affects the Tabor number, but no
        result in physical units; 1 in a dimensionless problem.
    tail_exponent : float, optional
        Exponent m > 1 of the tail p ~ -C H^-m when it is known (3 for van der Waals forces between
        half-spaces). C and the origin t are then fitted to the end of the data.  Otherwise t is the gap at
        which the wall diverges, and C and m are fitted.
    work : float, optional
        Work of adhesion to which the tractions are scaled, > 0.  By default they are not scaled, and the work of
        adhesion has any sign: a barrier may return more on separation than the tension takes.
    smoothing : float, optional
        Relative standard error of the tractions, below 0.1.  Above 0 the law is a smooth curve through the points
        within about this error, instead of an interpolating one: for noisy data.  The effect of this choice is a part
        of the `u_num` of every solution (see `alternatives`).

    Raises
    ------
    ValueError
        When the data are not those of a surface law, with the reason in one sentence.

    Examples
    --------
    >>> gap = np.geomspace(0.75, 20.0, 100)
    >>> law = TabulatedLaw(gap, 5.0 * (gap**-9 - gap**-3), tail_exponent=3)
    >>> round(law.equilibrium_gap, 5), round(law.work_of_adhesion, 4)     # exact: 1, 5 * 3/8
    (1.0, 1.875)
    """

    gaps: Sequence[float]
    tractions: Sequence[float]
    z0: float = 1.0
    tail_exponent: float | None = None
    work: float | None = None
    smoothing: float = 0.0
    equilibrium_gap: float = field(init=False, compare=False)
    work_of_adhesion: float = field(init=False, compare=False)
    _unit: float = field(init=False, compare=False)
    _spline: scipy.interpolate.PPoly = field(init=False, compare=False)
    _integral: scipy.interpolate.PPoly = field(init=False, compare=False)
    _peak: float = field(init=False, compare=False)
    _wall: tuple[float, float, float] = field(init=False, compare=False)
    _tail: tuple[float, float, float] = field(init=False, compare=False)

    def __post_init__(self) -> None:
        gap, p = _checked_points(self.gaps, self.tractions)
        columns = gap, p
        positive = "it is a positive quantity"
        z0 = real_number("z0", self.z0, low=0.0, high=math.inf, reason=positive)
        work = self.work
        if work is not None:
            work = real_number("work", work, low=0.0, high=math.inf, reason=positive)
        gap = gap / z0
        m = self.tail_exponent
        if m is not None:
            reason = "with m <= 1 the work of adhesion is infinite"
            m = real_number("tail_exponent", m, low=1.0, high=math.inf, reason=reason)
        reason = "it is the relative error of the tractions"
        error = real_number("smoothing", self.smoothing, low=0.0, high=0.1, reason=reason, closed_low=True)
        spline, wall, tail, peak = _curve(gap, p, m, error)
        equilibrium, adhesion = _deepest_well(spline, tail)
        if work is not None and not adhesion > 0.0:
            raise ValueError(
                f"the work of adhesion of the data is {adhesion * z0:g}, outside (0, inf): it cannot be scaled to "
                f"work = {work:g}, so leave that out"
            )
        # Without adhesion the data keep their unit.
        unit = adhesion if adhesion > 0.0 else 1.0
        normalised = scipy.interpolate.PPoly(spline.c / unit, spline.x - equilibrium)
        values = {
            "gaps": tuple(columns[0].tolist()),
            "tractions": tuple(columns[1].tolist()),
            "z0": z0,
            "tail_exponent": m,
            "work": work,
            "smoothing": error,
            "equilibrium_gap": equilibrium * z0,
            "work_of_adhesion": adhesion * z0 if work is None else work,
            "_unit": unit * z0 if work is None else work,
            "_spline": normalised,
            "_integral": normalised.antiderivative(),
            "_peak": peak - equilibrium,
            "_wall": (wall[0] / unit, wall[1] / unit, wall[2] - equilibrium),
            "_tail": (tail[0] / unit, tail[1], tail[2] - equilibrium),
        }
        for name, value in values.items():
            object.__setattr__(self, name, value)

    def __repr__(self) -> str:
        return f"TabulatedLaw({len(self.gaps)} points, gaps {self.gaps[0]:g} to {self.gaps[-1]:g})"

    @property
    def alternatives(self) -> tuple[TabulatedLaw, ...]:
        """Other laws for the same data: half and twice the smoothing, without some points; none without smoothing.

        Every second point is left out, fewer of less than 20.  Those that are not a law are not among them.

        Examples
        --------
        >>> gap = np.geomspace(0.75, 20.0, 20)
        >>> law = TabulatedLaw(gap, gap**-9 - gap**-3, smoothing=1e-3)
        >>> len(law.alternatives)
        4
        """
        if self.smoothing == 0.0:
            return ()
        rows = range(len(self.gaps))
        laws = []
        for chosen, factor in [(rows, 0.5), (rows, 2.0), *((left, 1.0) for left in _thinned(len(rows)))]:
            gaps, tractions = (tuple(column[i] for i in chosen) for column in (self.gaps, self.tractions))
            smoothing = min(factor * self.smoothing, _LARGEST_SMOOTHING)
            with contextlib.suppress(ValueError):  # too few points for a law, or too noisy ones
                laws.append(replace(self, gaps=gaps, tractions=tractions, smoothing=smoothing))
        return tuple(laws)

    @property
    def dimensionless(self) -> TabulatedLaw:
        """The law with the work of adhesion 1, or a well of the depth 1 if none adheres, and the range 1."""
        gaps = tuple((np.array(self.gaps) / self.z0).tolist())
        if self.work_of_adhesion > 0.0:
            return replace(self, gaps=gaps, z0=1.0, work=1.0)
        tractions = np.array(self.tractions) / (unit_of_energy(self) / self.z0)
        return replace(self, gaps=gaps, tractions=tuple(tractions.tolist()), z0=1.0)

    @property
    def singular_gap(self) -> float:
        """Gap s at which the fitted wall diverges."""
        return self._wall[2] * self.z0

    @property
    def peak_gap(self) -> float:
        """Gap of the largest tension."""
        return self._peak * self.z0

    @property
    def decay(self) -> tuple[float, float]:
        """(C, m) of the tail: p H^m -> -C; (0, inf) for a law of finite range."""
        C, m = self._tail[:2]
        return (C * (self._unit * self.z0 ** (m - 1.0)), m) if C else (C, m)

    def traction(self, H: Array) -> Array:
        """p(H)."""
        return self._joined(H, 0) * (self._unit / self.z0)

    def slope(self, H: Array) -> Array:
        """dp/dH."""
        return self._joined(H, 1) * (self._unit / self.z0**2)

    def curvature(self, H: Array) -> Array:
        """d2p/dH2."""
        return self._joined(H, 2) * (self._unit / self.z0**3)

    def energy(self, H: Array) -> Array:
        """Integral of p from H to infinity, exact for the spline, the wall and the tail."""
        H = np.asarray(H, float) / self.z0
        lowest, highest = self._spline.x[0], self._spline.x[-1]
        inside = np.clip(H, lowest, highest)
        beyond = -_tail_derivative(np.maximum(H, highest), self._tail, -1)
        below = _wall_derivative(lowest, self._wall, -1) - _wall_derivative(np.minimum(H, lowest), self._wall, -1)
        return np.asarray((self._integral(highest) - self._integral(inside) + beyond + below) * self._unit)

    def _joined(self, H: Array, order: int) -> Array:
        """Derivative of the dimensionless traction."""
        H = np.asarray(H, float) / self.z0
        lowest, highest = self._spline.x[0], self._spline.x[-1]
        inside = self._spline(np.clip(H, lowest, highest), order)
        below = _wall_derivative(np.minimum(H, lowest), self._wall, order)
        beyond = _tail_derivative(np.maximum(H, highest), self._tail, order)
        return np.where(lowest > H, below, np.where(highest < H, beyond, inside))


def _curve(gap: Array, p: Array, exponent: float | None, error: float) -> _Curve:
    """The law as a spline, its wall, its tail and the gap of the largest tension."""
    if error > 0.0:
        gap, p = law_curve(gap, p, error)
        return _splined(gap, p, exponent, _turns(p))
    if len(gap) < _FEW:
        with contextlib.suppress(ValueError):
            return _splined(*law_curve(gap, p, 0.0), exponent, _turns(p))
    return _splined(gap, p, exponent, _turns(p))


def _splined(gap: Array, p: Array, exponent: float | None, turns: int) -> _Curve:
    free = _quintic(gap, p)
    left = float(free(gap[0], 1)), float(free(gap[0], 2))
    wall = _fitted_wall(gap[0], p[0], *left)
    tail = _fitted_tail(gap, p, wall[2], exponent)
    right = float(_tail_derivative(gap[-1], tail, 1)), float(_tail_derivative(gap[-1], tail, 2))
    spline = _quintic(gap, p, left, right)
    return _Curve(spline, wall, tail, _checked_shape(spline, gap, p, turns))


def _turns(p: Array) -> int:
    """Number of extrema of the points."""
    steps = np.diff(p)
    return int(np.sum(np.diff(np.sign(steps[steps != 0.0])) != 0))


def _quintic(gap: Array, p: Array, *ends: tuple[float, float]) -> scipy.interpolate.PPoly:
    """Quintic spline through the points, with (slope, curvature) at both ends or not-a-knot there."""
    conditions: Any = tuple([(1, slope), (2, curvature)] for slope, curvature in ends) or None
    spline = scipy.interpolate.make_interp_spline(gap, p, k=5, bc_type=conditions)
    return scipy.interpolate.PPoly.from_spline((spline.t, spline.c, spline.k))


def _power(x: Array | float, exponent: float, order: int) -> Array | float:
    """Return the derivative of x^-exponent of the given order; order -1 is the primitive, 0 at infinity."""
    if order == -1:
        return x ** (1.0 - exponent) / (1.0 - exponent)
    factor = math.prod(-exponent - i for i in range(order))
    return factor * x ** (-exponent - order)


def _wall_derivative(H: Array | float, wall: tuple[float, float, float], order: int) -> Array | float:
    """Return the derivative of c + A (H - s)^-9; order -1 is a primitive."""
    c, A, s = wall
    constant = {-1: c * H, 0: c}.get(order, 0.0)
    return constant + A * _power(H - s, _WALL_EXPONENT, order)


def _tail_derivative(H: Array | float, tail: tuple[float, float, float], order: int) -> Array | float:
    """Return the derivative of -C (H - t)^-m; order -1 is the primitive, 0 at infinity."""
    C, m, t = tail
    return 0.0 * H if C == 0.0 else -C * _power(H - t, m, order)


def _thinned(count: int) -> list[list[int]]:
    """Rows of a table without every second of them, in two ways; without fewer if too few were left, or none."""
    for step in range(2, count):
        kept = [[i for i in range(count) if i in (0, count - 1) or i % step != left] for left in range(2)]
        if min(map(len, kept)) >= _FEWEST_POINTS:
            return kept
    return []


def _checked_points(gaps: Sequence[float], tractions: Sequence[float]) -> tuple[Array, Array]:
    """The data as arrays; ValueError if they cannot be points of a surface law."""
    try:
        gap, p = np.array(gaps), np.array(tractions)
    except ValueError as error:
        raise ValueError(f"gaps and tractions have to be two columns of real numbers: {error}") from error
    if not (gap.dtype.kind in "iuf" and p.dtype.kind in "iuf"):
        raise ValueError(f"gaps ({gap.dtype}) and tractions ({p.dtype}) have to be columns of real numbers")
    gap, p = gap.astype(float), p.astype(float)
    if gap.ndim != 1 or gap.shape != p.shape or len(gap) < _FEWEST_POINTS:
        raise ValueError(
            f"gaps of shape {gap.shape} and tractions of shape {p.shape} are not a table: "
            f"two columns of one length >= {_FEWEST_POINTS} carry a wall, a well and a tail"
        )
    if not (np.all(np.isfinite(gap)) and np.all(np.isfinite(p))):
        row = int(np.argmin(np.isfinite(gap) & np.isfinite(p)))
        raise ValueError(f"row {row} of the table, ({gap[row]}, {p[row]}), is not finite")
    if not np.all(np.diff(gap) > 0.0):
        row = int(np.argmax(np.diff(gap) <= 0.0)) + 1
        raise ValueError(f"gap {gap[row]:g} in row {row} is outside ({gap[row - 1]:g}, inf): gaps have to increase")
    if p[0] <= 0.0:
        raise ValueError(f"the first traction {p[0]:g} is outside (0, inf): the data have to reach the repulsive wall")
    if p[-1] > 0.0:
        raise ValueError(
            f"the last traction {p[-1]:g} is outside (-inf, 0]: the tail of a law attracts; end a repulsion that fades "
            "with a traction of 0"
        )
    least = int(np.argmin(p))
    if p[least] >= 0.0 or least == len(p) - 1:
        raise ValueError(
            f"the smallest traction {p[least]:g} is at the end of the data or not a tension: "
            "a law without a minimum does not hold two surfaces together"
        )
    return gap, p


def _deepest_well(spline: scipy.interpolate.PPoly, tail: tuple[float, float, float]) -> tuple[float, float]:
    """Of the gaps where repulsion turns into tension: that of the largest work of adhesion, and this work."""
    end, slope = spline.x[-1], spline.derivative()
    beyond = float(_tail_derivative(end, tail, -1))
    inside = [float(x) for x in spline.roots(discontinuity=False, extrapolate=False) if spline.x[0] < x < end]
    works = {x: beyond - float(spline.integrate(x, end)) for x in inside}
    wells = [x for x in inside if slope(x) < 0.0]
    # To the top of the barriers beyond.
    depths = {x: works[x] - min([0.0, *(works[y] for y in inside if y > x)]) for x in wells}
    deepest = max((x for x in wells if depths[x] > _SMALLEST_WELL * max(depths.values())), key=works.__getitem__)
    return deepest, works[deepest]


def _fitted_wall(gap: float, p: float, slope: float, curvature: float) -> tuple[float, float, float]:
    """(c, A, s) of c + A (H - s)^-9 that continues value, slope and curvature below the first point."""
    if not (slope < 0.0 < curvature):
        raise ValueError(
            f"at the first gap {gap:g} the slope {slope:g} and curvature {curvature:g} are outside "
            "(-inf, 0) and (0, inf): there is no convex repulsive wall to continue"
        )
    distance = -(_WALL_EXPONENT + 1.0) * slope / curvature
    A = -slope / _WALL_EXPONENT * distance ** (_WALL_EXPONENT + 1.0)
    return p - A * distance**-_WALL_EXPONENT, A, gap - distance


def _fitted_tail(gap: Array, p: Array, wall: float, exponent: float | None) -> tuple[float, float, float]:
    """(C, m, t) of the tail -C (H - t)^-m through the last point, fitted to the end of the data."""
    if p[-1] == 0.0:
        return 0.0, math.inf, 0.0
    octave = int(np.sum(gap - wall >= 0.5 * (gap[-1] - wall)))
    end = slice(-max(_TAIL_POINTS, octave), None)
    x, tension = gap[end], -p[end]
    if not np.all(tension > 0.0):
        raise ValueError(f"the last {len(x)} tractions are not all tensions: there is no tail to fit")
    # Straight lines through the last point: |p|^(-1/m) over H when m is known, else log |p| over log(H - s).
    if exponent is not None:
        y, abscissa = tension ** (-1.0 / exponent), x - gap[-1]
    else:
        y, abscissa = np.log(tension), np.log((x - wall) / (gap[-1] - wall))
    steepness = float(np.dot(abscissa, y - y[-1]) / np.dot(abscissa, abscissa))
    if exponent is None:
        m, t = -steepness, wall
        if not m > 1.0:
            raise ValueError(
                f"the end of the data decays like H^-{m:.3g}, outside (1, inf): "
                "the work of adhesion would be infinite, so extend the data or state tail_exponent"
            )
    else:
        m = exponent
        if not steepness > 0.0:
            raise ValueError(f"the tension grows at the end of the data, gap {gap[-1]:g}: there is no tail to fit")
        t = float(gap[-1] - y[-1] / steepness)
    return float(tension[-1] * (gap[-1] - t) ** m), m, t


def _checked_shape(spline: scipy.interpolate.PPoly, gap: Array, p: Array, turns: int) -> float:
    """Gap of the largest tension; ValueError for a spline with oscillations that the data do not have."""
    extrema = spline.derivative().roots(discontinuity=False, extrapolate=False)
    extrema = extrema[(extrema > gap[0]) & (extrema < gap[-1])]
    # A curve whose slope vanishes at the end has a root next to it, by rounding.
    ending = (extrema > gap[-2]) & (np.abs(spline(extrema) - p[-1]) <= _ROUNDOFF * np.abs(p).max())
    extrema = extrema[~ending]
    if len(extrema) != turns:
        raise ValueError(
            f"the smooth curve through the data turns {len(extrema)} times, the data {turns} times: "
            "they are too coarse or too noisy; add points, or smooth them"
        )
    return float(extrema[np.argmin(spline(extrema))])
