"""Manufactured solutions: known displacement fields, and the error of the elements.

An exact field u stresses the solid by sigma(u); the load vector integral of sigma(u) : eps(v) r dr dz then has u
itself as its solution, whatever body forces and tractions belong to it.  What the elements give instead is their
best approximation, whose error shows the order of the element and every mistake in its stiffness.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import spsolve
from skfem import Basis, Dofs, ElementQuadP

from fem_reference._elastic.dof_ordering import line_unknowns
from fem_reference._elastic.elasticity import gauss_product
from fem_reference._elastic.mapping import ChartMapping, InteriorChart
from fem_reference._elastic.mesh import Grid
from fem_reference._elastic.tensor_elements import tensor_stiffness
from fem_reference._typing import Array
from fem_reference.solid import Solid

__all__ = ["BIAXIAL", "SMOOTH", "Field", "column", "interior_stiffness", "manufactured_error"]


#: Gauss points a direction for loads and errors: the fields are no polynomials (more change nothing).
POINTS = 14


@dataclass(frozen=True, slots=True)
class Field:
    """A displacement field of (r, z) that leaves the axis where it is.

    Attributes
    ----------
    displacement : callable
        Returns u_r and u_z.
    gradient : callable
        Returns u_r,r; u_r,z; u_z,r; u_z,z.
    """

    displacement: Callable[[Array, Array], tuple[Array, Array]]
    gradient: Callable[[Array, Array], tuple[Array, Array, Array, Array]]


#: Every strain at work, none of them a polynomial: it shows the order of the element.
SMOOTH = Field(
    lambda r, z: (r * np.exp(-z) * np.cos(r), np.sin(2.0 * z + 0.3) * np.exp(-(r**2))),
    lambda r, z: (
        np.exp(-z) * (np.cos(r) - r * np.sin(r)),
        -r * np.exp(-z) * np.cos(r),
        -2.0 * r * np.sin(2.0 * z + 0.3) * np.exp(-(r**2)),
        2.0 * np.cos(2.0 * z + 0.3) * np.exp(-(r**2)),
    ),
)

#: Uniform strain with a rigid translation, the patch test of a homogeneous solid.
BIAXIAL = Field(
    lambda r, z: (0.2 * r, 1.0 - 0.3 * z),
    lambda r, z: (0.2 + 0.0 * r, 0.0 * r, 0.0 * r, -0.3 + 0.0 * r),
)


def column(k: float) -> Field:
    """Return the field of a column of E = z^k, confined sideways, under uniform pressure: u_z = -z^(1-k).

    Examples
    --------
    >>> column(0.5).displacement(np.array([1.0]), np.array([4.0]))[1]
    array([-2.])
    """
    return Field(
        lambda r, z: (0.0 * r, -(z ** (1.0 - k))),
        lambda r, z: (0.0 * r, 0.0 * r, 0.0 * r, -(1.0 - k) * z**-k),
    )


def interior_stiffness(grid: Grid, solid: Solid, order: int) -> sparse.csr_array:
    """Stiffness of the interior elements on all their functions, shape (2 N, 2 N), without boundary conditions."""
    dofs = Dofs(grid.quads(), ElementQuadP(order))
    total = sparse.csr_array((2 * dofs.N, 2 * dofs.N))
    for _, rows, K in tensor_stiffness(grid, dofs, solid):
        places = np.repeat(rows, rows.shape[1]), np.tile(rows, rows.shape[1]).ravel()
        total = total + sparse.coo_array((K.ravel(), places), shape=total.shape).tocsr()
    return total


def manufactured_error(grid: Grid, solid: Solid, order: int, field: Field) -> float:
    """Solve for a known field on [0, a]^2 and return the error of the displacement.

    Parameters
    ----------
    grid : Grid
        Interior grid; the field is prescribed on the axis (u_r) and at one point (u_z), its forces elsewhere.
    solid, order
        Material and element order.
    field : Field
        The exact displacement.

    Returns
    -------
    float
        L2 norm of the error relative to that of the displacement.
    """
    mesh = grid.quads()
    matrix = interior_stiffness(grid, solid, order)
    # Gauss points clustered towards the surface in every layer; the first reference axis of a tensor mesh is z.
    points, weights = gauss_product(POINTS, POINTS, 3)
    basis = Basis(
        mesh,
        ElementQuadP(order),
        ChartMapping(mesh, InteriorChart(float(grid.z[1]), solid.surface_exponent)),
        quadrature=(points[::-1], weights),
    )
    r, z = np.asarray(basis.global_coordinates())
    load = _load(basis, solid.modulus(z), solid.poisson(z), field)
    fixed = np.append(2 * line_unknowns(basis.dofs, 0, 0.0), 2 * line_unknowns(basis.dofs, 1, grid.extent)[0] + 1)
    values = np.zeros(matrix.shape[0])
    values[fixed[-1]] = float(field.displacement(np.array(0.0), np.array(grid.extent))[1])
    free = np.setdiff1d(np.arange(values.size), fixed)
    values[free] = spsolve(matrix[free][:, free].tocsc(), (load - matrix @ values)[free])
    error = norm = 0.0
    for component, exact in enumerate(field.displacement(r, z)):
        difference = np.asarray(basis.interpolate(values[component::2])) - exact
        error += float((difference**2 * r * basis.dx).sum())
        norm += float((exact**2 * r * basis.dx).sum())
    return float(np.sqrt(error / norm))


def _load(basis: Basis, E: Array, nu: Array, field: Field) -> Array:
    """Load vector of the stress of a field."""
    r, z = np.asarray(basis.global_coordinates())
    rr, rz, zr, zz = field.gradient(r, z)
    hoop = field.displacement(r, z)[0] / r
    lame, shear = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), E / (2.0 * (1.0 + nu))
    volume = lame * (rr + hoop + zz)
    s_rr, s_tt, s_zz = (volume + 2.0 * shear * strain for strain in (rr, hoop, zz))
    s_rz = shear * (rz + zr)
    load = np.zeros(2 * basis.N)
    dofs = np.asarray(basis.element_dofs)
    for i, (f,) in enumerate(basis.basis):
        radial = ((s_rr * f.grad[0] + s_tt * np.asarray(f) / r + s_rz * f.grad[1]) * r * basis.dx).sum(axis=1)
        axial = ((s_rz * f.grad[0] + s_zz * f.grad[1]) * r * basis.dx).sum(axis=1)
        np.add.at(load, 2 * dofs[i], radial)
        np.add.at(load, 2 * dofs[i] + 1, axial)
    return load
