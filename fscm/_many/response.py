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
    coarse, fine : int
        Nodes a panel of the pressure, and of the residual.
    terms : int
        Of the expansion in k.
    """

    coarse: int
    fine: int
    terms: int


class Interval(NamedTuple):
    """An interval of k with its own expansion, and the orders of the first and of the second solution there."""

    low: float
    high: float
    first: Orders
    second: Orders


#: The deformation is the more singular at the ends of panels the larger k is.
INTERVALS = (
    Interval(0.0, 0.35, Orders(7, 12, 12), Orders(9, 12, 14)),
    Interval(0.35, 0.7, Orders(7, 12, 12), Orders(9, 12, 14)),
    Interval(0.7, 0.8, Orders(9, 14, 8), Orders(11, 14, 10)),
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
        low, high, _, orders = interval
        self._low, self._high, self.orders = low, high, orders
        cosines = np.cos(np.pi * (np.arange(orders.terms) + 0.5) / orders.terms)
        self._nodes = 0.5 * (low + high + (high - low) * cosines)
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

    def coefficients(self, offsets: Array, orders: Orders) -> Array:
        """Coefficients of the scaled blocks between the panels of a mesh, shape (terms, m, fine, m, coarse).

        The orders of the pressure and of the expansion are at most those of the table.
        """
        panels = [self._panels[panel] for panel in _panels(offsets)]
        (own, fine, _), (coarse, _, terms), m = self.orders, orders, len(panels)
        coarser = gauss_rule(coarse).interpolation(gauss_rule(own).nodes)
        coefficients = np.empty((terms, m, fine, m, coarse))
        # Row by row: the blocks of a row are in the cache when they are transposed.
        for i, rows in enumerate(self._rows[np.ix_(panels, panels)]):
            blocks = self._blocks[rows, :terms]
            if coarse != own:
                blocks = (blocks.reshape(-1, own) @ coarser).reshape(m, terms, fine, coarse)
            coefficients[:, i] = blocks.transpose(1, 2, 0, 3)
        return coefficients

    def _expanded(self, offsets: Array, targets: NDArray[np.intp], sources: NDArray[np.intp]) -> Array:
        coarse, fine, terms = self.orders
        mesh = PanelMesh(offsets, fine, -float(offsets[0]))
        distance = _distances(offsets)[targets, sources]
        values = np.empty((terms, len(targets), fine * coarse))
        for i, k in enumerate(self._nodes):
            blocks = response_blocks(kernel_of(float(k)), mesh, targets, sources, _NEAR) @ self._to_fine
            values[i] = ((1.0 - k) * distance**k)[:, None] * blocks.reshape(len(targets), -1)
        expanded = np.tensordot(values, self._to_coefficients, axes=(0, 1))
        return expanded.reshape(len(targets), fine, coarse, terms).transpose(0, 3, 1, 2)

    def polynomials(self, k: Array, terms: int) -> Array:
        """Chebyshev polynomials at exponents, shape (len(k), terms)."""
        x = (2.0 * k - self._low - self._high) / (self._high - self._low)
        return np.asarray(chebyshev.chebvander(x, terms - 1), float)


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
