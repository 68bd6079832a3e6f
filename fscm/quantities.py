"""Table of quantities: kind, events and computation of each.

A new quantity is one row of `TABLE`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from fscm.critical import critical_tabor_number
from fscm.solution import Parts, Solution, solution_of

if TYPE_CHECKING:
    from fscm.analysis import Analysis

__all__ = ["QUANTITIES", "TABLE", "AtEvent", "PathPoint", "Quantity", "quantity_named"]


class PathPoint(Protocol):
    """A point of an equilibrium path, of any discretisation."""

    @property
    def central_gap(self) -> float:
        """H_0, in z0."""
        ...

    @property
    def displacement(self) -> float:
        """delta, in z0."""
        ...

    @property
    def load(self) -> float:
        """P, tension negative."""
        ...


@dataclass(frozen=True)
class Quantity:
    """A quantity of one problem.

    Attributes
    ----------
    kind : str
        "load", "displacement", "gap", "energy" or "number": its unit, see `Problem.units`.
    needs : tuple of str
        Events of the path that must exist.
    compute : callable
        Analysis -> Solution, without its time.
    """

    kind: str
    needs: tuple[str, ...]
    compute: Callable[[Analysis], Solution]


@dataclass(frozen=True)
class AtEvent(Quantity):
    """A quantity that is a functional of the state at one event.

    Attributes
    ----------
    functional : callable
        PathPoint -> float: the attribute times the sign.
    attribute : str
        Of `PathPoint`.
    sign : float
    """

    functional: Callable[[PathPoint], float]
    attribute: str
    sign: float

    @classmethod
    def of(cls, kind: str, event: str, attribute: str, sign: float = 1.0) -> AtEvent:
        """Row for an attribute of `PathPoint`, times a sign."""

        def functional(point: PathPoint) -> float:
            return sign * float(getattr(point, attribute))

        def compute(analysis: Analysis) -> Solution:
            return solution_of(
                functional(analysis.event(event).value), analysis.parts(event, attribute), [analysis.event(event)]
            )

        return cls(kind, (event,), compute, functional, attribute, sign)

    @property
    def event(self) -> str:
        """Name of the event."""
        return self.needs[0]


def _hysteresis_energy(analysis: Analysis) -> Solution:
    """Energy lost in all jumps of a cycle: the drops of energy at constant displacement."""
    value, parts, pairs = 0.0, Parts(), []
    for name in ("jump_in", "jump_out"):
        for fold, landing in analysis.jumps(name):
            value += fold.value.energy - landing.value.energy
            pairs += [fold, landing]
        parts = parts.plus(analysis.jump_parts(name))
    return solution_of(value, parts, pairs)


#: Rows by name: how each quantity is computed from the equilibrium path.
TABLE: dict[str, Quantity] = {
    "pull_off_force": AtEvent.of("load", "pull_off", "load", -1.0),
    "pull_off_displacement": AtEvent.of("displacement", "pull_off", "displacement"),
    "jump_in_displacement": AtEvent.of("displacement", "jump_in", "displacement"),
    "jump_in_gap": AtEvent.of("gap", "jump_in", "central_gap"),
    "jump_out_displacement": AtEvent.of("displacement", "jump_out", "displacement"),
    "jump_out_gap": AtEvent.of("gap", "jump_out", "central_gap"),
    "zero_load_displacement": AtEvent.of("displacement", "zero_load", "displacement"),
    "hysteresis_energy": Quantity("energy", ("jump_in", "jump_out"), _hysteresis_energy),
    "critical_tabor_number": Quantity(
        "number", (), lambda analysis: critical_tabor_number(analysis.problem, analysis.meshes)
    ),
}

#: Names of the quantities.
QUANTITIES = tuple(TABLE)


def quantity_named(name: str) -> Quantity:
    """Row of the table; ValueError with the known names for an unknown one."""
    if name not in TABLE:
        raise ValueError(f"unknown quantity {name!r}; known are {', '.join(TABLE)}")
    return TABLE[name]
