"""Table of the components of the atlas: what is expanded, where, in which form; and the quantities they make up."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["COMPONENTS", "CRITICAL", "QUANTITIES", "Component", "Composition"]

#: Name of the series of the critical Tabor number.
CRITICAL = "critical_tabor_number"


@dataclass(frozen=True)
class Component:
    """A function that one series expands.

    Attributes
    ----------
    upper : bool
        Whether its patch reaches from the critical Tabor number to 10, or from 0.01 to the seam.
    form : str
        Of `fscm.interpolation.forms.FORMS`.
    first, second : str
        Quantities.  Without a second one the component is the first; else it is (first + sign * second) / 2.
    sign : float
    """

    upper: bool
    form: str
    first: str
    second: str = ""
    sign: float = 1.0


@dataclass(frozen=True)
class Composition:
    """How a quantity is put together.

    Attributes
    ----------
    lower, upper, difference : str
        Names of components; empty where there is none.  The difference is added to the upper one, times `sign`.
    sign : float
    relative : bool
        Whether the deviation of the series is in proportion to the value, or to 1 + |value|.
    """

    lower: str
    upper: str
    difference: str = ""
    sign: float = 1.0
    relative: bool = False

    @property
    def jumps(self) -> bool:
        """Whether the quantity exists above the critical Tabor number only."""
        return not self.lower


_IN_D, _OUT_D, _IN_G, _OUT_G = (f"jump_{way}_{what}" for what in ("displacement", "gap") for way in ("in", "out"))

COMPONENTS: dict[str, Component] = {
    "pull_off_force.lower": Component(False, "force", "pull_off_force"),
    "pull_off_force.upper": Component(True, "force", "pull_off_force"),
    "pull_off_displacement.lower": Component(False, "displacement", "pull_off_displacement"),
    "pull_off_displacement.upper": Component(True, "displacement", "pull_off_displacement"),
    "zero_load_displacement.lower": Component(False, "logarithm", "zero_load_displacement"),
    "zero_load_displacement.upper": Component(True, "logarithm", "zero_load_displacement"),
    "jump_displacement.mean": Component(True, "minus_logarithm", _IN_D, _OUT_D),
    "jump_displacement.difference": Component(True, "power_3_2", _IN_D, _OUT_D, -1.0),
    "jump_gap.mean": Component(True, "root", _IN_G, _OUT_G),
    "jump_gap.difference": Component(True, "power_1_2", _IN_G, _OUT_G, -1.0),
    "hysteresis_energy.upper": Component(True, "power_2", "hysteresis_energy"),
}

QUANTITIES: dict[str, Composition] = {
    name: Composition(f"{name}.lower", f"{name}.upper", relative=relative)
    for name, relative in (
        ("pull_off_force", True),
        ("pull_off_displacement", False),
        ("zero_load_displacement", True),
    )
} | {
    _IN_D: Composition("", "jump_displacement.mean", "jump_displacement.difference"),
    _OUT_D: Composition("", "jump_displacement.mean", "jump_displacement.difference", -1.0),
    _IN_G: Composition("", "jump_gap.mean", "jump_gap.difference"),
    _OUT_G: Composition("", "jump_gap.mean", "jump_gap.difference", -1.0),
    "hysteresis_energy": Composition("", "hysteresis_energy.upper", relative=True),
}
