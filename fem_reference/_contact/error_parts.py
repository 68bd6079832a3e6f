"""Parts of the error of a quantity, each from a computation that differs in one thing.

The path on the finest mesh finds an event, and only the event is solved again on the others.  No part is taken from
another method, and none is a factor times another.

* mesh: three densities, and a lower degree at the medium one (`fem_reference._contact.uncertainty`).  Where that leaves
  more than `UNCERTAIN` of a solid that does not scale, the lower degree is taken on the finest mesh as well, and tells
  the error there.
* first layer, interior and exterior, apex: one feature of the coarsest mesh is made coarser, and what that changes is
  the part.  These features are `density` times a length too (the extent is the same at all densities), and so the
  error on the finest mesh is smaller.  For the first layer and the apex the elements have a lower degree, whose error
  is larger as well; they have the full one where that difference is too large (`UNCERTAIN`) and the solid does not
  scale.  For the extent they have the full one, since at a lower degree the elements next to the end alone change a
  displacement by a hundred times as much as the end does (n = 5).
* edge: the same mesh, with the contact edge half an element further in and out, plus the apex.
* tail: the displacement that the mesh leaves out, by its first term.
* algebra: another triangle of the factorisation, another start of Newton's method, another root search.  The whole
  system (`fem_reference._contact.uncondensed`) adds its own.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from fem_reference._contact.contact import Contact
from fem_reference._contact.events import PathEvents
from fem_reference._contact.mesh_choice import MeshChoice
from fem_reference._contact.resolved import ResolvedEvents
from fem_reference._contact.tail import TailContact
from fem_reference._contact.uncertainty import Convergence, three_meshes, two_degrees
from fem_reference._elastic.compliance import FixedCompliance
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._elastic.variants import EXTENT, FEATURES, variant
from fem_reference.errors import NotConverged

__all__ = ["PARTS", "Estimate", "EventsOnMeshes", "events_on_meshes"]

#: Names of the parts of a bound.
PARTS = ("mesh", "first layer", "interior and exterior", "edge", "tail", "algebra")

#: Degrees by which the elements of the meshes that differ in one feature are lower: they cost a third of those of the
#: full degree, and the difference that a feature makes is larger (measured: 2.4 to 1400 times for five quantities of
#: ten random problems, n = 1 ... 5.7, k = 0 ... 0.65, mu = 0.06 ... 2).
FEATURE_DEGREES = 2

#: Error of the densities, relative to the quantity, beyond which the lower degree is taken on the finest mesh; and the
#: difference that a feature makes with the lower degree, beyond which it is found with the full degree. Both are where
#: the solid does not scale, and ten times the accuracy "default". Two layers taken together may be as thick as the
#: length in which the modulus changes, and the lower degree then shows its own error there (measured: 2e-6 with degree
#: 4 and 2e-7 with 6, where a modulus grows tenfold within 0.4 contact radii).
UNCERTAIN = 1e-6

#: Relative rounding of a quantity itself: a few units of its last place.
ROUNDING = 1e-15

Functional = Callable[[PathEvents | ResolvedEvents], float]


@dataclass(frozen=True, slots=True)
class Estimate:
    """Values of a quantity on the three densities, and the parts of the error of the last.

    Attributes
    ----------
    values : tuple of float
        Coarse to fine.
    convergence : Convergence
        Of the three densities.
    parts : mapping of str to float
        By the names of `PARTS`.
    """

    values: tuple[float, float, float]
    convergence: Convergence
    parts: Mapping[str, float]


@dataclass(frozen=True, slots=True, eq=False)
class EventsOnMeshes:
    """The events of one path, and the same events on other meshes.

    Attributes
    ----------
    path : PathEvents or ResolvedEvents
        On the finest mesh.
    coarse, medium, lower_degree : ResolvedEvents
        At the other densities, and at the medium one with a lower degree.
    base : ResolvedEvents
        On the coarsest mesh with the lowest degree.
    features : mapping of str to ResolvedEvents
        On that mesh with one feature made coarser.
    finest_lower_degree : callable
        Returns the events on the finest mesh with a lower degree.
    full_degree : callable
        Returns the same for the name of a feature on the coarsest mesh with the full degree: for the extent, and for
        what the lower degree cannot resolve.
    placements : tuple of ResolvedEvents
        On the finest mesh with another placement of the contact edge.
    tail, rounding : ResolvedEvents
        On the finest mesh, with the displacement beyond it, and with the rounding of its condensation.
    ratio : float
        Refinement ratio of neighbouring densities.
    refined : bool
        As for `fem_reference._contact.uncertainty.three_meshes`.
    scaling : bool
        Whether one mesh serves every size of the contact.
    """

    path: PathEvents | ResolvedEvents
    coarse: ResolvedEvents
    medium: ResolvedEvents
    lower_degree: ResolvedEvents
    base: ResolvedEvents
    finest_lower_degree: Callable[[], ResolvedEvents]
    features: Mapping[str, ResolvedEvents]
    full_degree: Callable[[str], ResolvedEvents]
    placements: tuple[ResolvedEvents, ...]
    tail: ResolvedEvents
    rounding: ResolvedEvents
    ratio: float
    refined: bool
    scaling: bool

    def estimate(self, functional: Functional, declared: float) -> Estimate:
        """Return the parts of the error of a quantity, given its declared order.

        Raises
        ------
        NoSuchEvent
            If the path has no such event.
        NotConverged
            If an event cannot be found on one of the meshes.
        """
        fine = functional(self.path)
        values = functional(self.coarse), functional(self.medium), fine
        algebra = abs(functional(self.rounding) - fine) + ROUNDING * abs(fine)
        # The coarse mesh replaces it, and is farther away than the medium one.
        lower_degree, resolved = values[0], False
        with suppress(NotConverged):
            lower_degree, resolved = functional(self.lower_degree), not self.scaling
        convergence = three_meshes(values, self.ratio, declared, lower_degree, algebra, self.refined)
        if resolved and convergence.error > UNCERTAIN * abs(fine):
            with suppress(NotConverged):
                lowest = functional(self.finest_lower_degree())
                densities = three_meshes(values, self.ratio, declared, None, algebra)
                degrees = two_degrees((lower_degree, lowest), values[1:])
                convergence = replace(densities, error=max(densities.error, degrees))
        feature = {name: self._change(functional, name, values) for name in self.features}
        extent = abs(functional(self.full_degree(EXTENT)) - values[0])
        placement = max((abs(functional(events) - fine) for events in self.placements), default=0.0)
        parts = (
            convergence.error,
            feature["first layer"],
            extent,
            placement + feature["apex"],
            abs(functional(self.tail) - fine),
            algebra,
        )
        return Estimate(values, convergence, dict(zip(PARTS, parts, strict=True)))

    def _change(self, functional: Functional, feature: str, values: tuple[float, float, float]) -> float:
        """Difference that a coarser feature makes on the coarsest mesh."""
        with suppress(NotConverged):
            change = abs(functional(self.features[feature]) - functional(self.base))
            if self.scaling or change <= UNCERTAIN * abs(values[-1]):
                return change
        # The lower degree does not resolve the edge, or what is under the surface.
        return abs(functional(self.full_degree(feature)) - values[0])


# The quantities of one problem are requested one after the other, on the meshes of two kinds of events.
@lru_cache(maxsize=4)
def events_on_meshes(choice: MeshChoice, spec: MeshSpec, size: float) -> EventsOnMeshes:
    """Return the events of a problem on all meshes of an accuracy.

    Parameters
    ----------
    choice : MeshChoice
    spec, size
        As `fem_reference._contact.mesh_choice.chosen` returns them.

    Raises
    ------
    NotConverged
        If the path on the finest mesh cannot be traced.
    """
    _, middle, finest = choice.level.densities
    medium, fine = replace(spec, density=middle), replace(spec, density=finest)
    coarse = choice.contact(spec, size)
    lower_size = size
    placements: tuple[float, ...] = (-1.0, 1.0)
    if isinstance(coarse.compliance, FixedCompliance):
        # Another placement of the edge needs another mesh here: that of the other degree.
        r = fine.grid().r
        lower_size = size * (0.5 + 0.5 * float(r[np.argmin(abs(r - 1.0)) + 1]))
        placements = ()
    plain = replace(spec, order=spec.order - FEATURE_DEGREES)
    middle_contact = choice.contact(medium, size)
    moved = replace(medium, order=spec.order - 1).moved(lower_size / size)
    lower_degree = choice.contact(moved, lower_size)
    base = choice.contact(plain, size)
    features = {feature: choice.contact(variant(plain, feature), size) for feature in FEATURES if feature != EXTENT}
    # The finest mesh is the last: it is used next.
    path = choice.traced(fine, size)
    contact = path.contact

    @lru_cache(maxsize=1)
    def finest_lower_degree() -> ResolvedEvents:
        return ResolvedEvents(
            path, choice.contact(replace(fine, order=spec.order - 1).moved(lower_size / size), lower_size)
        )

    @lru_cache(maxsize=len(FEATURES))
    def full_degree(feature: str) -> ResolvedEvents:
        return ResolvedEvents(path, choice.contact(variant(spec, feature), size))

    return EventsOnMeshes(
        path,
        ResolvedEvents(path, coarse),
        ResolvedEvents(path, middle_contact),
        ResolvedEvents(path, lower_degree),
        ResolvedEvents(path, base),
        finest_lower_degree,
        {feature: ResolvedEvents(path, other_contact) for feature, other_contact in features.items()},
        full_degree,
        tuple(ResolvedEvents(path, contact, placement) for placement in placements),
        ResolvedEvents(path, _with_tail(contact, choice)),
        ResolvedEvents(path, _rounded(contact)),
        math.sqrt(choice.level.densities[0] / finest),
        fine.refines(medium),
        not isinstance(coarse.compliance, FixedCompliance),
    )


def _with_tail(contact: Contact, choice: MeshChoice) -> Contact:
    """The contact with the displacement beyond the mesh."""
    depth_exponent = choice.problem.solid.modulus.depth_exponent
    return TailContact(contact.punch, contact.law, contact.compliance, depth_exponent)


def _rounded(contact: Contact) -> Contact:
    """The contact with the rounding of its condensation."""
    return replace(contact, compliance=contact.compliance.rounded())
