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
from fem_reference.errors import Failure, NotConverged

__all__ = ["surface_stiffness"]


def surface_stiffness(half_space: HalfSpace, recoverable: bool = True) -> Array:
    """Schur complement S of the half-space on u_z at the surface: S w = load.

    Parameters
    ----------
    half_space : HalfSpace
        Gets what recovers the displacement below its surface, if that is wanted.
    recoverable : bool
        Whether it is.

    Returns
    -------
    ndarray, shape (m, m)
        Symmetric positive definite, per radian, in surface order.

    Raises
    ------
    NotConverged
        When the matrix is singular or not positive definite.
    """
    surface, boundary = half_space.surface, half_space.boundary
    # The last vertex of the surface is on the boundary, and a row of the boundary is fixed: that on the axis.
    present = np.isin(boundary, half_space.free)
    exterior_rows = np.setdiff1d(boundary[present], surface)
    rows = np.concatenate([surface, exterior_rows])
    eliminations: list[Elimination] | None = [] if recoverable else None
    places = element_places(half_space.dofs.topo)
    K = condensed_on(rows, half_space.elements, places, half_space.free, eliminations)
    order = np.argsort(rows)
    local = order[np.searchsorted(rows[order], boundary[present])]
    K[np.ix_(local, local)] += half_space.exterior[np.ix_(present, present)]
    scale = unit_scaling(np.diagonal(K))
    S, follow = eliminated(scale[:, None] * K * scale, surface.size, recoverable)
    if eliminations is not None:
        follow = scale[surface.size :, None] * follow / scale[: surface.size]
        half_space.eliminations[:] = [*eliminations, Elimination(exterior_rows, surface, follow)]
    scale = scale[: surface.size]
    S = 0.5 * (S + S.T) / scale[:, None] / scale
    if half_space.tension:
        S = S + half_space.tension * half_space.skin.matrix.toarray()
    try:
        linalg.cholesky(S, check_finite=False)
    except linalg.LinAlgError as error:
        raise NotConverged("the surface stiffness is not positive definite", Failure.STIFFNESS) from error
    return S
