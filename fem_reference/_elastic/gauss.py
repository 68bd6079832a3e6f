"""Gauss-Legendre rules on the unit interval."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from fem_reference._typing import Array

__all__ = ["unit_gauss"]


# The rules of a solve are few; a path asks for one of them hundreds of times.
@lru_cache(maxsize=32)
def unit_gauss(count: int) -> tuple[Array, Array]:
    """Points and weights on [0, 1], shapes (count,); read-only.

    Examples
    --------
    >>> x, w = unit_gauss(2)
    >>> round(float(w @ x**3), 15)
    0.25
    """
    x, w = np.polynomial.legendre.leggauss(count)
    points, weights = 0.5 * (x + 1.0), 0.5 * w
    points.flags.writeable = weights.flags.writeable = False
    return points, weights
