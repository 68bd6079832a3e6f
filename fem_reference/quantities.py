"""Quantities of a contact problem: one table of event, functional, kind and declared order."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, Protocol

from fem_reference._contact.events import LANDING
from fem_reference._contact.path import Point

__all__ = ["CRITICAL_MODULUS", "LOSSES", "QUANTITIES", "TABLE", "Quantity", "critical_quantity", "quantity_named"]

GAP_ORDER = 2.0
"""Declared order of the central gap at jump-out, in contact: under the tip of a cone the pressure has a kink, the
displacement a term r^2 log r (r^(2-k) in a graded solid, whose size falls with that of the contact edge), and that
decides it, not the degree of the element."""


class Events(Protocol):
    """Points of a path at its events, and the energies that the jumps lose."""

    @property
    def pull_off(self) -> Point:
        """The deepest minimum of the load along the path."""
        ...

    @property
    def jump_in(self) -> Point:
        """The first fold on approach."""
        ...

    @property
    def jump_out(self) -> Point:
        """The lowest fold."""
        ...

    @property
    def zero_load(self) -> Point:
        """The point in contact without load."""
        ...

    @property
    def cusp(self) -> Point:
        """The point where the two folds merge, at the modulus at which they do."""
        ...

    @property
    def jump_in_loss(self) -> float:
        """Energy lost by the jump into contact."""
        ...

    @property
    def jump_out_loss(self) -> float:
        """Energy lost by the jump out of contact."""
        ...


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
    order : float, optional
        Declared order of convergence; that of the element by default.
    parts : tuple of str
        Quantities whose sum it is, each with the contact edge at one radius.
    """

    events: tuple[str, ...]
    functional: Callable[[Events], float]
    kind: Literal["force", "length", "energy", "modulus"]
    order: float | None = None
    parts: tuple[str, ...] = ()


LOSSES = ("jump_in_energy", "jump_out_energy")
"""Energies lost by the two jumps; their sum is the hysteresis energy.  Each needs the contact edge at one radius only,
so that the mesh of a solid that is no power law can be fine there."""

TABLE = {
    "pull_off_force": Quantity(("pull_off",), lambda e: -e.pull_off.state.load, "force"),
    "pull_off_displacement": Quantity(("pull_off",), lambda e: e.pull_off.state.displacement, "length"),
    "jump_in_displacement": Quantity(("jump_in",), lambda e: e.jump_in.state.displacement, "length"),
    "jump_in_gap": Quantity(("jump_in",), lambda e: e.jump_in.state.central_gap, "length"),
    "jump_out_displacement": Quantity(("jump_out",), lambda e: e.jump_out.state.displacement, "length"),
    "jump_out_gap": Quantity(("jump_out",), lambda e: e.jump_out.state.central_gap, "length", GAP_ORDER),
    "zero_load_displacement": Quantity(("zero_load",), lambda e: e.zero_load.state.displacement, "length"),
    "hysteresis_energy": Quantity(
        ("jump_out", LANDING), lambda e: e.jump_in_loss + e.jump_out_loss, "energy", parts=LOSSES
    ),
    "jump_in_energy": Quantity((LANDING,), lambda e: e.jump_in_loss, "energy"),
    "jump_out_energy": Quantity(("jump_out",), lambda e: e.jump_out_loss, "energy"),
}
"""Quantities by name; pull_off_force is the positive number -min P."""

QUANTITIES = tuple(name for name in TABLE if name not in LOSSES)
"""Names of the quantities of a problem; `solve` takes those of `LOSSES` too."""


CRITICAL_MODULUS = "critical_modulus"
"""The modulus E0 below which the contact jumps, at the punch, the law and the solid's other parameters of the problem:
the two folds of the displacement merge there.  `solve` takes it too; the modulus of the problem is not used."""


def critical_quantity(E0: float) -> Quantity:
    """Return the row of the critical modulus, computed from the path of a modulus near it.

    Parameters
    ----------
    E0 : float
        Modulus of that path.
    """
    return Quantity(("cusp",), lambda events: E0 * events.cusp.branch.contact.compliance.stiffness, "modulus")


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
