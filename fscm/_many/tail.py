"""Tension beyond the mesh, for arrays of problems under the 9-3 law.

There p = -(8/3) [(f + a)^-3 - (f + a)^-9] with a = 1 - delta, expanded in a / f; f is a power of the radius.
"""

from __future__ import annotations

from math import comb
from typing import NamedTuple

import numpy as np

from fscm._typing import Array

__all__ = ["Tails", "tails_of"]

#: Terms in a / f, of which the last one bounds the error.
_TERMS = 5
_POWERS = np.arange(float(_TERMS))
#: Orders in 1 / f of the terms of both powers of the law, and their factors.
_ORDERS = np.concatenate([3.0 + _POWERS, 9.0 + _POWERS])
_FACTORS = np.concatenate(
    [sign * np.array([(-1.0) ** j * comb(m + j - 1, j) for j in range(_TERMS)]) for m, sign in ((3, -1.0), (9, 1.0))]
)


class Tails(NamedTuple):
    """Load and lift of the surface beyond the mesh; the lift is the same at all radii of the mesh.

    Attributes
    ----------
    load, lift : ndarray
    load_rate, lift_rate, load_slope, lift_slope : ndarray
        Their derivatives by log c and by delta.
    load_error, lift_error : ndarray
        Bounds on the error of the expansion.
    """

    load: Array
    lift: Array
    load_rate: Array
    lift_rate: Array
    load_slope: Array
    lift_slope: Array
    load_error: Array
    lift_error: Array


def tails_of(n: Array, k: Array, M: Array, radius: Array, displacement: Array) -> Tails:
    """Tails beyond the radius."""
    F, a, powers = (radius**n / n)[:, None], (1.0 - displacement)[:, None], np.tile(_POWERS, 2)
    terms = _FACTORS * F**-_ORDERS
    values, slopes = a**powers * terms, -powers * a ** np.maximum(powers - 1.0, 0.0) * terms
    parts = []
    for exponent, factor in ((np.ones(len(n)), 2.0), (-k, M * (1.0 - k))):
        # The integral of f^-m t^b beyond the radius.
        falls = _ORDERS * n[:, None] - exponent[:, None] - 1.0
        size = 8.0 / 3.0 * factor * radius ** (exponent + 1.0)
        value, slope, rate = (values / falls).sum(axis=1), (slopes / falls).sum(axis=1), -values.sum(axis=1)
        error = np.abs(values[:, _TERMS - 1] / falls[:, _TERMS - 1])
        parts.append((size * value, size * rate, size * slope, size * error))
    (load, load_rate, load_slope, load_error), (lift, lift_rate, lift_slope, lift_error) = parts
    return Tails(load, lift, load_rate, lift_rate, load_slope, lift_slope, load_error, lift_error)
