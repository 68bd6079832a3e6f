"""Table of quantities: kind, events and computation of each.

A new quantity is one row of `TABLE`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from fscm.critical import critical_tabor_number
from fscm.solution import Solution, State, solution_of

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
        "force", "displacement", "gap", "energy" or "number": its unit.
    needs : tuple of str
        Events of the path that have to exist.
    compute : callable
        Analysis -> Solution, without its time.
    """

    kind: str
    needs: tuple[str, ...]
    compute: Callable[[Analysis], Solution]


@dataclass(frozen=True, init=False)
class AtEvent(Quantity):
    """A quantity that is a functional of the state at one event."""

    functional: Callable[[PathPoint], float]

    def __init__(self, kind: str, event: str, functional: Callable[[PathPoint], float]) -> None:
        def compute(analysis: Analysis) -> Solution:
            pair = analysis.event(event)
            # Load and displacement share their error (that of the work of adhesion), so the larger stands for both.
            difference = pair.difference(functional, _load, _displacement)
            # Two meshes may share the innermost panel, whose error is that of the central gap alone.
            axis = pair.value.axis_uncertainty if functional is _central_gap else 0.0
            return solution_of(functional(pair.value), difference, [pair], axis)

        for name, value in (("kind", kind), ("needs", (event,)), ("compute", compute), ("functional", functional)):
            object.__setattr__(self, name, value)

    @property
    def event(self) -> str:
        """Name of the event."""
        return self.needs[0]


def _load(point: PathPoint) -> float:
    return point.load


def _displacement(point: PathPoint) -> float:
    return point.displacement


def _central_gap(point: PathPoint) -> float:
    return point.central_gap


def _energy(state: State) -> float:
    return state.energy


def _hysteresis_energy(analysis: Analysis) -> Solution:
    """Energy lost in all jumps of a cycle: by how much the energy drops at constant displacement."""
    jumps = [*analysis.jumps("jump_in"), *analysis.jumps("jump_out")]
    pairs = [pair for jump in jumps for pair in jump]
    lost = 0.0
    for fold, landing in jumps:
        lost = lost + fold.value.energy - landing.value.energy
    # The errors may cancel by accident, so their sizes are added.
    return solution_of(lost, sum(pair.difference(_energy) for pair in pairs), pairs)


TABLE: dict[str, Quantity] = {
    "pull_off_force": AtEvent("force", "pull_off", lambda point: -point.load),
    "pull_off_displacement": AtEvent("displacement", "pull_off", _displacement),
    "jump_in_displacement": AtEvent("displacement", "jump_in", _displacement),
    "jump_in_gap": AtEvent("gap", "jump_in", _central_gap),
    "jump_out_displacement": AtEvent("displacement", "jump_out", _displacement),
    "jump_out_gap": AtEvent("gap", "jump_out", _central_gap),
    "zero_load_displacement": AtEvent("displacement", "zero_load", _displacement),
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
