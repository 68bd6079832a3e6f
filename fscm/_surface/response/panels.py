"""Response of the images of a graded solid between the nodes of a panel mesh.

With the radii r = c s the response is c (W_0 - R(c)) with the matrix W_0 of the homogeneous solid and

    R_ij = int over a panel of L_j(t) t/(s_i + t) F(c (s_i + t), c |s_i - t|) dt,   F(A, B) = A sum_j a_j f(d_j),

from the table of F.  F has a kink at t = s_i, and is smooth on both sides of it on the scale of the solid: the panel of
a node is integrated on pieces that double in length away from it, and so are its neighbours if they are long.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from fscm._surface.deformation import Pieces, moments
from fscm._surface.mesh import PanelMesh, gauss_rule
from fscm._surface.response.patches import ImageTable
from fscm._typing import Array

__all__ = ["Remainder", "remainder"]

#: Longest panel beside the kink for which the Gauss rule is used, in units of the length of the solid.
_SHORT = 0.02
#: Longest piece at the kink, in units of that length, and of the radius of the target, but at least _SHORT: F is smooth
#: there as a function of the root v of the distance, in which u^2 log u is v^4 log v^2.
_FIRST, _MIRROR = 0.5, 2.0
#: Ratio of the length of a piece farther out to its distance; the last one may be _LAST times longer.  The coefficients
#: of F on it fall like (2 + sqrt 3)^-m.
_GROWTH, _LAST = 2.0, 1.25
#: Nodes of a piece, in addition to those of a panel at the kink, and to half of them farther out.
_AT_KINK, _AWAY = 8, 9


class Remainder:
    """R(c) and c dR/dc, and their rows for the axis.

    Attributes
    ----------
    matrix, rate : ndarray, shape (N, N)
    axis, axis_rate : ndarray, shape (N,)
    """

    def __init__(self, matrix: Array, rate: Array, axis: Array, axis_rate: Array) -> None:
        self.matrix, self.rate, self.axis, self.axis_rate = matrix, rate, axis, axis_rate

    def moved(self, step: float) -> Remainder:
        """The same at a scale whose logarithm is larger by a small step, to first order."""
        if step == 0.0:
            return self
        return Remainder(self.matrix + step * self.rate, self.rate, self.axis + step * self.axis_rate, self.axis_rate)


def _pieces(
    pair: NDArray[np.intp], sign: Array, start: Array, extent: Array, xi: Array, h: Array, longest: Array
) -> list[Pieces]:
    """Cover the distances start ... start + extent by pieces no longer than their distance allows, or `longest`."""
    parts = []
    active = np.flatnonzero(extent > 0.0)
    start, extent, xi = start.copy(), extent.copy(), xi.copy()
    while active.size:
        allowed = np.maximum(_GROWTH * start[active], longest[active])
        length = np.where(extent[active] <= _LAST * allowed, extent[active], allowed)
        parts.append(Pieces(pair[active], sign[active], start[active], length, xi[active]))
        start[active] += length
        extent[active] -= length
        xi[active] += sign[active] * length / h[active]
        active = active[extent[active] > 0.0]
    return parts


def _near_rows(
    table: ImageTable, c: float, length: float, r: Array, left: Array, right: Array, h: Array, order: int
) -> tuple[Array, Array]:
    """Rows, shape (pairs, order) each, of F and its rate for targets at the radii r.

    Parameters
    ----------
    length : float
        Length of the solid, in the unit of the radii.
    left, right : ndarray
        Distance of the target from the start of the panel (positive beyond it), and of the end from the target.
    """
    if not len(r):
        return np.zeros((0, order)), np.zeros((0, order))
    index = np.arange(len(r))
    longest = np.minimum(_FIRST * length, np.maximum(_MIRROR * r, _SHORT * length))
    parts: list[Pieces] = []
    v = left / h
    for sign, extent, gap in ((-1.0, left, -right), (1.0, right, -left)):
        # Inside the panel on both sides of the target, outside on one side from the clearance on.
        clearance = np.maximum(gap, 0.0)
        start = np.where(clearance > 0.0, 0.5 - 0.5 * sign, v)
        parts += _pieces(
            index, np.full(len(r), sign), clearance, np.maximum(extent - clearance, 0.0), start, h, longest
        )
    pieces = Pieces.join(parts)
    rows = np.zeros((2, len(r), order))
    modes = gauss_rule(order).to_modes
    at_kink = pieces.start < longest[pieces.pair]
    for mask, rule, squared in (
        (at_kink, gauss_rule(order + _AT_KINK), True),
        (~at_kink, gauss_rule(order // 2 + _AWAY), False),
    ):
        if not mask.any():
            continue
        p = pieces.subset(mask)
        u, weights = (rule.nodes**2, 2.0 * rule.nodes * rule.weights) if squared else (rule.nodes, rule.weights)
        distance = p.start[:, None] + p.length[:, None] * u
        radius = r[p.pair][:, None]
        t = radius + p.sign[:, None] * distance
        total = radius + t
        factors = p.length[:, None] * weights * t / total
        values_and_rates = table.of((c * total).ravel(), (c * distance).ravel())
        for row, values in zip(rows, values_and_rates, strict=True):
            row += moments(p, values.reshape(total.shape) * factors, u, h, order, len(r)) @ modes
    return rows[0], rows[1]


def _matching_panels(old: PanelMesh, mesh: PanelMesh) -> NDArray[np.intp]:
    """Index of each panel in the old mesh, shape (m,); -1 for a new one."""
    if (old.order, old.origin) != (mesh.order, mesh.origin):
        return np.full(len(mesh.lengths), -1)
    where = {ends: i for i, ends in enumerate(pairwise(old.offsets.tolist()))}
    return np.array([where.get(ends, -1) for ends in pairwise(mesh.offsets.tolist())])


def remainder(
    table: ImageTable, length: float, mesh: PanelMesh, c: float, previous: tuple[PanelMesh, Remainder] | None = None
) -> Remainder:
    """R(c) on a mesh.

    Parameters
    ----------
    table : ImageTable
    length : float
        Shortest length over which the solid changes.
    mesh : PanelMesh
    c : float
        Radius of s = 1.
    previous : tuple, optional
        R(c) on another mesh, reused between panels of both.
    """
    q, N, s, places, h = mesh.order, mesh.size, mesh.nodes, mesh.node_offsets, mesh.lengths
    match = np.full(len(h), -1) if previous is None else _matching_panels(previous[0], mesh)
    old = np.repeat(match >= 0, q)
    i, j = np.triu_indices(N)
    if previous is not None:
        new = ~(old[i] & old[j])
        i, j = i[new], j[new]
    both = table.of(c * (s[i] + s[j]), c * np.abs(places[i] - places[j]))
    weights = (s * mesh.weights) / (s[:, None] + s)
    on_axis = table.of(c * s, c * s)
    # Distances of the nodes, and of the axis, from both ends of each panel.
    at = np.append(places, -mesh.origin)[:, None]
    left, right = at - mesh.offsets[:-1], mesh.offsets[1:] - at
    inside = (left > 0.0) & (right > 0.0)
    long = c * h > _SHORT * length
    is_near = inside | ((np.maximum(-left, -right) < h) & long)
    is_near[:N] &= ~(old[:, None] & (match >= 0))
    node, panel = np.nonzero(is_near)
    radius = np.append(s, 0.0)[node]
    rows = _near_rows(table, c, length / c, radius, left[node, panel], right[node, panel], h[panel], q)
    reused = np.flatnonzero(old)
    old_indices = (match[match >= 0, None] * q + np.arange(q)).ravel()
    matrices, axes = [], []
    for values, on, row, name in zip(both, on_axis, rows, ("matrix", "rate"), strict=True):
        matrix = np.zeros((N + 1, N))
        matrix[i, j] = values
        matrix[j, i] = values
        matrix[:N] *= weights
        matrix[N] = on * mesh.weights
        matrix.reshape(N + 1, len(h), q)[node, panel] = row
        if previous is not None:
            matrix[np.ix_(reused, reused)] = getattr(previous[1], name)[np.ix_(old_indices, old_indices)]
        matrices.append(matrix[:N].copy())
        axes.append(matrix[N].copy())
    return Remainder(*matrices, *axes)
