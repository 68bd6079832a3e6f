"""Assembled stiffness of the half-space: interior elements and the exact exterior."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, cast

import numpy as np
from scipy import sparse
from skfem import Basis

from fem_reference._elastic.dof_ordering import both_components, line_unknowns, reversal_signs
from fem_reference._elastic.elasticity import Body, stiffness
from fem_reference._elastic.exterior import exterior_stiffness
from fem_reference._elastic.mapping import InteriorChart
from fem_reference._elastic.mesh import Grid, MeshSpec
from fem_reference._typing import Index
from fem_reference.modulus import Modulus
from fem_reference.poisson import PoissonRatio

__all__ = ["HalfSpace", "assemble_half_space", "half_space_of"]


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
        Rows of u_z along the surface, in surface order.
    boundary : ndarray of int
        Rows on the square's side and bottom, coupled by the exterior.
    """

    body: Body
    grid: Grid
    basis: Basis
    matrix: sparse.csr_array
    free: Index
    surface: Index
    boundary: Index


def assemble_half_space(grid: Grid, modulus: Modulus, nu: float | PoissonRatio, order: int = 4) -> HalfSpace:
    """Assemble interior and exterior.

    Parameters
    ----------
    grid : Grid
        Interior grid.
    modulus : Modulus
        E(z).
    nu : float or PoissonRatio
        Poisson ratio in [0, 0.5), or one of depth.
    order : int
        Element order, at least 2.

    Returns
    -------
    HalfSpace
    """
    mesh = grid.quads()
    first = float(grid.z[1])
    body = Body(mesh, InteriorChart(first, modulus.surface_exponent), modulus, nu, order)
    touching = np.flatnonzero(mesh.p[1][mesh.t].max(axis=0) <= first)
    matrix, basis = stiffness(body, touching)
    side = line_unknowns(basis, 0, grid.extent)
    bottom = line_unknowns(basis, 1, grid.extent, reverse=True)
    nz, nr, edges = grid.z.size - 1, grid.r.size - 1, order - 1
    square = np.concatenate([side[: nz + 1], bottom[1 : nr + 1], side[nz + 1 :], bottom[nr + 1 :]])
    signs = np.ones(square.size)
    signs[square.size - nr * edges :] = reversal_signs(nr, order)[nr + 1 :]
    weight = np.repeat(signs, 2)
    outer = weight[:, None] * exterior_stiffness(grid, modulus, nu, order) * weight
    boundary = both_components(square)
    rows, cols = np.repeat(boundary, boundary.size), np.tile(boundary, boundary.size)
    matrix = (matrix + sparse.coo_array((outer.ravel(), (rows, cols)), shape=matrix.shape)).tocsr()
    axis = 2 * line_unknowns(basis, 0, 0.0)
    free = np.setdiff1d(np.arange(matrix.shape[0]), axis)
    surface = 2 * line_unknowns(basis, 1, 0.0) + 1
    return HalfSpace(body, grid, basis, matrix, free, surface, boundary)


def half_space_of(modulus: Modulus, nu: float | PoissonRatio, spec: MeshSpec) -> HalfSpace:
    """Return the half-space on a mesh, kept for the next caller: compliance and pyamg's preconditioner share it.

    Parameters
    ----------
    modulus : Modulus
        E(z), hashable.
    nu : float or PoissonRatio
        Poisson ratio in [0, 0.5), or one of depth, hashable.
    spec : MeshSpec
        The mesh.

    Returns
    -------
    HalfSpace
    """
    return _kept(cast(Hashable, modulus), cast(Hashable, nu), spec)


# Two: the mesh of the last path, whose events are solved next, and one before it; each holds some 100 MB.
@lru_cache(maxsize=2)
def _kept(modulus: Any, nu: Any, spec: MeshSpec) -> HalfSpace:
    return assemble_half_space(spec.grid(), modulus, nu, spec.order)
