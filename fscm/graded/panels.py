"""Response of a graded solid between the nodes of a panel mesh: what its images take from that of its surface.

With the radii r = c s the response is c (W_0 - R(c)) with the matrix W_0 of the homogeneous solid and

    R_ij = int over a panel of L_j(t) t/(s_i + t) F(c (s_i + t), c |s_i - t|) dt,   F(A, B) = A sum_j a_j f(d_j),

from the table of F.  F has a kink at t = s_i, and is smooth to both sides of it on the scale of the solid: the panel of
a node is integrated on pieces that double in length from there on, and so are its neighbours where they are long.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fscm._deformation import Pieces, moments
from fscm._panels import PanelMesh, gauss_rule
from fscm._typing import Array
from fscm.graded.patches import ImageTable

__all__ = ["Remainder", "remainder"]

# Longest piece at the kink, and longest panel beside it for which the Gauss rule itself does, in units of the length of
# the solid: u^2 log u on it leaves (1/10)^2 times the inverse sixth power of the number of nodes, below 1e-10.
_FIRST, _SHORT = 0.1, 0.02
_EXTRA_NODES = 10


class Remainder:
    """R(c) and c dR/dc, and their rows for the axis.

    Attributes
    ----------
    matrix, rate : ndarray, shape (N, N)
    axis, axis_rate : ndarray, shape (N,)
    """

    def __init__(self, matrix: Array, rate: Array, axis: Array, axis_rate: Array) -> None:
        self.matrix, self.rate, self.axis, self.axis_rate = matrix, rate, axis, axis_rate


def _pieces(
    pair: NDArray[np.intp], sign: Array, near: Array, extent: Array, xi: Array, h: Array, first: float
) -> list[Pieces]:
    """Cover distances near ... near + extent by pieces no longer than their distance, or than `first`."""
    parts = []
    active = np.flatnonzero(extent > 0.0)
    near, extent, xi = near.copy(), extent.copy(), xi.copy()
    while active.size:
        allowed = np.maximum(near[active], first)
        length = np.where(extent[active] <= 1.5 * allowed, extent[active], allowed)
        parts.append(Pieces(pair[active], sign[active], near[active], length, xi[active]))
        near[active] += length
        extent[active] -= length
        xi[active] += sign[active] * length / h[active]
        active = active[extent[active] > 0.0]
    return parts


def _near_rows(
    table: ImageTable, c: float, first: float, r: Array, left: Array, right: Array, h: Array, order: int
) -> tuple[Array, Array]:
    """Rows, shape (pairs, order) each, of F and its rate for targets at the radii r.

    Parameters
    ----------
    left, right : ndarray
        Distance of the target from the start of the panel (positive behind it), and of the end from the target.
    """
    index = np.arange(len(r))
    parts: list[Pieces] = []
    v = left / h
    for sign, extent, gap in ((-1.0, left, -right), (1.0, right, -left)):
        # Inside: both sides from the target on.  Outside: one side, from the gap on.
        near = np.maximum(gap, 0.0)
        start = np.where(near > 0.0, 0.5 - 0.5 * sign, v)
        parts += _pieces(index, np.full(len(r), sign), near, np.maximum(extent - near, 0.0), start, h, first)
    p = Pieces.join(parts)
    rule = gauss_rule(order + _EXTRA_NODES)
    distance = p.near[:, None] + p.length[:, None] * rule.nodes
    radius = r[p.pair][:, None]
    t = radius + p.sign[:, None] * distance
    total = radius + t
    weights = p.length[:, None] * rule.weights * t / total
    found = table.of((c * total).ravel(), (c * distance).ravel())
    modes = gauss_rule(order).to_modes
    first_rows, rates = (
        moments(p, values.reshape(total.shape) * weights, rule.nodes, h, order, len(r)) @ modes for values in found
    )
    return first_rows, rates


def remainder(table: ImageTable, length: float, mesh: PanelMesh, c: float) -> Remainder:
    """R(c) on a mesh.

    Parameters
    ----------
    table : ImageTable
    length : float
        Shortest length over which the solid changes.
    mesh : PanelMesh
    c : float
        Radius of s = 1.
    """
    q, N, s, places, h = mesh.order, mesh.size, mesh.nodes, mesh.places, mesh.lengths
    i, j = np.triu_indices(N)
    both = table.of(c * (s[i] + s[j]), c * np.abs(places[i] - places[j]))
    weights = (s * mesh.weights) / (s[:, None] + s)
    on_axis = table.of(c * s, c * s)
    first = _FIRST * length / c
    # Distances of the nodes, and of the axis, from both ends of each panel.
    at = np.append(places, -mesh.origin)[:, None]
    left, right = at - mesh.offsets[:-1], mesh.offsets[1:] - at
    inside = (left > 0.0) & (right > 0.0)
    long = c * h > _SHORT * length
    near = inside | ((np.maximum(-left, -right) < h) & long)
    node, panel = np.nonzero(near)
    radius = np.append(s, 0.0)[node]
    rows = _near_rows(table, c, first, radius, left[node, panel], right[node, panel], h[panel], q)
    matrices, axes = [], []
    for values, on, row in zip(both, on_axis, rows, strict=True):
        matrix = np.empty((N + 1, N))
        matrix[i, j] = values
        matrix[j, i] = values
        matrix[:N] *= weights
        matrix[N] = on * mesh.weights
        matrix.reshape(N + 1, len(h), q)[node, panel] = row
        # In Fortran order, like the matrix that it is taken from.
        matrices.append(np.asfortranarray(matrix[:N]))
        axes.append(matrix[N].copy())
    return Remainder(*matrices, *axes)
