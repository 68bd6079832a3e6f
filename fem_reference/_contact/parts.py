"""Parts of the error of a quantity, each from a computation that differs in one thing.

An event of the path is solved again on each of the others.  No part is taken from another method, and none is a factor
times another.

* mesh: the same elements with two lower degrees (`fem_reference._contact.degree_error`).  If the solid does not scale,
  the lower one of both neighbours has the contact edge half an element further out as well.  A law from a table
  has kinks, and a punch may have kinks or knots, whose error falls slowly with the degree or not at all: there the
  differences from elements of other lengths are added.
* first layer, interior and exterior: one feature is made coarser with elements of the lowest degree, whose error is
  larger as well.  What that changes is the part, unless it exceeds that of the mesh and half of the accuracy: then the
  elements have the highest degree.  The interior has a coarser apex where the exterior begins earlier: where a mesh
  ends before its extent, it is one that ends there, compared with one of the whole extent.
* edge: the same mesh, with the contact edge a quarter of an element further in and out.  If the solid does not scale:
  at the radius where the values of states beside it have an extremum, and as far on the other side, where that was
  looked for.
* tail: the displacement that the mesh leaves out, by its first term.
* rounding: that of the quantity itself.  The whole system (`fem_reference._contact.uncondensed`) adds what its
  displacement leaves of the traction, and its distance from the condensed system.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache

from fem_reference._contact.carried import CarriedEvents
from fem_reference._contact.contact import Contact
from fem_reference._contact.degree_error import LARGEST_GAIN, SMALLEST_GAIN, degree_error
from fem_reference._contact.event_mesh import EventMesh
from fem_reference._contact.other_lengths import other_lengths
from fem_reference._contact.tail import TailContact
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._elastic.variants import ENDS, FEATURES, SHRINKAGE, variant
from fem_reference._wells import has_one_well
from fem_reference.accuracy import SEARCH_DEGREE
from fem_reference.errors import NotConverged

__all__ = ["PARTS", "Estimate", "EventsOnMeshes", "events_on_meshes"]

#: Names of the parts of a bound.
PARTS = ("mesh", "first layer", "interior and exterior", "edge", "tail", "rounding")

#: Relative rounding of a quantity itself, whatever else its parts show (measured: 6e-15 of a force from one kernel of
#: the BLAS to another, where nothing else was left).
ROUNDING = 1e-14

#: Distance by which the contact edge is placed beside its node, in halves of the element beyond it.
PLACEMENT = 0.5


@dataclass(frozen=True, slots=True)
class Estimate:
    """Values of a quantity with three degrees, and the parts of the error of the last.

    Attributes
    ----------
    values : tuple of float
        Of rising degrees; the first is nan if the event is not found with it.
    parts : mapping of str to float
        By the names of `PARTS`.
    """

    values: tuple[float, float, float]
    parts: Mapping[str, float]


@dataclass(frozen=True, slots=True, eq=False)
class EventsOnMeshes:
    """The events of one path on its mesh, and the same events on others.

    Attributes
    ----------
    fine : CarriedEvents
        With the highest degree.
    lower, base : CarriedEvents
        With the degree below, and with the lowest.
    feature : callable
        Returns the events with a feature made coarser, of the lowest degree or, with True, of the highest.
    placements : tuple of CarriedEvents
        With another placement of the contact edge.
    resized : tuple of CarriedEvents
        With elements of other lengths, for a law or a punch with bends.
    tail : CarriedEvents
        With the displacement beyond the mesh.
    degrees : tuple of int
        Of `base`, `lower` and `fine`.
    accuracy : float
        Relative error asked for.
    largest_gain : float
        From one degree to the next, that is believed.
    """

    fine: CarriedEvents
    lower: CarriedEvents
    base: CarriedEvents
    feature: Callable[[str, bool], CarriedEvents]
    placements: tuple[CarriedEvents, ...]
    resized: tuple[CarriedEvents, ...]
    tail: CarriedEvents
    degrees: tuple[int, int, int]
    accuracy: float
    largest_gain: float = LARGEST_GAIN

    def estimate(self, functional: Callable[[CarriedEvents], float]) -> Estimate:
        """Return the values of a quantity and the parts of its error.

        Raises
        ------
        NoSuchEvent
            If the path has no such event.
        NotConverged
            If an event cannot be found on one of the meshes.
        """
        fine, lower, base = functional(self.fine), functional(self.lower), math.nan
        with suppress(NotConverged):
            base = functional(self.base)
        values = base, lower, fine
        mesh = degree_error(self.degrees, values, self.largest_gain) + sum(
            abs(functional(events) - fine) for events in self.resized
        )
        feature = {name: self._change(functional, name, values, mesh) for name in FEATURES}
        placement = max((abs(functional(events) - fine) for events in self.placements), default=0.0)
        parts = (
            mesh,
            feature["first layer"],
            feature[ENDS],
            placement,
            abs(functional(self.tail) - fine),
            ROUNDING * abs(fine),
        )
        return Estimate(values, dict(zip(PARTS, parts, strict=True)))

    def _change(
        self,
        functional: Callable[[CarriedEvents], float],
        name: str,
        values: tuple[float, float, float],
        mesh: float,
    ) -> float:
        """Difference that a coarser feature makes."""
        base, _, fine = values
        with suppress(NotConverged):
            change = abs(functional(self.feature(name, False)) - base)
            if change <= max(mesh, 0.5 * self.accuracy * abs(fine)):
                return change
        # The lower degree does not resolve the edge, what is under the surface, or what is next to the end.
        return abs(functional(self.feature(name, True)) - fine)


# The quantities of one problem are requested one after the other, on the meshes of two kinds of events.
@lru_cache(maxsize=4)
def events_on_meshes(mesh: EventMesh) -> EventsOnMeshes:
    """Return the events of a problem on all meshes of an accuracy.

    Parameters
    ----------
    mesh : EventMesh
        The finest.

    Raises
    ------
    NotConverged
        If the path cannot be traced.
    """
    fine, meshes, spec = mesh.events, mesh.meshes, mesh.spec
    problem, contact = meshes.problem, fine.contact
    # The path has been followed on it.
    plain = replace(spec, order=SEARCH_DEGREE, end=math.inf)
    # Another placement of the edge needs another mesh if the solid does not scale: that of the degree below.
    placements = (-PLACEMENT, PLACEMENT) if meshes.scale else ()
    sides = () if meshes.scale or fine.anchor(mesh.event).radius_error == 0.0 else (-1.0, 1.0)

    def on(other: MeshSpec) -> Contact:
        return meshes.contact(other, mesh.size)

    @lru_cache(maxsize=2 * len(FEATURES))
    def feature(name: str, full: bool) -> CarriedEvents:
        coarser = spec if full else plain
        if name == ENDS:
            # A mesh of the whole extent shows what another one loses by its end.
            coarser = replace(coarser, end=spec.end / SHRINKAGE if full else spec.end)
        return CarriedEvents(fine, on(variant(coarser, name)))

    resized = [replace(spec, density=ratio * spec.density) for ratio in other_lengths(problem, spec, mesh.size)]
    return EventsOnMeshes(
        fine,
        CarriedEvents(fine, mesh.lower_contact),
        CarriedEvents(fine, on(plain)),
        feature,
        (
            *(CarriedEvents(fine, contact, placement) for placement in placements),
            *(CarriedEvents(fine, contact, beside=beside) for beside in sides),
        ),
        (
            *(CarriedEvents(fine, on(other)) for other in resized),
            *(
                CarriedEvents(fine, replace(contact, force=force.finer))
                for force in [contact.force]
                if force.finer is not force
            ),
        ),
        # Far away the body moves most whose displacement falls most slowly.
        CarriedEvents(
            fine, TailContact(contact.force, contact.compliance, min(solid.depth_exponent for solid in problem.solids))
        ),
        (SEARCH_DEGREE, spec.order - 1, spec.order),
        meshes.level.accuracy,
        # Between two wells the gap of the barrier is at a second edge, in longer elements: with the largest gain the
        # energy lost by a double layer (b = 0.8, l = 1, mu = 0.7) was off by 1.0002 bounds, with the smallest by 0.8.
        LARGEST_GAIN if has_one_well(problem.law) else SMALLEST_GAIN,
    )
