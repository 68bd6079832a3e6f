"""Mesh that carries a whole path: that of a solid that scales, or of the point where folds merge.

The first width of the contact edge is the length over which the surface law and the solid balance; the path traced
on that mesh shows how wide the edge is, and the mesh is made again until it is fine enough.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache

from fem_reference._contact.cusp import slowest_sample
from fem_reference._contact.events import CUSP, PathEvents, beyond_pull_off
from fem_reference._contact.mesh_lengths import (
    NARROWEST_OF_ONE_MESH,
    UNRESOLVED,
    balance_length,
    check_width,
    mesh_spec,
)
from fem_reference._contact.meshes import Meshes
from fem_reference._contact.path import EDGE_RISE, traced
from fem_reference._contact.states import NARROWER, WIDTH_SHARE, Point, edge_width
from fem_reference._elastic.mesh import MeshSpec
from fem_reference.accuracy import SEARCH_DEGREE
from fem_reference.errors import Failure, NotConverged
from fem_reference.punch import radius_at_height

__all__ = ["FAR_SHARE", "WidthSearch", "path_on", "search_path_on"]

#: Share of the density far beyond the edge, where contact begins on a spot much smaller than the punch and the tension
#: falls within an element otherwise: on the meshes of "quick" the path of n = 6.2, k = 0.53, mu = 2.9 stops there with
#: 1, and with 0.5 it is that of 0.3 to 1e-6 (measured).
FAR_SHARE = 0.5

#: Smallest radius of the contact, relative to that where the punch rises by `EDGE_RISE`, below which it is small.
SMALL_SPOT = 0.25

#: Meshes in a row on which a path cannot be traced, after which meshes of a finer accuracy are tried: a narrower edge
#: does not help then.
FAILURES = 3

#: Meshes too coarse to tell the width of the edge, after which the narrowest one is taken to tell it: at k = 0.88 and
#: mu = 1.2 under a cone the edge is 1e-5 of its radius wide.
MOST_UNRESOLVED = 4

#: Ratio of the density of the first mesh of a search to that of the others: the width of the edge, which is rounded to
#: a power of 2, is known well enough there.
ESTIMATE = 1.5

#: Largest number of meshes tried to find the width of the edge.
REFINEMENTS = 10


# The paths of one problem: the search for the width, on the meshes of two kinds of events.
@lru_cache(maxsize=12)
def _path_or_reason(meshes: Meshes, spec: MeshSpec, size: float) -> PathEvents | NotConverged:
    """The path, or why it cannot be traced: the next quantity would try it again."""
    try:
        return PathEvents(tuple(traced(meshes.contact(spec, size))))
    except NotConverged as error:
        # Without its traceback, which would keep every frame of the path.
        return NotConverged(error.reason, error.failure)


def path_on(meshes: Meshes, spec: MeshSpec, size: float) -> PathEvents:
    """Return the whole path on one mesh.

    Raises
    ------
    NotConverged
        If it cannot be traced there.
    """
    path = _path_or_reason(meshes, spec, size)
    if isinstance(path, NotConverged):
        raise path.with_traceback(None)
    return path


def search_path_on(meshes: Meshes, spec: MeshSpec, size: float) -> PathEvents:
    """Return the whole path on one mesh with elements of the degree of a search, or with their own if that fails.

    Raises
    ------
    NotConverged
        If it cannot be traced with either.
    """
    with suppress(NotConverged):
        return path_on(meshes, replace(spec, order=SEARCH_DEGREE), size)
    return path_on(meshes, spec, size)


@dataclass(slots=True)
class WidthSearch:
    """Search for the coarsest mesh on which the edges of a path are resolved.

    Parameters
    ----------
    meshes : Meshes
    events : tuple of str
        Events that are needed: the edge of a part of the path that none of them needs may be sharper.
    """

    meshes: Meshes
    events: tuple[str, ...]
    smallest: float = math.inf
    apex: float = math.inf
    far_share: float = 1.0
    failures: int = 0
    unresolved: int = 0

    def mesh(self, start: tuple[MeshSpec, float] | None = None) -> tuple[MeshSpec, float]:
        """Return the mesh and the radius of its edge.

        Parameters
        ----------
        start : tuple, optional
            The mesh and size of a similar problem, to begin with.

        Raises
        ------
        NotConverged
            If the path cannot be traced, or the edge is narrower than the mesh can resolve.
        """
        spec, size = self._estimated() if start is None else start
        for _ in range(REFINEMENTS):
            try:
                samples = search_path_on(self.meshes, spec, size).samples
            except NotConverged:
                narrower = self._without_path(spec, size)
                if narrower == spec or self.failures == FAILURES:
                    raise
                spec = narrower
                continue
            following = self._following(spec, size, samples)
            if following is None:
                return spec, size
            spec = following
        raise NotConverged(
            "the width of the contact edge was not found: the edge is narrower than the mesh can resolve", Failure.MESH
        )

    def _first(self) -> tuple[MeshSpec, float]:
        """The mesh for the edge where law and solid balance."""
        punch, law = self.meshes.problem.punch, self.meshes.problem.law
        self.smallest = radius_at_height(punch, EDGE_RISE * law.z0)
        # The folds merge before there is a sharp edge: the mesh of a solid that scales is fine at this radius, too.
        at_spot = self.events == (CUSP,) and not self.meshes.one_for_all
        size = self.smallest if at_spot else 2.0 * radius_at_height(punch, law.z0)
        width = 0.5 * balance_length(self.meshes.problem, size) / size
        check_width(width, UNRESOLVED * NARROWEST_OF_ONE_MESH)
        return self._spec(width, size), size

    def _estimated(self) -> tuple[MeshSpec, float]:
        """The mesh for the edges of a path on elements that are too long: the search ends on what it accepts."""
        spec, size = self._first()
        with suppress(NotConverged):
            samples = search_path_on(self.meshes, replace(spec, density=ESTIMATE * spec.density), size).samples
            if all(edge_width(point) > 0.0 for point in self._needed(samples) if point.branch.touching):
                return self._following(spec, size, samples) or spec, size
        return spec, size

    def _spec(self, width: float, size: float) -> MeshSpec:
        meshes = self.meshes
        width = max(width, NARROWEST_OF_ONE_MESH)
        return mesh_spec(meshes.problem, meshes.level, width, size, self.smallest, self.far_share, self.apex)

    def _without_path(self, spec: MeshSpec, size: float) -> MeshSpec:
        """The mesh to try where a path cannot be traced.

        An under-resolved edge is pinned to the elements; or contact begins on a spot, which is as small as the solid
        and the law allow, far from elements that lose the rest of the punch.
        """
        self.failures += 1
        self.unresolved += 1
        balance = balance_length(self.meshes.problem, size)
        if self.meshes.one_for_all:
            self.smallest, self.far_share = min(self.smallest, balance), FAR_SHARE * self.far_share
        else:
            self.apex = balance
        return self._spec(NARROWER * spec.edge_width, size)

    def _following(self, spec: MeshSpec, size: float, samples: Sequence[Point]) -> MeshSpec | None:
        """The mesh to try after a path that was traced on one, or None if that one resolves it."""
        self.failures = 0
        points = self._needed(samples)
        if self.meshes.one_for_all:
            # Contact may begin on a spot much smaller than the punch, and the mesh shrinks with it.
            self.smallest = min(self.smallest, *(point.state.size for point in points))
            law = self.meshes.problem.law
            if self.smallest < SMALL_SPOT * radius_at_height(self.meshes.problem.punch, EDGE_RISE * law.z0):
                self.far_share = min(self.far_share, FAR_SHARE)
        narrowest = min((edge_width(point) for point in points if point.branch.touching), default=1.0)
        if narrowest <= 0.0:
            # The gap falls at the edge of a mesh that is too coarse to tell the width.
            self.unresolved += 1
            width = NARROWEST_OF_ONE_MESH if self.unresolved >= MOST_UNRESOLVED else NARROWER * spec.edge_width
            return self._spec(min(width, spec.edge_width), size)
        width = WIDTH_SHARE * narrowest
        check_width(width, UNRESOLVED * NARROWEST_OF_ONE_MESH)
        needed = self._spec(width, size)
        if self.unresolved >= MOST_UNRESOLVED:
            # The narrowest mesh has told the width.
            self.unresolved = 0
            return needed if needed != spec else None
        resolved = needed.edge_width >= spec.edge_width and needed.extent <= spec.extent
        if resolved and self.far_share >= spec.far_share:
            return None
        return self._spec(min(width, spec.edge_width), size)

    def _needed(self, points: Sequence[Point]) -> Sequence[Point]:
        """The part of a path in which the edge has to be resolved."""
        if self.events == (CUSP,):
            # The folds merge before the edge is as sharp as at the pull-off.
            return points[: slowest_sample(points) + 2]
        if any(beyond_pull_off(event) for event in self.events):
            return points
        # Beyond the pull-off the edge is sharper relative to its radius, but that part is not needed.
        deepest = min(range(len(points)), key=lambda i: points[i].state.load)
        return points[: deepest + 2]
