"""Response of one panel to the pressure on another as a function of the gradient exponent, shared by many problems.

(1 - k) G_k is analytic in k, with its nearest singularities at k = 2 and k = -1.  So every block of the matrix of
`fscm._surface.deformation`, times the power k of the distance d of its panels, is expanded in Chebyshev polynomials of
k.  Its smooth part grows as d^k, so that the coefficients fall more slowly the narrower the panels are.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from fscm._surface.deformation import response_blocks
from fscm._surface.kernel import kernel_of
from fscm._surface.mesh import PanelMesh, gauss_rule
from fscm._typing import Array

__all__ = ["FIRST", "INTERVALS", "SECOND", "Orders", "ResponseTable", "assembled"]

#: Intervals of k, each with its own expansion.
INTERVALS = ((0.0, 0.4), (0.4, 0.8))


class Orders(NamedTuple):
    """Orders of the approximations.

    Attributes
    ----------
    coarse, fine : int
        Nodes a panel of the pressure, and of the residual.
    terms : int
        Of the expansion in k.
    """

    coarse: int
    fine: int
    terms: int


#: Orders of the first solution and of the second one, with which its error is measured.  The last coefficients are at
#: most 3e-10 and 3e-12 of a block (measured on the narrowest panels of the range).
FIRST, SECOND = Orders(10, 14, 15), Orders(12, 16, 17)


class ResponseTable:
    """Expansions of the blocks between panels, for k in one interval.

    Parameters
    ----------
    low, high : float
        The interval.
    orders : Orders
    """

    def __init__(self, low: float, high: float, orders: Orders) -> None:
        self._low, self._high, self.orders = low, high, orders
        cosines = np.cos(np.pi * (np.arange(orders.terms) + 0.5) / orders.terms)
        self._nodes = 0.5 * (low + high + (high - low) * cosines)
        self._to_coefficients = np.linalg.inv(chebyshev.chebvander(cosines, orders.terms - 1))
        self._to_fine = gauss_rule(orders.coarse).interpolation(gauss_rule(orders.fine).nodes)
        self._panels: dict[tuple[float, float], int] = {}
        self._rows = np.full((0, 0), -1)
        self._blocks = np.empty((0, orders.terms, orders.fine, orders.coarse))
        self._count = 0

    def coefficients(self, offsets: Array) -> Array:
        """Coefficients of the scaled blocks between the panels of a mesh, shape (terms, m, m, fine, coarse)."""
        panels = [self._panels.setdefault(panel, len(self._panels)) for panel in pairwise(offsets.tolist())]
        most = len(self._panels)
        if most > len(self._rows):
            old, size = len(self._rows), most + most // 2
            self._rows = np.pad(self._rows, (0, size - old), constant_values=-1)
        both = np.ix_(panels, panels)
        lacking = np.nonzero(self._rows[both] < 0)
        if lacking[0].size:
            stop = self._count + lacking[0].size
            if stop > len(self._blocks):
                self._blocks = np.concatenate([self._blocks[: self._count], np.empty((stop, *self._blocks.shape[1:]))])
            self._blocks[self._count : stop] = self._expanded(offsets, *lacking)
            targets, sources = (np.array(panels)[index] for index in lacking)
            self._rows[targets, sources] = np.arange(self._count, stop)
            self._count = stop
        return np.ascontiguousarray(self._blocks[self._rows[both]].transpose(2, 0, 1, 3, 4))

    def _expanded(self, offsets: Array, targets: NDArray[np.intp], sources: NDArray[np.intp]) -> Array:
        coarse, fine, terms = self.orders
        mesh = PanelMesh(offsets, fine, -float(offsets[0]))
        distance = _distances(offsets)[targets, sources]
        values = np.empty((terms, len(targets), fine * coarse))
        for i, k in enumerate(self._nodes):
            blocks = response_blocks(kernel_of(float(k)), mesh, targets, sources) @ self._to_fine
            values[i] = ((1.0 - k) * distance**k)[:, None] * blocks.reshape(len(targets), -1)
        expanded = np.tensordot(values, self._to_coefficients, axes=(0, 1))
        return expanded.reshape(len(targets), fine, coarse, terms).transpose(0, 3, 1, 2)

    def polynomials(self, k: Array) -> Array:
        """Chebyshev polynomials at exponents, shape (len(k), terms)."""
        x = (2.0 * k - self._low - self._high) / (self._high - self._low)
        return np.asarray(chebyshev.chebvander(x, self.orders.terms - 1), float)


def assembled(weights: Array, coefficients: Array, offsets: Array, k: Array) -> Array:
    """Sums of weighted coefficients as matrices, shape (b, m fine, m coarse), without the scale of the blocks.

    Parameters
    ----------
    weights : ndarray, shape (b, terms)
    coefficients : ndarray, shape (terms, m, m, fine, coarse)
    offsets : ndarray, shape (m + 1,)
    k : ndarray, shape (b,)
    """
    terms, m, _, fine, coarse = coefficients.shape
    blocks = (weights @ coefficients.reshape(terms, -1)).reshape(len(k), m, m, fine, coarse)
    blocks *= (_distances(offsets)[None] ** -k[:, None, None])[..., None, None]
    return blocks.transpose(0, 1, 3, 2, 4).reshape(len(k), m * fine, m * coarse)


def _distances(offsets: Array) -> Array:
    """Distances of the panels plus their lengths, with which the response scales; shape (m, m)."""
    start, end, length = offsets[:-1], offsets[1:], np.diff(offsets)
    between = np.maximum(start[:, None] - end, start - end[:, None])
    return np.asarray(np.maximum(between, 0.0) + np.maximum(length[:, None], length))
