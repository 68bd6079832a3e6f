"""Distance of two curves given by points, e.g. two S-shaped force-displacement curves.

Both axes are scaled by the range of the reference, so that a distance is a fraction of the picture.  The
distance is the largest one of a point of the candidate from the reference, interpolated by a cubic spline
over its length, in the range of x that both have.  The candidate must cover the whole reference: a long part of it
without points counts as a distance of its length.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy
from numpy.typing import NDArray

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


class CurveDistance(NamedTuple):
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


def curve_distance(x: Array, y: Array, reference_x: Array, reference_y: Array) -> CurveDistance:
    """Return the distance of a curve from a reference.

    Parameters
    ----------
    x, y, reference_x, reference_y : ndarray
        Points in the order of each curve; at least eight of each over the common range of x.

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
    largest, missing, reference, inside = _compared(x, y, reference_x, reference_y)
    return CurveDistance(
        max(largest, missing if missing > _LONGEST_PART else 0.0), _interpolation_error(reference, inside)
    )


def mesh_difference(coarse_x: Array, coarse_y: Array, x: Array, y: Array) -> float:
    """Bound the distance of computed points from the exact curve by that of a coarser computation.

    A long step of both, as far away or in compression, is no error of their points.

    Examples
    --------
    >>> t, s = np.linspace(0, 1, 21), np.linspace(0, 1, 61)
    >>> bool(0.0 < mesh_difference(t, np.sin(3 * t) + 1e-3, s, np.sin(3 * s)) < 2e-3)
    True
    """
    return _SAFETY * _compared(coarse_x, coarse_y, x, y)[0]


def _compared(
    x: Array, y: Array, reference_x: Array, reference_y: Array
) -> tuple[float, float, Array, NDArray[np.bool_]]:
    """Return the largest distance of a point, the longest part of the reference without one, and the scaled reference.

    The last array tells which points of the reference are in the common range.
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
    reference = reference / span
    polyline = _dense(reference)
    distances, segments = _nearest(curve[inside] / span, polyline)
    missing = _longest_part(polyline, segments, low / span[0], high / span[0])
    return float(distances.max()), missing, reference, reference_inside


def _checked(x: Array, y: Array) -> Array:
    points = np.column_stack([np.asarray(x, float), np.asarray(y, float)])
    if not np.isfinite(points).all():
        raise ValueError("a point of a curve is not a finite number")
    return points


def _dense(points: Array) -> Array:
    """Return points of the spline through some points, so near each other that chords between them are the spline."""
    steps = np.hypot(*np.diff(points / np.ptp(points, axis=0), axis=0).T)
    distinct = np.concatenate([[True], steps > _SAME])
    points, length = points[distinct], np.concatenate([[0.0], np.cumsum(steps[distinct[1:]])])
    between = np.linspace(0.0, 1.0, _SAMPLES, endpoint=False)
    samples = (length[:-1, None] + np.diff(length)[:, None] * between).ravel()
    return np.vstack([scipy.interpolate.CubicSpline(length, points)(samples), points[-1]])


def _nearest(points: Array, polyline: Array) -> tuple[Array, NDArray[np.int_]]:
    """Distance of every point from a polyline, and the number of its nearest segment."""
    starts, steps = polyline[:-1], np.diff(polyline, axis=0)
    squared = np.sum(steps**2, axis=1)
    squared[squared == 0.0] = 1.0
    distances, segments = np.empty(len(points)), np.empty(len(points), int)
    for i, point in enumerate(points):
        offsets = starts - point
        along = np.clip(-np.sum(offsets * steps, axis=1) / squared, 0.0, 1.0)
        apart = np.hypot(*(offsets + along[:, None] * steps).T)
        segments[i] = apart.argmin()
        distances[i] = apart[segments[i]]
    return distances, segments


def _longest_part(polyline: Array, segments: NDArray[np.int_], low: float, high: float) -> float:
    """Longest part between two abscissas, as a fraction of it, without a point at one of these segments."""
    lengths = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(polyline, axis=0).T))])
    inside = np.flatnonzero((polyline[:, 0] >= low) & (polyline[:, 0] <= high))
    stops = np.sort([inside[0], *segments, inside[-1]])
    return float(np.diff(lengths[stops]).max() / (lengths[inside[-1]] - lengths[inside[0]]))


def _interpolation_error(points: Array, inside: NDArray[np.bool_]) -> float:
    omitted = np.zeros(len(points), bool)
    omitted[1:-1:2] = True
    distances, _ = _nearest(points[omitted & inside], _dense(points[~omitted]))
    return float(distances.max()) / _HALVING_GAIN
