"""Order of the unknowns along a grid line, shared by interior, exterior and surface.

The order is: the vertices along the line, then the p - 1 edge functions of each element in turn.
"""

from __future__ import annotations

import numpy as np
from skfem import Dofs

from fem_reference._typing import Array, Index

__all__ = ["both_components", "line_unknowns", "reversal_signs"]


def line_unknowns(dofs: Dofs, axis: int, value: float, reverse: bool = False) -> Index:
    """Scalar unknowns on the grid line x[axis] = value of a tensor-product mesh.

    Parameters
    ----------
    dofs : skfem.Dofs
        Numbering of the functions of `ElementQuadP`.
    axis : int
        Mesh coordinate that is constant on the line.
    value : float
        Its value; must be a grid line.
    reverse : bool
        Order them against the other coordinate.

    Returns
    -------
    ndarray of int
        Vertices along the line, then edge functions element by element.

    Examples
    --------
    >>> from skfem import ElementQuadP, MeshQuad
    >>> dofs = Dofs(MeshQuad.init_tensor(np.array([0.0, 1.0, 2.0]), np.array([0.0, 1.0])), ElementQuadP(3))
    >>> surface = line_unknowns(dofs, 1, 0.0)
    >>> surface.size, dofs.topo.p[0][surface[:3]].tolist()  # three vertices and two functions on each of two edges
    (7, [0.0, 1.0, 2.0])
    """
    p = dofs.topo.p
    facets = dofs.topo.facets
    on_line = p[axis] == value
    vertices = np.flatnonzero(on_line)
    edges = np.flatnonzero(on_line[facets].all(axis=0))
    along = p[1 - axis]
    vertices = vertices[np.argsort(along[vertices])]
    edges = edges[np.argsort(along[facets[:, edges]].mean(axis=0))]
    if reverse:
        vertices, edges = vertices[::-1], edges[::-1]
    return np.concatenate([dofs.nodal_dofs[0, vertices], dofs.facet_dofs[:, edges].T.ravel()])


def reversal_signs(elements: int, order: int) -> Array:
    """Signs of the functions of a line in reverse order: those of edge functions of odd degree change.

    Examples
    --------
    >>> reversal_signs(1, 4)
    array([ 1.,  1.,  1., -1.,  1.])
    """
    edge = np.array([(-1.0) ** degree for degree in range(2, order + 1)])
    return np.concatenate([np.ones(elements + 1), np.tile(edge, elements)])


def both_components(scalar: Index) -> Index:
    """Interleave the unknowns 2 i (u_r) and 2 i + 1 (u_z) of scalar unknowns i.

    Examples
    --------
    >>> both_components(np.array([3, 5]))
    array([ 6,  7, 10, 11])
    """
    return np.stack([2 * scalar, 2 * scalar + 1], axis=1).reshape(2 * scalar.shape[0], *scalar.shape[1:])
