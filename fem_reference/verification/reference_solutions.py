"""Exact surface displacements of the power-law half-space.

A normal point load displaces the surface as 1/distance^(1+k), so an axisymmetric pressure p gives
w(r) = (2 b c0^k / E*) times the integral of p(t) t (r+t)^-(1+k) 2F1((k+1)/2, 1/2; 1; 4 r t / (r+t)^2) dt
(Eqs. 6-8 of the paper).  For the pressures below the Riesz potential is known in closed form.
"""

from __future__ import annotations

import math

import numpy as np
from scipy import special

from fem_reference._typing import Array

__all__ = ["gaussian_displacement", "power_displacement", "ring_displacement", "surface_constant"]


def surface_constant(k: float, nu: float) -> float:
    """Return the factor b(k, nu) of Eq. 7; b = 1 for k = 0.

    Examples
    --------
    >>> surface_constant(0.0, 0.3), round(surface_constant(1e-6, 0.3), 5)
    (1.0, 1.0)
    """
    if k == 0:
        return 1.0
    q = math.sqrt((1.0 + k) * (1.0 - k * nu / (1.0 - nu)))
    top = 2.0 ** (k + 1.0) * (k + 2.0) * q * math.sin(0.5 * math.pi * q)
    ratio = special.beta(0.5 * (3.0 + k + q), 0.5 * (3.0 + k - q)) / special.beta(0.5 * k, 0.5)
    return float(top / (k * (k + 1.0)) * ratio)


def ring_displacement(r: Array, k: float, nu: float) -> Array:
    """w(r), r != 1, under a ring of unit force a length at r = 1 on E = z^k (Eq. 6).

    Examples
    --------
    >>> w = ring_displacement(np.array([0.0, 1e6]), 0.0, 0.0)
    >>> [round(float(x), 9) for x in w * [1.0, 1e6]]  # 2 at the centre; far away the force 2 pi over pi r
    [2.0, 2.0]
    """
    r = np.asarray(r, float)
    distance = special.hyp2f1(0.5 * (1.0 + k), 0.5, 1.0, 4.0 * r / (1.0 + r) ** 2) / (1.0 + r) ** (1.0 + k)
    return np.asarray(2.0 * surface_constant(k, nu) * (1.0 - nu**2) * distance)


def gaussian_displacement(r: Array, k: float, nu: float) -> Array:
    """w(r) under p = exp(-r^2) on E = z^k: b (1 - nu^2) Gamma((1-k)/2) 1F1((1+k)/2; 1; -r^2).

    Examples
    --------
    >>> w = gaussian_displacement(np.array([0.0]), 0.0, 0.0)
    >>> bool(abs(w[0] - np.sqrt(np.pi)) < 1e-14)
    True
    """
    factor = surface_constant(k, nu) * (1.0 - nu**2) * special.gamma(0.5 * (1.0 - k))
    return np.asarray(factor * special.hyp1f1(0.5 * (1.0 + k), 1.0, -(np.asarray(r, float) ** 2)))


def power_displacement(r: Array, k: float, nu: float, beta: float) -> Array:
    """w(r), r <= 1, under p = (1 - r^2)^beta on the unit disc, on E = z^k.

    beta = 0 is the uniform disc, (1 + k)/2 the Hertz pressure (w is a parabola), -(1 - k)/2 the flat punch
    (w is constant): b (1 - nu^2) B((1-k)/2, beta + 1) 2F1((1+k)/2, -beta - (1-k)/2; 1; r^2).

    Examples
    --------
    >>> w = power_displacement(np.array([0.0, 1.0]), 0.0, 0.0, 0.5)  # Hertz: pi/4 (2 - r^2)
    >>> [round(float(x), 12) for x in w / np.pi]
    [0.5, 0.25]
    """
    factor = surface_constant(k, nu) * (1.0 - nu**2) * special.beta(0.5 * (1.0 - k), beta + 1.0)
    shape = special.hyp2f1(0.5 * (1.0 + k), -beta - 0.5 * (1.0 - k), 1.0, np.asarray(r, float) ** 2)
    return np.asarray(factor * shape)
