"""Weak form of axisymmetric linear elasticity.

Per radian it is the integral of sigma(u) : eps(v) r dr dz.

The four strains are u_r,r; u_r / r (hoop); u_z,z and u_r,z + u_z,r.  The displacement components share one
scalar space of order p (scikit-fem `ElementQuadP`); component c of scalar unknown i is unknown 2 i + c.
Gauss points never touch the axis, and u_r = 0 there keeps the hoop strain bounded.

Basis, quadrature and mapping are those of scikit-fem; the contraction over Gauss points is batched over
elements, because a Python loop over the 49 x 49 pairs of functions of an order-6 element takes ten times
longer.  The tests compare it with scikit-fem bilinear forms.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from skfem import Basis, ElementQuadP, MeshQuad

from fem_reference._elastic.dof_ordering import both_components
from fem_reference._elastic.gauss import unit_gauss
from fem_reference._elastic.mapping import Chart, ChartMapping
from fem_reference._typing import Array, Index
from fem_reference.solid import Solid

__all__ = ["Body", "contracted", "element_places", "gauss_product", "lame_parameters", "stiffness"]


#: Gauss points a direction beyond the order p: r and E(z) are no polynomials of low degree.
EXTRA_POINTS = 2

#: Elements contracted at once, 25 MB at order 6: a quarter faster than with 256, which the caches do not hold.
CHUNK = 64

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


def _element_matrices(body: Body, basis: Basis, chunk: slice) -> Array:
    """Stiffness of some elements, shape (elements, 2 n, 2 n) with n functions and interleaved components."""
    r, z = np.asarray(basis.global_coordinates())[:, chunk]
    measure = r * basis.dx[chunk]
    lame, shear = (constant * measure for constant in lame_parameters(body.solid, z))
    radial = np.stack([f[0].grad[0][chunk] for f in basis.basis], axis=-1)
    axial = np.stack([f[0].grad[1][chunk] for f in basis.basis], axis=-1)
    hoop = np.stack([np.asarray(f[0])[chunk] for f in basis.basis], axis=-1) / r[..., None]
    return contracted(radial, axial, hoop, lame, shear)


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


def stiffness(body: Body, first_layer: Index, depth_axis: int = 1) -> tuple[sparse.csr_array, Basis]:
    """Assemble the stiffness matrix of a body.

    Parameters
    ----------
    body : Body
        What to assemble.
    first_layer : ndarray of int
        Elements touching the surface; they get the quadrature of the chart of the first layer.
    depth_axis : int
        Mesh coordinate that points into the solid in those elements.

    Returns
    -------
    matrix : csr_array, shape (2 N, 2 N)
        Symmetric; no boundary condition applied.
    basis : skfem.Basis
        The scalar space with N unknowns (on all elements).

    Raises
    ------
    ValueError
        If the modulus is not positive, or Poisson's ratio outside its range.
    """
    bases = _bases(body, first_layer, depth_axis)
    triplets = []
    for _, local, K in _elements(body, bases):
        narrow = local.astype(np.int32)
        rows = np.broadcast_to(narrow[:, :, None], K.shape)
        cols = np.broadcast_to(narrow[:, None, :], K.shape)
        triplets.append((K.ravel(), rows.ravel(), cols.ravel()))
    data, rows, cols = (np.concatenate(column) for column in zip(*triplets, strict=True))
    size = 2 * bases[-1].N
    return sparse.coo_array((data, (rows, cols)), shape=(size, size)).tocsr(), bases[-1]


def element_places(mesh: MeshQuad) -> Index:
    """Column and row of each element of a tensor-product mesh, shape (2, elements).

    Examples
    --------
    >>> element_places(MeshQuad.init_tensor(np.array([0.0, 1.0, 3.0]), np.array([0.0, 5.0]))).tolist()
    [[0, 1], [0, 0]]
    """
    corners = mesh.p[:, mesh.t].min(axis=1)
    return np.stack([np.unique(along, return_inverse=True)[1] for along in corners])


def _bases(body: Body, first_layer: Index, depth_axis: int) -> list[Basis]:
    """The scalar space on the elements of each quadrature rule."""
    element = ElementQuadP(body.order)
    mapping = ChartMapping(body.mesh, body.chart)
    count = body.order + EXTRA_POINTS
    below = np.setdiff1d(np.arange(body.mesh.nelements), first_layer)
    rules = []
    if below.size:
        rules.append((below, gauss_product(count, count)))
    if first_layer.size:
        X, W = gauss_product(count, FIRST_LAYER_POINTS, 3)
        corners = body.mesh.p[depth_axis, body.mesh.t[:, first_layer[0]]]
        # scikit-fem numbers the corners of a tensor mesh down the columns: its first reference axis is z.
        rules.append((first_layer, (X[::-1] if corners[0] != corners[1] else X, W)))
    return [
        Basis(body.mesh, element, mapping, quadrature=rule, elements=elements, disable_doflocs=True)
        for elements, rule in rules
    ]


def _elements(body: Body, bases: Iterable[Basis]) -> Iterator[tuple[Index, Index, Array]]:
    """Numbers, rows and stiffness of some elements at a time: shapes (e,), (e, 2 n) and (e, 2 n, 2 n)."""
    for basis in bases:
        rows = both_components(np.asarray(basis.element_dofs)).T
        for start in range(0, rows.shape[0], CHUNK):
            chunk = slice(start, start + CHUNK)
            yield np.asarray(basis.tind)[chunk], rows[chunk], _element_matrices(body, basis, chunk)
