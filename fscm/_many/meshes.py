"""Common meshes: panels graded towards the edge at s = 1, of which every mesh takes those that its problems need."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from fscm._many.response import INTEGRATION_ERROR, Orders, ResponseTable
from fscm._surface.mesh import PanelMesh, gauss_rule
from fscm._typing import Array

__all__ = ["CommonMesh", "Panels", "panels_for"]

#: Panels beyond s = 2 that reach twice as far as the one before, and cuts of the innermost panel that halve it.
_DOUBLED, _HALVED = 12, 2
#: Numbers of panels of the meshes; few of them, so that many problems share a mesh.
_EDGES = (2, 3, 4, 6, 8, 11, 14, 17, 20, 24, 28, 32, 36, 40, 44)
_TIPS = (2, 4, 7)
_FARS = (2, 4, 6, 9, 12, 16)
#: The edge panels are at most half as long as the edge is wide, and shorter by this power of two above this gradient
#: exponent: the error of the pressure there is at most 1e-4 of the largest tension.
_STEEP, _STEEPER = 0.35, 5.0
#: Height of the punch at the end of the mesh, and least radius there in that of the edge.
_END_HEIGHT, _LEAST_END = 1e4, 2.5
#: At the end of the innermost panel, r^n / n is about 2^-_TIP_HEIGHT or less.
_TIP_HEIGHT = 10.0

#: Additional end, at s = 3: the gap rises steeply there.
_SPLIT = 2.0


class Panels(NamedTuple):
    """Numbers of panels.

    Attributes
    ----------
    edge : int
        Halvings of the distance from the edge on either side.
    tip : int
        Cuts of the innermost panel: the first few halve it, the others quarter it.
    far : int
        Panels beyond s = 2: the first few reach twice as far as the one before, the others four times.
    """

    edge: int
    tip: int
    far: int

    @property
    def finer(self) -> Panels:
        """Panels of the second solution: one more cut at either side of the edge and at the tip, and a later end."""
        return Panels(self.edge + 1, self.tip + 1, self.far + 1)

    @property
    def offsets(self) -> Array:
        """Ends of the panels relative to s = 1."""
        cut, distant = np.arange(self.tip, -1.0, -1.0), np.arange(1.0, self.far + 1.0)
        tip = 0.5 ** (1.0 + cut + np.maximum(cut - _HALVED, 0.0)) - 1.0
        far = 2.0 ** (1.0 + distant + np.maximum(distant - _DOUBLED, 0.0)) - 1.0
        halves = 0.5 ** np.arange(1.0, self.edge + 1.0)
        return np.concatenate([[-1.0], tip, -halves[1:], [0.0], halves[::-1], [1.0, _SPLIT], far])


def _at_least(numbers: tuple[int, ...], wanted: Array) -> Array:
    """The next larger of the numbers; the largest of all for more."""
    index = np.searchsorted(numbers, np.ceil(wanted - 1e-9))
    return np.array(numbers)[np.minimum(index, len(numbers) - 1)]


def panels_for(n: Array, k: Array, log_scale: Array, width: Array) -> list[Panels]:
    """Panels that problems need.

    Parameters
    ----------
    n, k : ndarray
    log_scale, width : ndarray
        Logarithm of the radius of the edge; width of the edge relative to it.
    """
    edge = 1.0 - np.log2(width) + _STEEPER * np.maximum(k - _STEEP, 0.0)
    doublings = np.log2(np.maximum(np.exp(np.log(_END_HEIGHT * n) / n - log_scale), _LEAST_END)) - 1.0
    far = np.where(doublings <= _DOUBLED, doublings, 0.5 * (doublings + _DOUBLED))
    cuts = log_scale / np.log(2.0) + _TIP_HEIGHT / n - 1.0
    tip = np.where(cuts <= _HALVED, cuts, 0.5 * (cuts + _HALVED))
    numbers = _at_least(_EDGES, edge), _at_least(_TIPS, tip), _at_least(_FARS, far)
    return [Panels(*map(int, row)) for row in zip(*numbers, strict=True)]


class CommonMesh:
    """Nodes and weights of the panels, of both orders.

    Attributes
    ----------
    offsets : ndarray
        Ends of the panels relative to s = 1.
    orders : Orders
    table : ResponseTable
    coefficients : ndarray, shape (terms, panels, fine, panels, coarse)
        Of the response.
    uncertain : ndarray, shape (panels, panels)
        Largest error of an entry of each block: the last two coefficients, and the integration.
    coarse, fine : PanelMesh
    count : int
        Number of panels.
    edge_nodes : slice
        Coarse nodes of the panel inside the edge.
    to_fine, to_coarse : ndarray
        Interpolation on a panel between the orders.
    at_end : ndarray
        Interpolation to the end of a panel.
    to_slopes : ndarray
        Derivative on a panel of unit length, at its coarse nodes.
    end : float
        Radius s where the mesh ends.
    """

    def __init__(self, panels: Panels, orders: Orders, table: ResponseTable) -> None:
        self.offsets, self.orders, self.table = panels.offsets, orders, table
        self.coefficients = table.coefficients(self.offsets, orders)
        sizes = np.array([np.abs(coefficient).max(axis=(1, 3)) for coefficient in self.coefficients])
        self.uncertain = sizes[-2:].sum(axis=0) + INTEGRATION_ERROR * sizes.sum(axis=0)
        self.coarse, self.fine = (PanelMesh(self.offsets, order, 1.0) for order in (orders.coarse, orders.fine))
        self.count = len(self.offsets) - 1
        inner = int(np.searchsorted(self.offsets, 0.0)) - 1
        self.edge_nodes = slice(inner * orders.coarse, (inner + 1) * orders.coarse)
        rule, fine_rule = gauss_rule(orders.coarse), gauss_rule(orders.fine)
        self.to_fine, self.to_coarse = rule.interpolation(fine_rule.nodes), fine_rule.interpolation(rule.nodes)
        self.at_end = rule.interpolation(np.ones(1))[0]
        polynomials = legendre.legvander(2.0 * rule.nodes - 1.0, rule.order - 2)
        self.to_slopes = 2.0 * polynomials @ legendre.legder(rule.to_modes)
        self.end = float(1.0 + self.offsets[-1])

    def refined(self, values: Array) -> Array:
        """Values at the coarse nodes, shape (b, N), at the fine ones."""
        by_panel = values.reshape(len(values), self.count, self.orders.coarse)
        return np.asarray((by_panel @ self.to_fine.T).reshape(len(values), -1))

    def slopes(self, values: Array) -> Array:
        """Derivatives by s of functions with values at the coarse nodes, shape (b, N), there."""
        by_panel = values.reshape(len(values), self.count, self.orders.coarse)
        return np.asarray((by_panel @ self.to_slopes.T / self.coarse.lengths[:, None]).reshape(len(values), -1))

    def transferred(self, w: Array, k: Array, target: CommonMesh) -> Array:
        """Deformations, shape (b, N), on another mesh; beyond this one they decrease as under a distant load."""
        offsets = target.coarse.node_offsets
        beyond = offsets > self.offsets[-1]
        values = np.stack([self.coarse.evaluate_at_offsets(row, offsets[~beyond]) for row in w])
        share = self.coarse.nodes[-1] / target.coarse.nodes[beyond]
        return np.concatenate([values, w[:, -1:] * share ** (1.0 + k[:, None])], axis=1)

    def by_modes(self, first: Array, second: Array) -> Array:
        """Sizes of the integrals of a product over the panels, summed over the Legendre modes; shape (b,)."""
        order = self.orders.fine
        shape, to_modes = (len(first), self.count, order), gauss_rule(order).to_modes.T
        modes = np.abs((first.reshape(shape) @ to_modes) * (second.reshape(shape) @ to_modes))
        return np.asarray((modes @ (1.0 / (2.0 * np.arange(order) + 1.0))) @ self.fine.lengths)
