"""The panel mesh: consecutive intervals of the radius, each with the same Gauss-Legendre nodes.

A function on the mesh is the vector of its values at all nodes, panel by panel; on each panel it is the polynomial of
degree q-1 through them.  Panel ends are stored relative to an origin, the axis or the cohesive edge, because the edge
is narrower than the rounding of its radius when k or mu is large.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from fscm._typing import Array

__all__ = ["GaussRule", "PanelMesh", "gauss_rule"]

#: Binary digits with which Gauss rules are computed before they are rounded.
_BITS = 120
#: Stands for a distance of zero from a node.
_ZERO = 1e-200


@dataclass(frozen=True, eq=False)
class GaussRule:
    """Gauss-Legendre rule on [0, 1] with its Legendre transform.

    Attributes
    ----------
    nodes, weights : ndarray, shape (q,)
        Nodes in ascending order and weights, sum 1.
    to_modes : ndarray, shape (q, q)
        Values at the nodes -> coefficients of P_l(2u - 1), l = 0 ... q-1.
    barycentric : ndarray, shape (q,)
        Weights of the barycentric formula, (-1)^j sqrt(u_j (1 - u_j) w_j) up to a factor.
    """

    nodes: Array
    weights: Array
    to_modes: Array
    barycentric: Array

    @property
    def order(self) -> int:
        """Number of nodes q."""
        return len(self.nodes)

    def interpolation(self, u: Array) -> Array:
        """Matrix, shape (len(u), q), from values at the nodes to values at local coordinates `u`."""
        # The barycentric formula: at a node, all other terms vanish beside that of the distance _ZERO.
        distance = np.asarray(u, float)[:, None] - self.nodes
        distance[distance == 0.0] = _ZERO
        rows: Array = np.divide(self.barycentric, distance, out=distance)
        rows /= rows.sum(axis=1, keepdims=True)
        return rows


def _gauss(order: int) -> tuple[Array, Array]:
    """Nodes and weights on [-1, 1], each the nearest double; numpy's weights are wrong by up to 8e-14 (18 nodes).

    Newton's method in integers, units of 2^-_BITS, from numpy's nodes; those below 0 mirror the others.
    """
    unit = 1 << _BITS
    nodes, weights = [], []
    for guess in legendre.leggauss(order)[0][order // 2 :]:
        x = int(Fraction(float(guess)) * unit)
        for _ in range(2):
            before, current = unit, x
            for m in range(1, order):
                before, current = current, ((2 * m + 1) * (x * current >> _BITS) - m * before) // (m + 1)
            away = unit - (x * x >> _BITS)
            # (1 - x^2) P' = n (P_{n-1} - x P_n)
            x -= current * away // (order * (before - (x * current >> _BITS)))
        nodes.append(x / unit)
        weights.append(2 * away * unit / (order * before) ** 2)
    mirrored = slice(order % 2, None)
    return (
        np.concatenate([-np.array(nodes[mirrored])[::-1], nodes]),
        np.concatenate([np.array(weights[mirrored])[::-1], weights]),
    )


@lru_cache(maxsize=32)
def gauss_rule(order: int) -> GaussRule:
    """The rule with `order` nodes."""
    x, w = _gauss(order)
    modes = (2.0 * np.arange(order) + 1.0)[:, None] * legendre.legvander(x, order - 1).T * (0.5 * w)[None, :]
    barycentric = np.asarray((-1.0) ** np.arange(order) * np.sqrt((1.0 - x) * (1.0 + x) * w), float)
    return GaussRule(0.5 * (1.0 + x), 0.5 * w, modes, barycentric)


@dataclass(frozen=True, eq=False)
class PanelMesh:
    """Panels between consecutive ends with `order` nodes each.

    Parameters
    ----------
    offsets : ndarray, shape (m + 1,)
        Panel ends relative to the origin, in any unit of radii; they ascend strictly from the axis.
    order : int
        Nodes a panel, q.
    origin : float
        Radius to which the offsets are relative, 0 by default; distances near it have full relative accuracy.

    Raises
    ------
    ValueError
        When the ends do not ascend strictly from the axis.
    """

    offsets: Array
    order: int
    origin: float = 0.0

    def __post_init__(self) -> None:
        if self.offsets[0] != -self.origin or np.any(np.diff(self.offsets) <= 0.0):
            raise ValueError("panel breaks must ascend strictly from 0")

    @cached_property
    def breaks(self) -> Array:
        """Radii of the panel ends, shape (m + 1,), rounded."""
        return self.origin + self.offsets

    @cached_property
    def starts(self) -> Array:
        """Radii of the panel starts, shape (m,), rounded."""
        return self.breaks[:-1]

    @cached_property
    def lengths(self) -> Array:
        """Panel lengths, shape (m,); exact differences of the offsets."""
        return np.diff(self.offsets)

    @cached_property
    def middles(self) -> Array:
        """Middles of the panels relative to the origin, shape (m,)."""
        return self.offsets[:-1] + 0.5 * self.lengths

    @property
    def rule(self) -> GaussRule:
        """The rule of every panel."""
        return gauss_rule(self.order)

    @property
    def size(self) -> int:
        """Number of nodes m q."""
        return len(self.lengths) * self.order

    @cached_property
    def node_offsets(self) -> Array:
        """Nodes relative to the origin, shape (m q,)."""
        return (self.offsets[:-1, None] + self.lengths[:, None] * self.rule.nodes).ravel()

    @cached_property
    def nodes(self) -> Array:
        """Radii of the nodes, shape (m q,), rounded."""
        # Not the origin plus the offsets: the starts near the axis are exact.
        return (self.starts[:, None] + self.lengths[:, None] * self.rule.nodes).ravel()

    @cached_property
    def weights(self) -> Array:
        """Quadrature weights of the nodes, shape (m q,)."""
        return (self.lengths[:, None] * self.rule.weights).ravel()

    def modes(self, values: Array) -> Array:
        """Legendre coefficients panel by panel, shape (m, q), of nodal `values`, shape (m q,)."""
        return values.reshape(-1, self.order) @ self.rule.to_modes.T

    def locate(self, offsets: Array) -> NDArray[np.intp]:
        """Index of the panel of each radius, relative to the origin; that of the last panel farther out."""
        return np.clip(np.searchsorted(self.offsets, offsets, side="right") - 1, 0, len(self.lengths) - 1)

    def seen_from(self, origin: float) -> Array:
        """Nodes relative to another origin, shape (m q,)."""
        return self.node_offsets + (self.origin - origin)

    def evaluate(self, values: Array, radii: Array) -> Array:
        """Values at `radii`, shape (p,), of the piecewise polynomial with nodal `values`."""
        return self.evaluate_at_offsets(values, radii - self.origin)

    def evaluate_at_offsets(self, values: Array, offsets: Array) -> Array:
        """Values of the piecewise polynomial with nodal `values` at radii relative to the origin, shape (p,)."""
        panel = self.locate(offsets)
        u = (offsets - self.offsets[panel]) / self.lengths[panel]
        rows = self.rule.interpolation(u)
        return np.einsum("ij,ij->i", rows, values.reshape(-1, self.order)[panel])

    def row_at_end(self, panel: int, end: float) -> Array:
        """Row, shape (m q,), that evaluates a nodal vector at the start (0.0) or end (1.0) of a panel."""
        row = np.zeros(self.size)
        row[panel * self.order : (panel + 1) * self.order] = self.rule.interpolation(np.array([end]))[0]
        return row

    def transfer(self, values: Array, target: PanelMesh, points: Array | None = None) -> Array:
        """Values on the panels of the mesh `target` of the function with nodal `values` on this one.

        Local coordinates come from offsets, so that panels far below the rounding of the radius keep full relative
        accuracy.

        Parameters
        ----------
        values : ndarray, shape (m q,)
        target : PanelMesh
        points : ndarray, shape (d,), optional
            Local coordinates on each panel of `target`, in [0, 1]; by default its nodes.
        """
        at_nodes, u_target = points is None, target.rule.nodes if points is None else points
        q, shift = len(u_target), target.origin - self.origin
        by_panel = values.reshape(-1, self.order)
        panel = self.locate(target.middles + shift)
        out = np.empty((len(panel), q))
        unchanged = np.zeros(len(panel), bool)
        if at_nodes and q == self.order and shift == 0.0:
            unchanged = (self.offsets[panel] == target.offsets[:-1]) & (self.offsets[panel + 1] == target.offsets[1:])
            out[unchanged] = by_panel[panel[unchanged]]
        new = np.flatnonzero(~unchanged)
        if not new.size:
            return out.ravel()
        panel = panel[new]
        start = target.offsets[new] + shift - self.offsets[panel]
        u = (start[:, None] + target.lengths[new, None] * u_target) / self.lengths[panel, None]
        rows = self.rule.interpolation(u.ravel()).reshape(len(new), q, self.order)
        out[new] = (rows @ by_panel[panel][:, :, None])[:, :, 0]
        outside = ((u < 0.0) | (u > 1.0)).any(axis=1)
        if outside.any():  # merged panels, whose nodes lie in several panels of this mesh
            merged = new[outside]
            offsets = (target.offsets[merged, None] + target.lengths[merged, None] * u_target) + shift
            out[merged] = self.evaluate_at_offsets(values, offsets.ravel()).reshape(-1, q)
        return out.ravel()
