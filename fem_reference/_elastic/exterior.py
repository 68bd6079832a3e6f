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
from numpy.typing import NDArray
from scipy import linalg
from skfem import Dofs, ElementQuadP, MeshQuad

from fem_reference._elastic.condensed_elements import condensed_elements
from fem_reference._elastic.dissection import condensed_on
from fem_reference._elastic.dof_ordering import both_components, line_unknowns
from fem_reference._elastic.elasticity import Body, element_places
from fem_reference._elastic.gauss import unit_gauss
from fem_reference._elastic.line_functions import line_projection
from fem_reference._elastic.mapping import ShellChart, first_layer_depth
from fem_reference._elastic.mesh import Grid
from fem_reference._elastic.tensor_elements import charted_stiffness
from fem_reference._typing import Array
from fem_reference.errors import Failure, NotConverged
from fem_reference.solid import PowerLaw, Solid, positive_modulus

__all__ = ["EXTERIOR_RATIO", "exterior_error", "exterior_stiffness"]


#: Scale ratio of one shell; at order 4 its radial error is below 1e-9 of the far field, itself 1/extent.
SHELL_RATIO = 1.3

#: Side of the square over the radius within which its bottom, and the depth within which its side, is one element for
#: the exterior. The field there is as smooth as the square is far, while the elements are those of the contact and of
#: its surface. The compliance of the contact changes, relative to its largest entry, by 2e-15 to 6e-10 at degree 7 and
#: by 3e-12 to 8e-9 at degree 4 where the side is 16 or 64 radii (measured for k = 0, 0.05, 0.6, 0.9; the largest for
#: k = 0.05), and falls like the compliance at the end of the mesh.
COARSE_RATIO = 8.0

#: Largest Poisson ratio of the exterior, whose stiffness needs a finite lambda: it changes by about 1 - 2 nu.
EXTERIOR_RATIO = 0.5 - 2.5e-8

#: Ratio 1.3^4096 at most: the remaining coupling is zero in double precision long before.
DOUBLINGS = 12

#: Doubling stops when the update of A, relative to A, is below rounding.
COUPLING_TOLERANCE = 1e-15


def exterior_stiffness(grid: Grid, solid: Solid, order: int, pressure_degree: int | None = None) -> Array:
    """Stiffness of the exterior of the square [0, a]^2 on its boundary.

    Parameters
    ----------
    grid : Grid
        Grid of the interior; the exterior has the nodes of its boundary, but those next to the surface and the axis.
    solid : Solid
        Its depth exponent, and its modulus and Poisson ratio at the depth a, are those of the exterior.  For a solid
        that is not a power law the square must be so large that this does not matter (see `exterior_error`).
    order : int
        Element order.
    pressure_degree : int, optional
        As for `charted_stiffness`.

    Returns
    -------
    ndarray, shape (2 m, 2 m)
        Symmetric; unknowns are the two interleaved components in an order that runs from the surface
        down the side and along the bottom to the axis.  The radial rows that are fixed, those of the last vertex and,
        if the surface is bonded, of the first, are there, and the caller removes them.

    Raises
    ------
    NotConverged
        If the doubling of shells does not end.
    """
    a = grid.extent
    k = solid.depth_exponent
    law = PowerLaw(float(solid.modulus(np.array(a))), a, k, min(float(solid.poisson(np.array(a))), EXTERIOR_RATIO))
    # Along the side down, then along the bottom to the axis.
    fine, keep = (
        np.concatenate([down, along])
        for down, along in ((grid.z, 2.0 * a - grid.r[-2::-1]), (_far(grid.z), _far(grid.r)[-2::-1]))
    )
    t = fine[keep.astype(bool)]
    mesh = MeshQuad.init_tensor(t, np.array([1.0, SHELL_RATIO]))
    layer = float(t[1])
    body = Body(mesh, ShellChart(a, layer, k), law, order)
    touching = np.flatnonzero(mesh.p[0][mesh.t].max(axis=0) <= layer * (1 + 1e-12))
    dofs = Dofs(mesh, ElementQuadP(order))
    elements = condensed_elements(charted_stiffness(body, dofs, touching, pressure_degree), dofs)
    inner = both_components(line_unknowns(dofs, 1, 1.0))
    outer = both_components(line_unknowns(dofs, 1, SHELL_RATIO))
    # u_r on the axis, and at a bonded surface.
    ends = (float(t[-1]), 0.0) if solid.bonded else (float(t[-1]),)
    fixed = 2 * np.concatenate([line_unknowns(dofs, 0, end) for end in ends])
    free = np.setdiff1d(elements.sides, fixed)
    present = ~np.isin(inner, fixed)
    condensed = condensed_on(np.concatenate([inner, outer])[np.tile(present, 2)], elements, element_places(mesh), free)
    condensed = 0.5 * (condensed + condensed.T)
    m = int(present.sum())
    A = _double(condensed[:m, :m], condensed[:m, m:], condensed[m:, m:], SHELL_RATIO ** (1.0 + k))

    def coordinate(y: Array) -> Array:
        """From the first layer of the interior to that of the exterior."""
        z = first_layer_depth(y, float(grid.z[1]), solid.surface_exponent)[0]
        return np.where(z < layer, layer * (z / layer) ** (1.0 - k), z)

    projection = np.kron(line_projection(fine, np.searchsorted(fine, t), order, coordinate), np.eye(2))[present]
    return np.asarray(projection.T @ A @ projection)


