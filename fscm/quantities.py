"""Table of quantities: unit, and the state and the functional of each.

A new quantity is one row of `TABLE`: the path is followed to its events, and its bound follows from the functional.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

__all__ = [
    "EVENTS",
    "EXTREMAL",
    "FUNCTIONALS",
    "QUANTITIES",
    "TABLE",
    "AtEvent",
    "Critical",
    "LostInJumps",
    "PathPoint",
    "Quantity",
    "quantity_named",
]

#: Functional that is extreme at each named point of the equilibrium path; None where the load is prescribed.
EXTREMAL = {"pull_off": "load", "jump_in": "displacement", "jump_out": "displacement", "zero_load": None}
#: Named points of the equilibrium path.
EVENTS = tuple(EXTREMAL)
#: Numbers of a state whose error is bounded (`fscm._bound`).
FUNCTIONALS = ("load", "displacement", "central_gap", "energy")


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
    """

    kind: str


@dataclass(frozen=True)
class AtEvent(Quantity):
    """A functional of the state at one event.

    Attributes
    ----------
    event, functional : str
        Of `EVENTS` and of `FUNCTIONALS`.
    sign : float
        Factor of the functional.

    Raises
    ------
    ValueError
        For an unknown event or functional.

    Examples
    --------
    >>> AtEvent("load", "pull_off", "force")
    Traceback (most recent call last):
    ValueError: functional = 'force' of a quantity is unknown; it is one of load, displacement, central_gap, energy
    """

    event: str
    functional: str
    sign: float = 1.0

    def __post_init__(self) -> None:
        for name, value, known in (("event", self.event, EVENTS), ("functional", self.functional, FUNCTIONALS)):
            if value not in known:
                raise ValueError(f"{name} = {value!r} of a quantity is unknown; it is one of {', '.join(known)}")

    def value(self, point: PathPoint) -> float:
        """The functional times its sign."""
        return self.sign * float(getattr(point, self.functional))


@dataclass(frozen=True)
class LostInJumps(Quantity):
    """Energy lost in jumps at constant displacement.

    Attributes
    ----------
    events : tuple of str
        "jump_in" for all jumps of an approach, "jump_out" for those of a retreat.
    """

    events: tuple[str, ...]


@dataclass(frozen=True)
class Critical(Quantity):
    """The Tabor number above which the path has jumps."""


#: Rows by name.
TABLE: dict[str, Quantity] = {
    "pull_off_force": AtEvent("load", "pull_off", "load", -1.0),
    "pull_off_displacement": AtEvent("displacement", "pull_off", "displacement"),
    "jump_in_displacement": AtEvent("displacement", "jump_in", "displacement"),
    "jump_in_gap": AtEvent("gap", "jump_in", "central_gap"),
    "jump_out_displacement": AtEvent("displacement", "jump_out", "displacement"),
    "jump_out_gap": AtEvent("gap", "jump_out", "central_gap"),
    "zero_load_displacement": AtEvent("displacement", "zero_load", "displacement"),
    "hysteresis_energy": LostInJumps("energy", ("jump_in", "jump_out")),
    "critical_tabor_number": Critical("number"),
}

#: Names of the quantities.
QUANTITIES = tuple(TABLE)


def quantity_named(name: str) -> Quantity:
    """Row of the table; ValueError with the known names for an unknown one."""
    if name not in TABLE:
        raise ValueError(f"unknown quantity {name!r}; known are {', '.join(TABLE)}")
    return TABLE[name]
