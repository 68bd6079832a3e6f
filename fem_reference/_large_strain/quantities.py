"""Quantities of a contact of finite strain: the events that each needs, and its value from their states."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from fem_reference._large_strain.equilibrium import State

__all__ = ["TABLE", "Quantity"]


@dataclass(frozen=True, slots=True)
class Quantity:
    """One row of the table.

    Attributes
    ----------
    events : tuple of str
        A level before the event that refers to it.
    functional : callable
        Value from the states at the events.
    stationary : bool
        Whether it does not change with the parameter of its one event.
    """

    events: tuple[str, ...]
    functional: Callable[[Mapping[str, State]], float]
    stationary: bool = False


def _energy_lost(states: Mapping[str, State]) -> float:
    """Energy lost by both jumps."""
    at_in = states["jump_in"].energy - states["landing"].energy
    return at_in + states["jump_out"].energy - states["separated"].energy


TABLE = {
    "pull_off_force": Quantity(("pull_off",), lambda s: -s["pull_off"].load, stationary=True),
    "pull_off_displacement": Quantity(("pull_off",), lambda s: s["pull_off"].displacement),
    "jump_in_displacement": Quantity(("jump_in",), lambda s: s["jump_in"].displacement, stationary=True),
    "jump_out_displacement": Quantity(("jump_out",), lambda s: s["jump_out"].displacement, stationary=True),
    "zero_load_displacement": Quantity(("zero_load",), lambda s: s["zero_load"].displacement),
    "hysteresis_energy": Quantity(("jump_in", "landing", "jump_out", "separated"), _energy_lost),
}
