r"""Potential of a ball under any law, in any consistent units.

The attraction between half-spaces p(d) determines the pair potential, phi(s) = p''(s)/(2 pi s): p'(d) is minus the
integral of phi over a plane at the distance d.  A sphere of the radius s around a point cuts the area
pi s (R^2 - (D - s)^2)/D out of a ball of the radius R at the distance D of the center, so that

    T = 1/(2 D) int p''(s) (R^2 - (D - s)^2) ds = {R [p(D - R) + p(D + R)] - e(D - R) + e(D + R)}/D

with the energy e of the law.  The second form cancels to the third power of R/D.
"""

from __future__ import annotations

import numpy as np

from fscm._typing import Array
from fscm.laws import SurfaceLaw

__all__ = ["ball_under_law"]

#: Radius over distance of the center below which the first form is integrated by a Gauss rule.
_FAR = 0.1
_GAUSS = np.polynomial.legendre.leggauss(20)


def ball_under_law(law: SurfaceLaw, d: Array, R: Array) -> tuple[Array, Array]:
    """T at distances d of the surface of balls, and its derivative by d; shape of both.

    Examples
    --------
    >>> from fscm import Ball, LennardJones
    >>> from fscm._ball import BallUnderMie
    >>> T, _ = ball_under_law(LennardJones(), np.array([1.5]), np.array([20.0]))
    >>> bool(abs(T[0] - BallUnderMie(Ball(R=20.0), LennardJones()).traction(np.array(0.0), np.array(0.5))) < 1e-14)
    True
    """
    d, R = np.broadcast_arrays(d, R)
    D, near = R + d, d + law.singular_gap
    far_pole = near + 2.0 * R
    p, p_pole = law.traction(near), law.traction(far_pole)
    value = (R * (p + p_pole) - (law.energy(near) - law.energy(far_pole))) / D
    rate = (R * (law.slope(near) + law.slope(far_pole)) + p - p_pole - value) / D
    far = np.flatnonzero(_FAR * D > R)
    if far.size:
        value, rate = np.array(value), np.array(rate)
        u, weights = _GAUSS
        R, D = R[far], D[far]
        curvature = law.curvature(D + R * u[:, None] + law.singular_gap)
        value[far] = 0.5 * R**3 / D * ((weights * (1.0 - u * u)) @ curvature)
        rate[far] = (R * R * ((weights * u) @ curvature) - value[far]) / D
    return value, rate
