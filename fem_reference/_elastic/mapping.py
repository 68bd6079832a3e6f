"""Mappings of the reference element to the solid: a chart after that of the straight quadrilaterals.

Near the surface of a solid with E ~ z^k the displacement behaves like w + c z^(1-k).  The chart of the first
layer, z = h (y/h)^(1/(1-k)), puts z^(1-k) into the polynomial space exactly, so the singular layer needs no
deep grading.  The chart of a shell draws the exterior between the square boundary and a scaled copy of it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from skfem import MeshQuad
from skfem.mapping import Mapping, MappingIsoparametric

from fem_reference._typing import Array

__all__ = ["Chart", "ChartMapping", "InteriorChart", "ShellChart", "first_layer_depth"]


class Chart(Protocol):
    """A smooth map of mesh coordinates (2, ...) to (r, z) with its Jacobian (2, 2, ...)."""

    def __call__(self, x: Array) -> tuple[Array, Array]:
        """Return the image, shape (2, ...), and the Jacobian d(r, z)/dx, shape (2, 2, ...)."""
        ...


def first_layer_depth(y: Array, first: float, k: float) -> tuple[Array, Array]:
    """z(y) and dz/dy: z = first (y/first)^(1/(1-k)) in the first layer, z = y below it.

    Examples
    --------
    >>> z, slope = first_layer_depth(np.array([0.25, 2.0]), first=1.0, k=0.5)
    >>> z, slope
    (array([0.0625, 2.    ]), array([0.5, 1. ]))
    """
    t = np.clip(y / first, 0.0, 1.0)
    inside = y < first
    power = 1.0 / (1.0 - k)
    z = np.where(inside, first * t**power, y)
    slope = np.where(inside, power * t ** (power - 1.0), 1.0)
    return z, slope


@dataclass(frozen=True, slots=True)
class InteriorChart:
    """Identity below the first layer, with a power of the depth inside it.

    Examples
    --------
    >>> image, jacobian = InteriorChart(first=1.0, k=0.5)(np.array([[2.0], [0.5]]))
    >>> image.ravel(), jacobian[1, 1]  # z = y^2, dz/dy = 2 y
    (array([2.  , 0.25]), array([1.]))
    """

    first: float
    k: float

    def __call__(self, x: Array) -> tuple[Array, Array]:
        """Return image and Jacobian."""
        z, slope = first_layer_depth(x[1], self.first, self.k)
        zero = np.zeros_like(z)
        return np.stack([x[0], z]), np.array([[np.ones_like(z), zero], [zero, slope]])


@dataclass(frozen=True, slots=True)
class ShellChart:
    """(t, rho) -> rho b(t): b runs down the side r = a of the square and back along its bottom z = a."""

    extent: float
    first: float
    k: float

    def __call__(self, x: Array) -> tuple[Array, Array]:
        """Return image and Jacobian."""
        t, rho = x
        a = self.extent
        side = t < a
        z, slope = first_layer_depth(np.minimum(t, a), self.first, self.k)
        b = np.stack([np.where(side, a, 2.0 * a - t), np.where(side, z, a)])
        db = np.stack([np.where(side, 0.0, -1.0), np.where(side, slope, 0.0)])
        return rho * b, np.array([[rho * db[0], b[0]], [rho * db[1], b[1]]])


class ChartMapping(Mapping):
    """A scikit-fem mapping that follows the straight element map by a chart.

    Parameters
    ----------
    mesh : MeshQuad
        Of straight quadrilaterals.
    chart : Chart
        From its coordinates to (r, z).

    Raises
    ------
    TypeError
        If the elements of the mesh are not straight quadrilaterals.

    Examples
    --------
    >>> mapping = ChartMapping(MeshQuad(), InteriorChart(first=1.0, k=0.5))
    >>> middle = np.array([[0.5], [0.5]])
    >>> mapping.F(middle).ravel(), mapping.detDF(middle).ravel()
    (array([0.5 , 0.25]), array([1.]))
    """

    def __init__(self, mesh: MeshQuad, chart: Chart) -> None:
        base = mesh.mapping()
        if not isinstance(base, MappingIsoparametric):
            raise TypeError("a chart needs a mesh of straight quadrilaterals")
        self.base = base
        self.mesh = mesh
        self.chart = chart
        self._inverse: tuple[Array, Any, Array] | None = None

    def F(self, X: Array, tind: Any = None) -> Array:
        """Image of the reference points."""
        return self.chart(self.base.F(X, tind))[0]

    def DF(self, X: Array, tind: Any = None) -> Array:
        """Jacobian of `F`."""
        outer = self.chart(self.base.F(X, tind))[1]
        return np.einsum("ijkl,jmkl->imkl", outer, self.base.DF(X, tind))

    def detDF(self, X: Array, tind: Any = None) -> Array:
        """Return the determinant of the Jacobian."""
        J = self.DF(X, tind)
        return J[0, 0] * J[1, 1] - J[0, 1] * J[1, 0]

    def invDF(self, X: Array, tind: Any = None) -> Array:
        """Inverse of the Jacobian, kept for the next function of the element at the same points."""
        cached = self._inverse
        if cached is None or cached[0] is not X or cached[1] is not tind:
            J = self.DF(X, tind)
            inverse = np.array([[J[1, 1], -J[0, 1]], [-J[1, 0], J[0, 0]]]) / (J[0, 0] * J[1, 1] - J[0, 1] * J[1, 0])
            cached = self._inverse = (X, tind, inverse)
        return cached[2]
