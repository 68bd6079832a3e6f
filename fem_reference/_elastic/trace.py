"""Functions of the elements on the surface of the half-space, and their quadrature."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import linalg

from fem_reference._elastic.gauss import unit_gauss
from fem_reference._elastic.line_functions import line_functions, line_slopes
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
        return line_functions(self.nodes, self.order, np.asarray(s, float))

    def projection(self, values: Array) -> Array:
        """Return the coefficients, shape (m,), closest in the mean square to values at the Gauss points."""
        root = np.sqrt(self.weight)
        return np.asarray(linalg.lstsq(root[:, None] * self.phi, root * values, check_finite=False)[0])

    def slopes(self, s: Array) -> Array:
        """Return the derivatives of the functions at any radii inside the mesh, on the outer side of a node."""
        return line_slopes(self.nodes, self.order, np.asarray(s, float))


def trace_of(grid: Grid, order: int) -> Trace:
    """Return the trace space of a grid on its surface, with a Gauss rule that resolves the surface law."""
    nodes = grid.r
    x, w = unit_gauss(2 * order + 2)
    h = np.diff(nodes)[:, None]
    s = (nodes[:-1, None] + h * x).ravel()
    weight = (h * w).ravel()
    return Trace(nodes, s, weight, line_functions(nodes, order, s), int(np.argmin(abs(nodes - 1.0))), order)
