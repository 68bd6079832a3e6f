"""Other lengths of the elements, whose differences tell the error by bends that falls slowly with the degree, or not.

At a kink of the punch, a line of the mesh, the pressure bends, and the error falls like a power of the degree.  A law
from a table bends at its rows, at gaps that move over the mesh.  A punch may have knots: radii at which a
derivative of any order jumps, and which are no lines of the mesh.  The elements themselves show them: on each, the
coefficients of a smooth height fall to its rounding.
"""

from __future__ import annotations

import math

import numpy as np

from fem_reference._contact.mesh_lengths import KINK_HEIGHT, kinks_within
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._typing import Array
from fem_reference.cohesive_laws import CohesiveTrapezoid
from fem_reference.problem import Problem
from fem_reference.profiles import Ball
from fem_reference.punch import radius_at_height
from fem_reference.tabulated_law import TabulatedLaw

__all__ = ["OTHER_LENGTHS", "has_knots", "other_lengths"]

#: Ratios of other lengths of the elements, whose differences tell the error by kinks of a law (measured: at most 0.44
#: of the sum of both bounds in 44 values on seven solids, of which eight were up to 11 times outside by degrees alone).
#: The round corners of a trapezoid are such kinks for the elements (by degrees alone 1.6 bounds outside, mu = 3), and
#: so are the knots of a punch (by degrees alone up to 5 bounds outside).
OTHER_LENGTHS = (0.6, 0.8, 1.25)

#: Degree of the coefficients of the height of a punch on an element.
KNOT_DEGREE = 24

#: Smallest coefficient of a knot, relative to the height or the length of the law: smooth punches are below 3e-13.  A
#: knot with a coefficient c moves a force by at most 41 c of it (measured with jumps of order 2 and 3 at 8 radii).
KNOT_SIZE = 1e-10


def other_lengths(problem: Problem, spec: MeshSpec, size: float) -> tuple[float, ...]:
    """Return the ratios of other lengths that tell the error by kinks of law or punch, or by knots of the punch.

    Parameters
    ----------
    problem : Problem
    spec : MeshSpec
        The mesh on which the error is told.
    size : float
        Radius of its edge.
    """
    of_law = isinstance(problem.law, CohesiveTrapezoid | TabulatedLaw)
    bends = of_law or kinks_within(problem) or has_knots(problem, size * spec.grid().r)
    return OTHER_LENGTHS if bends else ()


def has_knots(problem: Problem, lines: Array) -> bool:
    """Whether a derivative of a punch jumps between the lines of a mesh, within the reach of the law.

    The innermost element has a part of the bound of its own.  A ball has no knots, though the coefficients next to its
    end do not fall to rounding: its singularity is beyond.

    Examples
    --------
    >>> from fem_reference import CustomPunch, LennardJones, PowerLaw
    >>> def bent(r):
    ...     return r**2 + 0.1 * np.maximum(r - 1.5, 0.0) ** 3
    >>> problem = Problem(PowerLaw(E0=1.0, c0=1.0, k=0.0, nu=0.3), CustomPunch(bent, 3.0), LennardJones(1.0, 1.0))
    >>> has_knots(problem, np.array([0.0, 1.0, 2.0, 4.0])), has_knots(problem, np.array([0.0, 1.0, 1.5, 4.0]))
    (True, False)
    """
    if isinstance(problem.punch, Ball):
        return False
    length = problem.law.z0
    lines = np.minimum(lines[1:, None], radius_at_height(problem.punch, KINK_HEIGHT * length))
    low, high = lines[:-1], lines[1:]
    angles = math.pi * (np.arange(KNOT_DEGREE + 1) + 0.5) / (KNOT_DEGREE + 1)
    heights = problem.punch.height(low + (high - low) * 0.5 * (1.0 + np.cos(angles)))
    # Two neighbours, because a knot in the middle makes one of them small.
    weights = 2.0 / (KNOT_DEGREE + 1) * np.cos(np.outer((KNOT_DEGREE - 1, KNOT_DEGREE), angles))
    coefficients = np.abs(heights @ weights.T).max(axis=1)
    return bool(np.any(coefficients > KNOT_SIZE * np.maximum(heights.max(axis=1), length)))
