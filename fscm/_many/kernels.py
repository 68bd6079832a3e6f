"""Blocks of the response between panels that are apart, for several gradient exponents at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fscm._surface.kernel import NEAR_LIMIT, kernel_of
from fscm._surface.mesh import PanelMesh
from fscm._typing import Array

__all__ = ["Kernels", "are_apart"]

#: Points at a time: their powers are in the cache.
_POINTS = 8192


def are_apart(mesh: PanelMesh, targets: NDArray[np.intp], sources: NDArray[np.intp], near: float) -> NDArray[np.bool_]:
    """Which pairs of panels have a clearance of at least `near` lengths of the source."""
    return _clearances(mesh, targets, sources) >= near * mesh.lengths[sources]


def _clearances(mesh: PanelMesh, targets: NDArray[np.intp], sources: NDArray[np.intp]) -> Array:
    start, end = mesh.offsets[:-1], mesh.offsets[1:]
    return np.maximum(start[targets] - end[sources], start[sources] - end[targets])


class Kernels:
    """Ring responses G_k of gradient exponents k > 0, by the same expansions as `fscm._surface.kernel`."""

    def __init__(self, exponents: Array) -> None:
        kernels = [kernel_of(float(k)) for k in exponents]
        self._k = exponents[:, None]
        self._near = np.concatenate([[kernel.near_D for kernel in kernels], [kernel.near_C for kernel in kernels]])
        self._far = np.array([kernel.far for kernel in kernels])

    def blocks(self, mesh: PanelMesh, targets: NDArray[np.intp], sources: NDArray[np.intp], unit: Array) -> Array:
        """(1 - k) W times unit^k between nodes of pairs of panels, by the Gauss rule; shape (exponents, p, q, q)."""
        v, h, nodes = mesh.rule.nodes, mesh.lengths, mesh.nodes.reshape(-1, mesh.order)
        outward = (mesh.offsets[targets] > mesh.offsets[sources])[:, None]
        of_target = h[targets, None] * np.where(outward, v, v[::-1])
        of_source = h[sources, None] * np.where(outward, v[::-1], v)
        distance = _clearances(mesh, targets, sources)[:, None, None] + of_target[:, :, None] + of_source[:, None]
        r, t, units = (
            np.broadcast_to(values, distance.shape).ravel()
            for values in (nodes[targets][:, :, None], nodes[sources][:, None], unit[:, None, None])
        )
        distance = distance.ravel()
        blocks = np.empty((len(self._k), distance.size))
        for start in range(0, distance.size, _POINTS):
            part = slice(start, start + _POINTS)
            blocks[:, part] = self._responses(r[part], t[part], distance[part], units[part])
        blocks *= 1.0 - self._k
        weighted = blocks.reshape(len(self._k), len(targets), mesh.order, mesh.order)
        weighted *= (h[sources, None] * mesh.rule.weights)[:, None]
        return weighted

    def _responses(self, r: Array, t: Array, distance: Array, unit: Array) -> Array:
        """G_k(r, t) times unit^k, shape (exponents, points)."""
        total, out = r + t, np.empty((len(self._k), len(r)))
        ratio = distance / total
        near = ratio * ratio <= NEAR_LIMIT
        at, y = total[near], ratio[near]
        parts = self._near @ _powers(2.0 / NEAR_LIMIT * y * y - 1.0, self._near.shape[1])
        S, C = parts[: len(out)], parts[len(out) :]
        C *= 2.0 / self._k * np.expm1(-self._k * np.log(y))
        S += C
        out[:, near] = S * (t[near] / at) * np.exp(-self._k * np.log(at / unit[near]))
        far = ~near
        larger = np.maximum(r[far], t[far])
        F = self._far @ _powers((np.minimum(r[far], t[far]) / larger) ** 2, self._far.shape[1])
        out[:, far] = F * (t[far] / larger) * np.exp(-self._k * np.log(larger / unit[far]))
        return out


def _powers(x: Array, count: int) -> Array:
    """Powers 0 to count - 1, shape (count, len(x))."""
    powers = np.empty((count, len(x)))
    powers[0] = 1.0
    for i in range(1, count):
        np.multiply(powers[i - 1], x, out=powers[i])
    return powers
