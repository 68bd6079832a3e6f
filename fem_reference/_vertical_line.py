"""Energy of a traction along a vertical line, by quadrature."""

from __future__ import annotations

import math

import numpy as np

from fem_reference._surface_force import Interaction
from fem_reference._typing import Array

__all__ = ["energy_above"]

#: Nodes of a piece in the logarithm of the depth, and ratios of the depths of the pieces, of which the last one is
#: repeated: short ones where the repulsion is, of whose power d^-21 they leave 9e-10, and of d^-4 less than 1e-15.
_GAUSS = np.polynomial.legendre.leggauss(10)
_RATIOS = 2.0, 2.0, 4.0, *[8.0] * 30

#: Those for a law from a table, whose fifth derivative jumps at its points.
_RATIOS_OF_A_TABLE = *[1.25] * 20, *_RATIOS

#: Relative change of the energy by another piece, in place of a power of the depth, at which there are enough.
_CHANGE = 1e-9


def energy_above(interaction: Interaction, rho: Array, gap: Array, face: float, smooth: bool = True) -> Array:
    """Integral of p from a gap to infinity.

    Parameters
    ----------
    interaction : Interaction
    rho, gap : ndarray
    face : float
        Gap at which a point is on the face.
    smooth : bool
        Whether the law is no table.
    """
    rho, gap = np.broadcast_arrays(np.asarray(rho, float), np.asarray(gap, float))
    start, total = gap - face, np.zeros(rho.shape)
    x, weights = _GAUSS
    energy = np.full(rho.shape, np.inf)
    for ratio in _RATIOS if smooth else _RATIOS_OF_A_TABLE:
        half = 0.5 * math.log(ratio)
        depth = start * np.exp(half * (1.0 + x.reshape(-1, *[1] * start.ndim)))
        total = total + half * np.tensordot(weights, depth * interaction.traction(rho, depth + face), 1)
        start = ratio * start
        left, slope = interaction.traction(rho, start + face), interaction.slopes(rho, start + face)[1]
        # A power of the exponent q = -start slope/left beyond: start left/(q - 1).
        before, falling = energy, -(start * slope + left)
        energy = total + np.divide(start * left**2, falling, out=np.zeros_like(left), where=falling != 0.0)
        if not np.any(np.abs(energy - before) > _CHANGE * np.abs(energy)):
            break
    return np.asarray(energy)
