"""Bound of a quantity of finite strain, in parts: the same quantity on meshes that differ in one thing each.

Whatever is made coarser at least doubles what it causes of the error, so that the difference is at least that error:
one degree less, larger elements, half of the extent of the nonlinear core, the first layer.  A finer quadrature shows
what the quadrature causes, that over the elements and that of the potential of the punch.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from fem_reference._elastic.exterior import EXTERIOR_RATIO
from fem_reference._large_strain.discretisation import Discretisation, LinearEvent
from fem_reference._large_strain.equilibrium import State, settled
from fem_reference._large_strain.events import Family, PathEvent, found_event
from fem_reference.errors import NotConverged

__all__ = ["Estimate", "Functional", "estimate", "state_bounds", "variants_of"]

#: Density of the coarser elements over that of the mesh: the error of degree 6 falls by more than half.
COARSER = 1.25

#: Gauss points a direction that the finer quadrature adds.
MORE_POINTS = 3

#: Relative error that the Poisson's ratio of the exterior may cause.
EXTERIOR_ERROR = 2.0 * (0.5 - EXTERIOR_RATIO)

#: Events and the name of the one whose displacement is their level.
LEVELS = {"landing": "jump_in", "separated": "jump_out"}

#: Change of the logarithm of a radius from which on lines of the mesh get their places anew: they do not lie where the
#: punch or the solid has them by that share, whose square is what the forces lack.
MISPLACED = 1e-3

Functional = Callable[[Mapping[str, State]], float]


@dataclass(frozen=True, slots=True, eq=False)
class Estimate:
    """A quantity, the parts of its bound, its events, and the value with one degree less."""

    value: float
    parts: dict[str, float]
    events: dict[str, PathEvent]
    lower_degree: float


def variants_of(base: Discretisation) -> dict[str, Discretisation]:
    """Return the discretisations whose distance from the base bounds a part each; two parts may share a name."""
    spec, force = base.spec, base.interaction
    variants = {
        "degree": replace(base, spec=replace(spec, order=spec.order - 1)),
        "density": replace(base, spec=replace(spec, density=COARSER * spec.density)),
        "core": replace(base, extent=0.5 * base.extent),
        "quadrature": replace(base, extra=base.extra + MORE_POINTS),
        "first layer": replace(base, feature="first layer"),
    }
    return variants if force.finer is force else variants | {"force": replace(base, interaction=force.finer)}


def _events_of(
    discretisations: Mapping[str, Discretisation],
    linear: Mapping[str, LinearEvent],
    starts: Mapping[str, PathEvent],
    stationary: bool,
) -> dict[str, PathEvent]:
    """Events on elements, sought from those on other ones; a stationary quantity needs only the same parameter."""
    events: dict[str, PathEvent] = {}
    for name, discretisation in discretisations.items():
        family = Family(discretisation, linear[name], starts.get(name))
        if stationary:
            state = family.state(family.start)
            events[name] = PathEvent(family.start, state, state)
            continue
        level = events[LEVELS[name]].state.displacement if name in LEVELS else 0.0
        events[name] = found_event(name, family, level)
    return events


def _first_events(
    discretisations: Mapping[str, Discretisation], linear: Mapping[str, LinearEvent]
) -> dict[str, PathEvent]:
    """Events on elements of a lower degree; none where they have no states."""
    coarser = {name: discretisation.coarser for name, discretisation in discretisations.items()}
    try:
        return _events_of(coarser, linear, {}, stationary=False)
    except NotConverged:
        return {}


def estimate(
    linear: Mapping[str, LinearEvent], bases: Mapping[str, Discretisation], functional: Functional, stationary: bool
) -> Estimate:
    """Compute a quantity and the parts of its bound.

    Parameters
    ----------
    linear : mapping of str to LinearEvent
        Events of small strain that the quantity needs, by name; a level before what refers to it.
    bases : mapping of str to Discretisation
        Of each event.
    functional : callable
        Value from the states at the events.
    stationary : bool
        Whether the quantity does not change with the parameter of its one event.

    Raises
    ------
    NotConverged
        If an event is not found on one of the meshes.
    """
    rough = _first_events(bases, linear) or _events_of(bases, linear, {}, stationary=False)
    placed = _placed(bases, linear, rough)
    events = _events_of(placed, linear, rough, stationary=False)
    if any(abs(events[name].x - event.x) > MISPLACED for name, event in rough.items()):
        placed = _placed(bases, linear, events)
        events = _events_of(placed, linear, events, stationary=False)

    def value(results: Mapping[str, PathEvent]) -> float:
        return functional({name: event.state for name, event in results.items()})

    base = value(events)
    values = {
        variant: value(_events_of(changed, linear, events, stationary))
        for variant, changed in _variants_by_event(placed).items()
    }
    differences = {variant: abs(result - base) for variant, result in values.items()}
    parts = {
        "mesh": differences["degree"] + differences["density"],
        "first layer": differences["first layer"],
        "core": differences["core"] + EXTERIOR_ERROR * abs(base),
        "quadrature": differences["quadrature"] + differences.get("force", 0.0),
        "search": abs(base - functional({name: event.previous for name, event in events.items()})),
        "algebra": abs(functional({name: settled(event.state) for name, event in events.items()}) - base),
    }
    return Estimate(base, parts, events, values["degree"])


def _placed(
    bases: Mapping[str, Discretisation], linear: Mapping[str, LinearEvent], events: Mapping[str, PathEvent]
) -> dict[str, Discretisation]:
    """Elements whose lines of the punch or the solid, placed for the edges of small strain, are so for events."""
    return {
        name: base.at(linear[name].radius * math.exp(events[name].x)) if linear[name].point.branch.touching else base
        for name, base in bases.items()
    }


def state_bounds(state: State, base: Discretisation, linear: LinearEvent) -> tuple[float, float]:
    """Return bounds of the errors of displacement and load of the state at an event of small strain.

    Parameters
    ----------
    state : State
    base : Discretisation
        Its elements.
    linear : LinearEvent

    Raises
    ------
    NotConverged
        If the state is not found on one of the meshes.
    """
    origin = PathEvent(0.0, state, state)
    changed = [Family(variant, linear, origin).state(0.0).light for variant in variants_of(base).values()]

    def bound(measure: Callable[[State], float]) -> float:
        value = measure(state)
        return sum(abs(measure(other) - value) for other in changed) + EXTERIOR_ERROR * abs(value)

    return bound(lambda state: state.displacement), bound(lambda state: state.load)


def _variants_by_event(bases: Mapping[str, Discretisation]) -> dict[str, dict[str, Discretisation]]:
    """Variants of the meshes of all events, by their names."""
    by_event = {name: variants_of(base) for name, base in bases.items()}
    names = next(iter(by_event.values()))
    return {variant: {name: variants[variant] for name, variants in by_event.items()} for variant in names}
