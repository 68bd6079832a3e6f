"""The registry of what can be asked: one row a quantity."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["QUANTITIES", "Quantity"]


@dataclass(frozen=True, slots=True)
class Quantity:
    """A quantity: name, symbol, unit (the scale of the dimensionless value) and meaning with sign rule."""

    name: str
    symbol: str
    unit: str
    meaning: str


_LOAD = "pi Q^(2/n) dgamma z0^(2/n-1)"
_ENERGY = "pi Q^(2/n) dgamma z0^(2/n)"

QUANTITIES: dict[str, Quantity] = {
    q.name: q
    for q in (
        Quantity("pull_off_force", "-P_c", _LOAD, "-min P along the equilibrium path; positive"),
        Quantity("pull_off_displacement", "delta_c", "z0", "displacement where P is smallest"),
        Quantity(
            "jump_in_displacement",
            "delta_in",
            "z0",
            "fold where approach under displacement control jumps into contact",
        ),
        Quantity("jump_in_gap", "H0_in", "z0", "central gap at the jump-in fold"),
        Quantity(
            "jump_out_displacement",
            "delta_out",
            "z0",
            "fold where retreat under displacement control jumps out of contact",
        ),
        Quantity("jump_out_gap", "H0_out", "z0", "central gap at the jump-out fold"),
        Quantity("zero_load_displacement", "delta_0", "z0", "displacement in contact where P = 0"),
        Quantity(
            "hysteresis_energy", "W_hys", _ENERGY, "energy lost in one cycle of displacement control; >= 0"
        ),
        Quantity(
            "critical_tabor_number",
            "mu_crit",
            "1",
            "Tabor number above which jumps and hysteresis exist, at given n and k",
        ),
    )
}
