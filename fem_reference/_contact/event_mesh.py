"""Mesh of an accuracy that is fine at the contact edge of an event."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TypeVar

from fem_reference._contact.carried import CarriedEvents
from fem_reference._contact.contact import Contact
from fem_reference._contact.event_kinds import CUSP
from fem_reference._contact.events import PathEvents
from fem_reference._contact.followed import FollowedPath, followed_path, path_on
from fem_reference._contact.meshes import Meshes
from fem_reference._contact.states import edge_is_resolved
from fem_reference._elastic.mesh import MeshSpec
from fem_reference.accuracy import SEARCH_DEGREE, finer_levels
from fem_reference.errors import NotConverged
from fem_reference.problem import Problem, checked_problem
from fem_reference.punch import check_without_asperities

__all__ = ["EventMesh", "chosen", "event_mesh", "whole_path"]

#: Heights of a punch, in lengths of the law, between which it may have no asperity: below, it is flat to the law, and
#: above, the tension is 1e-12 of its peak.
LOWEST, HIGHEST = 1e-8, 1e4


Computed = TypeVar("Computed")


@dataclass(frozen=True, slots=True)
class EventMesh:
    """A problem on the mesh that suits an event.

    Attributes
    ----------
    path : FollowedPath
        Of the problem, at an accuracy.
    spec : MeshSpec
        Of the degree and density of the accuracy.
    size : float
        Radius of the edge of the mesh, in the length unit of the input.
    event : str
        The event at whose contact edge the mesh is fine.
    """

    path: FollowedPath
    spec: MeshSpec
    size: float
    event: str

    @property
    def meshes(self) -> Meshes:
        """The meshes of the problem."""
        return self.path.meshes

    @property
    def contact(self) -> Contact:
        """The problem on this mesh."""
        return self.meshes.contact(self.spec, self.size, whole=True)

    @property
    def lower_contact(self) -> Contact:
        """The problem with the degree below."""
        return self.meshes.lower_contact(self.spec, self.size)

    @property
    def events(self) -> CarriedEvents:
        """The events of the path on this mesh; kept for all quantities.

        Raises
        ------
        NotConverged
            If the path cannot be traced.
        """
        return _carried(self)

    def resolves(self, event: str) -> bool:
        """Whether the mesh is fine at the contact edge of an event; one that scales is fine at all of them.

        An edge on elements that are longer than it is wide has an error that does not fall from one degree to the next:
        they do not bound it.

        Raises
        ------
        NoSuchEvent, NotConverged
            If the event is not found.
        """
        return self.meshes.scale or edge_is_resolved(self.events.at(event))

    @property
    def whole_path(self) -> PathEvents:
        """The whole path at the accuracy of the meshes: on this one if it scales, or over meshes for each radius.

        Raises
        ------
        NotConverged
            If the path cannot be traced.
        """
        return path_on(self.meshes, self.spec, self.size) if self.meshes.scale else self.path.events()


def event_mesh(
    meshes: Meshes,
    events: Sequence[str],
    start: tuple[MeshSpec, float] | None = None,
    force_alone: bool = False,
) -> EventMesh:
    """Return the mesh whose edge width, and size unless it scales, suit the computed gap.

    Parameters
    ----------
    meshes : Meshes
    events : sequence of str
        Events that are needed.  A mesh that does not scale is fine at the edge of the first.
    start : tuple, optional
        The mesh and size of a similar problem, to begin with.
    force_alone : bool
        Whether the pull-off force alone is wanted: a mesh that scales may end nearer.

    Raises
    ------
    NoSuchEvent
        If the path has no such point.
    NotConverged
        If the path cannot be traced, or the edge is narrower than the mesh can resolve.
    """
    path = followed_path(meshes)
    return EventMesh(path, *path.mesh(events, start, force_alone), events[0])


def chosen(
    problem: Problem,
    events: Sequence[str],
    accuracy: float | str,
    usable: Callable[[EventMesh], object] | None = None,
    start: tuple[MeshSpec, float] | None = None,
    force_alone: bool = False,
) -> EventMesh:
    """Choose the coarsest meshes, from those of an accuracy on, on which the path of a problem can be traced.

    Under a flat punch contact begins on a spot so much smaller than the punch that coarse meshes lose the rim.

    Parameters
    ----------
    problem : Problem
    events : sequence of str
        As for `event_mesh`.
    accuracy : float or str
        As for `fem_reference.accuracy.level_for`.
    usable : callable, optional
        Called with the result; if it raises NotConverged, other meshes are tried.
    start, force_alone
        As for `event_mesh`.

    Raises
    ------
    ValueError
        For an unknown accuracy, or for an object that is not a Problem.
    NoSuchEvent
        As `event_mesh`.
    NotConverged
        If the path cannot be traced on the finest meshes either, or is not known to end: on a punch with asperities.
    """

    def mesh(meshes: Meshes) -> EventMesh:
        suitable = event_mesh(meshes, events, start, force_alone)
        if usable is not None:
            usable(suitable)
        return suitable

    return _on_first(problem, accuracy, mesh)


def whole_path(problem: Problem, accuracy: float | str) -> PathEvents:
    """Return the whole path, on the first meshes from those of an accuracy that carry it.

    Raises
    ------
    ValueError, NotConverged
        As `chosen`.
    """
    return _on_first(problem, accuracy, _whole_path)


def _whole_path(meshes: Meshes) -> PathEvents:
    """The path of these meshes; one that scales is followed with a lower degree first, for its edges."""
    path = followed_path(meshes)
    return path_on(meshes, *path.mesh_of_path()) if meshes.scale else path.events()


def _on_first(problem: Problem, accuracy: float | str, computed: Callable[[Meshes], Computed]) -> Computed:
    """What is computed on the first meshes, from those of an accuracy on, on which it converges."""
    length = checked_problem(problem).law.z0
    check_without_asperities(problem.punch, LOWEST * length, HIGHEST * length)
    *coarser, finest = [Meshes(problem, level) for level in finer_levels(accuracy)]
    for meshes in coarser:
        with suppress(NotConverged):
            return computed(meshes)
    return computed(finest)


@lru_cache(maxsize=12)
def _carried(mesh: EventMesh) -> CarriedEvents:
    """Events of a path on the mesh of one of them; at a cusp the path is traced there as well."""
    if mesh.event == CUSP:
        path = path_on(mesh.meshes, replace(mesh.spec, order=SEARCH_DEGREE), mesh.size)
    else:
        path = mesh.path.events(mesh.event)
    return CarriedEvents(path, mesh.contact)
