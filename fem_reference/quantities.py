"""Quantities of a contact problem: one table of event, functional and kind."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Literal

from fem_reference._contact.events import JUMP_IN, JUMP_OUT, LANDING, SEPARATED, Events, energy_lost, event_energy

__all__ = [
    "CRITICAL_MODULUS",
    "LOSSES",
    "QUANTITIES",
    "TABLE",
    "Quantity",
    "critical_quantity",
    "further_losses",
    "quantity_named",
]


@dataclass(frozen=True, slots=True)
class Quantity:
    """One row of the table.

    Attributes
    ----------
    events : tuple of str
        The events that it needs.  The mesh is finest at the contact edge of the first.
    functional : callable
        Its value from the events of a path, in the units of the problem.
    kind : {"force", "length", "energy", "modulus"}
        A length near zero is measured by the length of the surface law.
    terms : tuple of str
        Quantities whose sum it is, each with the contact edge at one radius.
    """

    events: tuple[str, ...]
    functional: Callable[[Events], float]
    kind: Literal["force", "length", "energy", "modulus"]
    terms: tuple[str, ...] = ()


#: Energies lost by the jump into contact and the jump out of contact. Each needs the contact edge at one radius only,
#: so that the mesh of a solid that is not a power law can be fine there. Their sum is the hysteresis energy, unless the
#: displacement has more folds at which the cycle jumps: see `further_losses`.
LOSSES = ("jump_in_energy", "jump_out_energy")

#: Quantities by name; pull_off_force is the positive number -min P.
TABLE = {
    "pull_off_force": Quantity(("pull_off",), lambda e: -e.at("pull_off").state.load, "force"),
    "pull_off_displacement": Quantity(("pull_off",), lambda e: e.at("pull_off").state.displacement, "length"),
    "jump_in_displacement": Quantity(("jump_in",), lambda e: e.at("jump_in").state.displacement, "length"),
    "jump_in_gap": Quantity(("jump_in",), lambda e: e.at("jump_in").state.central_gap, "length"),
    "jump_out_displacement": Quantity(("jump_out",), lambda e: e.at("jump_out").state.displacement, "length"),
    "jump_out_gap": Quantity(("jump_out",), lambda e: e.at("jump_out").state.central_gap, "length"),
    "zero_load_displacement": Quantity(("zero_load",), lambda e: e.at("zero_load").state.displacement, "length"),
    "hysteresis_energy": Quantity(
        (JUMP_OUT, LANDING), lambda e: math.fsum(energy_lost(e, jump) for jump in e.jumps), "energy", terms=LOSSES
    ),
    "jump_in_energy": Quantity((LANDING,), lambda e: energy_lost(e, (JUMP_IN, LANDING)), "energy"),
    "jump_out_energy": Quantity((JUMP_OUT,), lambda e: energy_lost(e, (JUMP_OUT, SEPARATED)), "energy"),
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
    return Quantity(("cusp",), lambda events: E0 * events.at("cusp").branch.contact.compliance.stiffness, "modulus")


def further_losses(path: Events) -> dict[str, Quantity]:
    """Return quantities whose sum is the energy lost by the jumps of a cycle that are not of `LOSSES`.

    Each needs the contact edge at one radius only: the energy at the fold, and the negative one where the jump ends.
    On two meshes these points do not have exactly the same displacement.  With the load P where the jump ends, both
    energies U are continued to one displacement, because dU = P d(delta) there.

    Parameters
    ----------
    path : Events
        The path of the problem.

    Returns
    -------
    dict of str to Quantity
        By names of their own; empty if the cycle has two jumps only.
    """
    rows: dict[str, Quantity] = {}
    for fold, end in path.jumps:
        if (fold, end) not in ((JUMP_IN, LANDING), (JUMP_OUT, SEPARATED)):
            at_end = path.at(end).state
            for event, sign in ((fold, 1.0), (end, -1.0)):
                functional = partial(_energy_at, event, sign, at_end.displacement, at_end.load)
                rows[f"energy at {event}"] = Quantity((event,), functional, "energy")
    return rows


def _energy_at(event: str, sign: float, displacement: float, load: float, events: Events) -> float:
    """Energy of an event, continued to a displacement with a load."""
    point = events.at(event)
    return sign * (event_energy(point) - load * (point.state.displacement - displacement))


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
