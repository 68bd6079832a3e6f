"""Fits by which the benchmark states how something grows."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

__all__ = ["Line", "growth_exponent", "line"]


class Line(NamedTuple):
    """The line y = start + slope x.

    Attributes
    ----------
    start, slope : float
    residual : float
        Largest distance of a point from the line, relative to its y.
    """

    start: float
    slope: float
    residual: float


def line(x: ArrayLike, y: ArrayLike) -> Line:
    """Fit a line by least squares.

    Raises
    ------
    ValueError
        If there are fewer than two different x.

    Examples
    --------
    >>> line([0.0, 1.0, 2.0], [10.0, 12.0, 14.0])
    Line(start=10.0, slope=2.0, residual=0.0)
    """
    x, y = np.asarray(x, float), np.asarray(y, float)
    if np.unique(x).size < 2:
        raise ValueError(f"a line needs two points with different x; there are {np.unique(x).size}")
    centre = x.mean()
    slope = float((x - centre) @ (y - y.mean()) / ((x - centre) @ (x - centre)))
    start = float(y.mean() - slope * centre)
    return Line(start, slope, float(np.abs((start + slope * x - y) / y).max()))


def growth_exponent(x: ArrayLike, y: ArrayLike) -> float:
    """Return the exponent p of y ~ x^p by a fit of the logarithms.

    Examples
    --------
    >>> round(growth_exponent([1.0, 10.0, 100.0], [2.0, 20.0, 200.0]), 12)
    1.0
    """
    return line(np.log(np.asarray(x, float)), np.log(np.asarray(y, float))).slope
