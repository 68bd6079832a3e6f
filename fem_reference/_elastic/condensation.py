"""Condensation of the half-space to its surface.

Nested dissection eliminates the inside of the grid; then the exterior joins at its boundary, which is eliminated next.
What is left is the Schur complement of u_z on the surface.
"""

from __future__ import annotations

import numpy as np
from scipy import linalg

from fem_reference._elastic.assembly import HalfSpace
from fem_reference._elastic.dissection import Elimination, condensed_on, eliminated
from fem_reference._elastic.elasticity import element_places
from fem_reference._elastic.scaling import unit_scaling
from fem_reference._typing import Array
from fem_reference.errors import NotConverged

__all__ = ["condensed", "surface_stiffness"]


def surface_stiffness(half_space: HalfSpace) -> Array:
    """Schur complement S of the half-space on u_z at the surface: S w = load.

    Parameters
    ----------
    half_space : HalfSpace
        The assembled half-space.

    Returns
    -------
    ndarray, shape (m, m)
        Symmetric positive definite, per radian, in surface order.

    Raises
    ------
    NotConverged
        When the matrix is singular or not positive definite.
    """
    return condensed(half_space)[0]


def condensed(half_space: HalfSpace, recoverable: bool = True) -> tuple[Array, Array]:
    """Surface stiffness, and its rounding as far as the two triangles of the elimination differ.

    Parameters
    ----------
    half_space : HalfSpace
        Gets what recovers the displacement below its surface, if that is wanted.
    recoverable : bool
        Whether it is, and the rounding; zero is returned for the latter otherwise.

    Returns
    -------
    stiffness, rounding : ndarray, shape (m, m)
        Both symmetric; rounding is the difference of the lower and the upper triangle, whose mean the stiffness is.

    Raises
    ------
    NotConverged
        As `surface_stiffness`.
    """
    surface, boundary = half_space.surface, half_space.boundary
    # The last vertex of the surface is on the boundary, and a row of the boundary is fixed: that on the axis.
    present = np.isin(boundary, half_space.free)
    exterior_rows = np.setdiff1d(boundary[present], surface)
    rows = np.concatenate([surface, exterior_rows])
    eliminations = half_space.eliminations if recoverable else None
    places = element_places(half_space.dofs.topo)
    K = condensed_on(rows, half_space.elements, places, half_space.free, eliminations)
    order = np.argsort(rows)
    local = order[np.searchsorted(rows[order], boundary[present])]
    K[np.ix_(local, local)] += half_space.exterior[np.ix_(present, present)]
    scale = unit_scaling(np.diagonal(K))
    S, follow = eliminated(scale[:, None] * K * scale, surface.size, eliminations is not None)
    if eliminations is not None:
        follow = scale[surface.size :, None] * follow / scale[: surface.size]
        eliminations.append(Elimination(exterior_rows, surface, follow))
    scale = scale[: surface.size]
    lower = np.tril((S - S.T) / scale[:, None] / scale)
    S = 0.5 * (S + S.T) / scale[:, None] / scale
    try:
        linalg.cholesky(S, check_finite=False)
    except linalg.LinAlgError as error:
        raise NotConverged("the surface stiffness is not positive definite; check modulus and mesh") from error
    return S, lower + lower.T
