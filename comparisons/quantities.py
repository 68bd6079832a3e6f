"""The registry of what can be asked: one row a quantity."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["QUANTITIES", "Quantity"]


@dataclass(frozen=True, slots=True)
class Quantity:
    """A quantity: name, symbol, kind (which decides unit and sign) and meaning.

    Examples
    --------
    >>> QUANTITIES["pull_off_force"].unit
    'pi Q^(2/n) dgamma z0^(2/n-1)'
    """

    name: str
    symbol: str
    kind: str
    meaning: str

    @property
    def unit(self) -> str:
        """The scale of the dimensionless value."""
        return _UNITS[self.kind]

    @property
    def sign(self) -> str:
        """Which way is positive, and where zero is."""
        return _SIGNS[self.kind]


#: Kind -> scale; the kinds are those of `fscm.physical.PhysicalProblem.scales`, and plain numbers.
_UNITS = {
    "load": "pi Q^(2/n) dgamma z0^(2/n-1)",
    "energy": "pi Q^(2/n) dgamma z0^(2/n)",
    "displacement": "z0",
    "gap": "z0",
    "number": "1",
}

_SIGNS = {
    "load": "positive, though the load is a tension",
    "energy": "never negative",
    "displacement": "positive towards the half-space, zero where the undeformed gap at r = 0 is zero",
    "gap": "zero at the equilibrium distance of two flat surfaces, above -1",
    "number": "positive",
}

QUANTITIES: dict[str, Quantity] = {
    q.name: q
    for q in (
        Quantity("pull_off_force", "-P_c", "load", "-min P along the equilibrium path"),
        Quantity("pull_off_displacement", "delta_c", "displacement", "displacement where P is smallest"),
        Quantity("jump_in_displacement", "delta_in", "displacement", "fold where approach jumps into contact"),
        Quantity("jump_in_gap", "H0_in", "gap", "central gap at the jump-in fold"),
        Quantity("jump_out_displacement", "delta_out", "displacement", "fold where retreat jumps out of contact"),
        Quantity("jump_out_gap", "H0_out", "gap", "central gap at the jump-out fold"),
        Quantity("zero_load_displacement", "delta_0", "displacement", "displacement in contact where P = 0"),
        Quantity("hysteresis_energy", "W_hys", "energy", "lost in one cycle of displacement control"),
        Quantity("critical_tabor_number", "mu_crit", "number", "jumps and hysteresis exist above it; mu is ignored"),
    )
}
