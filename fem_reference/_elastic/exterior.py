"""Stiffness of the infinite exterior of the meshed square on its boundary.

There is no truncation radius.

With E ~ z^k, scaling lengths by tau multiplies stiffness by tau^(1+k).  Shells between the square [0, a]^2
and its copies scaled by s, s^2, ... are therefore one shell up to a factor.  If [[A, B], [B', D]] is its
condensed stiffness (inner, outer boundary), two shells condense to the same form for the ratio s^2, four to
s^4: after a dozen doublings the outer boundary is at infinity for any practical purpose and A is the exact
Dirichlet-to-Neumann matrix of the discrete exterior, for both modulus exponents and any Poisson ratio.
"""

from __future__ import annotations

import numpy as np
from scipy import linalg
from scipy.sparse.linalg import splu
from skfem import MeshQuad

from fem_reference._elastic.dof_ordering import both_components, line_unknowns
from fem_reference._elastic.elasticity import Body, stiffness
from fem_reference._elastic.mapping import ShellChart
from fem_reference._elastic.mesh import Grid
from fem_reference._typing import Array
from fem_reference.errors import NotConverged
from fem_reference.modulus import Modulus, PowerLawModulus

__all__ = ["exterior_stiffness"]


SHELL_RATIO = 1.3
"""Scale ratio of one shell; at order 4 its radial error is below 1e-9 of the far field, itself 1/extent."""

DOUBLINGS = 12
"""Ratio 1.3^4096 at most: the remaining coupling is zero in double precision long before."""

COUPLING_TOLERANCE = 1e-15
"""Doubling stops when the update of A, relative to A, is below rounding."""


def exterior_stiffness(grid: Grid, modulus: Modulus, nu: float, order: int) -> Array:
    """Stiffness of the exterior of the square [0, a]^2 on its boundary.

    Parameters
    ----------
    grid : Grid
        Grid of the interior; its boundary nodes are those of the exterior.
    modulus : Modulus
        Its depth exponent and its value at depth a define the power law of the exterior.  For a modulus
        that is no power law the square must reach to where it has become one.
    nu : float
        Poisson ratio.
    order : int
        Element order.

    Returns
    -------
    ndarray, shape (2 m, 2 m)
        Symmetric; unknowns are the two interleaved components in an order that runs from the surface
        down the side and along the bottom to the axis.  No condition on the axis has been applied: the
        last vertex keeps its radial row, which the caller removes.

    Raises
    ------
    NotConverged
        If the doubling of shells does not end.
    """
    a = grid.extent
    k = modulus.depth_exponent
    value = float(modulus(np.array(a)))
    law = modulus if isinstance(modulus, PowerLawModulus) else PowerLawModulus(value, a, k)
    t = np.concatenate([grid.z, a + (a - grid.r[::-1][1:])])
    mesh = MeshQuad.init_tensor(t, np.array([1.0, SHELL_RATIO]))
    first = float(grid.z[1])
    body = Body(mesh, ShellChart(a, first, k), law, nu, order)
    touching = np.flatnonzero(mesh.p[0][mesh.t].max(axis=0) <= first * (1 + 1e-12))
    matrix, basis = stiffness(body, touching, depth_axis=0)
    inner = both_components(line_unknowns(basis, 1, 1.0))
    outer = both_components(line_unknowns(basis, 1, SHELL_RATIO))
    axis = 2 * line_unknowns(basis, 0, float(t[-1]))
    free = np.setdiff1d(np.arange(matrix.shape[0]), np.concatenate([inner, outer, axis]))
    ends = np.concatenate([inner, outer])
    coupling = matrix[free][:, ends].toarray()
    condensed = matrix[ends][:, ends].toarray() - coupling.T @ splu(matrix[free][:, free].tocsc()).solve(coupling)
    m = inner.size
    on_axis = np.isin(inner, axis)
    keep = ~on_axis
    A = np.zeros((m, m))
    A[np.ix_(keep, keep)] = _double(
        condensed[:m, :m][np.ix_(keep, keep)],
        condensed[:m, m:][np.ix_(keep, keep)],
        condensed[m:, m:][np.ix_(keep, keep)],
        SHELL_RATIO ** (1.0 + k),
    )
    return A


def _double(A: Array, B: Array, D: Array, factor: float) -> Array:
    """Stiffness of infinitely many self-similar shells; `factor` scales one shell to the next."""
    for _ in range(DOUBLINGS):
        middle = linalg.cho_factor(D + factor * A)
        X = linalg.cho_solve(middle, np.hstack([B.T, factor * B]))
        XB, XC = X[:, : A.shape[0]], X[:, A.shape[0] :]
        update = B @ XB
        A_new = A - update
        D = factor * (D - B.T @ XC)
        B = -B @ XC
        # Rounding must not unbalance the two triangles: the doubling would amplify it.
        A, D = 0.5 * (A_new + A_new.T), 0.5 * (D + D.T)
        factor *= factor
        if np.abs(update).max() <= COUPLING_TOLERANCE * np.abs(A).max():
            return A
    raise NotConverged("the exterior shells did not converge by doubling; reduce the number of boundary elements")
