"""Distance of two curves given by points, e.g. two S-shaped force-displacement curves.

Both axes are scaled by the range of the reference, so that a distance is a fraction of the picture.  The
distance is the largest one of a point of the candidate from the reference, interpolated by a cubic spline
over its length, in the range of x that both have.  The candidate must cover the whole reference: a long part of it
without points counts as a distance of its length.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy
from numpy.typing import NDArray

__all__ = ["CurveDistance", "curve_distance", "mesh_difference"]

Array = NDArray[np.float64]

#: Samples of the spline between neighbouring points; the chords between samples are off by a thousandth of
#: the spline's own error.
_SAMPLES = 32
#: Neighbouring points nearer than this, as a fraction of the picture, count as one: a fold inserted beside a
#: point.
_SAME = 1e-7
#: The spline through every other point has 16 times the error where the curve is smooth; half of that is used.
_HALVING_GAIN = 8.0
#: Longest part of the reference, as a fraction of its length, that may have no point of the candidate
#: (measured: 0.25 far away, where the steps of the finite elements are long).
_LONGEST_PART = 1 / 3
#: Factor on the distance of two computations with different meshes, as a bound on the error of the finer.
_SAFETY = 2.0
_FEWEST_POINTS = 8


@dataclass(frozen=True, slots=True)
class CurveDistance:
    """A distance and the bound on its error by the interpolation of the reference, as fractions of the picture.

    Examples
    --------
    >>> t = np.linspace(0, 1, 21)
    >>> found = curve_distance(t, t**2, t, t**2)
    >>> found.value < 1e-15, found.u_interpolation < 1e-5
    (True, True)
    """

    value: float
    u_interpolation: float


def curve_distance(
    x: Array, y: Array, reference_x: Array, reference_y: Array, *, interpolated: bool = True
) -> CurveDistance:
    """Return the distance of a curve from a reference.

    Parameters
    ----------
    x, y, reference_x, reference_y : ndarray
        Points in the order of each curve; at least eight of each over the common range of x.
    interpolated : bool
        Whether to estimate the interpolation error.

    Raises
    ------
    ValueError
        If a number is not finite, lengths differ, or too few points are in the common range.

    Examples
    --------
    >>> t, s = np.linspace(0, 1, 21), np.linspace(0, 1, 61)
    >>> found = curve_distance(t, np.sin(3 * t) + 0.01, s, np.sin(3 * s))
    >>> bool(0.009 < found.value < 0.011), found.u_interpolation < 1e-5
    (True, True)
    """
    curve, reference = (_checked(a, b) for a, b in ((x, y), (reference_x, reference_y)))
    low = max(curve[:, 0].min(), reference[:, 0].min())
    high = min(curve[:, 0].max(), reference[:, 0].max())
    inside, reference_inside = ((p[:, 0] >= low) & (p[:, 0] <= high) for p in (curve, reference))
    if min(int(inside.sum()), int(reference_inside.sum())) < _FEWEST_POINTS:
        raise ValueError(f"fewer than {_FEWEST_POINTS} points of the two curves share a range of x")
    span = np.ptp(reference[reference_inside], axis=0)
    if not (span > 0.0).all():
        raise ValueError("the reference is a point or a line along an axis: it has no range to scale by")
    curve, reference = curve[inside] / span, reference / span
    polyline = _dense(reference)
    nearest = [polyline.nearest(point) for point in curve]
    missing = polyline.longest_part(np.array([place for _, place in nearest]), low / span[0], high / span[0])
    value = max([distance for distance, _ in nearest] + [missing] * (missing > _LONGEST_PART))
    return CurveDistance(value, _interpolation_error(reference, reference_inside) if interpolated else 0.0)


def mesh_difference(coarse_x: Array, coarse_y: Array, x: Array, y: Array) -> float:
    """Bound the distance of computed points from the exact curve by that of a coarser computation.

    Examples
    --------
    >>> t, s = np.linspace(0, 1, 21), np.linspace(0, 1, 61)
    >>> bool(0.0 < mesh_difference(t, np.sin(3 * t) + 1e-3, s, np.sin(3 * s)) < 2e-3)
    True
    """
    return _SAFETY * curve_distance(coarse_x, coarse_y, x, y, interpolated=False).value


def _checked(x: Array, y: Array) -> Array:
    points = np.column_stack([np.asarray(x, float), np.asarray(y, float)])
    if not np.isfinite(points).all():
        raise ValueError("a point of a curve is not a finite number")
    return points


def _dense(points: Array) -> _Polyline:
    steps = np.hypot(*np.diff(points / np.ptp(points, axis=0), axis=0).T)
    kept = np.concatenate([[True], steps > _SAME])
    points, length = points[kept], np.concatenate([[0.0], np.cumsum(steps[kept[1:]])])
    between = np.linspace(0.0, 1.0, _SAMPLES, endpoint=False)
    samples = (length[:-1, None] + np.diff(length)[:, None] * between).ravel()
    return _Polyline(np.vstack([scipy.interpolate.CubicSpline(length, points)(samples), points[-1]]))


class _Polyline:
    """Segments between neighbouring points, with what the distance of every point from them needs."""

    def __init__(self, points: Array) -> None:
        self._x, self._y = points[:-1].T
        self._dx, self._dy = np.diff(points, axis=0).T
        squared = self._dx**2 + self._dy**2
        self._squared = np.where(squared > 0.0, squared, 1.0)
        #: Length from the first point to each point.
        self.lengths = np.concatenate([[0.0], np.cumsum(np.sqrt(squared))])
        self._abscissas = points[:, 0]

    def nearest(self, point: Array) -> tuple[float, int]:
        """Distance of a point, and the number of the segment that is nearest."""
        x, y = self._x - point[0], self._y - point[1]
        along = np.clip(-(x * self._dx + y * self._dy) / self._squared, 0.0, 1.0)
        distances = np.hypot(x + along * self._dx, y + along * self._dy)
        place = int(distances.argmin())
        return float(distances[place]), place

    def longest_part(self, places: NDArray[np.int_], low: float, high: float) -> float:
        """Longest part between two abscissas, as a fraction of it, without a point at one of these segments."""
        inside = np.flatnonzero((self._abscissas >= low) & (self._abscissas <= high))
        first, last = inside[0], inside[-1]
        stops = np.sort(np.concatenate([[first], places, [last]]))
        return float(np.diff(self.lengths[stops]).max() / (self.lengths[last] - self.lengths[first]))


def _interpolation_error(points: Array, inside: NDArray[np.bool_]) -> float:
    omitted = np.zeros(len(points), bool)
    omitted[1:-1:2] = True
    polyline = _dense(points[~omitted])
    return max(polyline.nearest(point)[0] for point in points[omitted & inside]) / _HALVING_GAIN
