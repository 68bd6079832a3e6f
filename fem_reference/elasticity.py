"""Weak form of axisymmetric linear elasticity, per radian: integral of sigma(u) : eps(v) r dr dz.

The four strains are u_r,r; u_r / r (hoop); u_z,z and u_r,z + u_z,r.  The displacement components share one
scalar space of order p (scikit-fem `ElementQuadP`); component c of scalar unknown i is unknown 2 i + c.
Gauss points never touch the axis, and u_r = 0 there keeps the hoop strain bounded.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from skfem import Basis, BilinearForm, ElementQuadP, MeshQuad

from fem_reference.mapping import Chart, ChartMapping
from fem_reference.modulus import Modulus

__all__ = ["Body", "gauss_product", "stiffness"]

Array = NDArray[np.float64]

EXTRA_POINTS = 2
"""Gauss points a direction beyond the order p: r and E(z) are no polynomials of low degree."""

FIRST_LAYER_POINTS = 14
"""Gauss points through the first layer, in the cube root of y: integrands like y^(k/(1-k)) reach 1e-10."""


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """A meshed piece of solid: mesh, chart to the (r, z) plane, modulus, Poisson ratio and element order."""

    mesh: MeshQuad
    chart: Chart
    modulus: Modulus
    nu: float
    order: int = 4

    def __post_init__(self) -> None:
        if not 0 <= self.nu < 0.5:
            raise ValueError(
                f"Poisson ratio nu = {self.nu} is outside [0, 0.5): displacement elements cannot keep the volume; "
                "take nu = 0.499 or less"
            )
        if self.order < 2:
            raise ValueError(f"element order {self.order} is below 2: the hierarchical element starts there")


@lru_cache(maxsize=8)
def _gauss(count: int) -> tuple[Array, Array]:
    x, w = np.polynomial.legendre.leggauss(count)
    return 0.5 * (x + 1.0), 0.5 * w


def gauss_product(first: int, second: int, power: int = 1) -> tuple[Array, Array]:
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
    x, wx = _gauss(first)
    u, wu = _gauss(second)
    y, wy = u**power, wu * power * u ** (power - 1)
    return np.array([np.tile(x, second), np.repeat(y, first)]), np.outer(wy, wx).ravel()


@BilinearForm
def _radial_radial(u: Any, v: Any, w: Any) -> Any:
    ur, uz, vr, vz = u.grad[0], u.grad[1], v.grad[0], v.grad[1]
    return w.stiff * (ur * vr + u * v * w.inverse_r**2) + w.cross * (ur * v + u * vr) + w.shear * uz * vz


@BilinearForm
def _radial_axial(u: Any, v: Any, w: Any) -> Any:
    """Trial u_z against test u_r."""
    return w.lame * v.grad[0] * u.grad[1] + w.cross * v * u.grad[1] + w.shear * v.grad[1] * u.grad[0]


@BilinearForm
def _axial_axial(u: Any, v: Any, w: Any) -> Any:
    return w.stiff * u.grad[1] * v.grad[1] + w.shear * u.grad[0] * v.grad[0]


def _blocks(body: Body, basis: Basis) -> tuple[Any, Any, Any]:
    r, z = np.asarray(basis.global_coordinates())
    E = body.modulus(z)
    if not np.all(E > 0):
        raise ValueError("the modulus is not positive everywhere: a soft layer of zero stiffness has no solution")
    nu = body.nu
    lame = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)) * r
    shear = E / (2.0 * (1.0 + nu)) * r
    weights = {"stiff": lame + 2.0 * shear, "lame": lame, "shear": shear, "cross": lame / r, "inverse_r": 1.0 / r}
    rr = _radial_radial.assemble(basis, **weights)
    rz = _radial_axial.assemble(basis, **weights)
    zz = _axial_axial.assemble(basis, **weights)
    return rr, rz, zz


def stiffness(body: Body, first_layer: NDArray[np.intp], depth_axis: int = 1) -> tuple[sparse.csr_array, Basis]:
    """Assemble the stiffness matrix of a body.

    Parameters
    ----------
    body : Body
        What to assemble.
    first_layer : ndarray of int
        Elements touching the surface; they get the quadrature of the graded chart.
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
        If the modulus is not positive.
    """
    element = ElementQuadP(body.order)
    mapping = ChartMapping(body.mesh, body.chart)
    count = body.order + EXTRA_POINTS
    others = np.setdiff1d(np.arange(body.mesh.nelements), first_layer)
    rules = []
    if others.size:
        rules.append((others, gauss_product(count, count)))
    if first_layer.size:
        X, W = gauss_product(count, FIRST_LAYER_POINTS, 3)
        rules.append((first_layer, (X if depth_axis == 1 else X[::-1], W)))
    total = None
    for elements, rule in rules:
        basis = Basis(body.mesh, element, mapping, quadrature=rule, elements=elements, disable_doflocs=True)
        rr, rz, zz = _blocks(body, basis)
        blocks = [rr, rz, zz]
        total = blocks if total is None else [a + b for a, b in zip(total, blocks, strict=True)]
    if total is None:
        raise ValueError("the body has no elements")
    rr, rz, zz = total
    return _interleave(rr, rz, zz), basis


def _interleave(rr: Any, rz: Any, zz: Any) -> sparse.csr_array:
    N = rr.shape[0]
    rows, cols, data = [], [], []
    for block, (i, j) in ((rr, (0, 0)), (rz, (0, 1)), (rz.T, (1, 0)), (zz, (1, 1))):
        entry = block.tocoo()
        rows.append(2 * entry.row.astype(np.int64) + i)
        cols.append(2 * entry.col.astype(np.int64) + j)
        data.append(entry.data)
    coo = sparse.coo_array((np.concatenate(data), (np.concatenate(rows), np.concatenate(cols))), shape=(2 * N, 2 * N))
    matrix = coo.tocsr()
    matrix.indices, matrix.indptr = matrix.indices.astype(np.int32), matrix.indptr.astype(np.int32)
    return matrix
