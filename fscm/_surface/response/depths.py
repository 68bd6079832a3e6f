"""Division of the depth into intervals on which the elastic constants are polynomials to rounding."""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial import chebyshev

from fscm._typing import Array
from fscm.errors import Failure, NotConverged
from fscm.solids import GradedHalfSpace

__all__ = ["changes_below", "depth_intervals", "interval_ranges"]

#: Degree of the polynomials, and largest size of the last two coefficients of log E and nu: the remainder is below the
#: error of the integration.
_DEGREE, _LEFT = 10, 1e-11
#: Largest ratio of the range of such a polynomial to that at its nodes: Lebesgue's constant is 2.4.
_BETWEEN = 2.5
#: First depth of the geometric division, in units of the length of the solid, and its ratio.
_FIRST, _RATIO = 1.0 / 64.0, 2.0
#: An interval shorter than this share of its depth is a jump that is not among the interfaces of the solid.
_SHORTEST = 1e-9


def interval_ranges(solid: GradedHalfSpace, ends: Array) -> Array:
    """Least and largest log E and nu at the nodes of the intervals, shape (2 for log E and nu, 2, intervals)."""
    values = _at_nodes(solid, ends[:-1], ends[1:])
    return np.stack([values.min(axis=2), values.max(axis=2)], axis=1)


def changes_below(ranges: Array, ends: Array, deepest: Array) -> Array:
    """Bounds of the changes of log E and nu from any depth of an interval down to each of several deepest ones.

    Parameters
    ----------
    ranges : ndarray, shape (2, 2, n)
        From `interval_ranges`.
    ends : ndarray, shape (n + 1,)
        Ends of the intervals.
    deepest : ndarray, shape (m,)
        In the last interval.

    Returns
    -------
    ndarray, shape (m, n)
        At least what a polynomial on an interval leaves.
    """
    low, high = ranges[:, 0, ::-1], ranges[:, 1, ::-1]
    changes = np.maximum.accumulate(high, axis=1) - np.minimum.accumulate(low, axis=1)
    changes = np.tile(np.max(changes, axis=0)[::-1], (len(deepest), 1))
    # Markov's inequality: the slope of a polynomial is at most the square of its degree times its range, per length.
    changes[:, -1] *= np.minimum(1.0, _DEGREE**2 * (deepest - ends[-2]) / (ends[-1] - ends[-2]))
    return np.maximum(_BETWEEN * changes, _LEFT)


def _at_nodes(solid: GradedHalfSpace, a: Array, b: Array) -> Array:
    """Log E and nu at the nodes of intervals, shape (2, n, nodes)."""
    nodes = chebyshev.chebpts1(_DEGREE + 1)
    z = a[:, None] + 0.5 * (b - a)[:, None] * (1.0 + nodes)
    return np.stack([np.log(solid.modulus(z.ravel())), solid.poisson(z.ravel())]).reshape(2, *z.shape)


def depth_intervals(solid: GradedHalfSpace, deepest: float) -> Array:
    """Ends of the intervals from the surface to a depth, ascending.

    Raises
    ------
    NotConverged
        At a jump that is not among the interfaces.

    Examples
    --------
    >>> from fscm import Coating
    >>> sharp = Coating(E_coating=1.0, E_substrate=9.0, thickness=3.0, transition=0.0, nu_coating=0.3)
    >>> 3.0 in depth_intervals(sharp, 10.0)
    True
    """
    shallowest = min(_FIRST * solid.length, deepest)
    count = max(1, math.ceil(math.log(deepest / shallowest) / math.log(_RATIO)))
    ends = np.concatenate([[0.0], np.geomspace(shallowest, deepest, count + 1)[:-1], [deepest], solid.interfaces])
    ends = np.unique(ends[ends <= deepest])
    nodes = chebyshev.chebpts1(_DEGREE + 1)
    to_modes = np.linalg.inv(chebyshev.chebvander(nodes, _DEGREE))
    a, b = ends[:-1], ends[1:]
    while a.size:
        bad = np.max(np.abs(_at_nodes(solid, a, b) @ to_modes.T)[..., -2:], axis=(0, 2)) > _LEFT
        a, b = a[bad], b[bad]
        if np.any(b - a < _SHORTEST * b):
            raise NotConverged(
                f"the modulus or Poisson's ratio jumps near the depth {b[np.argmin(b - a)]:.6g} (in the unit of the "
                "solid), and is not resolved there",
                Failure.SOLID,
            )
        middle = 0.5 * (a + b)
        ends = np.union1d(ends, middle)
        a, b = np.concatenate([a, middle]), np.concatenate([middle, b])
    return ends
