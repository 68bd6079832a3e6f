"""Functions between the nodes of a mesh: samples on its panels, their integrals and their projection.

A dozen nodes do not show that a function bends inside a panel, as a tabulated law does at its knots.  The samples
are so many that the error of their integrals is a small share of that of the nodes, wherever it bends.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
from numpy.polynomial import legendre

from fscm._surface.mesh import PanelMesh, gauss_rule
from fscm._typing import Array

__all__ = ["POINTS", "Samples"]

#: Each panel has this many equal pieces with a Gauss rule of this order.  Where a derivative of order s jumps inside a
#: panel, the integral over q nodes is wrong in proportion to q^-(s + 1): at 16 nodes and s = 1, a slope, 60 times more
#: than over these 128 points.
_PIECES, _ORDER = 16, 8
#: Local coordinates of the samples of a panel, in [0, 1], and their weights, sum 1.
POINTS = ((np.arange(_PIECES)[:, None] + gauss_rule(_ORDER).nodes) / _PIECES).ravel()
_WEIGHTS = np.tile(gauss_rule(_ORDER).weights, _PIECES) / _PIECES


@lru_cache(maxsize=32)
def _projection(order: int) -> Array:
    """Matrix, shape (order, samples), from samples to the nodal values of the nearest polynomial in least squares."""
    at_nodes, at_samples = (legendre.legvander(2.0 * u - 1.0, order - 1) for u in (gauss_rule(order).nodes, POINTS))
    return (at_nodes * (2.0 * np.arange(order) + 1.0)) @ (at_samples * _WEIGHTS[:, None]).T


@dataclass(frozen=True, eq=False)
class Samples:
    """The samples on all panels of a mesh; functions there have the shape (m s,), panel by panel.

    Parameters
    ----------
    mesh : PanelMesh
    """

    mesh: PanelMesh

    @cached_property
    def radii(self) -> Array:
        """Radii of the samples, rounded."""
        return (self.mesh.starts[:, None] + self.mesh.lengths[:, None] * POINTS).ravel()

    def projected(self, values: Array) -> Array:
        """Nodal values, shape (m q,), of the polynomials nearest to the samples.

        Their products with any polynomial of the panel have the integrals of the sampled function.
        """
        return np.asarray((values.reshape(-1, len(POINTS)) @ _projection(self.mesh.order).T).ravel())

    def integrals(self, values: Array) -> Array:
        """Integral over each panel, shape (m,)."""
        return np.asarray((values.reshape(-1, len(POINTS)) @ _WEIGHTS) * self.mesh.lengths)
