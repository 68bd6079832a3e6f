"""Events of a path: their names, the function that vanishes at each, and its slope."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from fem_reference._contact.states import Point, point_at

__all__ = [
    "CUSP",
    "EVENTS",
    "JUMP_IN",
    "JUMP_OUT",
    "LANDING",
    "SEPARATED",
    "Anchor",
    "beginning_of",
    "beyond_pull_off",
    "displacement",
    "displacement_rate",
    "event_energy",
    "excess_of",
    "kind_of",
    "load",
    "load_rate",
    "slope_at",
]

#: Events of the path: the deepest minimum of the load, the two folds of displacement control, and the point in contact
#: where the load changes from tension to compression.
EVENTS = ("pull_off", "jump_in", "jump_out", "zero_load")

#: The point at the displacement of the jump into contact, on the next branch inwards: where that jump ends.
LANDING = "landing"

#: The point out of contact at the displacement of the jump out of contact: where that jump ends.
SEPARATED = "separated"

#: The first fold on approach.
JUMP_IN = "jump_in"

#: The last fold on retreat.
JUMP_OUT = "jump_out"

#: The point where the two folds merge, at the modulus at which they do; its compliance has that modulus.
CUSP = "cusp"

#: Relative change of the parameter for the slope of a rate: an error of this size slows the secant method only.
SLOPE_STEP = 1e-4


@dataclass(frozen=True, slots=True, eq=False)
class Anchor:
    """An event of a path, from which the same event on another mesh is found.

    Attributes
    ----------
    point : Point
        The state.
    slope : float
        Derivative there, by the parameter, of the function that vanishes (see `excess_of`).
    radius_error : float
        Relative error of the radius of the edge.
    """

    point: Point
    slope: float
    radius_error: float = 0.0


def kind_of(event: str) -> str:
    """Return the name of an event without the number of its jump.

    Examples
    --------
    >>> kind_of("jump_out_2"), kind_of("jump_out")
    ('jump_out', 'jump_out')
    """
    return event.rstrip("0123456789").removesuffix("_")


def beginning_of(event: str) -> str | None:
    """Return the fold where the jump begins that ends at an event, or None.

    Examples
    --------
    >>> beginning_of("landing"), beginning_of("separated_2"), beginning_of("pull_off")
    ('jump_in', 'jump_out_2', None)
    """
    kind = kind_of(event)
    beginning = {LANDING: JUMP_IN, SEPARATED: JUMP_OUT}.get(kind)
    return None if beginning is None else beginning + event.removeprefix(kind)


def beyond_pull_off(event: str) -> bool:
    """Whether an event lies on the path beyond the pull-off, where the edge is sharper relative to its radius."""
    return kind_of(event) in ("zero_load", LANDING)


def slope_at(event: str, point: Point) -> float:
    """Return the slope, at the state of an event, of the function that vanishes there (see `excess_of`)."""
    if beginning_of(event) is not None:
        return point.state.displacement_rate
    if event == "zero_load":
        return point.state.load_rate
    unit = point.parameter if point.branch.touching else point.branch.contact.law.z0
    ahead = point_at(point, point.parameter + SLOPE_STEP * unit)
    excess = excess_of(event)
    return (excess(ahead) - excess(point)) / (ahead.parameter - point.parameter)


def excess_of(event: str, level: float = 0.0) -> Callable[[Point], float]:
    """Return the function of a point that vanishes at an event.

    Parameters
    ----------
    event : str
        One of `EVENTS`, or of the names in `fem_reference._contact.events.PathEvents.jumps`.
    level : float
        Displacement at a landing or separation.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> excess_of("landing", level=1.0)(SimpleNamespace(state=SimpleNamespace(displacement=3.0)))
    2.0
    """
    value = {"pull_off": load_rate, "jump_in": displacement_rate, "jump_out": displacement_rate, "zero_load": load}
    rate = value.get(kind_of(event), displacement)
    return lambda point: rate(point) - level


def event_energy(point: Point) -> float:
    """Elastic plus surface energy at a point."""
    return point.branch.contact.energy(point.state.y)


def load(point: Point) -> float:
    """Load at a point."""
    return point.state.load


def load_rate(point: Point) -> float:
    """Change of the load along the path."""
    return point.load_rate


def displacement(point: Point) -> float:
    """Displacement at a point."""
    return point.state.displacement


def displacement_rate(point: Point) -> float:
    """Change of the displacement along the path."""
    return point.displacement_rate
