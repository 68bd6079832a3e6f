"""Choice of the mesh of an accuracy, with an edge as fine as the computed gap needs.

A solid that scales has one mesh for every size of the contact (`fem_reference._contact.one_mesh`).  Otherwise the path
has a mesh for each radius of the contact edge, and so has each event (`fem_reference._contact.followed`).
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from fem_reference._contact.bodies import compliance_of
from fem_reference._contact.contact import Contact
from fem_reference._contact.events import CUSP, PathEvents
from fem_reference._contact.followed import FollowedPath
from fem_reference._contact.mesh_lengths import balance_length, check_width, mesh_spec, scales, spot_length
from fem_reference._contact.one_mesh import OneMesh
from fem_reference._contact.path import EDGE_RISE
from fem_reference._contact.resolved import ResolvedEvents
from fem_reference._contact.tracing import traced
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._elastic.variants import VariantSpec
from fem_reference.accuracy import SEARCH_DEGREE, Level, finer_levels
from fem_reference.errors import NotConverged
from fem_reference.problem import Problem
from fem_reference.punch import check_without_asperities, radius_at_height

__all__ = ["MeshChoice", "chosen", "followed_path", "path_over_meshes", "whole_path"]

#: Heights of a punch, in lengths of the law, between which it may have no asperity: below, it is flat to the law, and
#: above, the tension is 1e-12 of its peak.
LOWEST, HIGHEST = 1e-8, 1e4


@dataclass(frozen=True, slots=True)
class MeshChoice:
    """The mesh for a problem at an accuracy.

    Parameters
    ----------
    problem : Problem
    level : Level
        Degree and density of the meshes.
    event : str, optional
        The event at whose contact edge the mesh is fine, if the solid does not scale.
    """

    problem: Problem
    level: Level
    event: str = ""

    def contact(self, spec: MeshSpec, size: float) -> Contact:
        """Discretise the problem on a mesh with its edge at the radius `size`."""
        # The whole system is solved on meshes of the accuracy itself, not on those that differ in one thing.
        whole = spec.order == self.level.order and not isinstance(spec, VariantSpec)
        return Contact(self.problem.force, compliance_of(self.problem, spec, size, self.scaling, whole))

    def lower_contact(self, spec: MeshSpec, size: float) -> Contact:
        """Discretise the problem with the degree below.

        If the solid does not scale, the edge is half an element further out, too.
        """
        below = replace(spec, order=spec.order - 1)
        if self.scaling:
            return self.contact(below, size)
        # Another placement needs another mesh: the one for the other degree serves both.
        r = spec.grid().r
        other_size = size * (0.5 + 0.5 * float(r[np.argmin(abs(r - 1.0)) + 1]))
        return self.contact(below.moved(other_size / size), other_size)

    def traced(self, spec: MeshSpec, size: float) -> ResolvedEvents:
        """The events of the path on that mesh; kept for all quantities.

        Raises
        ------
        NotConverged
            If the path cannot be traced.
        """
        return _resolved(self, spec, size)

    def path(self, spec: MeshSpec, size: float) -> PathEvents:
        """The whole path on that mesh.

        Raises
        ------
        NotConverged
            If it cannot be traced there.
        """
        path = _traced(self, spec, size)
        if isinstance(path, str):
            raise NotConverged(path)
        return path

    def search_path(self, spec: MeshSpec, size: float) -> PathEvents:
        """The whole path on that mesh with elements of the degree of a search, or with their own if that fails.

        Raises
        ------
        NotConverged
            If it cannot be traced with either.
        """
        with suppress(NotConverged):
            return self.path(replace(spec, order=SEARCH_DEGREE), size)
        return self.path(spec, size)

    @property
    def scaling(self) -> bool:
        """Whether one mesh carries the path: the compliance of one size is that of every size, but for a factor."""
        return scales(self.problem)

    def adapted(
        self, events: tuple[str, ...], start: tuple[MeshSpec, float] | None = None
    ) -> tuple[MeshChoice, MeshSpec, float]:
        """Mesh whose edge width (and, if the solid does not scale, size) fits the computed gap.

        Parameters
        ----------
        events : tuple of str
            Events that are needed.  If the solid does not scale, the mesh is fine at the edge of the first.
        start : tuple, optional
            The mesh and size of a similar problem, to begin with.

        Returns
        -------
        choice : MeshChoice
            This one, or one whose event is at the edge of the mesh.
        spec : MeshSpec
            Of the degree and density of the accuracy.
        size : float
            Radius of the edge of the mesh, in the length unit of the input.

        Raises
        ------
        NoSuchEvent
            If the solid does not scale and the path has no such point.
        NotConverged
            If the path cannot be traced, or the edge is narrower than the mesh can resolve.
        """
        if self.scaling or events == (CUSP,):
            return self, *OneMesh(self, events).found(start)
        return replace(self, event=events[0]), *followed_path(self).mesh(events[0])

    def spec_at(self, width: float, radius: float) -> MeshSpec:
        """Mesh of a solid that does not scale, for an edge of that relative width at a radius."""
        law, punch = self.problem.law, self.problem.punch
        smallest = min(radius, radius_at_height(punch, EDGE_RISE * law.z0))
        apex = spot_length(self.problem, 2.0 * radius_at_height(punch, law.z0))
        return mesh_spec(self.problem, self.level, width, radius, smallest, apex=apex)

    def first_mesh(self) -> tuple[MeshSpec, float]:
        """Mesh on which the path of a solid that does not scale begins, and the radius of its edge."""
        size = 2.0 * radius_at_height(self.problem.punch, self.problem.law.z0)
        width = 0.5 * balance_length(self.problem, size) / size
        check_width(width)
        return self.spec_at(width, size), size


def whole_path(problem: Problem, accuracy: float | str) -> PathEvents:
    """Return the whole path, on one mesh or, if the solid does not scale, on a mesh for each radius.

    Raises
    ------
    ValueError, NotConverged
        As `chosen`.
    """

    def path(choice: MeshChoice, spec: MeshSpec, size: float) -> PathEvents:
        if choice.scaling:
            return choice.path(spec, size)
        return followed_path(choice).events()

    return path(*chosen(problem, ("zero_load",), accuracy, path))


def followed_path(choice: MeshChoice) -> FollowedPath:
    """Return the path of a solid that does not scale, followed once for all of its events."""
    return _followed(replace(choice, event=""))


def path_over_meshes(problem: Problem, accuracy: float | str) -> PathEvents:
    """Return the path of a solid that does not scale, on the first meshes from those of an accuracy that carry it.

    Raises
    ------
    NotConverged
        If the path cannot be followed on the finest meshes either.
    """
    *coarser, finest = [MeshChoice(problem, level) for level in finer_levels(accuracy)]
    for choice in coarser:
        with suppress(NotConverged):
            return followed_path(choice).events()
    return followed_path(finest).events()


# Several problems are solved in turns where a parameter is varied.
@lru_cache(maxsize=2)
def _followed(choice: MeshChoice) -> FollowedPath:
    return FollowedPath(choice, choice.first_mesh())


def chosen(
    problem: Problem,
    events: tuple[str, ...],
    accuracy: float | str,
    usable: Callable[[MeshChoice, MeshSpec, float], object] | None = None,
    start: tuple[MeshSpec, float] | None = None,
) -> tuple[MeshChoice, MeshSpec, float]:
    """Choose the coarsest meshes, from those of an accuracy on, on which the path of a problem can be traced.

    Under a flat punch contact begins on a spot so much smaller than the punch that coarse meshes lose the rim.

    Parameters
    ----------
    problem : Problem
    events : tuple of str
        As for `MeshChoice.adapted`.
    accuracy : float or str
        As for `fem_reference.accuracy.level_for`.
    usable : callable, optional
        Called with the result; if it raises NotConverged, other meshes are tried.
    start : tuple, optional
        As for `MeshChoice.adapted`.

    Returns
    -------
    choice : MeshChoice
    spec, size
        As `MeshChoice.adapted` returns them.

    Raises
    ------
    ValueError
        For an unknown accuracy, or for an object that is not a Problem.
    NoSuchEvent
        As `MeshChoice.adapted`.
    NotConverged
        If the path cannot be traced on the finest meshes either, or is not known to end: on a punch with asperities.
    """
    if not isinstance(problem, Problem):
        raise ValueError(f"problem = {problem!r} is not a Problem; make one of a solid, a punch and a surface law")
    length = problem.law.z0
    check_without_asperities(problem.punch, LOWEST * length, HIGHEST * length)

    def used(meshes: tuple[MeshChoice, MeshSpec, float]) -> tuple[MeshChoice, MeshSpec, float]:
        if usable is not None:
            usable(*meshes)
        return meshes

    *coarser, finest = [MeshChoice(problem, level) for level in finer_levels(accuracy)]
    for choice in coarser:
        with suppress(NotConverged):
            return used(choice.adapted(events, start))
    return used(finest.adapted(events, start))


# The paths of one problem: the search for the width, on the meshes of two kinds of events.
@lru_cache(maxsize=12)
def _traced(choice: MeshChoice, spec: MeshSpec, size: float) -> PathEvents | str:
    """The path, or why it cannot be traced: the next quantity would try it again."""
    try:
        return PathEvents(tuple(traced(choice.contact(spec, size))))
    except NotConverged as reason:
        return str(reason)


@lru_cache(maxsize=12)
def _resolved(choice: MeshChoice, spec: MeshSpec, size: float) -> ResolvedEvents:
    """Events of a path on a mesh that is fine at the edge of one of them, or at all if the solid scales."""
    path = followed_path(choice).events(choice.event) if choice.event else choice.search_path(spec, size)
    return ResolvedEvents(path, choice.contact(spec, size))
