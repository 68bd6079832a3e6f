"""Quantities of a contact problem: one table of weights, functionals, events and kinds."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Literal

from fem_reference._contact.event_kinds import JUMP_IN, JUMP_OUT, LANDING, SEPARATED, event_energy
from fem_reference._contact.events import PathEvents
from fem_reference._contact.quantity import Quantity, Term
from fem_reference._contact.states import Point

__all__ = [
    "CRITICAL_MODULUS",
    "LOSSES",
    "QUANTITIES",
    "TABLE",
    "critical_quantity",
    "further_losses",
    "quantity_named",
]


def _displacement(point: Point) -> float:
    return point.state.displacement


def _central_gap(point: Point) -> float:
    return point.state.central_gap


def _load(point: Point) -> float:
    return point.state.load


def _one(
    event: str,
    functional: Callable[[Point], float],
    kind: Literal["force", "length"],
    weight: float = 1.0,
    *,
    stationary: bool = False,
) -> Quantity:
    """A quantity of one state."""
    return Quantity((Term(weight, functional, event, stationary),), kind)


#: What the jump out of contact and the jump into contact lose: the energy at the fold less that where the jump ends.
#: The contact edge is at one radius, so that a mesh can be fine there.
_LOST_OUT = Term(1.0, event_energy, JUMP_OUT), Term(-1.0, event_energy, SEPARATED)
_LOST_IN = Term(-1.0, event_energy, LANDING), Term(1.0, event_energy, JUMP_IN)

#: Energies lost by the jump into contact and the jump out of contact. Their sum is the hysteresis energy, unless the
#: displacement has more folds at which the cycle jumps: see `further_losses`.
LOSSES = ("jump_in_energy", "jump_out_energy")

#: Quantities by name; pull_off_force is the positive number -min P.
TABLE = {
    "pull_off_force": _one("pull_off", _load, "force", -1.0, stationary=True),
    "pull_off_displacement": _one("pull_off", _displacement, "length"),
    "jump_in_displacement": _one("jump_in", _displacement, "length", stationary=True),
    "jump_in_gap": _one("jump_in", _central_gap, "length"),
    "jump_out_displacement": _one("jump_out", _displacement, "length", stationary=True),
    "jump_out_gap": _one("jump_out", _central_gap, "length"),
    "zero_load_displacement": _one("zero_load", _displacement, "length"),
    "hysteresis_energy": Quantity((*_LOST_OUT, *_LOST_IN), "energy", addends=LOSSES),
    "jump_in_energy": Quantity(_LOST_IN, "energy"),
    "jump_out_energy": Quantity(_LOST_OUT, "energy"),
}

#: Names of the quantities of a problem; `solve` takes those of `LOSSES` too.
QUANTITIES = tuple(name for name in TABLE if name not in LOSSES)


#: The modulus E0 below which the contact jumps, at the punch, the law and the solid's other parameters of the problem:
#: the two folds of the displacement merge there. `solve` takes it too; the modulus of the problem is not used.
CRITICAL_MODULUS = "critical_modulus"


def critical_quantity(E0: float) -> Quantity:
    """Return the row of the critical modulus, computed from the path of a modulus near it.

    Parameters
    ----------
    E0 : float
        Modulus of that path.
    """
    return Quantity((Term(E0, lambda point: point.branch.contact.compliance.stiffness, "cusp"),), "modulus")


def further_losses(path: PathEvents) -> dict[str, Quantity]:
    """Return quantities whose sum is the energy lost by the jumps of a cycle that are not of `LOSSES`.

    Each needs the contact edge at one radius only: the energy at the fold, and the negative one where the jump ends.
    On two meshes these points do not have exactly the same displacement.  With the load P where the jump ends, both
    energies U are continued to one displacement, because dU = P d(delta) there.

    Parameters
    ----------
    path : PathEvents
        The path of the problem.

    Returns
    -------
    dict of str to Quantity
        By names of their own; empty if the cycle has two jumps only.
    """
    rows: dict[str, Quantity] = {}
    for fold, end in path.jumps:
        if (fold, end) not in ((JUMP_IN, LANDING), (JUMP_OUT, SEPARATED)):
            energy = partial(_energy_continued, path.at(end))
            for event, sign in ((fold, 1.0), (end, -1.0)):
                rows[f"energy at {event}"] = Quantity((Term(sign, energy, event),), "energy")
    return rows


def _energy_continued(end: Point, point: Point) -> float:
    """Energy of a point, continued with the load of the end of a jump to the displacement there."""
    return event_energy(point) - end.state.load * (point.state.displacement - end.state.displacement)


def quantity_named(name: str) -> Quantity:
    """Return a row of the table.

    Raises
    ------
    ValueError
        For an unknown name.

    Examples
    --------
    >>> quantity_named("jump_out_gap").events
    ('jump_out',)
    """
    if name == CRITICAL_MODULUS:
        return critical_quantity(1.0)
    if name not in TABLE:
        raise ValueError(f"quantity {name!r} is unknown; choose one of {', '.join((*TABLE, CRITICAL_MODULUS))}")
    return TABLE[name]
