"""Sums over the elements of a tensor-product mesh in place of a sparse matrix.

Every entry of the stiffness is a sum of entries of a few elements, and those of one element are dense: a product with
all elements at a time reads fewer bytes than one with a sparse matrix, whose parts take longer to be cut out than all
products of a solve.  The exterior couples the boundary; it is smooth and has a low rank.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.linalg.lapack import dpstrf

from fem_reference._elastic.assembly import HalfSpace
from fem_reference._elastic.elasticity import element_places
from fem_reference._elastic.scaling import unit_scaling
from fem_reference._typing import Array, Index

__all__ = ["Border", "ElementSum", "ScaledStiffness", "border_of", "grid_positions", "places_in"]


@dataclass(frozen=True, slots=True, eq=False)
class Border:
    """Coupling V V' of unknowns that are on the boundary of the mesh.

    Attributes
    ----------
    rows : ndarray of int, shape (b,)
        The unknowns.
    root : ndarray, shape (b, rank)
        V.
    """

    rows: Index
    root: Array

    def within(self, inside: Index, count: int) -> Border:
        """Return the part on some of `count` unknowns, numbered as they are there."""
        there = places_in(inside, count)[self.rows]
        return Border(there[there < inside.size], self.root[there < inside.size])


def border_of(rows: Index, coupling: Array) -> Border:
    """Return a positive semidefinite coupling as V V', to rounding.

    Examples
    --------
    >>> border_of(np.arange(2), np.array([[4.0, 2.0], [2.0, 1.0]])).root.tolist()
    [[2.0], [1.0]]
    """
    factor, order, rank, _ = dpstrf(coupling.T, lower=1)
    root = np.empty((rows.size, rank))
    root[order - 1] = np.tril(factor[:, :rank])
    return Border(rows, root)


@dataclass(frozen=True, slots=True, eq=False)
class ElementSum:
    """A matrix that is a sum over elements, with a coupling of the boundary.

    Attributes
    ----------
    targets, sources : ndarray of int, shapes (e, a) and (e, b)
        Rows and columns of each element.
    blocks : ndarray, shape (e, a, b)
    size : int
        Number of rows.
    to, of : Border
        The coupling V W' of a column of the matrix to a row.

    Examples
    --------
    >>> none = Border(np.empty(0, int), np.empty((0, 0)))
    >>> chain = ElementSum(np.array([[0, 1], [1, 2]]), np.array([[0], [1]]), np.ones((2, 2, 1)), 3, none, none)
    >>> (chain @ np.array([[5.0], [7.0]])).ravel().tolist()
    [5.0, 12.0, 7.0]
    """

    targets: Index
    sources: Index
    blocks: Array
    size: int
    to: Border
    of: Border

    def __matmul__(self, x: Array) -> Array:
        """Product with columns, shape (n, q)."""
        of_elements = self.blocks @ x.take(self.sources, axis=0)
        q, flat = x.shape[1], self.targets.ravel()
        product = np.empty((self.size, q))
        for column, values in enumerate(of_elements.reshape(-1, q).T):
            product[:, column] = np.bincount(flat, values, minlength=self.size)
        product[self.to.rows] += self.to.root @ (self.of.root.T @ x[self.of.rows])
        return product

    @property
    def nbytes(self) -> int:
        """Bytes of the blocks and indices."""
        return self.blocks.nbytes + self.targets.nbytes + self.sources.nbytes + self.to.root.nbytes


class ScaledStiffness:
    """The stiffness of a half-space on its free rows, scaled to a unit diagonal.

    Parameters
    ----------
    half_space : HalfSpace

    Attributes
    ----------
    scale : ndarray, shape (n,)
        D of the scaled stiffness D A D.
    sides : ndarray of int, shape (c, l, m)
        Place of each function of an element among the free rows, by column and row of the elements; of fixed ones 0,
        with zeros in the blocks.
    blocks : ndarray, shape (c, l, m, m)
        Scaled stiffness of the elements.
    border : Border
        The exterior, scaled.
    positions : ndarray of int, shape (2, n)
        Column and row of each unknown: even on grid lines, odd between them.
    ranks : ndarray of int, shape (n,)
        Number of each unknown among those of its vertex or edge.
    in_element : ndarray of int, shape (2, m)
        Column and row of each function of an element, from the corner of the element on: 0, 1 or 2.

    Raises
    ------
    NotConverged
        If a diagonal entry is not positive.
    """

    def __init__(self, half_space: HalfSpace) -> None:
        sides, size = half_space.elements.sides, half_space.elements.size
        free, boundary = half_space.free, half_space.boundary
        stiffness = half_space.stiffness_of_sides
        diagonals = np.einsum("eii->ei", stiffness)
        diagonal = np.asarray(np.bincount(sides.ravel(), diagonals.ravel(), minlength=size), float)
        diagonal[boundary] += np.diagonal(half_space.exterior)
        self.scale: Array = unit_scaling(diagonal[free])
        scale, place = np.zeros(size), np.zeros(size, np.intp)
        scale[free], place[free] = self.scale, np.arange(free.size)
        columns, rows = element_places(half_space.dofs.topo)
        order = np.lexsort((rows, columns)).reshape(columns.max() + 1, -1)
        self.sides: Index = place[sides[order]]
        of_sides = scale[sides[order]]
        self.blocks: Array = stiffness[order]
        self.blocks *= of_sides[..., :, None]
        self.blocks *= of_sides[..., None, :]
        present = np.flatnonzero(scale[boundary])
        on_boundary = scale[boundary[present]]
        exterior = half_space.exterior[np.ix_(present, present)]
        exterior *= on_boundary[:, None]
        exterior *= on_boundary
        self.border = border_of(place[boundary[present]], exterior)
        positions, ranks = np.repeat(grid_positions(half_space), 2, axis=1), _ranks(half_space)
        self.positions: Index = positions[:, free]
        self.ranks: Index = ranks[free]
        # All elements of a tensor-product mesh have the order of the first, which is in its corner.
        first = sides[order[0, 0]]
        self.in_element: Index = positions[:, first]
        self._rank_in_element = ranks[first]
        flat = self.sides.reshape(order.size, -1)
        blocks = self.blocks.reshape(order.size, *stiffness.shape[1:])
        self._sum = ElementSum(flat, flat, blocks, free.size, self.border, self.border)

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return int(self.scale.size)

    def __matmul__(self, x: Array) -> Array:
        """Product with columns, shape (n, q)."""
        return self._sum @ x

    def functions(self, axis: int, across: int, along: int) -> Index:
        """Return the functions of an element at a place of it, across and along an axis, by their rank."""
        places = self.in_element[axis], self.in_element[1 - axis]
        there = np.flatnonzero((places[0] == across) & (places[1] == along))
        return there[np.argsort(self._rank_in_element[there])]

    @property
    def _of_vertices(self) -> Index:
        """Functions of an element that are those of a vertex."""
        return np.flatnonzero(np.all(self.in_element != 1, axis=0))

    def on_vertices(self, vertices: Index) -> ElementSum:
        """Return the columns of all functions of vertices, in the order in which they are given."""
        local = self._of_vertices
        number = places_in(vertices, self.size)
        number[number == vertices.size] = 0
        targets, blocks = self._sum.targets, np.ascontiguousarray(self._sum.blocks[:, :, local])
        sources = number[targets[:, local]]
        return ElementSum(targets, sources, blocks, self.size, self.border, self.border.within(vertices, self.size))

    def among_vertices(self, vertices: Index, numbers: Index, size: int) -> sparse.csr_array:
        """Return the matrix of all functions of vertices, with another numbering and ones where it has none.

        Parameters
        ----------
        vertices, numbers : ndarray of int, shape (v,)
            The unknowns, and the number of each.
        size : int
            Rows of the result.
        """
        local = self._of_vertices
        number = np.zeros(self.size, np.intp)
        number[vertices] = numbers
        of_elements, blocks = number[self._sum.targets[:, local]], self._sum.blocks[:, local[:, None], local]
        border = self.border.within(vertices, self.size)
        of_border = numbers[border.rows]
        missing = np.setdiff1d(np.arange(size), numbers)
        rows = np.repeat(of_elements, local.size, axis=1).ravel(), np.repeat(of_border, of_border.size), missing
        columns = np.tile(of_elements, local.size).ravel(), np.tile(of_border, of_border.size), missing
        values = blocks.ravel(), (border.root @ border.root.T).ravel(), np.ones(missing.size)
        entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
        return sparse.coo_array(entries, shape=(size, size)).tocsr()

    @property
    def nbytes(self) -> int:
        """Bytes of the elements and of the border."""
        return self._sum.nbytes


def grid_positions(half_space: HalfSpace) -> Index:
    """Column and row of every vertex and edge function, shape (2, N): even on grid lines, odd between them."""
    dofs, grid = half_space.dofs, half_space.grid
    mesh = dofs.topo
    positions = np.zeros((2, dofs.N), np.intp)
    for position, along, nodes in zip(positions, mesh.p, (grid.r, grid.z), strict=True):
        of_vertices = 2 * np.searchsorted(nodes, along)
        position[dofs.nodal_dofs[0]] = of_vertices
        position[dofs.facet_dofs] = of_vertices[mesh.facets].sum(axis=0) // 2
    return positions


def _ranks(half_space: HalfSpace) -> Index:
    """Number of each row among those of its vertex or edge, shape (2 N,)."""
    edges, ranks = half_space.dofs.facet_dofs, np.zeros(half_space.dofs.N, np.intp)
    ranks[edges] = np.arange(edges.shape[0])[:, None]
    return (2 * ranks[:, None] + np.arange(2)).ravel()


def places_in(numbers: Index, size: int) -> Index:
    """Place of each of `size` numbers among some of them; of the others the place after the last.

    Examples
    --------
    >>> places_in(np.array([2, 0]), 4).tolist()
    [1, 2, 0, 2]
    """
    places = np.full(size, numbers.size)
    places[numbers] = np.arange(numbers.size)
    return places
