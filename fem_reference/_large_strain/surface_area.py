"""Area of the deformed surface, on which the surface tension of the solid acts: residual, tangent and energy.

The energy is the tension times the excess of the area over that of its projection, per radian the integral of

    rho (L - rho') dr,      L = sqrt(rho'^2 + u_z'^2),

over the material radius, with the current radius rho = r + u_r.  The projection covers the same plane for any
displacement that vanishes far away, so that the plane surface is in balance; for small slopes the excess is
r u_z'^2/2.  Strains carry the factor t of `fem_reference._large_strain.material`, and the energy 1/t^2.
"""

from __future__ import annotations

import numpy as np

from fem_reference._large_strain.faces import Faces
from fem_reference._typing import Array

__all__ = ["excess", "excess_residual", "excess_tangent"]


def _lengths(faces: Faces) -> tuple[Array, Array]:
    """L, and L - rho' without cancellation where the surface is upright."""
    length = np.hypot(faces.stretch, faces.tilt)
    upright = faces.stretch > 0.0
    difference = np.where(
        upright, faces.tilt**2 / np.where(upright, length + faces.stretch, 1.0), length - faces.stretch
    )
    return length, difference


def excess(faces: Faces, weight: Array, finiteness: float) -> float:
    """Return the excess of the area per radian, over t^2."""
    return float(weight @ (faces.rho * _lengths(faces)[1])) / finiteness**2


def excess_residual(faces: Faces, weight: Array, N: Array, dN: Array, finiteness: float) -> tuple[Array, Array]:
    """Return the derivatives of the excess by both components.

    Parameters
    ----------
    faces : Faces
    weight : ndarray, shape (q,)
        Gauss weights of dr.
    N, dN : ndarray, shape (e, q/e, n)
        Functions of each element, and their derivatives.
    finiteness : float
        The factor t.

    Returns
    -------
    tuple of ndarray, shape (e, n)
    """
    length, difference = _lengths(faces)

    def integrals(values: Array, functions: Array) -> Array:
        return ((weight * values).reshape(N.shape[0], 1, -1) @ functions)[:, 0]

    by_stretch = -faces.rho * difference / length
    across = integrals(difference, N) + integrals(by_stretch, dN)
    return across / finiteness, integrals(faces.rho * faces.tilt / length, dN) / finiteness


def excess_tangent(faces: Faces, weight: Array, N: Array, dN: Array) -> Array:
    """Return the second derivatives of the excess, shape (e, 2 n, 2 n), components interleaved.

    The factors t of both derivatives are those of the energy.

    Parameters
    ----------
    faces, weight, N, dN
        As for `excess_residual`.
    """
    e, per, n = N.shape
    length, difference = _lengths(faces)
    rho, stretch, tilt = (values / length for values in (faces.rho, faces.stretch, faces.tilt))

    def product(test: Array, values: Array, functions: Array) -> Array:
        return np.swapaxes(test, 1, 2) @ ((weight * values).reshape(e, per, 1) * functions)

    K = np.empty((e, 2 * n, 2 * n))
    crossed = product(N, -difference / length, dN)
    K[:, 0::2, 0::2] = crossed + crossed.swapaxes(1, 2) + product(dN, rho * tilt**2, dN)
    K[:, 0::2, 1::2] = product(N, tilt, dN) - product(dN, rho * stretch * tilt, dN)
    K[:, 1::2, 0::2] = K[:, 0::2, 1::2].swapaxes(1, 2)
    K[:, 1::2, 1::2] = product(dN, rho * stretch**2, dN)
    return K
