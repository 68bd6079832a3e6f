"""Mesh of an accuracy that is fine at the contact edge of an event, or at every edge of the path.

A problem whose compliance serves every size has one mesh (`fem_reference._contact.width_search`).  Otherwise the path
has a mesh for each radius of the contact edge, and so has each event (`fem_reference._contact.followed`).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from typing import TypeVar

from fem_reference._contact.carried import CarriedEvents
from fem_reference._contact.contact import Contact
from fem_reference._contact.events import CUSP, PathEvents
from fem_reference._contact.followed import followed_path
from fem_reference._contact.meshes import Meshes
from fem_reference._contact.width_search import WidthSearch, path_on, search_path_on
from fem_reference._elastic.mesh import MeshSpec
from fem_reference.accuracy import finer_levels
from fem_reference.errors import NotConverged
from fem_reference.problem import Problem
from fem_reference.punch import check_without_asperities

__all__ = ["EventMesh", "chosen", "event_mesh", "path_over_meshes", "whole_path"]

#: Heights of a punch, in lengths of the law, between which it may have no asperity: below, it is flat to the law, and
#: above, the tension is 1e-12 of its peak.
LOWEST, HIGHEST = 1e-8, 1e4


Computed = TypeVar("Computed")


@dataclass(frozen=True, slots=True)
class EventMesh:
    """A problem on the mesh that suits an event.

    Attributes
    ----------
    meshes : Meshes
        Of the problem, at an accuracy.
    spec : MeshSpec
        Of the degree and density of the accuracy.
    size : float
        Radius of the edge of the mesh, in the length unit of the input.
    event : str
        The event at whose contact edge the mesh is fine, or none if the mesh carries the whole path.
    """

    meshes: Meshes
    spec: MeshSpec
    size: float
    event: str = ""

    @property
    def contact(self) -> Contact:
        """The problem on this mesh."""
        return self.meshes.contact(self.spec, self.size)

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

    @property
    def whole_path(self) -> PathEvents:
        """The whole path: on this mesh if that carries it, or over meshes for each radius.

        Raises
        ------
        NotConverged
            If the path cannot be traced.
        """
        return followed_path(self.meshes).events() if self.event else path_on(self.meshes, self.spec, self.size)


def event_mesh(meshes: Meshes, events: Sequence[str], start: tuple[MeshSpec, float] | None = None) -> EventMesh:
    """Return the mesh whose edge width, and size if a mesh holds for one, suits the computed gap.

    Parameters
    ----------
    meshes : Meshes
    events : sequence of str
        Events that are needed.  A mesh that does not carry the whole path is fine at the edge of the first.
    start : tuple, optional
        The mesh and size of a similar problem, to begin with.

    Raises
    ------
    NoSuchEvent
        If a mesh does not carry the whole path and the path has no such point.
    NotConverged
        If the path cannot be traced, or the edge is narrower than the mesh can resolve.
    """
    if meshes.one_for_all or tuple(events) == (CUSP,):
        return EventMesh(meshes, *WidthSearch(meshes, tuple(events)).mesh(start))
    return EventMesh(meshes, *followed_path(meshes).mesh(events[0]), events[0])


def chosen(
    problem: Problem,
    events: Sequence[str],
    accuracy: float | str,
    usable: Callable[[EventMesh], object] | None = None,
    start: tuple[MeshSpec, float] | None = None,
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
    start : tuple, optional
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
    if not isinstance(problem, Problem):
        raise ValueError(f"problem = {problem!r} is not a Problem; make one of a solid, a punch and a surface law")
    length = problem.law.z0
    check_without_asperities(problem.punch, LOWEST * length, HIGHEST * length)

    def mesh(meshes: Meshes) -> EventMesh:
        suitable = event_mesh(meshes, events, start)
        if usable is not None:
            usable(suitable)
        return suitable

    return _on_first(problem, accuracy, mesh)


def whole_path(problem: Problem, accuracy: float | str) -> PathEvents:
    """Return the whole path, on one mesh or on a mesh for each radius.

    Raises
    ------
    ValueError, NotConverged
        As `chosen`.
    """
    return chosen(problem, ("zero_load",), accuracy, lambda mesh: mesh.whole_path).whole_path


def path_over_meshes(problem: Problem, accuracy: float | str) -> PathEvents:
    """Return the path over meshes for each radius, on the first meshes from those of an accuracy that carry it.

    Raises
    ------
    NotConverged
        If the path cannot be followed on the finest meshes either.
    """
    return _on_first(problem, accuracy, lambda meshes: followed_path(meshes).events())


def _on_first(problem: Problem, accuracy: float | str, computed: Callable[[Meshes], Computed]) -> Computed:
    """What is computed on the first meshes, from those of an accuracy on, on which it converges."""
    *coarser, finest = [Meshes(problem, level) for level in finer_levels(accuracy)]
    for meshes in coarser:
        with suppress(NotConverged):
            return computed(meshes)
    return computed(finest)


@lru_cache(maxsize=12)
def _carried(mesh: EventMesh) -> CarriedEvents:
    """Events of a path on the mesh of one of them, or on the mesh of the whole path."""
    if mesh.event:
        path = followed_path(mesh.meshes).events(mesh.event)
    else:
        path = search_path_on(mesh.meshes, mesh.spec, mesh.size)
    return CarriedEvents(path, mesh.contact)
