"""Surface displacement from the pressure on panels: product integration of the ring response.

w(r_i) = sum_j W_ij p_j with p the piecewise polynomial through its nodal values.  Panels farther than their
own length from r_i use the Gauss rule itself.  Nearer panels are integrated on pieces that double in length
away from r_i, so that the kernel is smooth on each; the pieces that touch r_i use interpolatory rules for the
weights 1, u^-k and (u^-k - 1)/k, in which the two parts of the kernel (`Kernel.near_parts`) are smooth.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from fscm._kernel import Kernel, box_cox
from fscm._panels import PanelMesh, gauss_rule
from fscm._typing import Array

__all__ = ["axis_row", "response_block", "response_matrix"]

# A panel is near when it is closer than its own length: then the Gauss rule of q nodes leaves at most
# (3 + sqrt 8)^-2q times the strength of a weak singularity.
_NEAR = 1.0
# Nodes of the rule on a piece; exact for the panel polynomial (degree q-1) times a factor that is analytic
# to one piece length on either side, whose coefficients fall like 5.8^-m.
_EXTRA_NODES = 10


@lru_cache(maxsize=64)
def _singular_rule(order: int, k: float) -> tuple[Array, Array, Array]:
    """Weights at the Gauss nodes of [0, 1] for the weight functions 1, u^-k and (u^-k - 1)/k.

    Moments of the shifted Legendre polynomials: int P_l u^-k = (-1)^l (k)_l / (1-k)_{l+1}; for (u^-k - 1)/k
    the factor k of (k)_l cancels for l >= 1 and the l = 0 moment is 1/(1-k), so k = 0 is not special.
    """
    rule = gauss_rule(order)
    power = np.empty(order)
    difference = np.empty(order)
    power[0] = difference[0] = 1.0 / (1.0 - k)
    ratio = 1.0 / (1.0 - k)  # (k+1)_{l-1} / (1-k)_{l+1}
    for m in range(1, order):
        ratio *= (k + m - 1.0 if m > 1 else 1.0) / (1.0 - k + m)
        difference[m] = (-1.0) ** m * ratio
        power[m] = k * difference[m]
    # to_modes.T carries the node weights and the factors 2l+1.
    return rule.weights, rule.to_modes.T @ power, rule.to_modes.T @ difference


@dataclass
class _Pieces:
    """Sub-intervals of near (target, panel) pairs, as flat arrays of one length.

    A point of a piece lies at distance `near + L u` from its target on side `sign` and at local coordinate
    `xi + sign L u / h` of its panel.
    """

    pair: NDArray[np.intp]
    sign: Array
    near: Array
    length: Array
    xi: Array

    @staticmethod
    def join(parts: list[_Pieces]) -> _Pieces:
        return _Pieces(
            *(np.concatenate([getattr(p, f) for p in parts]) for f in ("pair", "sign", "near", "length", "xi"))
        )


def _doubling_pieces(
    pair: NDArray[np.intp], sign: Array, near: Array, extent: Array, xi: Array, h: Array
) -> list[_Pieces]:
    """Cover distances near ... near + extent by pieces no longer than their distance from the target."""
    parts = []
    active = np.flatnonzero(extent > 0.0)
    near, extent, xi = near.copy(), extent.copy(), xi.copy()
    while active.size:
        # The last piece takes the whole remainder when it is within 1.5 of the allowed length.
        length = np.where(extent[active] <= 1.5 * near[active], extent[active], near[active])
        parts.append(_Pieces(pair[active], sign[active], near[active], length, xi[active]))
        near[active] += length
        extent[active] -= length
        xi[active] += sign[active] * length / h[active]
        active = active[extent[active] > 0.0]
    return parts


def _moments(pieces: _Pieces, values: Array, u: Array, h: Array, order: int, count: int) -> Array:
    """Legendre moments, shape (count, order), of weighted kernel `values` (pieces, nodes), summed by pair."""
    local = pieces.xi[:, None] + (pieces.sign * pieces.length / h[pieces.pair])[:, None] * u
    x = 2.0 * local - 1.0
    out = np.zeros((count, order))
    previous, current = np.ones_like(x), x
    for m in range(order):
        polynomial = previous if m == 0 else current
        out[:, m] = np.bincount(pieces.pair, np.einsum("ij,ij->i", values, polynomial), minlength=count)
        if m >= 1:
            previous, current = current, ((2 * m + 1) * x * current - m * previous) / (m + 1)
    return out


def _near_rows(
    kernel: Kernel, r: Array, gap: Array, side: Array, own: NDArray[np.bool_], v: Array, h: Array, order: int
) -> Array:
    """Rows, shape (pairs, order), of nodal weights for near pairs.

    Parameters
    ----------
    r : target radii.  gap : distance to the nearest panel end (0 for own panels).  side : +1 when the panel
    is to the right of the target, -1 to the left.  own : target inside the panel.  v : its local coordinate
    there. h : panel lengths.  All of shape (pairs,).
    """
    count = len(r)
    index = np.arange(count)
    rule = gauss_rule(order + _EXTRA_NODES)
    u = rule.nodes
    smooth: list[_Pieces] = []
    singular: list[_Pieces] = []
    out = index[~own]
    if out.size:
        xi = np.where(side[out] > 0, 0.0, 1.0)
        smooth += _doubling_pieces(out, side[out], gap[out], h[out], xi, h[out])
    mine = index[own]
    if mine.size:
        # The kernel is also singular, in its parts, at t = 0: pieces that touch r stay within [r/2, 2r].
        for sign, available, limit in ((-1.0, v * h, 0.5 * r), (1.0, (1.0 - v) * h, r)):
            s = np.full(mine.size, sign)
            touch = np.minimum(available[mine], limit[mine])
            singular.append(_Pieces(mine, s, np.zeros(mine.size), touch, v[mine]))
            rest = available[mine] - touch
            smooth += _doubling_pieces(mine, s, touch, rest, v[mine] + sign * touch / h[mine], h[mine])
    moments = np.zeros((count, order))
    if smooth:
        p = _Pieces.join(smooth)
        distance = p.near[:, None] + p.length[:, None] * u
        radius = np.broadcast_to(r[p.pair][:, None], distance.shape)
        t = radius + p.sign[:, None] * distance
        values = kernel.response(radius, t, distance) * (p.length[:, None] * rule.weights)
        moments += _moments(p, values, u, h, order, count)
    if singular:
        p = _Pieces.join(singular)
        distance = p.length[:, None] * u
        radius = np.broadcast_to(r[p.pair][:, None], distance.shape)
        t = radius + p.sign[:, None] * distance
        plain, power, difference = _singular_rule(rule.order, kernel.k)
        S, C = kernel.near_parts(radius, t, distance)
        # L(distance/(r+t)) with distance = L u splits into u^-k L(g) + (u^-k - 1)/k, g = L/(r+t).
        smooth_log = box_cox(np.log(p.length[:, None] / (radius + t)), kernel.k)
        values = p.length[:, None] * (plain * S + C * (power * smooth_log + difference))
        moments += _moments(p, values, u, h, order, count)
    return moments @ gauss_rule(order).to_modes


def response_block(kernel: Kernel, mesh: PanelMesh, targets: NDArray[np.intp], sources: NDArray[np.intp]) -> Array:
    """Block of the response matrix between two sets of panels.

    Parameters
    ----------
    targets, sources : ndarray of int
        Panel indices.

    Returns
    -------
    ndarray, shape (len(targets) q, len(sources) q)
        Dimension radius^(1-k): displacement / ((1-k) M) per nodal pressure.
    """
    q = mesh.order
    v, w = mesh.rule.nodes, mesh.rule.weights
    # Less the origin: clearances come from exact differences.
    a, b, h = mesh.offsets[:-1], mesh.offsets[1:], mesh.lengths
    at, bt, ht = a[targets, None], b[targets, None], h[targets, None]  # (T, 1)
    as_, bs, hs = a[None, sources], b[None, sources], h[None, sources]  # (1, S)
    # Clearance of each target node from each source panel: (T, S, q).
    left = (at - bs)[:, :, None] + (ht * v)[:, None, :]  # panel to the left of the node
    right = (as_ - bt)[:, :, None] + (ht * v[::-1])[:, None, :]  # panel to the right
    own = (targets[:, None] == sources[None, :])[:, :, None]
    is_left = at >= bs
    gap = np.where(is_left[:, :, None], left, right)
    gap = np.where(own, 0.0, gap)
    near = gap < _NEAR * hs[:, :, None]

    nodes = mesh.nodes.reshape(-1, q)
    r = nodes[targets, None, :, None]  # (T, 1, q, 1)
    t = nodes[None, sources, None, :]  # (1, S, 1, q)
    beyond = np.where(is_left[:, :, None], (hs.T * v[::-1])[None, :, :], (hs.T * v)[None, :, :])
    distance = gap[:, :, :, None] + beyond[:, :, None, :]
    far = np.broadcast_to(~near[:, :, :, None], distance.shape)
    block = np.zeros(distance.shape)
    rb, tb = np.broadcast_to(r, distance.shape), np.broadcast_to(t, distance.shape)
    block[far] = kernel.response(rb[far], tb[far], distance[far])
    block *= (hs.T * w)[None, :, None, :]

    T, S, Q = np.nonzero(near)
    if T.size:
        own_pair = targets[T] == sources[S]
        block[T, S, Q] = _near_rows(
            kernel,
            nodes[targets[T], Q],
            gap[T, S, Q],
            np.where(is_left[T, S], -1.0, 1.0),
            own_pair,
            v[Q],
            h[sources[S]],
            q,
        )
    return block.transpose(0, 2, 1, 3).reshape(len(targets) * q, len(sources) * q)


def response_matrix(kernel: Kernel, mesh: PanelMesh, previous: tuple[PanelMesh, Array] | None = None) -> Array:
    """The whole matrix W, shape (m q, m q); blocks between panels that `previous` has too are reused."""
    count, q = len(mesh.lengths), mesh.order
    everything = np.arange(count)
    if previous is None or (previous[0].order, previous[0].origin) != (q, mesh.origin):
        return response_block(kernel, mesh, everything, everything)
    old, old_matrix = previous
    where = {edges: i for i, edges in enumerate(pairwise(old.offsets))}
    match = np.array([where.get(edges, -1) for edges in pairwise(mesh.offsets)])
    kept, fresh = np.flatnonzero(match >= 0), np.flatnonzero(match < 0)
    W = np.empty((count, q, count, q))
    W[np.ix_(kept, np.arange(q), kept, np.arange(q))] = old_matrix.reshape(len(old.lengths), q, len(old.lengths), q)[
        np.ix_(match[kept], np.arange(q), match[kept], np.arange(q))
    ]
    if fresh.size:
        W[fresh] = response_block(kernel, mesh, fresh, everything).reshape(len(fresh), q, count, q)
        if kept.size:
            block = response_block(kernel, mesh, kept, fresh).reshape(len(kept), q, len(fresh), q)
            W[np.ix_(kept, np.arange(q), fresh, np.arange(q))] = block
    return W.reshape(count * q, count * q)


def axis_row(kernel: Kernel, mesh: PanelMesh) -> Array:
    """Row, shape (m q,), of the displacement on the axis: the integral of p(t) t^-k."""
    q = mesh.order
    row = mesh.weights * mesh.nodes ** (-kernel.k)
    row[:q] = mesh.lengths[0] ** (1.0 - kernel.k) * _singular_rule(q, kernel.k)[1]
    near = np.flatnonzero(mesh.starts[1:] < _NEAR * mesh.lengths[1:]) + 1
    if near.size:
        zeros = np.zeros(near.size)
        rows = _near_rows(
            kernel,
            zeros,
            mesh.starts[near],
            zeros + 1.0,
            np.zeros(near.size, bool),
            zeros,
            mesh.lengths[near],
            q,
        )
        row.reshape(-1, q)[near] = rows
    return row
