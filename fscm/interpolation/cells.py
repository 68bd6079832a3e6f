"""Cells of the atlas, in each of which a bound of its own holds."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from fscm._typing import Array
from fscm.interpolation.coordinates import LEAST_MU, MOST_MU, Coordinates, seam

__all__ = ["CELLS", "Cells", "cells_of", "plane_cells"]

#: Cells in each direction.
CELLS = 3
_LINEAR = Coordinates((0.0, 0.0, 0.0, 0.0, 0.0), math.inf, math.inf)
Cells = tuple[NDArray[np.int_], ...]


def _cells(coordinate: Array) -> NDArray[np.int_]:
    """Numbers of cells that have as many Chebyshev nodes each."""
    angle = np.arccos(np.clip(-coordinate, -1.0, 1.0))
    return np.minimum((angle * (CELLS / math.pi)).astype(np.int_), CELLS - 1)


def plane_cells(n: Array, k: Array) -> Cells:
    """Numbers of the cells in 1/n and k.

    Examples
    --------
    >>> [int(number[0]) for number in plane_cells(np.array([6.0]), np.array([0.4]))]
    [0, 1]
    """
    plane = _LINEAR.plane(n, k)
    return _cells(plane[:, 0]), _cells(plane[:, 1])


def cells_of(upper: bool, n: Array, k: Array, mu: Array, critical: Array) -> Cells:
    """Numbers of the cells in 1/n, k and the logarithm of mu."""
    low, high = (critical, MOST_MU) if upper else (LEAST_MU, seam(n))
    part = np.log(mu / low) / np.log(high / low)
    return *plane_cells(n, k), _cells(2.0 * part - 1.0)
