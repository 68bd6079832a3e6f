"""Stiffness of the half-space: interior elements and the exact exterior."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, cast

import numpy as np
from scipy import sparse
from skfem import Basis

from fem_reference._elastic.condensed_elements import CondensedElements, condensed_elements
from fem_reference._elastic.dof_ordering import both_components, line_unknowns, reversal_signs
from fem_reference._elastic.elasticity import Body
from fem_reference._elastic.exterior import exterior_stiffness
from fem_reference._elastic.mapping import InteriorChart
from fem_reference._elastic.mesh import Grid, MeshSpec
from fem_reference._elastic.tensor_elements import numbering, tensor_stiffness
from fem_reference._typing import Array, Index
from fem_reference.modulus import Modulus
from fem_reference.poisson import PoissonRatio

__all__ = ["HalfSpace", "assemble_half_space", "half_space_of"]


@dataclass(frozen=True, eq=False)
class HalfSpace:
    """The discretised half-space.

    Attributes
    ----------
    body : Body
        Interior mesh, chart, material.
    grid : Grid
        Its grid.
    basis : skfem.Basis
        Scalar space; component c of unknown i is row 2 i + c.
    elements : CondensedElements
        Stiffness of the elements per radian, on their sides.
    exterior : ndarray, shape (b, b)
        Stiffness of the exterior on `boundary`.
    free : ndarray of int
        Rows of vertex and edge functions that are not fixed by u_r = 0 on the axis.
    surface : ndarray of int
        Rows of u_z along the surface, in surface order.
    boundary : ndarray of int
        Rows on the square's side and bottom, coupled by the exterior.
    """

    body: Body
    grid: Grid
    basis: Basis
    elements: CondensedElements
    exterior: Array
    free: Index
    surface: Index
    boundary: Index

    @property
    def unknowns(self) -> int:
        """Free displacements of the mesh, with those inside the elements."""
        return int(self.free.size + self.elements.inside.size)

    @cached_property
    def matrix(self) -> sparse.csr_array:
        """Stiffness with the exterior, shape (2 N, 2 N); rows inside the elements are empty, fixed ones are not."""
        rows, cols = np.repeat(self.boundary, self.boundary.size), np.tile(self.boundary, self.boundary.size)
        inside = self.elements.assembled()
        return (inside + sparse.coo_array((self.exterior.ravel(), (rows, cols)), shape=inside.shape)).tocsr()


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
    layer = float(grid.z[1])
    body = Body(mesh, InteriorChart(layer, modulus.surface_exponent), modulus, nu, order)
    basis = numbering(mesh, order)
    inside = 2 * int(basis.interior_dofs.shape[0])
    parts = tensor_stiffness(grid, basis, modulus, nu, order)
    elements = condensed_elements(parts, mesh.nelements, inside, 2 * basis.N)
    side = line_unknowns(basis, 0, grid.extent)
    bottom = line_unknowns(basis, 1, grid.extent, reverse=True)
    nz, nr, edges = grid.z.size - 1, grid.r.size - 1, order - 1
    square = np.concatenate([side[: nz + 1], bottom[1 : nr + 1], side[nz + 1 :], bottom[nr + 1 :]])
    signs = np.ones(square.size)
    signs[square.size - nr * edges :] = reversal_signs(nr, order)[nr + 1 :]
    weight = np.repeat(signs, 2)
    outer = weight[:, None] * exterior_stiffness(grid, modulus, nu, order) * weight
    free = np.setdiff1d(elements.sides, 2 * line_unknowns(basis, 0, 0.0))
    surface = 2 * line_unknowns(basis, 1, 0.0) + 1
    return HalfSpace(body, grid, basis, elements, outer, free, surface, both_components(square))


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
    return _assembled(cast(Hashable, modulus), cast(Hashable, nu), spec)


# Two: the mesh of the last path, whose events are solved next, and one before it; each holds some 100 MB.
@lru_cache(maxsize=2)
def _assembled(modulus: Any, nu: Any, spec: MeshSpec) -> HalfSpace:
    return assemble_half_space(spec.grid(), modulus, nu, spec.order)