def _far(nodes: Array) -> NDArray[np.bool_]:
    """Whether the exterior has a node of a side: all in its outer part, and the end next to the contact."""
    return (nodes >= nodes[-1] / COARSE_RATIO) | (nodes == 0.0)


def _double(A: Array, B: Array, D: Array, factor: float) -> Array:
    """Stiffness of infinitely many self-similar shells; `factor` scales one shell to the next."""
    for _ in range(DOUBLINGS):
        try:
            root = linalg.cholesky(D + factor * A, lower=True)
        except linalg.LinAlgError as error:
            raise NotConverged("the stiffness of the exterior is not positive definite", Failure.STIFFNESS) from error
        inner = linalg.solve_triangular(root, B.T, lower=True)
        update = inner.T @ inner
        A = A - update
        if np.abs(update).max() <= COUPLING_TOLERANCE * np.abs(A).max():
            return A
        outer = factor * linalg.solve_triangular(root, B, lower=True)
        B, D = -(inner.T @ outer), factor * D - outer.T @ outer
        # Rounding must not unbalance the two triangles: the doubling would amplify it.
        A, D = 0.5 * (A + A.T), 0.5 * (D + D.T)
        factor *= factor
    raise NotConverged("the exterior shells did not converge by doubling", Failure.STIFFNESS)


#: Octaves of depth above and below the end of the mesh where the modulus is compared with that of the exterior.
OCTAVES_UP = 40

#: Gauss points an octave: the estimate is needed to a few per cent.
POINTS = 16

#: Largest change of the displacement relative to the product of the integrals (measured with meshes of 2^6 to 2^16
#: under a Gaussian load, for 15 moduli: coatings 100:1 to 1:100, offset power laws, exponentials: 0.02 to 0.39 for nu =
#: 0, 0.05 to 0.08 for nu = 0.3; a point load on a homogeneous solid stretches its surface by 1 - 2 nu).
SKIN_SHARE = 0.4


def exterior_error(solid: Solid, extent: float) -> float:
    """Estimate the relative error of the surface displacement from the power law that the exterior takes.

    Beyond the mesh the modulus is taken for E_x(z) = E(a) (z/a)^k, also above the depth a.  By reciprocity the
    displacement changes by the energy of the difference E - E_x in the field of a point load.  A skin of that field
    stretches with the solid under it, by about P/(E(a) r^2) at the radius r; integrated over r > a this gives
    P/(E(a) a) times T/a, with T the integral of |E - E_x|/E(a) over the depth.  The solid below the depth a adds its
    relative difference, weighted with a/z.  The displacement it is compared with is the integral of
    P/(E (1 + z)^2).

    Parameters
    ----------
    solid : Solid
        In lengths of the contact radius.  A Poisson ratio of depth changes the moduli E/(1 - nu^2) and E/(1 + nu) of a
        skin; the larger difference counts.
    extent : float
        Side a of the meshed square in the same lengths.

    Examples
    --------
    >>> exterior_error(PowerLaw(1.0, 1.0, 0.4, 0.3), 64.0)
    0.0
    """
    if solid.as_power_law is not None:
        return 0.0
    x, w = unit_gauss(POINTS)
    octaves = extent * 2.0 ** np.arange(-OCTAVES_UP, OCTAVES_UP)
    z = octaves[:, None] * (1.0 + x)
    weight = octaves[:, None] * w
    at_end = float(solid.modulus(np.array(extent)))
    law = at_end * (z / extent) ** solid.depth_exponent
    E = positive_modulus(solid, z)
    # Relative to those of the power law; both are E/law where Poisson's ratio is one number.
    ratio, ratio_at_end = solid.poisson(z), solid.poisson(np.array(extent))
    ratios = (
        E
        / law
        * np.array([np.ones_like(z), (1.0 - ratio_at_end**2) / (1.0 - ratio**2), (1.0 + ratio_at_end) / (1.0 + ratio)])
    )
    above = z < extent
    skin = float(np.sum((weight * law * np.abs(ratios - 1.0).max(axis=0))[above])) / (at_end * extent)
    below = float(np.max((np.maximum(ratios, 1.0 / ratios).max(axis=0) - 1.0)[~above] * extent / z[~above]))
    displacement = float(np.sum(weight / (E * (1.0 + z) ** 2)))
    return SKIN_SHARE * (skin + below) / (at_end * extent) / displacement
