"""Functions of the elements on the surface of the half-space, and their quadrature."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import linalg

from fem_reference._elastic.mesh import Grid
from fem_reference._typing import Array

__all__ = ["Trace", "trace_of"]


@dataclass(frozen=True, slots=True, eq=False)
class Trace:
    """Surface functions in surface order (vertices, then edge functions) at Gauss points.

    Attributes
    ----------
    nodes : ndarray, shape (e + 1,)
        Surface vertices.
    s : ndarray, shape (q,)
        Gauss points.
    weight : ndarray, shape (q,)
        Gauss weights of ds.
    phi : ndarray, shape (q, m)
        Function values.
    edge : int
        Index of the vertex at s = 1 (its function is 1 there and all others vanish).
    order : int
        Polynomial order.
    """

    nodes: Array
    s: Array
    weight: Array
    phi: Array
    edge: int
    order: int

    @property
    def extent(self) -> float:
        """Outer end of the surface mesh."""
        return float(self.nodes[-1])

    def evaluate(self, s: Array) -> Array:
        """Return function values at any radii inside the mesh, shape (len(s), m)."""
        return _line_functions(self.nodes, self.order, np.asarray(s, float))

    def projection(self, values: Array) -> Array:
        """Return the coefficients, shape (m,), closest in the mean square to values at the Gauss points."""
        root = np.sqrt(self.weight)
        return np.asarray(linalg.lstsq(root[:, None] * self.phi, root * values, check_finite=False)[0])

    def slopes(self, s: Array) -> Array:
        """Return the derivatives of the functions at any radii inside the mesh, on the outer side of a node."""
        return _line_slopes(self.nodes, self.order, np.asarray(s, float))


def _line_functions(nodes: Array, order: int, s: Array) -> Array:
    """Functions of scikit-fem's `ElementLinePp` in surface order, at radii `s`.

    Written out, because that class makes its polynomials again in every call, and the path evaluates one radius
    at a time.
    """
    element = np.clip(np.searchsorted(nodes, s, side="right") - 1, 0, nodes.size - 2)
    x = (s - nodes[element]) / np.diff(nodes)[element]
    legendre = np.polynomial.legendre.legvander(2.0 * x - 1.0, order)
    values = np.zeros((s.size, nodes.size + (nodes.size - 1) * (order - 1)))
    rows = np.arange(s.size)
    values[rows, element] = 1.0 - x
    values[rows, element + 1] = x
    for degree in range(2, order + 1):
        # The integral of the Legendre polynomial of one degree less, normalised.
        rise = legendre[:, degree] - legendre[:, degree - 2]
        values[rows, nodes.size + element * (order - 1) + degree - 2] = rise / np.sqrt(4.0 * degree - 2.0)
    return values


def _line_slopes(nodes: Array, order: int, s: Array) -> Array:
    """Derivatives of `_line_functions`."""
    element = np.clip(np.searchsorted(nodes, s, side="right") - 1, 0, nodes.size - 2)
    h = np.diff(nodes)[element]
    legendre = np.polynomial.legendre.legvander(2.0 * (s - nodes[element]) / h - 1.0, order - 1)
    slopes = np.zeros((s.size, nodes.size + (nodes.size - 1) * (order - 1)))
    rows = np.arange(s.size)
    slopes[rows, element] = -1.0 / h
    slopes[rows, element + 1] = 1.0 / h
    for degree in range(2, order + 1):
        column = nodes.size + element * (order - 1) + degree - 2
        slopes[rows, column] = np.sqrt(4.0 * degree - 2.0) * legendre[:, degree - 1] / h
    return slopes


def trace_of(grid: Grid, order: int) -> Trace:
    """Return the trace space of a grid on its surface, with a Gauss rule that resolves the surface law."""
    nodes = grid.r
    x, w = np.polynomial.legendre.leggauss(2 * order + 2)
    h = np.diff(nodes)
    s = (nodes[:-1, None] + 0.5 * h[:, None] * (x + 1.0)).ravel()
    weight = (0.5 * h[:, None] * w).ravel()
    return Trace(nodes, s, weight, _line_functions(nodes, order, s), int(np.argmin(abs(nodes - 1.0))), order)
