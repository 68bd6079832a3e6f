"""Weak form of axisymmetric linear elasticity.

Per radian it is the integral of sigma(u) : eps(v) r dr dz.

The four strains are u_r,r; u_r / r (hoop); u_z,z and u_r,z + u_z,r.  The displacement components share one
scalar space of order p (scikit-fem `ElementQuadP`); component c of scalar unknown i is unknown 2 i + c.
Gauss points never touch the axis, and u_r = 0 there keeps the hoop strain bounded.  The tests compare the stiffness
with scikit-fem bilinear forms.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from skfem import MeshQuad

from fem_reference._elastic.gauss import unit_gauss
from fem_reference._elastic.mapping import Chart
from fem_reference._typing import Array, Index
from fem_reference.solid import Solid

__all__ = ["Body", "contracted", "element_places", "gauss_product", "lame_parameters"]


#: Gauss points a direction beyond the order p: r and E(z) are no polynomials of low degree.
EXTRA_POINTS = 2

#: Gauss points through the first layer, in the cube root of y: integrands like y^(k/(1-k)) reach 1e-10.
FIRST_LAYER_POINTS = 14


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """A meshed piece of solid: mesh, chart to the (r, z) plane, material and element order.

    Attributes
    ----------
    mesh : MeshQuad
        Quadrilaterals in the coordinates of the chart.
    chart : Chart
        From those to (r, z).
    solid : Solid
        In units of the mesh.
    order : int
        Degree of the elements, at least 2.

    Raises
    ------
    ValueError
        If the order is outside its range.
    """

    mesh: MeshQuad
    chart: Chart
    solid: Solid
    order: int = 4

    def __post_init__(self) -> None:
        if self.order < 2:
            raise ValueError(f"element order {self.order} is below 2: the hierarchical element starts there")


def gauss_product(count: int, depth_count: int, power: int = 1) -> tuple[Array, Array]:
    """Gauss rule on the unit square; the second coordinate is y = u^power with Gauss points in u.

    Returns
    -------
    X : ndarray, shape (2, first * second)
        Points.
    W : ndarray, shape (first * second,)
        Weights, summing to 1.

    Examples
    --------
    >>> X, W = gauss_product(2, 3)
    >>> X.shape, round(float(W @ X[1] ** 4), 12)
    ((2, 6), 0.2)
    """
    x, wx = unit_gauss(count)
    u, wu = unit_gauss(depth_count)
    y, wy = u**power, wu * power * u ** (power - 1)
    return np.array([np.tile(x, depth_count), np.repeat(y, count)]), np.outer(wy, wx).ravel()


def lame_parameters(solid: Solid, z: Array) -> tuple[Array, Array]:
    """Lame's constants lambda and mu at depths.

    Raises
    ------
    ValueError
        If the modulus is not positive, or Poisson's ratio outside its range.
    """
    E, ratio = solid.modulus(z), solid.poisson(z)
    if not np.all(E > 0):
        raise ValueError("the modulus is not positive everywhere: a soft layer of zero stiffness has no solution")
    if not np.all((ratio >= 0) & (ratio < 0.5)):
        raise ValueError("Poisson's ratio is not in [0, 0.5) everywhere: displacement elements cannot keep the volume")
    return E * ratio / ((1.0 + ratio) * (1.0 - 2.0 * ratio)), E / (2.0 * (1.0 + ratio))


def contracted(radial: Array, axial: Array, hoop: Array, lame: Array, shear: Array) -> Array:
    """Stiffness of elements from the values of n functions at q points, shape (elements, 2 n, 2 n).

    Parameters
    ----------
    radial, axial, hoop : ndarray, shape (elements, q, n)
        Derivatives along r and z, and the values over r.
    lame, shear : ndarray, shape (elements, q)
        Lame's constants times the weights of the points.
    """
    # A radial function strains by `radial` (rr), `hoop` and `axial` (rz); an axial one by `axial` (zz)
    # and `radial` (rz).
    lame, shear = lame[..., None], shear[..., None]
    stiff = lame + 2.0 * shear
    n = radial.shape[-1]
    K = np.empty((radial.shape[0], 2 * n, 2 * n))
    radial_t, axial_t, hoop_t = (np.swapaxes(f, 1, 2) for f in (radial, axial, hoop))
    K[:, 0::2, 0::2] = (
        radial_t @ (stiff * radial + lame * hoop) + hoop_t @ (stiff * hoop + lame * radial) + axial_t @ (shear * axial)
    )
    K[:, 0::2, 1::2] = (radial_t + hoop_t) @ (lame * axial) + axial_t @ (shear * radial)
    K[:, 1::2, 0::2] = np.swapaxes(K[:, 0::2, 1::2], 1, 2)
    K[:, 1::2, 1::2] = axial_t @ (stiff * axial) + radial_t @ (shear * radial)
    return K


def element_places(mesh: MeshQuad) -> Index:
    """Column and row of each element of a tensor-product mesh, shape (2, elements).

    Examples
    --------
    >>> element_places(MeshQuad.init_tensor(np.array([0.0, 1.0, 3.0]), np.array([0.0, 5.0]))).tolist()
    [[0, 1], [0, 0]]
    """
    corners = mesh.p[:, mesh.t].min(axis=1)
    return np.stack([np.unique(along, return_inverse=True)[1] for along in corners])
