"""Tensor-product meshes of the half-space, fine at a contact edge and at the surface.

Radii r >= 0 run along the surface, depth z >= 0 into the solid.  Radial nodes sit at s_e + d sinh(x) and
depth nodes at d_z sinh(x) with x equally spaced: an element is about `density` times its distance from the
edge (or the surface), and never smaller than `density` times the width d that has to be resolved.  Where the modulus
changes within a short length, elements are no longer than `density` times that length plus the distance to it; where
it jumps there is a mesh line.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from skfem import MeshQuad

from fem_reference._elastic.depth_scales import DepthScales
from fem_reference._elastic.nodes import depth_nodes, outer_nodes, radial_nodes, sinh_nodes
from fem_reference._typing import Array

__all__ = ["Grid", "MeshSpec", "edge_grid", "ended", "shortened", "uniform_grid"]

#: Smallest ratio of the last depth to the one before it, where a mesh has been shortened.
CLEARANCE = 1.5

#: Smallest ratio of the last radius to the one before it, where a mesh ends before its extent.
NEAREST = 1.1

_NO_SCALES = DepthScales()


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """Nodes of a tensor-product mesh of [0, a] x [0, a].

    Attributes
    ----------
    r : ndarray, shape (nr + 1,)
        Radial nodes, from 0 to a.
    z : ndarray, shape (nz + 1,)
        Depth nodes, from 0 to a.

    Raises
    ------
    ValueError
        If the nodes do not rise strictly from 0, or the two sides differ.
    """

    r: Array
    z: Array

    def __post_init__(self) -> None:
        for name, nodes in (("radial", self.r), ("depth", self.z)):
            if nodes[0] != 0 or np.any(np.diff(nodes) <= 0):
                raise ValueError(f"{name} nodes must rise strictly from 0: the mesh would be folded over")
        if not math.isclose(self.r[-1], self.z[-1], rel_tol=1e-12):
            raise ValueError(f"the mesh ends at r = {self.r[-1]} and z = {self.z[-1]}; the exterior needs a square")

    @property
    def extent(self) -> float:
        """Side a of the meshed square."""
        return float(self.r[-1])

    def quads(self) -> MeshQuad:
        """Return the scikit-fem mesh (columns of quadrilaterals in r, rows in z)."""
        return MeshQuad.init_tensor(self.r, self.z)


def edge_grid(
    edge: float = 1.0,
    edge_width: float = 0.1,
    surface_depth: float = 0.05,
    extent: float = 100.0,
    density: float = 0.5,
    apex_width: float | None = None,
    scales: DepthScales = _NO_SCALES,
    far_share: float = 1.0,
    kinks: tuple[float, ...] = (),
) -> Grid:
    """Return a grid refined around the radius `edge` and towards the surface.

    Parameters
    ----------
    edge : float
        Radius at which the radial elements are smallest; a node sits there.
    edge_width : float
        Radial length to resolve at the edge; elements there have the size `density * edge_width`.
    surface_depth : float
        Depth to resolve under the surface; the first layer has the thickness `density * surface_depth`.
    extent : float
        Side of the meshed square.
    density : float
        Growth of element size with distance; halving it halves every element.
    apex_width : float, optional
        Radial length to resolve at r = 0 as well (a cone has a singular stress there).
    scales : DepthScales
        Depths and lengths of the modulus to follow.
    far_share : float
        Share of `density` that the radial elements more than one edge radius beyond the edge have, in (0, 1].
    kinks : tuple of float
        Radii where the slope of the punch jumps: mesh lines.

    Returns
    -------
    Grid

    Raises
    ------
    ValueError
        If a length is not positive or the edge is not inside the extent.
    """
    for name, value in (("edge_width", edge_width), ("surface_depth", surface_depth), ("density", density)):
        if not (math.isfinite(value) and value > 0):
            raise ValueError(f"{name} = {value} is outside (0, infinity): it is a length to resolve")
    if not 0 < edge < extent:
        raise ValueError(f"edge = {edge} is outside (0, extent = {extent}): the refined radius must lie in the mesh")
    if not 0 < far_share <= 1:
        raise ValueError(f"far_share = {far_share} is outside (0, 1]: it is a share of the density")
    depths = depth_nodes(surface_depth, extent, density, scales)
    if kinks:
        apex = edge if apex_width is None else apex_width
        return Grid(radial_nodes(edge, edge_width, apex, extent, density, np.array(kinks)), depths)
    if apex_width is None:
        inside = edge - sinh_nodes(edge_width, edge, density)[::-1]
    else:
        half = 0.5 * edge
        inside = edge - sinh_nodes(edge_width, half, density)[::-1]
        inside = np.concatenate([sinh_nodes(apex_width, half, density), inside[1:]])
    outside = edge + outer_nodes(edge, edge_width, extent - edge, density, far_share)
    inside[0], outside[-1] = 0.0, extent
    return Grid(np.concatenate([inside, outside[1:]]), depths)


def ended(grid: Grid, end: float) -> Grid:
    """Return a grid that ends at its first depth from `end` on, or the same if that is its last one.

    No element is much longer than it was: what the elements at the end leave of a value falls fast with their distance
    (measured at degree 4: up to 2e-9 of a pull-off force from an end of 74 on, up to 1e-10 from one of 180 on; up to
    2e-8 with an end at 134 that is 4 times as far as the last depth before it).

    Examples
    --------
    >>> shorter = ended(edge_grid(extent=1000.0), 100.0)
    >>> bool(100.0 <= shorter.extent < 200.0), bool(shorter.r[-1] == shorter.extent)
    (True, True)
    """
    last = int(np.searchsorted(grid.z, end))
    if last >= grid.z.size - 1:
        return grid
    return Grid(shortened(grid.r, float(grid.z[last]), NEAREST), grid.z[: last + 1])


def shortened(nodes: Array, end: float, clearance: float = CLEARANCE) -> Array:
    """Nodes up to a new end."""
    return np.append(nodes[nodes * clearance <= end], end)


def uniform_grid(extent: float, count: int) -> Grid:
    """Return `count` x `count` equal squares on [0, extent]^2 (for manufactured solutions).

    Examples
    --------
    >>> uniform_grid(1.0, 2).r
    array([0. , 0.5, 1. ])
    """
    nodes = np.linspace(0.0, extent, count + 1)
    return Grid(nodes, nodes.copy())


@dataclass(frozen=True, slots=True)
class MeshSpec:
    """What a mesh in units of the edge radius is made of (see `edge_grid`), hashable.

    Attributes
    ----------
    edge_width, surface_depth, extent, apex_width : float
        Lengths in units of the edge radius.
    density : float
        Growth of element size with distance.
    order : int
        Degree of the elements.
    scales : DepthScales
        Depths and lengths of the modulus, in units of the edge radius.
    far_share : float
        Share of `density` that the radial elements far beyond the edge have, where a punch is much wider than the
        contact.
    kinks : tuple of float
        Radii where the slope of the punch jumps, in units of the edge radius: the mesh then has one size only.
    punch_scales : DepthScales, optional
        As `scales`, of the solid of an elastic punch: both meshes have the same radial nodes.
    end : float
        Depth, in units of the edge radius, from which on the first node of a mesh of the whole `extent` ends this one:
        the elements within are the same.
    """

    edge_width: float
    surface_depth: float
    extent: float
    density: float
    order: int
    apex_width: float | None = None
    scales: DepthScales = _NO_SCALES
    far_share: float = 1.0
    kinks: tuple[float, ...] = ()
    punch_scales: DepthScales | None = None
    end: float = math.inf

    def grid(self) -> Grid:
        """Return the grid with its edge at s = 1."""
        grid = edge_grid(
            1.0,
            self.edge_width,
            self.surface_depth,
            self.extent,
            self.density,
            self.apex_width,
            self.scales,
            self.far_share,
            self.kinks,
        )
        return ended(grid, self.end)

    def moved(self, ratio: float) -> MeshSpec:
        """Return the mesh whose edge radius is `ratio` times as large, with the lines where they are.

        Examples
        --------
        >>> MeshSpec(0.1, 0.05, 100.0, 0.5, 4, kinks=(2.0,)).moved(4.0).kinks
        (0.5,)
        """
        punch_scales = None if self.punch_scales is None else self.punch_scales.scaled(ratio)
        kinks = tuple(r / ratio for r in self.kinks)
        return replace(self, scales=self.scales.scaled(ratio), kinks=kinks, punch_scales=punch_scales)

    def of_punch(self) -> Self:
        """Return the mesh of the punch, if it is elastic: its depth follows its own solid."""
        return self if self.punch_scales is None else replace(self, scales=self.punch_scales, punch_scales=None)
