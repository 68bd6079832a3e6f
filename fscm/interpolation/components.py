"""Components of the atlas, each expanded in a series, and the quantities that consist of them."""

from __future__ import annotations

from typing import NamedTuple

__all__ = ["COMPONENTS", "CRITICAL", "FOLD_GAPS", "QUANTITIES", "RELATIVE", "Component", "Composition"]

#: Name of the series of the critical Tabor number.
CRITICAL = "critical_tabor_number"
#: Quantities of which the relative deviation is bounded; of the others, that in proportion to 1 + |value|.
RELATIVE = ("pull_off_force", "zero_load_displacement", CRITICAL)


class Component(NamedTuple):
    """A function that one series expands.

    Attributes
    ----------
    upper : bool
        Whether its patch reaches from the critical Tabor number to 10, or from 0.01 to the seam.
    form : str
        Of `fscm.interpolation.forms.FORMS`.
    quantity, subtracted : str
        The component is the first quantity, minus the second if there is one.
    """

    upper: bool
    form: str
    quantity: str
    subtracted: str = ""


class Composition(NamedTuple):
    """Components of a quantity.

    Attributes
    ----------
    lower, upper, difference : str
        Names of components, or empty.  The difference is subtracted from the upper one.
    """

    lower: str
    upper: str
    difference: str = ""

    @property
    def jumps(self) -> bool:
        """Whether the quantity exists above the critical Tabor number only."""
        return not self.lower


_IN_D, _OUT_D, _IN_G, _OUT_G = (f"jump_{way}_{name}" for name in ("displacement", "gap") for way in ("in", "out"))

#: Central gaps of the two folds that merge at the critical Tabor number.
FOLD_GAPS = (_IN_G, _OUT_G)

#: Every series of the atlas, by name.
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

#: The series of which each quantity consists.
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
