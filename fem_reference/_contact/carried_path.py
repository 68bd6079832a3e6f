"""Path in contact whose states are carried from mesh to mesh, each fine at the contact edge of its state.

On one mesh of a solid that does not scale, the edge crosses elements that are longer than it is wide where the contact
becomes many times as large as at its beginning.  The path on that mesh has minima and maxima at its nodes, or ends.  A
state on a mesh that is fine at its edge is that of the problem, and so are its rates: two neighbours decide whether
there are turning points between them, as on one mesh.
"""

from __future__ import annotations

import math
from itertools import pairwise

from fem_reference._contact.completeness import complete_branch, displacement_sample, load_sample
from fem_reference._contact.edge_search import MINIMA, EdgeSearch
from fem_reference._contact.events import excess_of
from fem_reference._contact.path import Point
from fem_reference._elastic.mesh import MeshSpec
from fem_reference.errors import NotConverged

__all__ = ["carried_path", "found_on_carried"]

CARRIED_STEP = 0.2
"""Change of the logarithm of the radius from one mesh to the next.  The test of turning points asks for no mesh between
on cones at mu = 3 whose modulus falls to a fifth below the surface, and each state is found from the last."""

LARGEST_CHANGE = 1e-4
"""Change of delta in lengths of the law, and of P relative to the largest tension, below which two turning points are
not told from none.  It is above what the meshes of the search leave of a state: at most 6e-5 of the largest tension
(measured between the degrees 4 and 6 under a cone at mu = 3 on a solid whose modulus falls to a third)."""


def carried_path(search: EdgeSearch, inner: float, start: float) -> tuple[Point, ...]:
    """Return states in contact until the load is compressive, so close that no pair of turning points is between two.

    Parameters
    ----------
    search : EdgeSearch
        What solves on a mesh for each radius.
    inner : float
        Radius of the first contact edge.
    start : float
        Radius to begin with.

    Raises
    ------
    NotConverged
        If a state is not found, or turning points cannot be excluded.
    """
    points = [search.at(start)]
    while points[0].edge_radius > inner:
        points.insert(0, search.at(max(inner, points[0].edge_radius * math.exp(-CARRIED_STEP))))
    while not _settled(points[-1]):
        points.append(search.at(points[-1].edge_radius * math.exp(CARRIED_STEP)))
    length = points[0].branch.contact.law.length
    tension = abs(min(point.state.load for point in points))
    tests = ((displacement_sample, LARGEST_CHANGE * length), (load_sample, LARGEST_CHANGE * tension))
    return tuple(complete_branch(points, tests, lambda _, radius: search.at(radius)))


def _settled(point: Point) -> bool:
    """Whether the load is compressive and rises, and the displacement rises."""
    return point.state.load > 0.0 and point.load_rate > 0.0 and point.displacement_rate > 0.0


def found_on_carried(search: EdgeSearch, points: tuple[Point, ...], degree: int) -> tuple[MeshSpec, float]:
    """Return the mesh that is fine at the contact edge of an event on such a path, and the radius of that edge.

    Parameters
    ----------
    search : EdgeSearch
        For the event.
    points : tuple of Point
        As `carried_path` returns them.
    degree : int
        Of the elements on which the event will be solved.

    Raises
    ------
    NotConverged
        If the path has no such point: it may lie before there is a contact edge.  Also as `EdgeSearch.found`.
    """
    excess = excess_of(search.event, search.level)
    starts = [b.edge_radius for a, b in pairwise(points) if excess(a) < 0.0 <= excess(b)]
    if not starts:
        raise NotConverged(f"the path beyond the first contact edge, on a mesh for each radius, has no {search.event}")
    return search.lowest(starts if search.event in MINIMA else starts[-1:], degree)
