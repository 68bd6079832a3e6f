"""Surface displacement from the pressure on panels: product integration of the ring response.

w(r_i) = sum_j W_ij p_j with p the piecewise polynomial through its nodal values.  Panels farther than their
own length from r_i use the Gauss rule itself.  Nearer panels are integrated on pieces that double in length
away from r_i, so that the kernel is smooth on each; the pieces that touch r_i use interpolatory rules for the
weights 1, u^-k and (u^-k - 1)/k, in which the two parts of the kernel (`Kernel.near_parts`) are smooth.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache, partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from fscm._surface.kernel import Kernel, box_cox
from fscm._surface.mesh import PanelMesh, gauss_rule
from fscm._surface.response_store import as_matrix, known_matrix
from fscm._typing import Array

__all__ = ["Pieces", "axis_row", "moments", "response_blocks", "response_matrix"]

#: A panel is near when it is closer than its own length.  Farther away the error of the Gauss rule of q nodes is at
#: most (3 + sqrt 8)^-2q times the strength of the singularity.
_NEAR = 1.0
#: Nodes of the rule on a piece; exact for the panel polynomial (degree q-1) times a factor that is analytic
#: to one piece length on either side, whose coefficients fall like 5.8^-m.
_EXTRA_NODES = 10
#: Rows that are computed at a time: larger temporary arrays are out of the cache, and their memory is requested anew.
_NEAR_ROWS, _FAR_ROWS = 400, 2000


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
class Pieces:
    """Sub-intervals of near (target, panel) pairs, as flat arrays of one length.

    A point of a piece lies at the distance `start + length u` from its target on the side `sign`, and at the local
    coordinate `xi + sign length u / h` of its panel.
    """

    pair: NDArray[np.intp]
    sign: Array
    start: Array
    length: Array
    xi: Array

    @staticmethod
    def join(parts: list[Pieces]) -> Pieces:
        return Pieces(
            *(np.concatenate([getattr(p, f) for p in parts]) for f in ("pair", "sign", "start", "length", "xi"))
        )

    def subset(self, mask: NDArray[np.bool_]) -> Pieces:
        """Those for which the mask holds."""
        return Pieces(self.pair[mask], self.sign[mask], self.start[mask], self.length[mask], self.xi[mask])


def _doubling_pieces(
    pair: NDArray[np.intp], sign: Array, start: Array, extent: Array, xi: Array, h: Array
) -> list[Pieces]:
    """Cover the distances start ... start + extent by pieces no longer than their distance from the target."""
    parts = []
    active = np.flatnonzero(extent > 0.0)
    start, extent, xi = start.copy(), extent.copy(), xi.copy()
    while active.size:
        # The last piece takes the whole remainder when it is within 1.5 of the allowed length.
        length = np.where(extent[active] <= 1.5 * start[active], extent[active], start[active])
        parts.append(Pieces(pair[active], sign[active], start[active], length, xi[active]))
        start[active] += length
        extent[active] -= length
        xi[active] += sign[active] * length / h[active]
        active = active[extent[active] > 0.0]
    return parts


def moments(pieces: Pieces, values: Array, u: Array, h: Array, order: int, count: int) -> Array:
    """Legendre moments, shape (count, order), of weighted kernel `values` (pieces, nodes), summed by pair."""
    x = (pieces.sign * pieces.length / h[pieces.pair])[:, None] * u
    x += pieces.xi[:, None]
    x *= 2.0
    x -= 1.0
    out = np.empty((order, count))
    # The recurrence of the Legendre polynomials, on the products with the values.
    previous, current = values, x * values
    work = np.empty_like(x)
    for m in range(order):
        if m >= 2:
            np.multiply(x, current, out=work)
            work *= (2 * m - 1) / m
            if m == 2:
                previous = values * (1.0 - 1.0 / m)
            else:
                previous *= 1.0 - 1.0 / m
            work -= previous
            previous, current, work = current, work, previous
        term = values if m == 0 else current
        out[m] = np.bincount(pieces.pair, term.sum(axis=1), minlength=count)
    return out.T


def _near_rows(
    kernel: Kernel, r: Array, gap: Array, side: Array, inside: NDArray[np.bool_], v: Array, h: Array, order: int
) -> Array:
    """Rows, shape (pairs, order), of nodal weights for near pairs.

    Parameters
    ----------
    r : target radii.  gap : distance to the closest panel end (0 inside the panel).  side : +1 when the panel is to the
    right of the target, -1 to the left.  inside : target inside the panel.  v : its local coordinate there.
    h : panel lengths.  All of shape (pairs,).
    """
    count = len(r)
    index = np.arange(count)
    rule = gauss_rule(order + _EXTRA_NODES)
    u = rule.nodes
    smooth: list[Pieces] = []
    singular: list[Pieces] = []
    out = index[~inside]
    if out.size:
        xi = np.where(side[out] > 0, 0.0, 1.0)
        smooth += _doubling_pieces(out, side[out], gap[out], h[out], xi, h[out])
    mine = index[inside]
    if mine.size:
        # The kernel is also singular, in its parts, at t = 0: pieces that touch r stay within [r/2, 2r].
        for sign, available, limit in ((-1.0, v * h, 0.5 * r), (1.0, (1.0 - v) * h, r)):
            s = np.full(mine.size, sign)
            touch = np.minimum(available[mine], limit[mine])
            singular.append(Pieces(mine, s, np.zeros(mine.size), touch, v[mine]))
            remaining = available[mine] - touch
            smooth += _doubling_pieces(mine, s, touch, remaining, v[mine] + sign * touch / h[mine], h[mine])
    total = np.zeros((count, order))
    if smooth:
        p = Pieces.join(smooth)
        distance = p.start[:, None] + p.length[:, None] * u
        radius = np.broadcast_to(r[p.pair][:, None], distance.shape)
        t = radius + p.sign[:, None] * distance
        values = kernel.response(radius, t, distance) * (p.length[:, None] * rule.weights)
        total += moments(p, values, u, h, order, count)
    if singular:
        p = Pieces.join(singular)
        distance = p.length[:, None] * u
        radius = np.broadcast_to(r[p.pair][:, None], distance.shape)
        t = radius + p.sign[:, None] * distance
        plain, power, difference = _singular_rule(rule.order, kernel.k)
        S, C = kernel.near_parts(radius, t, distance)
        # L(distance/(r+t)) with distance = L u splits into u^-k L(g) + (u^-k - 1)/k, g = L/(r+t).
        smooth_log = box_cox(np.log(p.length[:, None] / (radius + t)), kernel.k)
        values = p.length[:, None] * (plain * S + C * (power * smooth_log + difference))
        total += moments(p, values, u, h, order, count)
    # Not by BLAS, whose rounding of a row depends on their number: stored blocks would change the last bit.
    return np.einsum("ij,jk->ik", total, gauss_rule(order).to_modes)


def _batches(mask: NDArray[np.bool_], size: int) -> Iterator[tuple[NDArray[np.intp], NDArray[np.intp]]]:
    """Indices (pair, node) of the rows for which the mask holds, up to `size` at a time."""
    pair, node = np.nonzero(mask)
    for start in range(0, len(pair), size):
        yield pair[start : start + size], node[start : start + size]


def response_blocks(
    kernel: Kernel, mesh: PanelMesh, targets: NDArray[np.intp], sources: NDArray[np.intp], near: float = _NEAR
) -> Array:
    """Blocks of the response matrix between pairs of panels.

    Parameters
    ----------
    targets, sources : ndarray of int, shape (p,)
        Panel indices.
    near : float
        A panel is near when it is closer than so many of its lengths.

    Returns
    -------
    ndarray, shape (p, q, q)
        Dimension radius^(1-k): displacement / ((1-k) M) at each node of the target per nodal pressure of the source.
    """
    q = mesh.order
    v, w = mesh.rule.nodes, mesh.rule.weights
    # Relative to the origin: clearances come from exact differences.
    a, b, h = mesh.offsets[:-1], mesh.offsets[1:], mesh.lengths
    # Clearance of each target node from the source panel, shape (p, q).
    is_left = a[targets] >= b[sources]  # the panel is to the left of the node
    left = (a[targets] - b[sources])[:, None] + h[targets, None] * v
    right = (a[sources] - b[targets])[:, None] + h[targets, None] * v[::-1]
    gap = np.where(is_left[:, None], left, right)
    gap[targets == sources] = 0.0
    is_near = gap < near * h[sources, None]
    nodes = mesh.nodes.reshape(-1, q)
    blocks = np.empty((len(targets), q, q))

    for pair, node in _batches(~is_near, _FAR_ROWS):
        panel = sources[pair]
        distance = gap[pair, node, None] + h[panel, None] * np.where(is_left[pair, None], v[::-1], v)
        radius = np.broadcast_to(nodes[targets[pair], node][:, None], distance.shape)
        blocks[pair, node] = kernel.response(radius, nodes[panel], distance) * (h[panel, None] * w)

    for pair, node in _batches(is_near, _NEAR_ROWS):
        panel = sources[pair]
        blocks[pair, node] = _near_rows(
            kernel,
            nodes[targets[pair], node],
            gap[pair, node],
            np.where(is_left[pair], -1.0, 1.0),
            targets[pair] == panel,
            v[node],
            h[panel],
            q,
        )
    return blocks


def response_matrix(kernel: Kernel, mesh: PanelMesh, previous: tuple[PanelMesh, Array] | None = None) -> Array:
    """The whole matrix W, shape (m q, m q); stored blocks, and those of `previous`, are reused."""
    count, q = len(mesh.lengths), mesh.order
    matrix = known_matrix(kernel, mesh, partial(response_blocks, kernel))
    if matrix is not None:
        return matrix
    blocks = np.empty((count, count, q, q))
    computed = np.zeros((count, count), bool)
    if previous is not None and (previous[0].order, previous[0].origin) == (q, mesh.origin):
        old, old_matrix = previous
        where = {edges: i for i, edges in enumerate(pairwise(old.offsets.tolist()))}
        match = np.array([where.get(edges, -1) for edges in pairwise(mesh.offsets.tolist())])
        reused, panels = np.flatnonzero(match >= 0), len(old.lengths)
        old_blocks = old_matrix.reshape(panels, q, panels, q).transpose(0, 2, 1, 3)
        blocks[np.ix_(reused, reused)] = old_blocks[np.ix_(match[reused], match[reused])]
        computed[np.ix_(reused, reused)] = True
    targets, sources = np.nonzero(~computed)
    blocks[targets, sources] = response_blocks(kernel, mesh, targets, sources)
    return as_matrix(blocks.reshape(-1, q, q))


def axis_row(kernel: Kernel, mesh: PanelMesh) -> Array:
    """Row, shape (m q,), of the displacement on the axis: the integral of p(t) t^-k."""
    q = mesh.order
    row = mesh.weights * mesh.nodes ** (-kernel.k)
    row[:q] = mesh.lengths[0] ** (1.0 - kernel.k) * _singular_rule(q, kernel.k)[1]
    for i in np.flatnonzero(mesh.starts[1:] < _NEAR * mesh.lengths[1:]) + 1:
        row[i * q : (i + 1) * q] = _near_axis_row(kernel, float(mesh.starts[i]), float(mesh.lengths[i]), q)
    return row


@lru_cache(maxsize=4096)
def _near_axis_row(kernel: Kernel, start: float, length: float, order: int) -> Array:
    """Weights, shape (order,), of the displacement on the axis for a panel longer than its distance from the axis."""
    unit, zero = np.ones(1), np.zeros(1)
    none = np.zeros(1, bool)
    return _near_rows(kernel, zero, start * unit, unit, none, zero, length * unit, order)[0]
