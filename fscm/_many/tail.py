"""Tension beyond the mesh, for arrays of problems under the 9-3 law.

There p = -(8/3) [(f + a)^-3 - (f + a)^-9] with a = 1 - delta, expanded in a / f; f is a power of the radius.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fscm._typing import Array

__all__ = ["Tails", "tails_of"]

#: Terms in a / f, of which the last one bounds the error.
_TERMS = 5


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
    F, a = radius**n / n, 1.0 - displacement
    parts = []
    for exponent, factor in ((1.0, 2.0), (-k, M * (1.0 - k))):
        value, slope, rate, last = (np.zeros(len(n)) for _ in range(4))
        for power, sign in ((3.0, -1.0), (9.0, 1.0)):
            binomial = np.ones(len(n))
            for j in range(_TERMS):
                # The integral of f^-(m + j) t^b beyond the radius.
                order = power + j
                term = sign * binomial * F**-order / (order * n - exponent - 1.0)
                value, last = value + a**j * term, np.abs(a**j * term)
                rate = rate - (order * n - exponent - 1.0) * a**j * term
                slope = slope - (j * a ** (j - 1) * term if j else 0.0)
                binomial = binomial * -(power + j) / (j + 1.0)
            if power == 3.0:
                error = last
        size = 8.0 / 3.0 * factor * radius ** (exponent + 1.0)
        parts.append((size * value, size * rate, size * slope, size * error))
    (load, load_rate, load_slope, load_error), (lift, lift_rate, lift_slope, lift_error) = parts
    return Tails(load, lift, load_rate, lift_rate, load_slope, lift_slope, load_error, lift_error)
