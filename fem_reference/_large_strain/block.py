"""A discretised half-space: a core of finite strain, its surface, and the linear exterior that closes it.

Lengths are in units of the size c of the mesh, whose edge is at s = 1.  The tangent is a sparse matrix on the sides of
the elements, which is factorised.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import SuperLU, splu

from fem_reference._elastic.assembly import square_boundary
from fem_reference._elastic.dof_ordering import line_unknowns
from fem_reference._elastic.elasticity import EXTRA_POINTS
from fem_reference._elastic.exterior import exterior_stiffness
from fem_reference._elastic.mesh import Grid
from fem_reference._elastic.trace import Trace, trace_of
from fem_reference._large_strain.core import Core, core_of
from fem_reference._large_strain.surface import local_slopes
from fem_reference._typing import Array, Index
from fem_reference.errors import NotConverged
from fem_reference.solid import Solid

__all__ = ["Block", "block_of", "factorised", "linear_response", "summed"]


@dataclass(frozen=True, eq=False)
class Block:
    """A discretised half-space, in lengths of the radius of its edge.

    Attributes
    ----------
    core : Core
    trace : Trace
        Its surface.
    slopes : ndarray
        Derivatives of the surface functions.
    radial : ndarray of int
        Rows of u_r on it in surface order; those of u_z are the next ones.
    boundary : ndarray of int
        Rows on the side and bottom of the square.
    exterior : ndarray
        Stiffness of the exterior there.
    fixed : ndarray of int
        Rows that are zero.
    """

    core: Core
    trace: Trace
    slopes: Array
    radial: Index
    boundary: Index
    exterior: Array
    fixed: Index

    @cached_property
    def surface_rows(self) -> Index:
        """Rows of the functions of each surface element, both components interleaved, shape (e, 2 (p + 1))."""
        rows = self.radial[self.trace.functions]
        return np.stack([rows, rows + 1], axis=2).reshape(rows.shape[0], -1)

    @cached_property
    def free(self) -> Index:
        """Rows on the sides of elements that are not fixed."""
        return np.setdiff1d(self.core.sides, self.fixed)

    @cached_property
    def _pattern(self) -> tuple[Index, Index, Index, Index]:
        """How entries of all parts go into a matrix of compressed columns on the free rows."""
        size = self.free.size
        number = np.full(self.core.size, -1)
        number[self.free] = np.arange(size)
        keys, present = [], []
        for rows in (self.core.sides, self.surface_rows, self.boundary[None]):
            numbers = number[rows]
            free = numbers >= 0
            keys.append((numbers[:, None, :] * size + numbers[:, :, None]).ravel())
            present.append((free[:, None, :] & free[:, :, None]).ravel())
        places = np.flatnonzero(np.concatenate(present))
        # With the place in the lowest bits: a sort of numbers is several times as fast as one of their places.
        bits = int(places.size).bit_length()
        ordered = np.sort((np.concatenate(keys)[places] << bits) | np.arange(places.size))
        key = ordered >> bits
        starts = np.flatnonzero(np.concatenate([[True], key[1:] != key[:-1]]))
        columns = np.searchsorted(key[starts], size * np.arange(size + 1))
        return places[ordered & ((1 << bits) - 1)], starts, key[starts] % size, columns

    def matrix(self, elements: Array, surface: Array) -> sparse.csc_array:
        """Tangent on the free rows from those of the elements and of the surface."""
        order, starts, rows, columns = self._pattern
        entries = np.concatenate([elements.ravel(), surface.ravel(), self.exterior.ravel()])[order]
        data = np.add.reduceat(entries, starts)
        return sparse.csc_array((data, rows, columns), shape=(self.free.size, self.free.size))


def block_of(
    grid: Grid,
    solid: Solid,
    order: int,
    mixed: bool,
    tension: float = 0.0,
    extra: int = EXTRA_POINTS,
) -> Block:
    """Discretise a half-space.

    Parameters
    ----------
    grid : Grid
        With its edge at s = 1.
    solid : Solid
        In lengths of the edge radius; its Poisson ratio is up to 0.5.
    order : int
        Degree of the elements.
    mixed : bool
        Whether the pressure is an unknown of its own; an incompressible solid needs it.
    tension : float
        Largest tension on the surface.
    extra : int
        Gauss points a direction beyond the degree.
    """

    def constants(z: Array) -> tuple[Array, Array]:
        E, ratio = solid.modulus(z), solid.poisson(z)
        with np.errstate(divide="ignore"):
            softness = np.divide((1.0 + ratio) * (1.0 - 2.0 * ratio), ratio * E)
        return E / (2.0 * (1.0 + ratio)), softness

    core = core_of(grid, constants, order, mixed, tension, extra)
    trace = trace_of(grid, order)
    boundary, signs = square_boundary(grid, core.dofs, order)
    exterior = exterior_stiffness(grid, solid, order, order - 1 if mixed else None)
    surface = 2 * line_unknowns(core.dofs, 1, 0.0)
    fixed = 2 * line_unknowns(core.dofs, 0, 0.0)
    if solid.bonded:
        fixed = np.union1d(fixed, surface)
    return Block(core, trace, local_slopes(trace), surface, boundary, signs[:, None] * exterior * signs, fixed)


def summed(rows: Index, entries: Array, size: int) -> Array:
    """Sum of entries by their rows."""
    return np.asarray(np.bincount(rows.ravel(), entries.ravel(), size), float)


def factorised(K: sparse.csc_array) -> SuperLU:
    """Factors of a tangent.

    Raises
    ------
    NotConverged
        If it is singular.
    """
    try:
        return splu(K, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    except RuntimeError as error:
        raise NotConverged(f"the tangent of the solid of finite strain is singular: {error}") from error


def linear_response(block: Block, pressure: Array, stiffness: Array) -> tuple[Array, Array]:
    """Displacement and pressures of the linear solid under a pressure at the Gauss points of its surface.

    Parameters
    ----------
    block : Block
    pressure : ndarray, shape (q,)
    stiffness : ndarray, shape (e, 2 (p + 1), 2 (p + 1))
        That of the surface elements.
    """
    core, trace = block.core, block.trace
    at_rest = np.zeros(core.size), core.no_pressure(), 1.0
    linear, forces = core.condensed(*at_rest), core.forces(*at_rest)
    if linear is None or forces is None:
        raise AssertionError("the undeformed solid is not turned inside out")
    tangent, condensed = linear
    factors = factorised(block.matrix(tangent, stiffness))
    down = (trace.weight * trace.s * pressure).reshape(trace.local.shape[0], 1, -1) @ trace.local
    load = summed(block.surface_rows[:, 1::2], down, core.size)
    u = np.zeros(core.size)
    u[block.free] = factors.solve(load[block.free])
    return u, core.recover(condensed, forces, core.eliminated(condensed, forces)[1], u)
