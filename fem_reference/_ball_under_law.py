r"""Traction of a ball under any law of the gap over a half-space, through the pair potential of that.

A law p(d) belongs to the pair potential phi(s) = p''(s)/(2 pi s).  Of a ball of the radius R the part at the distance s
of a point has the area pi s (R^2 - (D - s)^2)/D, with the distance D = R + d of the centre, so that

    T = {R [p(d) + p(d + 2 R)] - int p ds}/D = -(1/D) int p'(s) (D - s) ds,

integrals over the ball, from d to d + 2 R.

The face is where the repulsion diverges: `singular_gap`, or, for a law without one, a gap of -z0.
"""

from __future__ import annotations

import math

import numpy as np

from fem_reference._typing import Array
from fem_reference.laws import SurfaceLaw

__all__ = ["face_gap", "rate_of_ball", "traction_of_ball"]

#: Radius over the distance of the centre below which the second form is taken, by quadrature: the first one cancels to
#: the third power of it.
_FAR = 0.1

#: Nodes of the quadrature, over which nothing changes within a radius by more than _FAR.
_GAUSS = np.polynomial.legendre.leggauss(16)


def face_gap(law: SurfaceLaw) -> float:
    """Gap at which a point is on the face."""
    return law.singular_gap if math.isfinite(law.singular_gap) else -law.z0


def traction_of_ball(law: SurfaceLaw, d: Array, R: Array) -> Array:
    """T at distances of the surface of balls, shape of both.

    Examples
    --------
    >>> from fem_reference.laws import LennardJones
    >>> from fem_reference.interaction import Body
    >>> from fem_reference.profiles import Ball
    >>> law, d = LennardJones(work_of_adhesion=1.0, z0=1.0), np.array(1.5)
    >>> exact = Body(Ball(R=20.0), law).traction(np.array(0.0), np.array(0.5))
    >>> bool(abs(traction_of_ball(law, d, np.array(20.0)) - exact) < 1e-14)
    True
    """
    near, pole = d + face_gap(law), d + 2.0 * R + face_gap(law)
    value = R * (law.traction(near) + law.traction(pole)) - (law.energy(near) - law.energy(pole))
    far = _FAR * (R + d) > R
    if np.any(far):
        value = np.where(far, R * R * _slopes_over(law, d, np.where(far, R, 0.0), 1), value)
    return np.asarray(value / (R + d))


def rate_of_ball(law: SurfaceLaw, d: Array, R: Array, value: Array) -> Array:
    """Derivative by the distance of the traction `value`, shape of all."""
    near, pole = d + face_gap(law), d + 2.0 * R + face_gap(law)
    slopes = law.slope(near) + law.slope(pole)
    rate = R * slopes + law.traction(near) - law.traction(pole)
    far = _FAR * (R + d) > R
    if np.any(far):
        rate = np.where(far, R * (slopes - _slopes_over(law, d, np.where(far, R, 0.0), 0)), rate)
    return np.asarray((rate - value) / (R + d))


def _slopes_over(law: SurfaceLaw, d: Array, R: Array, power: int) -> Array:
    """Integral of p'(D + R u) u^power over u from -1 to 1."""
    x, weights = _GAUSS
    shape = (-1, *[1] * np.ndim(d))
    gap = d + R * (1.0 + x.reshape(shape)) + face_gap(law)
    return np.asarray(np.tensordot(weights * x**power, law.slope(gap), 1))
