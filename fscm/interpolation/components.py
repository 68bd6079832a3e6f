"""Table of the components of the atlas: what is expanded, where, in which form; and the quantities they make up."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["COMPONENTS", "CRITICAL", "FOLD_GAPS", "QUANTITIES", "RELATIVE", "Component", "Composition"]

#: Name of the series of the critical Tabor number.
CRITICAL = "critical_tabor_number"
#: Quantities of which the relative deviation is bounded; of the others, that in proportion to 1 + |value|.
RELATIVE = ("pull_off_force", "zero_load_displacement", CRITICAL)


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
        Quantities.  The component is the first one, less the second one if there is one.
    """

    upper: bool
    form: str
    first: str
    second: str = ""


@dataclass(frozen=True)
class Composition:
    """How a quantity is put together.

    Attributes
    ----------
    lower, upper, difference : str
        Names of components; empty where there is none.  The difference is subtracted from the upper one.
    """

    lower: str
    upper: str
    difference: str = ""

    @property
    def jumps(self) -> bool:
        """Whether the quantity exists above the critical Tabor number only."""
        return not self.lower


_IN_D, _OUT_D, _IN_G, _OUT_G = (f"jump_{way}_{what}" for what in ("displacement", "gap") for way in ("in", "out"))

#: Central gaps of the two folds that merge at the critical Tabor number.
FOLD_GAPS = (_IN_G, _OUT_G)

COMPONENTS: dict[str, Component] = {
    "pull_off_force.lower": Component(False, "force", "pull_off_force"),
    "pull_off_force.upper": Component(True, "force", "pull_off_force"),
    "pull_off_displacement.lower": Component(False, "plain", "pull_off_displacement"),
    "pull_off_displacement.upper": Component(True, "displacement", "pull_off_displacement"),
    "zero_load_displacement.lower": Component(False, "logarithm", "zero_load_displacement"),
    "zero_load_displacement.upper": Component(True, "logarithm", "zero_load_displacement"),
    "jump_in_displacement.upper": Component(True, "minus_logarithm", _IN_D),
    "jump_displacement.difference": Component(True, "power_3_2", _IN_D, _OUT_D),
    "jump_in_gap.upper": Component(True, "root", _IN_G),
    "jump_gap.difference": Component(True, "power_1_2", _IN_G, _OUT_G),
    "hysteresis_energy.upper": Component(True, "quarter", "hysteresis_energy"),
}

QUANTITIES: dict[str, Composition] = {
    name: Composition(f"{name}.lower", f"{name}.upper")
    for name in ("pull_off_force", "pull_off_displacement", "zero_load_displacement")
} | {
    _IN_D: Composition("", "jump_in_displacement.upper"),
    _OUT_D: Composition("", "jump_in_displacement.upper", "jump_displacement.difference"),
    _IN_G: Composition("", "jump_in_gap.upper"),
    _OUT_G: Composition("", "jump_in_gap.upper", "jump_gap.difference"),
    "hysteresis_energy": Composition("", "hysteresis_energy.upper"),
}
