"""Exact solves of the strips of a tensor-product mesh, the smoother of the half-space (overlapping line Schwarz).

Elements have every aspect ratio, and unknowns are coupled strongly along thin columns and along thin rows.  A strip is
all between two grid lines four positions apart; every other strip is independent of the next, but for the exterior, so
that one factorisation solves half of them: by small dense blocks made of those of the elements (`block_tridiagonal`),
or a sparse one.  Strips are solved exactly, so that a residual is left on the lines between them only: it is kept and
changed there, at a tenth of the cost of a product with the whole matrix.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Protocol

from scipy import sparse
from scipy.sparse.linalg import SuperLU, splu

from fem_reference._linear.block_tridiagonal import BlockTridiagonal, spread
from fem_reference._linear.element_sums import ElementSum, ScaledStiffness, places_in
from fem_reference._linear.strip_blocks import PERIOD, coupling_of, split, strip_blocks
from fem_reference._typing import Array, Index
from fem_reference.errors import Failure, NotConverged

__all__ = ["StripSmoother", "Strips", "element_strips", "factorise", "sparse_bytes", "strips_of"]

#: Positions, of a period, of the lines between the strips of the first half and of the second.
_DROPPED = (PERIOD // 2, 0)


def factorise(matrix: Any) -> SuperLU:
    """Factorise by SuperLU in its symmetric mode, ten times faster here than its default.

    Parameters
    ----------
    matrix : csr_array or csc_array, shape (N, N)
        Symmetric, so that its rows are its columns.

    Raises
    ------
    RuntimeError
        If the matrix is singular.

    Examples
    --------
    >>> import numpy as np
    >>> factorise(sparse.csr_array(np.array([[2.0, 1.0], [1.0, 2.0]]))).solve(np.array([3.0, 3.0]))
    array([1., 1.])
    """
    columns = matrix.T if matrix.format == "csr" else matrix
    return splu(columns, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})


class _Factors(Protocol):
    """A factorised matrix."""

    def solve(self, b: Array, /) -> Array:
        """Solve for loads, shape (n,) or (n, q)."""


@dataclass(frozen=True, slots=True, eq=False)
class Strips:
    """Every other strip of the mesh, factorised.

    Attributes
    ----------
    inside, lines : ndarray of int
        Unknowns in the strips, and on the grid lines between them.
    factors : SuperLU or BlockTridiagonal
        Of the matrix on `inside`.
    coupling : csr_array or ElementSum
        The matrix, rows `lines` and columns `inside`.
    bytes_of_matrices : int
        Of both.
    """

    inside: Index
    lines: Index
    factors: _Factors
    coupling: sparse.csr_array | ElementSum
    bytes_of_matrices: int
    _places: tuple[Index, Index] = field(init=False)

    def __post_init__(self) -> None:
        size = self.inside.size + self.lines.size
        object.__setattr__(self, "_places", (places_in(self.inside, size), places_in(self.lines, size)))

    def correct(self, x: Array, residual: Array) -> None:
        """Solve the strips exactly; update x and the residual, shape (N,) or (N, q), in place."""
        change = self.factors.solve(residual.take(self.inside, axis=0))
        left = residual.take(self.lines, axis=0) - self.coupling @ change
        of_inside, of_lines = self._places
        x += spread(change, of_inside)
        residual[:] = spread(left, of_lines)

    @property
    def storage(self) -> int:
        """Bytes of factors, coupling and indices."""
        return self.bytes_of_matrices + sum(index.nbytes for index in (self.inside, self.lines, *self._places))


def strips_of(matrix: sparse.csr_array, positions: Index) -> list[Strips]:
    """Return both halves of the strips of a sparse matrix.

    Parameters
    ----------
    matrix : csr_array, shape (N, N)
        Symmetric positive definite.
    positions : ndarray of int, shape (N,)
        Position of each unknown across the lines, such as its column; unknowns on the same position are in one strip.

    Raises
    ------
    NotConverged
        If a strip is singular.

    Examples
    --------
    >>> import numpy as np
    >>> chain = sparse.diags_array([-np.ones(7), 2 * np.ones(8), -np.ones(7)], offsets=[-1, 0, 1]).tocsr()
    >>> [strips.lines.tolist() for strips in strips_of(chain, np.arange(8))]
    [[2, 6], [0, 4]]
    """
    strips = []
    for dropped in _DROPPED:
        inside, lines = split(positions, dropped)
        columns = matrix[:, inside].tocsr()
        try:
            factors = factorise(columns[inside])
        except RuntimeError as error:
            raise NotConverged(f"a strip of the mesh is singular ({error})", Failure.STIFFNESS) from error
        coupling = columns[lines]
        strips.append(Strips(inside, lines, factors, coupling, 12 * factors.nnz + sparse_bytes(coupling)))
    return strips


def element_strips(stiffness: ScaledStiffness, axis: int) -> list[Strips]:
    """Return both halves of the strips of the elements: columns (axis 0) or rows (axis 1).

    Raises
    ------
    NotConverged
        If a strip is singular.
    """
    strips = []
    for dropped in _DROPPED:
        inside, lines = split(stiffness.positions[axis], dropped)
        border = stiffness.border.within(inside, stiffness.size)
        factors = BlockTridiagonal(strip_blocks(stiffness, axis, dropped), border)
        coupling = coupling_of(stiffness, axis, dropped)
        strips.append(Strips(inside, lines, factors, coupling, factors.nbytes + coupling.nbytes))
    return strips


class StripSmoother:
    """Smoother of a level of pyamg: all strips, one half after the other.

    Parameters
    ----------
    strips : list of Strips
        Of the matrix of this level, in the order of their solves.
    """

    def __init__(self, strips: list[Strips]) -> None:
        self._strips = strips

    def __call__(self, A: Any, x: Array, b: Array) -> None:
        """Improve a solution of A x = b, shape (N,), in place."""
        residual = b - A @ x
        for strips in self._strips:
            strips.correct(x, residual)

    def reversed(self) -> StripSmoother:
        """Return the adjoint: the same strips in the opposite order."""
        return StripSmoother(self._strips[::-1])

    @property
    def storage(self) -> int:
        """Bytes of the strips."""
        return sum(strips.storage for strips in self._strips)


def sparse_bytes(matrix: Any) -> int:
    """Values and both index arrays of a compressed matrix."""
    return int(matrix.data.nbytes + matrix.indices.nbytes + matrix.indptr.nbytes)
