"""The whole half-space as one matrix: interior elements plus the exact exterior, axis condition removed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from skfem import Basis

from fem_reference.chains import both_components, line_unknowns, reversal_signs
from fem_reference.elasticity import Body, stiffness
from fem_reference.exterior import exterior_stiffness
from fem_reference.mapping import InteriorChart
from fem_reference.mesh import Grid
from fem_reference.modulus import Modulus

__all__ = ["HalfSpace", "assemble_half_space"]

Index = NDArray[np.intp]


@dataclass(frozen=True, slots=True, eq=False)
class HalfSpace:
    """The assembled half-space.

    Attributes
    ----------
    body : Body
        Interior mesh, chart, material.
    grid : Grid
        Its grid.
    basis : skfem.Basis
        Scalar space; component c of unknown i is row 2 i + c.
    matrix : csr_array, shape (2 N, 2 N)
        Stiffness per radian, with the exterior; rows of `axis` still to be removed.
    free : ndarray of int
        Rows that are not fixed by u_r = 0 on the axis.
    surface : ndarray of int
        Rows of u_z along the surface, in chain order.
    boundary : ndarray of int
        Rows on the square's side and bottom, coupled by the exterior.

    Examples
    --------
    >>> from fem_reference.mesh import graded_grid
    >>> from fem_reference.modulus import PowerLaw
    >>> half_space = assemble_half_space(graded_grid(extent=4.0, density=1.5), PowerLaw(1.0, 1.0, 0.4), nu=0.3)
    >>> bool(abs(half_space.matrix - half_space.matrix.T).max() < 1e-10)
    True
    """

    body: Body
    grid: Grid
    basis: Basis
    matrix: sparse.csr_array
    free: Index
    surface: Index
    boundary: Index


def assemble_half_space(grid: Grid, modulus: Modulus, nu: float, order: int = 4) -> HalfSpace:
    """Assemble interior and exterior.

    Parameters
    ----------
    grid : Grid
        Interior grid.
    modulus : Modulus
        E(z).
    nu : float
        Poisson ratio in [0, 0.5).
    order : int
        Element order, at least 2.

    Returns
    -------
    HalfSpace

    Examples
    --------
    >>> from fem_reference.mesh import graded_grid
    >>> from fem_reference.modulus import PowerLaw
    >>> grid = graded_grid(extent=4.0, density=1.5)
    >>> half_space = assemble_half_space(grid, PowerLaw(1.0, 1.0, 0.4), nu=0.3)
    >>> int(half_space.matrix.shape[0] - half_space.free.size)  # one radial unknown fixed per axis function
    17
    """
    mesh = grid.quads()
    first = float(grid.z[1])
    body = Body(mesh, InteriorChart(first, modulus.surface_exponent), modulus, nu, order)
    touching = np.flatnonzero(mesh.p[1][mesh.t].max(axis=0) <= first)
    matrix, basis = stiffness(body, touching)
    side = line_unknowns(basis, 0, grid.extent)
    bottom = line_unknowns(basis, 1, grid.extent, reverse=True)
    nz, nr, edges = grid.z.size - 1, grid.r.size - 1, order - 1
    chain = np.concatenate([side[: nz + 1], bottom[1 : nr + 1], side[nz + 1 :], bottom[nr + 1 :]])
    signs = np.ones(chain.size)
    signs[chain.size - nr * edges :] = reversal_signs(nr, order)[nr + 1 :]
    weight = np.repeat(signs, 2)
    outer = weight[:, None] * exterior_stiffness(grid, modulus, nu, order) * weight
    boundary = both_components(chain)
    rows, cols = np.repeat(boundary, boundary.size), np.tile(boundary, boundary.size)
    matrix = (matrix + sparse.coo_array((outer.ravel(), (rows, cols)), shape=matrix.shape)).tocsr()
    axis = 2 * line_unknowns(basis, 0, 0.0)
    free = np.setdiff1d(np.arange(matrix.shape[0]), axis)
    surface = 2 * line_unknowns(basis, 1, 0.0) + 1
    return HalfSpace(body, grid, basis, matrix, free, surface, boundary)
