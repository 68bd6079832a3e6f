"""Condensation of the half-space to its surface.

Unknowns are eliminated by nested dissection of the grid with the surface last, so the trailing block of one
sparse factorisation is the Schur complement of the surface.  No linear system is solved column by column.
"""

from __future__ import annotations

import numpy as np
from scipy import linalg
from scipy.sparse.linalg import splu

from fem_reference._elastic.assembly import HalfSpace
from fem_reference._typing import Array, Index
from fem_reference.errors import NotConverged

__all__ = ["condensed", "dissection_order", "grid_positions", "surface_stiffness"]


SYMMETRY_TOLERANCE = 1e-7
"""Relative asymmetry of the Schur complement that signals pivoting or a singular matrix (measured: 1e-12)."""


def grid_positions(half_space: HalfSpace) -> tuple[Index, Index]:
    """Grid position (column, row) of every scalar unknown: even on grid lines, odd between them.

    Returns
    -------
    column, row : ndarray of int, shape (N,)
    """
    basis, grid = half_space.basis, half_space.grid
    mesh = basis.mesh
    i = 2 * np.searchsorted(grid.r, mesh.p[0])
    j = 2 * np.searchsorted(grid.z, mesh.p[1])
    column, row = np.empty(basis.N, np.intp), np.empty(basis.N, np.intp)
    for position, value in ((column, i), (row, j)):
        position[basis.nodal_dofs[0]] = value
        position[basis.facet_dofs] = value[mesh.facets].sum(axis=0) // 2
        position[basis.interior_dofs] = value[mesh.t].sum(axis=0) // 4
    return column, row


def _dissect(i0: int, i1: int, j0: int, j1: int, rank: Index, start: int) -> int:
    """Rank the grid positions of a closed block so that separators come after what they separate."""
    ni, nj = i1 - i0, j1 - j0
    if max(ni, nj) < 4:
        for i in range(i0, i1 + 1):
            for j in range(j0, j1 + 1):
                # Interior of elements first: its elimination causes no fill.
                rank[i, j] = start + (0 if i % 2 and j % 2 else 1)
        return start + 2
    if ni >= nj:
        cut = i0 + ni // 2
        cut += cut % 2
        start = _dissect(i0, cut - 1, j0, j1, rank, start)
        start = _dissect(cut + 1, i1, j0, j1, rank, start)
        rank[cut, j0 : j1 + 1] = start
        return start + 1
    cut = j0 + nj // 2
    cut += cut % 2
    start = _dissect(i0, i1, j0, cut - 1, rank, start)
    start = _dissect(i0, i1, cut + 1, j1, rank, start)
    rank[i0 : i1 + 1, cut] = start
    return start + 1


def dissection_order(half_space: HalfSpace) -> Index:
    """Elimination order of the free rows: nested dissection, outer boundary, then the surface's u_z.

    Returns
    -------
    ndarray of int, shape (free,)
        Rows of the stiffness matrix.
    """
    grid = half_space.grid
    ni, nj = 2 * (grid.r.size - 1), 2 * (grid.z.size - 1)
    rank = np.zeros((ni + 1, nj + 1), np.intp)
    last = _dissect(0, ni - 1, 1, nj - 1, rank, 0)
    rank[ni, :] = last
    rank[:, nj] = last
    rank[:, 0] = last + 1
    column, row = grid_positions(half_space)
    key = np.repeat(rank[column, row], 2)
    key[half_space.surface] = last + 2
    position = np.zeros(key.size)
    position[half_space.surface] = np.arange(half_space.surface.size)
    free = half_space.free
    return free[np.lexsort((free, position[free], key[free]))]


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


def condensed(half_space: HalfSpace) -> tuple[Array, Array]:
    """Surface stiffness, and its rounding as far as the two triangles of the factorisation differ.

    Returns
    -------
    stiffness, rounding : ndarray, shape (m, m)
        Both symmetric; rounding is half the difference of the lower and the upper triangle.

    Raises
    ------
    NotConverged
        As `surface_stiffness`.
    """
    order = dissection_order(half_space)
    m = half_space.surface.size
    matrix = half_space.matrix[order][:, order].tocsc()
    scale = 1.0 / np.sqrt(matrix.diagonal())
    matrix.data *= scale[matrix.indices] * np.repeat(scale, np.diff(matrix.indptr))
    try:
        factors = splu(matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    except RuntimeError as error:
        raise NotConverged(f"the stiffness matrix is singular ({error}); check modulus, mesh and nu") from error
    tail = np.arange(order.size - m, order.size)
    if not (np.array_equal(factors.perm_c[tail], tail) and np.array_equal(factors.perm_r[tail], tail)):
        raise NotConverged("the factorisation reordered the surface unknowns; the matrix is not positive definite")
    S = factors.L[-m:, -m:].toarray() @ factors.U[-m:, -m:].toarray()
    if np.abs(S - S.T).max() > SYMMETRY_TOLERANCE * np.abs(S).max():
        raise NotConverged("the surface stiffness is not symmetric; the matrix is not positive definite")
    lower = np.tril(0.5 * (S - S.T) / scale[-m:, None] / scale[-m:])
    S = 0.5 * (S + S.T) / scale[-m:, None] / scale[-m:]
    try:
        linalg.cholesky(S)
    except linalg.LinAlgError as error:
        raise NotConverged(
            f"the surface stiffness is not positive definite ({error}); check modulus and mesh"
        ) from error
    return S, lower + lower.T
