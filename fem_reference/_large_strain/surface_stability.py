"""Tension under which the flat surface of a compressible neo-Hookean solid becomes unstable.

A half-space under a tension T normal to its deformed surface is stretched by F in depth, with

    T = G (F - 1/F) + lambda ln F / F.

Waves of the surface, e^(iqx - kappa qz), change no energy of the second order at the stretch where the tractions of
both decaying waves are dependent (the surface instability of Biot, here with a load that follows the surface).  There
is no length in it: at that tension waves of every length grow.  An incompressible solid is not stretched, and stays
stable.
"""

from __future__ import annotations

import math

import numpy as np

from fem_reference._roots import root_between

__all__ = ["largest_tension"]

#: Stretches between which the first instability is searched for.
STRETCHES = np.linspace(1.0 + 1e-3, 3.0, 400)


def largest_tension(nu: float) -> float:
    """Return the tension at which a flat surface becomes unstable, relative to E/(1 - nu^2); inf if there is none.

    Examples
    --------
    >>> round(largest_tension(0.3), 4), largest_tension(0.5)
    (0.5481, inf)
    """
    if nu >= 0.49:
        return math.inf
    values = [_determinant(F, nu)[0] for F in STRETCHES]
    change = np.flatnonzero(np.sign(values[1:]) != np.sign(values[:-1]))
    if not change.size:
        return math.inf
    i = int(change[0])
    F = root_between(lambda F: _determinant(F, nu)[0], STRETCHES[i], STRETCHES[i + 1])
    return _determinant(F, nu)[1] * (1.0 - nu**2)


def _determinant(F: float, nu: float) -> tuple[float, float]:
    """Determinant of the tractions of both waves over the difference of their decays, and the tension; E is 1."""
    G = 0.5 / (1.0 + nu)
    lame = 2.0 * G * nu / (1.0 - 2.0 * nu)
    tension = G * (F - 1.0 / F) + lame * math.log(F) / F
    rest = G - lame * math.log(F)
    along, across, coupled = G + lame + rest, G + (lame + rest) / F**2, (lame + rest) / F
    # (G kappa^2 - along) U + coupled kappa W = 0 and (across kappa^2 - G) W - coupled kappa U = 0.
    squares = np.roots([G * across, coupled**2 - G * G - along * across, along * G])
    decays = np.sqrt(squares.astype(complex))
    rows = []
    for kappa in np.where(decays.real < 0.0, -decays, decays):
        U, W = coupled * kappa, along - G * kappa**2
        rows.append([-G * kappa * U - (rest / F + tension) * W, -across * kappa * W + (lame / F - tension) * U])
    determinant = (rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0]) / (decays[0] - decays[1])
    return float(determinant.real if abs(determinant.real) > abs(determinant.imag) else determinant.imag), tension
