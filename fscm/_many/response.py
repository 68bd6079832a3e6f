"""Response of one panel to the pressure on another as a function of the gradient exponent, shared by many problems.

(1 - k) G_k is analytic in k, with its nearest singularities at k = 2 and k = -1.  So every block of the matrix of
`fscm._surface.deformation`, times the power k of the distance d of its panels, is expanded in Chebyshev polynomials of
k.  Its smooth part grows as d^k, so that the coefficients fall more slowly the narrower the panels are.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from fscm._many.kernels import Kernels, are_apart
from fscm._surface.deformation import response_blocks
from fscm._surface.kernel import kernel_of
from fscm._surface.mesh import PanelMesh, gauss_rule
from fscm._typing import Array

__all__ = ["INTEGRATION_ERROR", "INTERVALS", "Interval", "Orders", "ResponseTable", "assembled", "scales"]

#: Distance in lengths of a panel beyond which it is integrated by its Gauss rule, and the error of that relative to the
#: largest entry of a block (measured worst 2.5e-12 for k = 0.7, between panels that double).
_NEAR, INTEGRATION_ERROR = 0.875, 5e-12


class Orders(NamedTuple):
    """Orders of the approximations.

    Attributes
    ----------
    first : tuple of int
        Nodes a panel of the pressure of a first solution, and of another one where the bound is too large.
    coarse, fine : int
        Those of the second solution, and of the residuals.
    terms : int
        Of the expansion in k.
    """

    first: tuple[int, int]
    coarse: int
    fine: int
    terms: int


class Interval(NamedTuple):
    """An interval of k with its own expansion, and the orders there."""

    low: float
    high: float
    orders: Orders


#: The deformation is the more singular at the ends of panels the larger k is.
INTERVALS = (
    Interval(0.0, 0.35, Orders((6, 7), 8, 12, 14)),
    Interval(0.35, 0.67, Orders((6, 7), 8, 12, 14)),
    Interval(0.67, 0.8, Orders((8, 9), 10, 14, 12)),
)


class ResponseTable:
    """Expansions of the blocks between the panels of meshes, for k in one interval.

    Parameters
    ----------
    interval : Interval
    meshes : iterable of ndarray
        Ends of the panels of each mesh relative to s = 1.
    """

    def __init__(self, interval: Interval, meshes: Iterable[Array]) -> None:
        self._low, self._high, self.orders = interval
        orders = self.orders
        cosines = np.cos(np.pi * (np.arange(orders.terms) + 0.5) / orders.terms)
        self._nodes = 0.5 * (self._low + self._high + (self._high - self._low) * cosines)
        self._kernels = Kernels(self._nodes)
        self._to_coefficients = np.linalg.inv(chebyshev.chebvander(cosines, orders.terms - 1))
        self._to_fine = gauss_rule(orders.coarse).interpolation(gauss_rule(orders.fine).nodes)
        self._panels: dict[tuple[float, float], int] = {}
        indices = [
            (offsets, np.array([self._panels.setdefault(panel, len(self._panels)) for panel in _panels(offsets)]))
            for offsets in meshes
        ]
        lacking = np.zeros((len(self._panels), len(self._panels)), bool)
        for _, panels in indices:
            lacking[np.ix_(panels, panels)] = True
        self._rows = np.cumsum(lacking).reshape(lacking.shape) - 1
        self._blocks = np.empty((int(lacking.sum()), orders.terms, orders.fine, orders.coarse))
        for offsets, panels in indices:
            targets, sources = np.nonzero(lacking[np.ix_(panels, panels)])
            rows = self._rows[panels[targets], panels[sources]]
            if rows.size:
                self._blocks[rows] = self._expanded(offsets, targets, sources)
            lacking[np.ix_(panels, panels)] = False
        sizes = np.array([np.abs(block).max(axis=(1, 2)) for block in self._blocks]).reshape(-1, orders.terms)
        self._uncertain = sizes[:, -2:].sum(axis=1) + INTEGRATION_ERROR * sizes.sum(axis=1)

    def coefficients(self, offsets: Array) -> tuple[Array, Array]:
        """Coefficients of the scaled blocks between the panels of a mesh, and the largest error of an entry of each.

        The shapes are (terms, m, fine, m, coarse) and (m, m); the error is that of the last two coefficients and of
        the integration.
        """
        panels = [self._panels[panel] for panel in _panels(offsets)]
        (_, coarse, fine, terms), m, rows = self.orders, len(panels), self._rows[np.ix_(panels, panels)]
        coefficients = np.empty((terms, m, fine, m, coarse))
        # Row by row: the blocks of a row are in the cache when they are transposed.
        for i, row in enumerate(rows):
            coefficients[:, i] = self._blocks[row].transpose(1, 2, 0, 3)
        return coefficients, self._uncertain[rows]

    def _expanded(self, offsets: Array, targets: NDArray[np.intp], sources: NDArray[np.intp]) -> Array:
        _, coarse, fine, terms = self.orders
        mesh = PanelMesh(offsets, fine, -float(offsets[0]))
        distance = _distances(offsets)[targets, sources]
        values = np.empty((terms, len(targets), fine, coarse))
        apart = are_apart(mesh, targets, sources, _NEAR)
        values[:, apart] = self._kernels.blocks(mesh, targets[apart], sources[apart], distance[apart]) @ self._to_fine
        close = ~apart
        for i, k in enumerate(self._nodes):
            blocks = response_blocks(kernel_of(float(k)), mesh, targets[close], sources[close], _NEAR) @ self._to_fine
            values[i, close] = ((1.0 - k) * distance[close] ** k)[:, None, None] * blocks
        return np.tensordot(values, self._to_coefficients, axes=(0, 1)).transpose(0, 3, 1, 2)

    def polynomials(self, k: Array) -> Array:
        """Chebyshev polynomials at exponents, shape (len(k), terms)."""
        x = (2.0 * k - self._low - self._high) / (self._high - self._low)
        return np.asarray(chebyshev.chebvander(x, self.orders.terms - 1), float)


def _panels(offsets: Array) -> list[tuple[float, float]]:
    return list(pairwise(offsets.tolist()))


def scales(offsets: Array, k: Array) -> Array:
    """Powers -k of the distances of the panels, shape (len(k), m, m)."""
    return np.exp(-k[:, None, None] * np.log(_distances(offsets)))


def assembled(weights: Array, coefficients: Array, scale: Array) -> Array:
    """Sums of weighted coefficients as matrices, shape (b, m fine, m coarse).

    Parameters
    ----------
    weights : ndarray, shape (b, terms)
    coefficients : ndarray, shape (terms, m, fine, m, coarse)
    scale : ndarray, shape (b, m, m)
        Of the blocks.
    """
    terms, m, fine, _, coarse = coefficients.shape
    rows = (weights @ coefficients.reshape(terms, -1)).reshape(len(weights), m, fine, m * coarse)
    rows *= np.repeat(scale, coarse, axis=2)[:, :, None]
    return rows.reshape(len(weights), m * fine, m * coarse)


def _distances(offsets: Array) -> Array:
    """Distances of the panels plus their lengths, with which the response scales; shape (m, m)."""
    start, end, length = offsets[:-1], offsets[1:], np.diff(offsets)
    between = np.maximum(start[:, None] - end, start - end[:, None])
    return np.asarray(np.maximum(between, 0.0) + np.maximum(length[:, None], length))
