r"""Integrals of a pair potential around the axis of a punch.

With the squared distances A of the nearest and B of the farthest point of a ring, C = (A + B)/2 and D = (B - A)/2,

    int (C - D cos phi)^-s dphi         = 2 pi A^(1/2-s) B^(-1/2) g(A/B),
    int cos phi (C - D cos phi)^-s dphi = 2 pi A^(1/2-s) B^(-1/2) (1 - A/B) k(A/B),

    g(t) = 2F1(1 - s, 1/2; 1; 1 - t),   k(t) = (s/4) 2F1(2 - s, 3/2; 3; 1 - t),

by a quadratic transformation of the Legendre functions P_(s-1) and P^1_(s-1).  For integers s both are polynomials of
t.  Otherwise they have a power t^(s-1/2) at t = 0, where the nearest point is close, and are smooth in a root of t.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
import scipy
from numpy.polynomial import chebyshev

from fem_reference._typing import Array

__all__ = ["Azimuth", "azimuth"]

#: Root of t in which both functions are smooth: t^(s-1/2) is then a power of six or more for all exponents above one.
_ROOT = 4

#: Nodes at which both are sampled, and relative size of the coefficients that are left out: the rounding of the samples
#: is half of it for s = 2.05 to 24 (measured).
_SAMPLES, _LEFT_OUT = 96, 3e-14


class Azimuth:
    """g and k of some s, as series in one variable.

    Parameters
    ----------
    orders : tuple of float
        s of each, above 1.

    Examples
    --------
    >>> g, k = azimuth((3.0,)).values(np.array([0.25]))[:, :, 0].T
    >>> float(g[0]), float(k[0])  # (3 + 2 t + 3 t^2)/8 and 3 (1 + t)/8
    (0.4609375, 0.46875)
    """

    def __init__(self, orders: tuple[float, ...]) -> None:
        self.orders = orders
        self._polynomial = all(s == round(s) for s in orders)
        columns = [self._powers if self._polynomial else self._series][0](orders)
        length = max(map(len, columns))
        self._coefficients = np.stack([np.pad(column, (0, length - len(column))) for column in columns], axis=1)

    @staticmethod
    def _powers(orders: tuple[float, ...]) -> list[Array]:
        """Coefficients of t^i, all positive: those of 2F1(1 - s, b; 1 - s + b - ...; t) up to a factor."""
        columns = []
        for s in map(round, orders):
            for a, b, c, factor in ((1 - s, 0.5, 1.0, 1.0), (2 - s, 1.5, 3.0, 0.25 * s)):
                rows = [1.0]
                for i in range(-a):
                    rows.append(rows[-1] * (a + i) * (b + i) / ((a + b - c + 1.0 + i) * (i + 1.0)))
                column = np.array(rows)
                columns.append(column * (factor / column.sum()))  # both are `factor` at t = 1
        return columns

    @staticmethod
    def _series(orders: tuple[float, ...]) -> list[Array]:
        """Chebyshev coefficients in the root of t, by interpolation at Chebyshev points."""
        columns = []
        angle = math.pi * (np.arange(_SAMPLES) + 0.5) / _SAMPLES
        t = (0.5 * (1.0 + np.cos(angle))) ** _ROOT
        transform = np.cos(np.outer(np.arange(_SAMPLES), angle)) * 2.0 / _SAMPLES
        transform[0] *= 0.5
        for s in orders:
            for samples in (
                scipy.special.hyp2f1(1.0 - s, 0.5, 1.0, 1.0 - t),
                0.25 * s * scipy.special.hyp2f1(2.0 - s, 1.5, 3.0, 1.0 - t),
            ):
                column = transform @ samples
                large = np.flatnonzero(np.abs(column) > _LEFT_OUT * np.abs(column).max())
                columns.append(column[: large[-1] + 1])
        return columns

    def values(self, t: Array) -> Array:
        """g and k of each s, shape (s, 2, *t.shape)."""
        degree = self._coefficients.shape[0] - 1
        flat = t.ravel()
        if self._polynomial:
            basis = np.empty((degree + 1, flat.size))
            basis[0] = 1.0
            for i in range(degree):
                np.multiply(basis[i], flat, out=basis[i + 1])
        else:
            basis = chebyshev.chebvander(2.0 * np.sqrt(np.sqrt(flat)) - 1.0, degree).T
        return (self._coefficients.T @ basis).reshape(len(self.orders), 2, *t.shape)


@lru_cache(maxsize=32)
def azimuth(orders: tuple[float, ...]) -> Azimuth:
    """Return the functions of some s."""
    return Azimuth(orders)
