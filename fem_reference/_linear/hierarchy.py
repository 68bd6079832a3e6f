"""Hierarchy of pyamg for the vertex functions of the half-space: smoothed aggregation with strips as smoother.

pyamg's own smoothers change one vertex at a time.  On elements that are a thousand times longer than thick they leave
nearly all of an error that is smooth along the thin side only (measured: 0.96 to 0.999 of it a cycle), and the
iterations outside grow with the mesh.  The finest level of the hierarchy is still a tensor-product mesh, so strips
smooth it (0.5 to 0.7 of the error a cycle).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np
from scipy import sparse

from fem_reference._linear.algebraic_multigrid import pyamg
from fem_reference._linear.strips import StripSmoother, factorise, sparse_bytes, strips_of
from fem_reference._typing import Array, Index

__all__ = ["hierarchy_bytes", "vertex_hierarchy"]

#: Levels: on the second, which has a quarter of the unknowns, a sparse factorisation costs less than further levels,
#: whose smoother changes one aggregate at a time (measured at a Tabor number of 300: 14 iterations outside, 17 with
#: three levels).
LEVELS = 2


def vertex_hierarchy(matrix: Any, candidates: Array, positions: Sequence[Index]) -> pyamg.MultilevelSolver:
    """Return the hierarchy of a matrix on the vertices of a tensor-product mesh, two unknowns a vertex.

    Parameters
    ----------
    matrix : sparse array, shape (2 V, 2 V)
        Symmetric positive definite.
    candidates : ndarray, shape (2 V, c)
        Displacements that a coarse level must represent.
    positions : sequence of ndarray of int, shape (V,)
        Column and row of each vertex.

    Raises
    ------
    NotConverged
        If a strip of the mesh is singular.
    """
    with _same_numbers():
        return _hierarchy(matrix, candidates, positions)


@contextmanager
def _same_numbers() -> Iterator[None]:
    """Give pyamg the same random vectors every time: it takes them from NumPy's global generator.

    Another thread that draws from this generator at the same time gets them, too.
    """
    before = np.random.get_state()  # noqa: NPY002  # pyamg draws from the global generator
    np.random.seed(0)  # noqa: NPY002  # pyamg draws from the global generator
    try:
        yield
    finally:
        np.random.set_state(before)  # noqa: NPY002  # pyamg draws from the global generator


def _hierarchy(matrix: Any, candidates: Array, positions: Sequence[Index]) -> pyamg.MultilevelSolver:
    hierarchy = pyamg.smoothed_aggregation_solver(
        sparse.bsr_matrix(sparse.csr_matrix(matrix), blocksize=(2, 2)),
        B=candidates,
        strength=("evolution", {"epsilon": 4.0, "k": 2}),
        smooth=("energy", {"krylov": "cg", "maxiter": 3}),
        presmoother=None,
        postsmoother=None,
        max_levels=LEVELS,
        coarse_solver="splu",
    )
    if len(hierarchy.levels) > 1:
        finest = hierarchy.levels[0]
        A = sparse.csr_array(matrix)
        smoother = StripSmoother([strips for index in positions for strips in strips_of(A, np.repeat(index, 2))])
        finest.presmoother, finest.postsmoother = smoother, smoother.reversed()
    return hierarchy


def hierarchy_bytes(hierarchy: pyamg.MultilevelSolver) -> int:
    """Bytes of a hierarchy: its matrices, candidates and smoothers, and the factors of the coarsest level.

    Examples
    --------
    >>> hierarchy = pyamg.smoothed_aggregation_solver(sparse.csr_array(np.eye(10)))  # one level
    >>> hierarchy_bytes(hierarchy) - 12 * 20  # values and indices of the matrix 164, candidates 80
    244
    """
    total = 12 * factorise(sparse.csr_array(hierarchy.levels[-1].A)).nnz
    for level in hierarchy.levels:
        total += sum(sparse_bytes(getattr(level, name)) for name in ("A", "P", "R") if hasattr(level, name))
        total += level.B.nbytes
        # Both smoothers of a level share their factors, or the inverses of the diagonal blocks.
        smoother = getattr(level, "presmoother", None)
        if isinstance(smoother, StripSmoother):
            total += smoother.storage
        else:
            blocks = getattr(smoother, "keywords", {}).get("Dinv")
            total += 0 if blocks is None else blocks.nbytes
    return total
