"""Functions of the elements on the surface of the half-space, and their quadrature."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import linalg

from fem_reference._elastic.gauss import unit_gauss
from fem_reference._elastic.line_functions import line_functions, line_slopes
from fem_reference._elastic.mesh import Grid
from fem_reference._typing import Array, Index

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
    functions : ndarray of int, shape (e, order + 1)
        Those that do not vanish on an element: both vertices, then its edge functions.
    local : ndarray, shape (e, q/e, order + 1)
        Their values.
    edge : int
        Index of the vertex at s = 1 (its function is 1 there and all others vanish).
    order : int
        Polynomial order.
    """

    nodes: Array
    s: Array
    weight: Array
    phi: Array
    functions: Index
    local: Array
    edge: int
    order: int

    @property
    def extent(self) -> float:
        """Outer end of the surface mesh."""
        return float(self.nodes[-1])

    def evaluate(self, s: Array) -> Array:
        """Return function values at any radii inside the mesh, shape (len(s), m)."""
        return line_functions(self.nodes, self.order, np.asarray(s, float))

    def mass_times(self, density: Array, X: Array) -> Array:
        """Return M X, with M_ij the sum of phi_i phi_j times a density at the Gauss points; X of shape (m, m)."""
        e = self.functions.shape[0]
        M = np.swapaxes(self.local, 1, 2) @ (density.reshape(e, -1, 1) * self.local)
        parts = M @ X[self.functions]
        product = np.zeros_like(X)
        product[:e] = parts[:, 0]
        product[1 : e + 1] += parts[:, 1]
        product[e + 1 :] = parts[:, 2:].reshape(-1, X.shape[1])
        return product

    def projection(self, values: Array) -> Array:
        """Return the coefficients, shape (m,), closest in the mean square to values at the Gauss points."""
        root = np.sqrt(self.weight)
        weighted = root[:, None] * self.phi
        return np.asarray(linalg.lstsq(weighted, root * values, check_finite=False, lapack_driver="gelsy")[0])

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
    phi = line_functions(nodes, order, s)
    e = nodes.size - 1
    element = np.arange(e)[:, None]
    functions = np.hstack([element, element + 1, e + 1 + element * (order - 1) + np.arange(order - 1)])
    local = np.take_along_axis(phi.reshape(e, -1, phi.shape[1]), functions[:, None, :], axis=2)
    return Trace(nodes, s, weight, phi, functions, local, int(np.argmin(abs(nodes - 1.0))), order)
