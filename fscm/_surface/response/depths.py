"""Division of the depth into intervals on which the elastic constants are polynomials to rounding."""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial import chebyshev

from fscm._typing import Array
from fscm.errors import Failure, NotConverged
from fscm.solids import GradedHalfSpace

__all__ = ["depth_intervals"]

#: Degree of the polynomials, and largest size of the last two coefficients of log E and nu: the remainder is below the
#: error of the integration.
_DEGREE, _LEFT = 10, 1e-11
#: First depth of the geometric division, in units of the length of the solid, and its ratio.
_FIRST, _RATIO = 1.0 / 64.0, 2.0
#: An interval shorter than this share of its depth is a jump that is not among the interfaces of the solid.
_SHORTEST = 1e-9


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
        z = a[:, None] + 0.5 * (b - a)[:, None] * (1.0 + nodes)
        values = np.stack([np.log(solid.modulus(z.ravel())), solid.poisson(z.ravel())]).reshape(2, *z.shape)
        bad = np.max(np.abs(values @ to_modes.T)[..., -2:], axis=(0, 2)) > _LEFT
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
