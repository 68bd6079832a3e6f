"""Cache of blocks of the response, for later meshes and problems of the same gradient exponent.

A block is the response of one panel to the pressure on another.  It depends on the two panels, the kernel and the order
only.  The panels of most meshes come from a few initial panels by halving, the same for all problems.
"""

from __future__ import annotations

import math
import threading
from collections import OrderedDict
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fscm._surface.mesh import PanelMesh
from fscm._typing import Array

__all__ = ["BLOCKS_MEMORY", "ResponseBlocks", "as_matrix", "clear", "known_matrix", "memory"]

#: Largest memory of all stored blocks, in bytes; temporarily, while a table grows, one half more.
BLOCKS_MEMORY = 96_000_000
#: Largest table, in percent of that.
_TABLE_SHARE = 50
#: Number of panels in a new table.
_FIRST = 32
#: Ends with more binary digits do not come from the initial panels: their blocks are not stored.
_DIGITS = 40

Compute = Callable[[PanelMesh, NDArray[np.intp], NDArray[np.intp]], Array]


class ResponseBlocks:
    """Blocks for one kernel, order and origin, shape (order, order) each.

    Parameters
    ----------
    compute : callable
        Mesh, indices of target panels, indices of source panels (of one length p) -> ndarray, shape (p, q, q).
    """

    def __init__(self, compute: Compute) -> None:
        self._compute = compute
        self._places: dict[tuple[float, float], int] = {}
        self._known = np.zeros((0, 0), bool)
        self._blocks = np.zeros((0, 0, 0, 0))
        self._lock = threading.Lock()

    @property
    def memory(self) -> int:
        """Bytes of the table."""
        return self._blocks.nbytes + self._known.nbytes

    def of(self, mesh: PanelMesh) -> Array:
        """Blocks between all panels of a mesh as a matrix, shape (m q, m q); missing ones are computed and stored."""
        with self._lock:
            panels = list(pairwise(mesh.offsets.tolist()))
            new = [panel for panel in panels if panel not in self._places]
            most = math.isqrt(_TABLE_SHARE * BLOCKS_MEMORY // 100 // 8) // mesh.order
            if len(self._places) + len(new) > most:
                self._places.clear()
                self._known[:], new = False, panels
                if len(new) > most:
                    everything = np.indices((len(panels), len(panels))).reshape(2, -1)
                    return as_matrix(self._compute(mesh, *everything))
            for panel in new:
                self._places[panel] = len(self._places)
            self._grow(len(self._places), mesh.order, most)
            places = np.array([self._places[panel] for panel in panels])
            both = np.ix_(places, places)
            lacking = np.nonzero(~self._known[both])
            if lacking[0].size:
                targets, sources = places[lacking[0]], places[lacking[1]]
                self._blocks[targets, sources] = self._compute(mesh, *lacking)
                self._known[targets, sources] = True
            matrix = np.empty((len(panels), mesh.order, len(panels), mesh.order))
            for rows, place in zip(matrix, places.tolist(), strict=True):
                rows[:] = self._blocks[place].take(places, axis=0).transpose(1, 0, 2)
            return matrix.reshape(mesh.size, mesh.size)

    def _grow(self, count: int, order: int, most: int) -> None:
        old = len(self._known)
        if count <= old:
            return
        size = min(max(_FIRST, count + count // 2), most)
        computed, blocks = np.zeros((size, size), bool), np.empty((size, size, order, order))
        if old:
            computed[:old, :old], blocks[:old, :old] = self._known, self._blocks
        self._known, self._blocks = computed, blocks


_STORES: OrderedDict[Any, ResponseBlocks] = OrderedDict()
_LOCK = threading.Lock()


def as_matrix(blocks: Array) -> Array:
    """The matrix, shape (m q, m q), of blocks of all targets and sources in turn, shape (m m, q, q)."""
    count, q = math.isqrt(len(blocks)), blocks.shape[-1]
    return blocks.reshape(count, count, q, q).transpose(0, 2, 1, 3).reshape(count * q, count * q)


def known_matrix(kernel: object, mesh: PanelMesh, compute: Compute) -> Array | None:
    """The matrix of all panels of a mesh, shape (m q, m q); None if its panels do not come from the initial ones.

    Afterwards all tables together take at most `BLOCKS_MEMORY`; the least recently used is dropped first.
    """
    fraction = np.frexp(mesh.offsets)[0] * 2.0**_DIGITS
    if np.any(fraction != np.rint(fraction)):
        return None
    key = kernel, mesh.order, mesh.origin
    with _LOCK:
        store = _STORES.setdefault(key, ResponseBlocks(compute))
        _STORES.move_to_end(key)
    matrix = store.of(mesh)
    with _LOCK:
        while memory() > BLOCKS_MEMORY:
            _STORES.popitem(last=False)
    return matrix


def memory() -> int:
    """Bytes of all tables."""
    return sum(store.memory for store in _STORES.values())


def clear() -> None:
    """Drop all blocks."""
    with _LOCK:
        _STORES.clear()
