"""Load vectors of given axisymmetric surface loads.

Each function takes the surface mesh and returns the integrals of load times basis function times r dr, shape (m,).
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from fem_reference._elastic.gauss import unit_gauss
from fem_reference._elastic.trace import Trace
from fem_reference._typing import Array

__all__ = ["disc_load", "ring_load", "smooth_load"]

Load = Callable[[Trace], Array]

#: Gauss points an element of the disc, fourth-power clustered in the last: integrands down to q^(-1/2) are exact.
DISC_POINTS = 30


def smooth_load(pressure: Callable[[Array], Array]) -> Load:
    """Return the load of a pressure p(r), compression positive, that is smooth on every element."""
    return lambda trace: np.asarray(trace.phi.T @ (trace.weight * trace.s * pressure(trace.s)))


def disc_load(pressure: Callable[[Array], Array]) -> Load:
    """Return the load of a pressure that is a function of q = 1 - r^2 on r < 1, possibly singular at q = 0."""

    def load(trace: Trace) -> Array:
        x, w = unit_gauss(DISC_POINTS)
        nodes = trace.nodes[: trace.edge + 1]
        total = np.zeros(trace.phi.shape[1])
        for left, right in pairwise(nodes):
            h = right - left
            end = right == nodes[-1]
            gap = h * (x**4 if end else 1.0 - x)
            weight = h * w * (4.0 * x**3 if end else 1.0)
            s = right - gap
            # 1 - s from the distance to the node, not from s: the pressure may be singular there.
            below = (1.0 - right) + gap
            total += trace.evaluate(s).T @ (weight * s * pressure(below * (1.0 + s)))
        return total

    return load


def ring_load(trace: Trace) -> Array:
    """Return the load of a ring of unit force a length at r = 1, which is a node."""
    load = np.zeros(trace.phi.shape[1])
    load[trace.edge] = 1.0
    return load
