"""Gap of a contact from its pressure and the ring response of Eq. 6, by a tanh-sinh rule."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray
from scipy.special import ellipkm1, gamma, hyp2f1

from comparisons.models.cohesive_contact import CohesiveContact, ContactState
from comparisons.models.cohesive_profiles import pressure

Array = NDArray[np.float64]

T = np.linspace(-4.3, 4.3, 401)
FRACTION = 1.0 / (1.0 + np.exp(-np.pi * np.sinh(T)))
REST = 1.0 / (1.0 + np.exp(np.pi * np.sinh(T)))
WEIGHT = np.pi * np.cosh(T) * FRACTION * REST * (T[1] - T[0])


def integrate(f: Callable[[Array, Array, Array], Array], low: float, high: float) -> float:
    """Tanh-sinh rule; f gets t and its distances from `low` and from `high`, both without cancellation."""
    size = high - low
    return float(np.sum(f(low + size * FRACTION, size * FRACTION, size * REST) * WEIGHT) * size)


def ring(k: float, r: float, t: Array, distance: Array) -> Array:
    """Eq. 6 over 2 b c0^k / E*, distance = |r - t|: F((k+1)/2, (k+1)/2; 1; x^2) about x = 1 (DLMF 15.8.4)."""
    big = np.maximum(r, t)
    x2, y = (np.minimum(r, t) / big) ** 2, distance * (r + t) / big**2
    a, b = (1 + k) / 2, (1 - k) / 2
    if k == 0:
        F = 2 / np.pi * ellipkm1(y)
    else:
        z = np.minimum(y, 0.5)
        about_one = gamma(-k) / gamma(b) ** 2 * hyp2f1(a, a, 1 + k, z)
        about_one += z**-k * gamma(k) / gamma(a) ** 2 * hyp2f1(b, b, 1 - k, z)
        F = np.where(y < 0.3, about_one, hyp2f1(a, a, 1.0, np.minimum(x2, 0.75)))
    return np.where(r < t, t**-k, t * r ** -(k + 1.0)) * F


def kernel_gap(contact: CohesiveContact, state: ContactState, r: float) -> float:
    """H(r) = -delta + r^n / n + 2 (1 - k) integral of p G_k dt, tilde variables."""
    n, k = contact.punch.n, contact.punch.k
    a, c = float(state.contact_radius[0]), float(state.cohesive_radius[0])
    points = sorted({0.0, a, c, min(r, c)})
    w = 0.0
    for low, high in pairwise(points):

        def integrand(t: Array, up: Array, down: Array, low: float = low, high: float = high) -> Array:
            # One-sided values: the pressure of this interval even where t rounds to its end.
            p = pressure(contact, state, np.clip(t, np.nextafter(low, high), np.nextafter(high, low)))
            distance = up if r == low else down if r == high else np.abs(r - t)
            return p * ring(k, r, t, distance)

        w += integrate(integrand, low, high)
    return -float(state.displacement[0]) + r**n / n + 2 * (1 - k) * w
