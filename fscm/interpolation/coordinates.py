r"""Coordinates of the atlas, in which its quantities are smooth, and the cells in each of which a bound holds.

The natural measure of the compliance is M' = 2 mu^((2n+k-1)/n) n^((1-k)/n): it is the M of Eq. 28 for radii in units of
(n Q z0)^(1/n).  A patch reaches from a smallest to a largest Tabor number, which may depend on n and k.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fscm._typing import Array

__all__ = [
    "BOX",
    "CELLS",
    "LEAST_MU",
    "MOST_MU",
    "Cells",
    "Coordinates",
    "cells_of",
    "patch_ends",
    "plane_cells",
    "reduced_compliance",
    "seam",
]

#: Smallest and largest parameters of the atlas.
BOX: dict[str, tuple[float, float]] = {"n": (1.0, 6.0), "k": (0.0, 0.8), "mu": (0.01, 10.0)}
#: Smallest and largest Tabor number of the atlas.
LEAST_MU, MOST_MU = BOX["mu"]
#: Cells in each direction.
CELLS = 3
#: Numbers of the cells of n, of k and, but for the critical Tabor number, of mu.
Cells = tuple[NDArray[np.int_], ...]
#: Reciprocals of the shape index; the load integral of the 9-3 law diverges at n = 2/3.
_LEAST_NU, _MOST_NU = 1.0 / BOX["n"][1], 1.0 / BOX["n"][0]
_MOST_K = BOX["k"][1]


def seam(n: Array) -> Array:
    """Largest Tabor number of the lower patch, above every critical one.

    Examples
    --------
    >>> float(seam(np.array([1.0]))[0])
    1.1
    """
    return 0.65 + 0.45 / n


def patch_ends(upper: bool, n: Array, critical: Array) -> tuple[Array | float, Array | float]:
    """Smallest and largest Tabor number of a patch."""
    return (critical, MOST_MU) if upper else (LEAST_MU, seam(n))


def reduced_compliance(n: Array, k: Array, mu: Array) -> Array:
    """M'.

    Examples
    --------
    >>> float(reduced_compliance(np.array([1.0]), np.array([0.4]), np.array([1.0]))[0])
    2.0
    """
    return 2.0 * np.exp(((2.0 * n + k - 1.0) * np.log(mu) + (1.0 - k) * np.log(n)) / n)


@dataclass(frozen=True)
class Coordinates:
    """Map of the parameters of a patch to the cube from -1 to 1.

    Attributes
    ----------
    scale : tuple of float
        Coefficients a of ln c = a0 + a1/n + a2 k + a3 k/n + a4/n^2; the third coordinate is linear in ln(1 + c M').
    n_pole, k_pole : float
        Distances beyond n = 1 and k = 0.8, in 1/n and k, of the singularities of the logarithms in which the first two
        coordinates are linear; infinite for coordinates that are linear in 1/n and k.
    root : bool
        Whether the third coordinate is linear in the square root of the share: at the cusp, the states at the two folds
        are smooth functions of it.

    Examples
    --------
    >>> cube = Coordinates((0.0, 0.0, 0.0, 0.0, 0.0), math.inf, math.inf)
    >>> n, k, mu = np.array([1.0, 6.0]), np.array([0.0, 0.8]), np.array([0.01, 10.0])
    >>> cube.plane(n, k).round(12).tolist()
    [[1.0, -1.0], [-1.0, 1.0]]
    >>> [round(float(x), 12) for x in cube.share(n, k, mu, 0.01, 10.0)]
    [0.0, 1.0]
    """

    scale: tuple[float, ...]
    n_pole: float
    k_pole: float
    root: bool = False

    def plane(self, n: Array, k: Array) -> Array:
        """First two coordinates, shape (m, 2)."""
        of_n = _linear_or_log(1.0 / n, _LEAST_NU, _MOST_NU, self.n_pole)
        return np.stack([of_n, _linear_or_log(k, 0.0, _MOST_K, self.k_pole)], axis=-1)

    def share(self, n: Array, k: Array, mu: Array, low: Array | float, high: Array | float) -> Array:
        """Share of the way from the smallest Tabor number of the patch to the largest, 0 to 1."""
        a, nu = self.scale, 1.0 / n
        c = np.exp(a[0] + a[1] * nu + a[2] * k + a[3] * k * nu + a[4] * nu * nu)
        x, start, end = (np.log1p(c * reduced_compliance(n, k, np.broadcast_to(m, n.shape))) for m in (mu, low, high))
        return (x - start) / (end - start)

    def cube(self, n: Array, k: Array, share: Array) -> Array:
        """All three coordinates, shape (m, 3)."""
        along = np.sqrt(np.maximum(share, 0.0)) if self.root else share
        return np.concatenate([self.plane(n, k), 2.0 * along[:, None] - 1.0], axis=-1)


def _linear_or_log(x: Array, low: float, high: float, pole: float) -> Array:
    if math.isinf(pole):
        return (2.0 * x - low - high) / (high - low)
    start, end = -math.log(high - low + pole), -math.log(pole)
    return 2.0 * (-np.log(high + pole - x) - start) / (end - start) - 1.0


#: Coordinates in which nothing is transformed.
_LINEAR = Coordinates((0.0, 0.0, 0.0, 0.0, 0.0), math.inf, math.inf)


def _cells(coordinate: Array) -> NDArray[np.int_]:
    """Numbers of cells that have as many Chebyshev nodes each."""
    angle = np.arccos(np.clip(-coordinate, -1.0, 1.0))
    return np.minimum((angle * (CELLS / math.pi)).astype(np.int_), CELLS - 1)


def plane_cells(n: Array, k: Array) -> Cells:
    """Numbers of the cells in 1/n and k.

    Examples
    --------
    >>> [int(number[0]) for number in plane_cells(np.array([6.0]), np.array([0.4]))]
    [0, 1]
    """
    plane = _LINEAR.plane(n, k)
    return _cells(plane[:, 0]), _cells(plane[:, 1])


def cells_of(upper: bool, n: Array, k: Array, mu: Array, critical: Array) -> Cells:
    """Numbers of the cells in 1/n, k and the logarithm of mu."""
    low, high = patch_ends(upper, n, critical)
    return *plane_cells(n, k), _cells(2.0 * np.log(mu / low) / np.log(high / low) - 1.0)
