"""Neo-Hookean solid: stress and tangent from the displacement gradient, with and without a pressure of its own.

    psi = G/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2,      F = I + grad u, J = det F

has the stress dpsi/dF = G F + (q - G) F^-T with q = lambda ln J.  In the mixed form q is an unknown of its own and
ln J = q/lambda a second equation, which holds for an incompressible solid (1/lambda = 0) as well.

Gradients are ordered rr, rz, hoop, zr, zz: the first three belong to u_r, the others to u_z.  To come from the linear
solid, strains may be multiplied by a `finiteness` t: psi(I + t grad u)/t^2 is the linear energy as t -> 0.
"""

from __future__ import annotations

import numpy as np

from fem_reference._typing import Array

__all__ = ["Kinematics", "kinematics", "stress", "tangent"]

#: Gradients of one element point.
GRADIENTS = 5

#: Places of those gradients in F: row and column, the hoop apart.
PLACES = ((0, 0, 0), (1, 0, 1), (3, 1, 0), (4, 1, 1))
HOOP = 2


class Kinematics:
    """Deformation gradient and what follows from it, at points of elements.

    Attributes
    ----------
    F : ndarray, shape (5, e, q)
        Entries of the deformation gradient in the order of the gradients.
    inverse : ndarray, shape (5, e, q)
        Those of F^-T, the derivatives of ln J by F.
    log_J : ndarray, shape (e, q)
        ln J.
    """

    __slots__ = ("F", "finiteness", "inverse", "log_J")

    def __init__(self, F: Array, inverse: Array, log_J: Array, finiteness: float) -> None:
        self.F, self.inverse, self.log_J, self.finiteness = F, inverse, log_J, finiteness


def kinematics(gradients: Array, finiteness: float = 1.0) -> Kinematics | None:
    """Return the kinematics of gradients, shape (5, e, q); None where the solid would be turned inside out.

    Examples
    --------
    >>> doubled = kinematics(np.array([1.0, 0.0, 1.0, 0.0, 1.0]).reshape(5, 1, 1))
    >>> bool(abs(doubled.log_J[0, 0] - 3 * np.log(2.0)) < 1e-15), doubled.inverse[:, 0, 0].tolist()
    (True, [0.5, -0.0, 0.5, -0.0, 0.5])
    >>> kinematics(np.array([-2.0, 0.0, 0.0, 0.0, 0.0]).reshape(5, 1, 1)) is None
    True
    """
    F = finiteness * gradients
    F[[0, HOOP, 4]] += 1.0
    det = F[0] * F[4] - F[1] * F[3]
    if not (det.min() > 0.0 and F[HOOP].min() > 0.0):
        return None
    inverse = np.stack([F[4] / det, -F[3] / det, 1.0 / F[HOOP], -F[1] / det, F[0] / det])
    # ln J of small gradients without cancellation.
    g = finiteness * gradients
    area = g[0] + g[4] + g[0] * g[4] - g[1] * g[3]
    return Kinematics(F, inverse, np.log1p(area) + np.log1p(g[HOOP]), finiteness)


def stress(state: Kinematics, shear: Array, q: Array) -> Array:
    """Return dpsi/dgradients, shape (5, e, q), from the shear modulus and q = lambda ln J, both of shape (e, q)."""
    t = state.finiteness
    return np.asarray((shear * (state.F - state.inverse) + t * q * state.inverse) / t)


def tangent(state: Kinematics, shear: Array, q: Array, lame: Array) -> Array:
    """Return the derivative of the stress, shape (5, 5, e, q), with that part of lambda with which q follows from u."""
    C = state.inverse
    D = np.zeros((GRADIENTS, *C.shape))
    difference = shear - state.finiteness * q
    for a, i, J in PLACES:
        for b, k, L in PLACES:
            crossed = C[PLACES[2 * k + J][0]] * C[PLACES[2 * i + L][0]]
            D[a, b] = difference * crossed
    D[HOOP, HOOP] = difference * C[HOOP] ** 2
    for a in range(GRADIENTS):
        D[a, a] += shear
        D[a] += lame * C[a] * C
    return D


def energy(state: Kinematics, shear: Array, lame: Array) -> Array:
    """Return psi, shape (e, q)."""
    F, t = state.F, state.finiteness
    # I1 - 3 - 2 ln J from the gradients, without the cancellation of the threes.
    first = (F[0] - 1.0) ** 2 + F[1] ** 2 + (F[HOOP] - 1.0) ** 2 + F[3] ** 2 + (F[4] - 1.0) ** 2
    first += 2.0 * (F[0] + F[HOOP] + F[4] - 3.0 - state.log_J)
    return np.asarray(0.5 * (shear * first + lame * state.log_J**2) / t**2)
