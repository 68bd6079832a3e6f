"""Load vectors of given surface loads, for the verification ladder: what an axisymmetric load does on the basis.

Each function takes the surface mesh and returns the integrals of load times basis function times r dr, shape (m,).
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from fem_reference.surface import Trace

__all__ = ["disc_load", "ring_load", "smooth_load"]

Array = NDArray[np.float64]
Load = Callable[[Trace], Array]

DISC_POINTS = 30
"""Gauss points an element of the disc, fourth-power clustered in the last: integrands down to q^(-1/2) are exact."""


def smooth_load(pressure: Callable[[Array], Array]) -> Load:
    """Return the load of a pressure p(r), compression positive, that is smooth on every element."""
    return lambda trace: np.asarray(trace.phi.T @ (trace.weight * trace.s * pressure(trace.s)))


def disc_load(pressure: Callable[[Array], Array]) -> Load:
    """Return the load of a pressure that is a function of q = 1 - r^2 on r < 1, possibly singular at q = 0."""

    def load(trace: Trace) -> Array:
        x, w = np.polynomial.legendre.leggauss(DISC_POINTS)
        x, w = 0.5 * (x + 1.0), 0.5 * w
        nodes = trace.nodes[: trace.edge + 1]
        total = np.zeros(trace.phi.shape[1])
        for left, right in pairwise(nodes):
            h = right - left
            last = right == nodes[-1]
            gap = h * (x**4 if last else 1.0 - x)
            weight = h * w * (4.0 * x**3 if last else 1.0)
            s = right - gap
            # 1 - s from the distance to the node, not from s: the pressure may be singular there.
            below = (1.0 - right) + gap
            total += trace.evaluate(s).T @ (weight * s * pressure(below * (1.0 + s)))
        return total

    return load


def ring_load(trace: Trace) -> Array:
    """Return the load of a ring of unit force a length at r = 1, which is a node.

    Examples
    --------
    >>> from fem_reference.surface import MeshSpec, trace_of
    >>> spec = MeshSpec(edge_width=0.25, surface_depth=0.08, extent=16.0, density=1.0, order=4)
    >>> trace = trace_of(spec.grid(), spec.order)
    >>> ring, field = ring_load(trace), np.zeros(trace.phi.shape[1])
    >>> field[: trace.nodes.size] = trace.nodes**0  # u_z = 1 at every node
    >>> float(ring @ field)  # work per radian: force 1 on a length 1
    1.0
    """
    load = np.zeros(trace.phi.shape[1])
    load[trace.edge] = 1.0
    return load
