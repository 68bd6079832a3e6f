"""Common meshes: panels graded towards the edge at s = 1, of which every mesh takes those that its problems need."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from fscm._many.response import ResponseTable
from fscm._surface.mesh import PanelMesh, gauss_rule
from fscm._typing import Array

__all__ = ["CommonMesh", "Nodes", "Panels", "panels_for"]

#: Panels beyond s = 2 that reach twice as far as the one before, and cuts of the innermost panel that halve it.
_DOUBLED, _HALVED = 12, 4
#: Numbers of panels of the meshes; few of them, so that many problems share a mesh.
_EDGES = (2, 3, 4, 6, 8, 11, 14, 17, 20, 24, 28, 32, 36, 40, 44)
_TIPS = (2, 4, 7)
_FARS = (2, 4, 6, 9, 12, 16)
#: The edge panels are shorter than the edge is wide by the first power of two at least, and by so much more above this
#: gradient exponent: the error of the pressure there is at most 2e-5 of the largest tension.
_EDGE_CUTS, _STEEP, _STEEPER = 1.25, 0.25, 5.5
#: Height of the punch at the end of the mesh: the first number, and the second one times the height at the edge; least
#: radius there in that of the edge.
_END_HEIGHT, _END_RATIO, _LEAST_END = 2e3, 1e3, 2.5
#: At the end of the innermost panel, r^n / n is about 2^-_TIP_HEIGHT or less.
_TIP_HEIGHT = 6.0
#: Additional ends: at s = 3, where the gap rises steeply; at s = 3/8 if the tip has most cuts, since the pressure of a
#: sharp punch is the harder to resolve the wider the panel.
_SPLIT, _PARTED = 2.0, -0.625


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
    def offsets(self) -> Array:
        """Ends of the panels relative to s = 1."""
        cut, distant = np.arange(self.tip, -1.0, -1.0), np.arange(1.0, self.far + 1.0)
        tip = 0.5 ** (1.0 + cut + np.maximum(cut - _HALVED, 0.0)) - 1.0
        far = 2.0 ** (1.0 + distant + np.maximum(distant - _DOUBLED, 0.0)) - 1.0
        halves = 0.5 ** np.arange(1.0, self.edge + 1.0)
        parted = [_PARTED] if self.tip >= _TIPS[-1] else []
        return np.concatenate([[-1.0], tip[:-1], parted, -halves, [0.0], halves[::-1], [1.0, _SPLIT], far])


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
    edge = _EDGE_CUTS - np.log2(width) + _STEEPER * np.maximum(k - _STEEP, 0.0)
    end = (_END_HEIGHT * n * np.exp(-n * log_scale) + _END_RATIO) ** (1.0 / n)
    doublings = np.log2(np.maximum(end, _LEAST_END)) - 1.0
    far = np.where(doublings <= _DOUBLED, doublings, 0.5 * (doublings + _DOUBLED))
    cuts = log_scale / np.log(2.0) + _TIP_HEIGHT / n - 1.0
    tip = np.where(cuts <= _HALVED, cuts, 0.5 * (cuts + _HALVED))
    numbers = _at_least(_EDGES, edge), _at_least(_TIPS, tip), _at_least(_FARS, far)
    return [Panels(*map(int, row)) for row in zip(*numbers, strict=True)]


class CommonMesh:
    """Panels with the nodes of the residual, and those of the pressure of both solutions.

    Attributes
    ----------
    offsets : ndarray
        Ends of the panels relative to s = 1.
    table : ResponseTable
    coefficients : ndarray, shape (terms, panels, fine, panels, coarse)
        Of the response.
    uncertain : ndarray, shape (panels, panels)
        Largest error of an entry of each block.
    fine : PanelMesh
    first : tuple of Nodes
    second : Nodes
    count : int
        Number of panels.
    end : float
        Radius s where the mesh ends.
    """

    def __init__(self, panels: Panels, table: ResponseTable) -> None:
        self.offsets, self.table = panels.offsets, table
        self.coefficients, self.uncertain = table.coefficients(self.offsets)
        self.fine, self.count = PanelMesh(self.offsets, table.orders.fine, 1.0), len(self.offsets) - 1
        first, coarse, _, _ = table.orders
        self.second = Nodes(self.offsets, coarse, self.fine.order, coarse)
        self.first = tuple(Nodes(self.offsets, order, self.fine.order, coarse) for order in first)
        self.end = float(1.0 + self.offsets[-1])

    def modes(self, values: Array) -> Array:
        """Legendre coefficients of functions with values at the fine nodes, shape (b, count, fine)."""
        return np.asarray(self.by_panel(values) @ self.fine.rule.to_modes.T)

    def by_panel(self, values: Array) -> Array:
        """Values at the fine nodes, shape (b, N), panel by panel."""
        return values.reshape(len(values), self.count, self.fine.order)


class Nodes:
    """Nodes of the pressure.

    Attributes
    ----------
    mesh : PanelMesh
    edge : slice
        Nodes of the panel inside the edge.
    to_fine, to_coarse : ndarray
        Interpolation on a panel to the nodes of the residual, and from them.
    to_coefficients : ndarray
        Interpolation on a panel to the nodes to which the coefficients of the response belong.
    at_end : ndarray
        Interpolation to the end of a panel.
    to_slopes : ndarray
        Derivative on a panel of unit length, at its nodes.
    """

    def __init__(self, offsets: Array, order: int, fine: int, of_coefficients: int) -> None:
        self.mesh = PanelMesh(offsets, order, 1.0)
        inner = int(np.searchsorted(offsets, 0.0)) - 1
        self.edge = slice(inner * order, (inner + 1) * order)
        rule, fine_rule = gauss_rule(order), gauss_rule(fine)
        self.to_fine, self.to_coarse = rule.interpolation(fine_rule.nodes), fine_rule.interpolation(rule.nodes)
        self.to_coefficients = rule.interpolation(gauss_rule(of_coefficients).nodes)
        self.at_end = rule.interpolation(np.ones(1))[0]
        polynomials = legendre.legvander(2.0 * rule.nodes - 1.0, rule.order - 2)
        self.to_slopes = 2.0 * polynomials @ legendre.legder(rule.to_modes)

    def interpolated(self, values: Array, rows: Array) -> Array:
        """Values at these nodes, shape (b, N), times the same rows on every panel."""
        by_panel = values.reshape(len(values), -1, self.mesh.order)
        return np.asarray((by_panel @ rows.T).reshape(len(values), -1))

    def slopes(self, values: Array) -> Array:
        """Derivatives by s of functions with values at these nodes, shape (b, N), there."""
        lengths = np.repeat(self.mesh.lengths, self.mesh.order)
        return self.interpolated(values, self.to_slopes) / lengths
