r"""Limit of finite strain for mu -> infinity and small strain, by the elastic energy of third order.

In units of E* and the contact radius a, the linear field of JKR is that of an approach h = a^2/R by Hertz and of a flat
punch that is raised by -d.  To first order in the strain, what finite strain changes of the energy at given approach
and contact is the energy of third order of this field.  For the neo-Hookean solid
psi = G/2 (I1 - 3 - 2 ln J) + lambda/2 (ln J)^2, with the gradient H of the displacement,

    e3 = -(G/3) tr H^3 - (lambda/2) tr H tr H^2,

which is finite for nu = 1/2, since lambda tr H = -2 nu S with the harmonic function S that is the pressure at the
surface.  Its integral is a homogeneous polynomial Q(h, d) of degree three.  At the pull-off of JKR, d = -(4/3) h, the
load of a given contact changes by (3/2) Q_h - (1/2) Q_d, and contacts beside it have the same load to first order.
That the punch touches displaced points, r + u_r, and the work of adhesion counts for their area, cancels there.

The fields are those of the load p(r) with the transform sin(xi)/xi (flat punch) and 2 (sin(xi) - xi cos(xi))/xi^3
(Hertz): closed forms of rho = sqrt(r^2 + (z - i)^2) = zeta - i eta with oblate coordinates zeta, eta.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from comparisons.model import Array

#: Nodes of a side of each square of the quadrature (measured: 20 nodes have 12 digits).
_NODES = 32

#: Rise of a flat punch over the approach of Hertz at the pull-off of JKR: d/h.
_RAISED = -4.0 / 3.0


@lru_cache(maxsize=64)
def strain_limit(nu: float) -> float:
    """Return s / (a/R), where s is the relative change of the pull-off force of JKR by finite strain, for a/R -> 0.

    Parameters
    ----------
    nu : float
        Poisson's ratio, 0 to 0.5.

    Examples
    --------
    >>> round(strain_limit(0.5), 4), round(strain_limit(0.3), 4)
    (0.0294, -0.0044)
    """

    def energy(h: float, d: float) -> float:
        return third_order_energy(h, d, nu)

    # Exact differences of a polynomial of degree three.
    by_hertz = 0.5 * (energy(2.0, _RAISED) - energy(0.0, _RAISED)) - energy(1.0, 0.0)
    by_punch = 0.5 * (energy(1.0, _RAISED + 1.0) - energy(1.0, _RAISED - 1.0)) - energy(0.0, 1.0)
    load = 2.0 * _RAISED + 4.0 / 3.0
    return float((1.5 * by_hertz - 0.5 * by_punch) / load)


def third_order_energy(h: float, d: float, nu: float) -> float:
    """Return the energy of third order of a linear field, in units of E*.

    Parameters
    ----------
    h, d : float
        Approach by Hertz, and of the flat punch, for a contact radius of 1.
    nu : float
        Poisson's ratio, 0 to 0.5.

    Examples
    --------
    The load of Hertz on an incompressible solid changes by 9/4 of it, times sqrt(delta/R):

    >>> round(2.25 * third_order_energy(1.0, 0.0, 0.5), 4)
    -0.0651
    """
    r, z, volume, flat, hertz = _fields()
    # Gradient of the displacement in units in which 2 G = 1, so that E* = 1/(1 - nu).
    A0, A1, B0, B1, C1 = (h * hertz + d * flat) / (np.pi * (1.0 - nu))
    free = 1.0 - 2.0 * nu
    hoop = (z * A1 - free * C1) / r
    rr, zz = z * B0 - free * A0 - hoop, -free * A0 - z * B0
    rz, zr = 2.0 * (1.0 - nu) * A1 - z * B1, -2.0 * (1.0 - nu) * A1 - z * B1
    trace, determinant = rr + zz, rr * zz - rz * zr
    square = trace**2 - 2.0 * determinant + hoop**2
    cube = trace**3 - 3.0 * trace * determinant + hoop**3
    return float(volume @ (nu * A0 * square - cube / 6.0) * (1.0 - nu))


@lru_cache(maxsize=1)
def _fields() -> tuple[Array, Array, Array, Array, Array]:
    """Radii, depths and volumes of the nodes, and the potentials of both loads there."""
    zeta, eta, volume = _quadrature()
    r, z = np.sqrt((1.0 + zeta**2) * (1.0 - eta**2)), zeta * eta
    return r, z, volume, *_potentials(r, z, zeta - 1j * eta)


def _quadrature() -> tuple[Array, Array, Array]:
    """Oblate coordinates of the nodes, and their volumes.

    Two triangles meet at the edge of the contact, zeta = eta = 0, where the field is singular as 1/sqrt(zeta^2 +
    eta^2); beyond zeta = 1 the variable is 1/zeta.
    """
    x, weights = np.polynomial.legendre.leggauss(_NODES)
    s, t = (grid.ravel() for grid in np.meshgrid(0.5 * (x + 1.0), 0.5 * (x + 1.0), indexing="ij"))
    area = 0.25 * np.outer(weights, weights).ravel()
    zeta = np.concatenate([s, s * t, 1.0 / s])
    eta = np.concatenate([s * t, s, t])
    volume = 2.0 * np.pi * (zeta**2 + eta**2) * np.concatenate([area * s, area * s, area / s**2])
    return zeta, eta, volume


def _potentials(r: Array, z: Array, rho: NDArray[np.complex128]) -> tuple[Array, Array]:
    """Integrals over xi of p exp(-xi z) times xi J0, xi J1, xi^2 J0, xi^2 J1 and J1, of both loads: shape (5, m)."""
    Z = z - 1j
    L = np.log(Z + rho)
    flat = 1.0 / rho, -Z / (r * rho), Z / rho**3, r / rho**3, (rho - Z) / r
    # A superposition of flat punches of the radii t < 1 with the weight 2 t.
    hertz = (
        2.0 * z * L - 2.0 * rho,
        (Z * rho - r**2 * L - 2.0 * z * rho) / r,
        2.0 * (Z - z) / rho - 2.0 * L,
        2.0 * (r**2 + z * Z) / (r * rho),
        (z * (Z * rho + r**2 * L - Z**2) - 2.0 * (rho**3 - Z**3) / 3.0) / r,
    )
    return np.imag(flat), np.imag(hertz)
