"""Stiffness of the half-space: interior elements and the exact exterior."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

import numpy as np
from scipy import sparse
from skfem import Dofs, ElementQuadP

from fem_reference._elastic.condensed_elements import CondensedElements, condensed_elements
from fem_reference._elastic.dissection import Elimination
from fem_reference._elastic.dof_ordering import both_components, line_unknowns, reversal_signs
from fem_reference._elastic.elasticity import Body, element_places
from fem_reference._elastic.element_forces import ElementForces
from fem_reference._elastic.exterior import exterior_stiffness
from fem_reference._elastic.mapping import InteriorChart
from fem_reference._elastic.mesh import Grid, MeshSpec
from fem_reference._elastic.surface_tension import SurfaceTension
from fem_reference._elastic.tensor_elements import tensor_stiffness
from fem_reference._typing import Array, Index
from fem_reference.solid import Solid

__all__ = ["HalfSpace", "assemble_half_space", "assembled", "half_space_of", "square_boundary"]


@dataclass(frozen=True, eq=False)
class HalfSpace:
    """The discretised half-space.

    Attributes
    ----------
    body : Body
        Interior mesh, chart, material.
    grid : Grid
        Its grid.
    dofs : skfem.Dofs
        Numbering of the scalar functions; component c of unknown i is row 2 i + c.
    elements : CondensedElements
        Stiffness of the elements per radian, on their sides.
    exterior : ndarray, shape (b, b)
        Stiffness of the exterior on `boundary`.
    free : ndarray of int
        Rows of vertex and edge functions that are not fixed by u_r = 0, on the axis or at a bonded surface.
    surface : ndarray of int
        Rows of u_z along the surface, in surface order.
    boundary : ndarray of int
        Rows on the square's side and bottom, coupled by the exterior.
    eliminations : list of Elimination
        What recovers the displacement of the mesh from that of its surface, once it has been condensed.
    tension : float
        Surface tension, relative to the unit of the modulus and of the lengths.
    """

    body: Body
    grid: Grid
    dofs: Dofs
    elements: CondensedElements
    exterior: Array
    free: Index
    surface: Index
    boundary: Index
    eliminations: list[Elimination] = field(default_factory=list)
    tension: float = 0.0

    @property
    def unknowns(self) -> int:
        """Free displacements of the mesh, with those inside the elements."""
        return int(self.free.size + self.elements.inside.size)

    @cached_property
    def matrix(self) -> sparse.csr_array:
        """Stiffness with the exterior, shape (2 N, 2 N); rows inside the elements are empty, fixed ones are not."""
        rows, cols = np.repeat(self.boundary, self.boundary.size), np.tile(self.boundary, self.boundary.size)
        inside = replace(self.elements, stiffness=self.stiffness_of_sides).assembled()
        return (inside + sparse.coo_array((self.exterior.ravel(), (rows, cols)), shape=inside.shape)).tocsr()

    @property
    def stiffness_of_sides(self) -> Array:
        """Stiffness of the elements on their sides, with the surface tension; shape (elements, m, m)."""
        if not self.tension:
            return self.elements.stiffness
        functions, tense = self.skin.of_elements
        stiffness, (columns, layers) = self.elements.stiffness.copy(), element_places(self.dofs.topo)
        for element in np.flatnonzero(layers == 0):
            rows = self.surface[functions[columns[element]]]
            local = np.argmax(self.elements.sides[element][:, None] == rows, axis=0)
            stiffness[element][np.ix_(local, local)] += self.tension * tense[columns[element]]
        return stiffness

    @cached_property
    def skin(self) -> SurfaceTension:
        """The work of a surface tension of 1."""
        return SurfaceTension(self.grid.r, self.body.order, self.body.solid.depth_exponent)

    def under_tension(self, tension: float) -> HalfSpace:
        """Return the half-space with a surface tension, and with the same elements, exterior and eliminations."""
        return self if tension == self.tension else replace(self, tension=tension)

    @cached_property
    def _forces(self) -> ElementForces:
        return ElementForces(self.grid, self.dofs, self.body.solid)

    def recovered(self, w: Array) -> Array:
        """Return the displacement of the mesh, shape (2 N, q), without that inside the elements, from its surface."""
        u = np.zeros((self.elements.size, w.shape[1]))
        u[self.surface] = w
        for elimination in reversed(self.eliminations):
            u[elimination.rows] = elimination.follow @ u[elimination.stays]
        return u

    def gathered(self, load: Array) -> Array:
        """Return the load on the surface, shape (m, q), that moves it as a load on the mesh does: shape (2 N, q)."""
        load = load.copy()
        for elimination in self.eliminations:
            load[elimination.stays] += elimination.follow.T @ load[elimination.rows]
        return np.asarray(load[self.surface])

    def completed(self, u: Array) -> Array:
        """Fill in the displacement inside every element, under that of the sides; shape (2 N, q)."""
        complete = u.copy()
        complete[self.elements.inside] = self.elements.follow @ u[self.elements.sides]
        return complete

    def remainder(self, load: Array, u: Array) -> Array:
        """What a displacement leaves of a load: the load minus the forces of elements and exterior.

        It is right to the rounding of these forces, while a product of the assembled stiffness is right to the rounding
        of the stiffness times the displacement, which is larger by the power of ten by which an element is thin.

        Parameters
        ----------
        load, u : ndarray, shape (2 N, q)
            No load inside the elements, nor the displacement there.

        Returns
        -------
        ndarray, shape (2 N, q)
            Zero on the rows that are fixed and on those inside the elements, whose remainder the sides bear.
        """
        elements = self.elements
        left = load - self._forces.under(self.completed(u))
        left[self.boundary] -= self.exterior @ u[self.boundary]
        if self.tension:
            left[self.surface] -= self.tension * self.skin.forces(u[self.surface])
        borne = np.swapaxes(elements.follow, 1, 2) @ left[elements.inside]
        for column, values in enumerate(borne.reshape(-1, left.shape[1]).T):
            left[:, column] += np.bincount(elements.sides.ravel(), values, minlength=elements.size)
        free = np.zeros_like(left)
        free[self.free] = left[self.free]
        return free


def assemble_half_space(grid: Grid, solid: Solid, order: int = 4, recoverable: bool = True) -> HalfSpace:
    """Assemble interior and exterior.

    Parameters
    ----------
    grid : Grid
        Interior grid.
    solid : Solid
        In units of the grid.
    order : int
        Element order, at least 2.
    recoverable : bool
        Whether the displacement inside the elements is recovered later.

    Returns
    -------
    HalfSpace
    """
    mesh = grid.quads()
    layer = float(grid.z[1])
    body = Body(mesh, InteriorChart(layer, solid.surface_exponent), solid, order)
    dofs = Dofs(mesh, ElementQuadP(order))
    elements = condensed_elements(tensor_stiffness(grid, dofs, solid), dofs, recoverable)
    boundary, weight = square_boundary(grid, dofs, order)
    outer = weight[:, None] * exterior_stiffness(grid, solid, order) * weight
    fixed = 2 * line_unknowns(dofs, 0, 0.0)
    if solid.bonded:
        fixed = np.concatenate([fixed, 2 * line_unknowns(dofs, 1, 0.0)])
    free = np.setdiff1d(elements.sides, fixed)
    surface = 2 * line_unknowns(dofs, 1, 0.0) + 1
    return HalfSpace(body, grid, dofs, elements, outer, free, surface, boundary, tension=solid.surface_tension)


def square_boundary(grid: Grid, dofs: Dofs, order: int) -> tuple[Index, Array]:
    """Rows on the side and bottom of the square in the order of its exterior, and the signs of their functions."""
    side = line_unknowns(dofs, 0, grid.extent)
    bottom = line_unknowns(dofs, 1, grid.extent, reverse=True)
    nz, nr, edges = grid.z.size - 1, grid.r.size - 1, order - 1
    square = np.concatenate([side[: nz + 1], bottom[1 : nr + 1], side[nz + 1 :], bottom[nr + 1 :]])
    signs = np.ones(square.size)
    signs[square.size - nr * edges :] = reversal_signs(nr, order)[nr + 1 :]
    return both_components(square), np.repeat(signs, 2)


def assembled(solid: Solid, spec: MeshSpec) -> HalfSpace:
    """Return the half-space on a mesh, whose surface alone is wanted."""
    return assemble_half_space(spec.grid(), solid, spec.order, recoverable=False)


def half_space_of(solid: Solid, spec: MeshSpec) -> HalfSpace:
    """Return the half-space on a mesh, kept for its whole system."""
    return _kept_half_space(solid.without_tension(), spec).under_tension(solid.surface_tension)


# Two: the mesh of the last path, whose events are solved next, and one before it; each holds some 50 MB.
@lru_cache(maxsize=2)
def _kept_half_space(solid: Solid, spec: MeshSpec) -> HalfSpace:
    return assemble_half_space(spec.grid(), solid, spec.order)
