"""The distance of two curves given by points, e.g. two S-shaped force-displacement curves.

Both axes are scaled by the range of the reference, so that a distance is a fraction of the picture.  Each curve is
interpolated by a cubic spline over its length; the distance is the largest one of a point of either curve from the
other, over the common range of x.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

__all__ = ["CurveDistance", "curve_distance", "spread"]

Array = NDArray[np.float64]

#: Samples of the spline between neighbouring points; the chords between samples are off by a thousandth of the
#: spline's own error.
_SAMPLES = 32
#: Neighbouring points nearer than this, as a fraction of the picture, count as one: a fold inserted beside a point.
_SAME = 1e-7
#: The spline through every other point errs four times as much or more (16 times where the curve is smooth).
_HALVING_GAIN = 4.0
#: Factor on the distance of two computations of different fineness, as an estimate of the error of the finer.
_SAFETY = 2.0
_FEWEST_POINTS = 8


@dataclass(frozen=True, slots=True)
class CurveDistance:
    """The distance and what interpolation may add to it, of either curve; fractions of the picture."""

    value: float
    u_candidate: float
    u_reference: float


def curve_distance(
    x: Array, y: Array, reference_x: Array, reference_y: Array, *, interpolated: bool = True
) -> CurveDistance:
    """Return the distance of a curve from a reference.

    Parameters
    ----------
    x, y, reference_x, reference_y : ndarray
        Points in the order of each curve; at least eight of each over the common range of x.
    interpolated : bool
        Whether to estimate the interpolation errors.

    Raises
    ------
    ValueError
        If a number is not finite, lengths differ, or too few points are in the common range.

    Examples
    --------
    >>> t, s = np.linspace(0, 1, 60), np.linspace(0, 1, 41)
    >>> found = curve_distance(t, np.sin(3 * t) + 0.01, s, np.sin(3 * s))
    >>> bool(0.0 < found.value < 0.01), found.u_reference < 1e-6
    (True, True)
    """
    curve, reference = (_checked(a, b) for a, b in ((x, y), (reference_x, reference_y)))
    low = max(curve[:, 0].min(), reference[:, 0].min())
    high = min(curve[:, 0].max(), reference[:, 0].max())
    inside = [(points[:, 0] >= low) & (points[:, 0] <= high) for points in (curve, reference)]
    if min(int(mask.sum()) for mask in inside) < _FEWEST_POINTS:
        raise ValueError(f"fewer than {_FEWEST_POINTS} points of the two curves share a range of x")
    span = np.ptp(reference[inside[1]], axis=0)
    if not (span > 0.0).all():
        raise ValueError("the reference is a point or a line along an axis: it has no range to scale by")
    curve, reference = curve / span, reference / span
    value = max(
        _farthest(curve[inside[0]], _dense(reference)), _farthest(reference[inside[1]], _dense(curve))
    )
    if not interpolated:
        return CurveDistance(value, 0.0, 0.0)
    return CurveDistance(
        value, _interpolation_error(curve, inside[0]), _interpolation_error(reference, inside[1])
    )


def spread(coarse_x: Array, coarse_y: Array, x: Array, y: Array) -> float:
    """Bound the distance of computed points from the exact curve by that of a coarser computation."""
    return _SAFETY * curve_distance(coarse_x, coarse_y, x, y, interpolated=False).value


def _checked(x: Array, y: Array) -> Array:
    points = np.column_stack([np.asarray(x, float), np.asarray(y, float)])
    if not np.isfinite(points).all():
        raise ValueError("a point of a curve is not a finite number")
    return points


def _dense(points: Array) -> Array:
    steps = np.hypot(*np.diff(points / np.ptp(points, axis=0), axis=0).T)
    kept = np.concatenate([[True], steps > _SAME])
    points, length = points[kept], np.concatenate([[0.0], np.cumsum(steps[kept[1:]])])
    between = np.linspace(0.0, 1.0, _SAMPLES, endpoint=False)
    samples = (length[:-1, None] + np.diff(length)[:, None] * between).ravel()
    return np.vstack([CubicSpline(length, points)(samples), points[-1]])


def _farthest(points: Array, polyline: Array) -> float:
    """Largest distance of points from a polyline."""
    start, step = polyline[:-1], np.diff(polyline, axis=0)
    squared = (step**2).sum(axis=1)
    largest = 0.0
    for point in points:
        along = np.clip(((point - start) * step).sum(axis=1) / np.where(squared > 0.0, squared, 1.0), 0.0, 1.0)
        nearest = start + along[:, None] * step
        largest = max(largest, float(((nearest - point) ** 2).sum(axis=1).min()))
    return float(np.sqrt(largest))


def _interpolation_error(points: Array, inside: NDArray[np.bool_]) -> float:
    left_out = np.zeros(len(points), bool)
    left_out[1:-1:2] = True
    return _farthest(points[left_out & inside], _dense(points[~left_out])) / _HALVING_GAIN
