"""Cubic interpolation that is monotone between two points, at one place."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Sequence

__all__ = ["monotone_cubic"]


def monotone_cubic(x: Sequence[float], y: Sequence[float], at: float) -> float:
    """Return a value of the curve of `scipy.interpolate.PchipInterpolator` (Fritsch & Butland 1984).

    The errors of assumptions need hundreds of curves, each at one place: SciPy takes 0.3 ms to make one.

    Parameters
    ----------
    x, y : sequence of float
        Two points or more, with rising x.
    at : float

    Examples
    --------
    >>> monotone_cubic([0.0, 1.0, 2.0], [0.0, 1.0, 2.0], 1.5)
    1.5
    """
    i = min(max(bisect_left(x, at), 1), len(x) - 1)
    length = x[i] - x[i - 1]
    t = (at - x[i - 1]) / length
    left, right = length * _slope(x, y, i - 1), length * _slope(x, y, i)
    rise = y[i] - y[i - 1]
    return y[i - 1] + t * (left + t * (3.0 * rise - 2.0 * left - right + t * (left + right - 2.0 * rise)))


def _slope(x: Sequence[float], y: Sequence[float], i: int) -> float:
    """The derivative at a point."""
    last = len(x) - 1
    if last == 1:
        return (y[1] - y[0]) / (x[1] - x[0])
    inner = min(max(i, 1), last - 1)
    h, m = zip(*((x[j + 1] - x[j], (y[j + 1] - y[j]) / (x[j + 1] - x[j])) for j in (inner - 1, inner)), strict=True)
    if i == inner:
        if m[0] * m[1] <= 0.0:
            return 0.0
        weights = 2.0 * h[1] + h[0], h[1] + 2.0 * h[0]
        return sum(weights) / (weights[0] / m[0] + weights[1] / m[1])
    (near, far), (h_near, h_far) = (m, h) if i == 0 else (m[::-1], h[::-1])
    slope = ((2.0 * h_near + h_far) * near - h_near * far) / (h_near + h_far)
    if slope * near <= 0.0:
        return 0.0
    return 3.0 * near if near * far <= 0.0 and math.fabs(slope) > 3.0 * math.fabs(near) else slope
