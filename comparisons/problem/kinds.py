"""The one table of kinds: what a problem file may state, and what each solver makes of it.

A row has a formula, the keys of a kind, and the class of that name in both solvers, which takes their values in this
order, or a function that builds it.  The check of a file, the variation of keys, the uncertainties, `fscm-bench list
kinds` and the tables of the documentation follow from this table.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from types import ModuleType
from typing import TYPE_CHECKING, Any

from comparisons.problem.punch_shapes import RoundedFlat, SmoothedProfile

if TYPE_CHECKING:
    from comparisons.problem.problem import Section

__all__ = ["KINDS", "SECTIONS", "Form", "Kind", "kind_rows"]

#: The sections of a file, all required.
SECTIONS = ("solid", "punch", "law")


@dataclass(frozen=True)
class Form:
    """What the value of a key, or of each row of a column, may be.

    Attributes
    ----------
    description : str
        The end of a sentence that begins with "must be".
    unit : str
        In SI; empty for a plain number.
    low, high : float
        Limits in SI.
    excluded : tuple of float
        Limits that are not admissible themselves.
    is_list, is_file : bool
        Whether the value is a list with an entry for each layer, or the name of a file.
    is_uncertain : bool
        Whether an uncertainty is admissible.
    is_optional : bool
        Whether the column may be missing.
    if_not_rising : str
        What to do with a value of a column that is not above the one before it; empty if it need not be.

    Examples
    --------
    >>> RATIO.admits(0.5), LENGTH.admits(0.0)
    (True, False)
    """

    description: str
    unit: str = ""
    low: float = -math.inf
    high: float = math.inf
    excluded: tuple[float, ...] = ()
    is_list: bool = False
    is_file: bool = False
    is_uncertain: bool = True
    is_optional: bool = False
    if_not_rising: str = ""

    def admits(self, value: float) -> bool:
        """Whether a value in SI is within the limits."""
        return self.low <= value <= self.high and value not in self.excluded

    def named(self, name: str) -> str:
        """Return a name with the unit in brackets, as ``thickness [m]``."""
        return f"{name} [{self.unit}]" if self.unit else name


def _quantity(description: str, unit: str, example: str, **limits: Any) -> Form:
    return Form(f'{description}, as "{example}" or a plain number in {unit}', unit, **limits)


def _list(form: Form) -> Form:
    description = f"a list with {form.description}, for each layer"
    return replace(form, description=description, is_list=True, is_uncertain=False)


_POSITIVE: dict[str, Any] = {"low": 0.0, "excluded": (0.0,)}
MODULUS = _quantity("a modulus of at least 1 Pa (megapascal is MPa)", "Pa", "2 GPa", low=1.0)
LENGTH = _quantity("a positive length", "m", "100 nm", **_POSITIVE)
FROM_ZERO = _quantity("a length, 0 or more", "m", "20 nm", low=0.0)
ANGLE = _quantity(
    "an angle between axis and flank, above 0 and below 90 degrees",
    "rad",
    "70 deg",
    low=0.0,
    high=math.pi / 2.0,
    excluded=(0.0, math.pi / 2.0),
)
ENERGY_PER_AREA = _quantity("a positive energy per area", "J/m^2", "50 mJ/m^2", **_POSITIVE)
SHAPE_PARAMETER = _quantity("positive, a length to the power n - 1", "m^(n-1)", "1 um^2", **_POSITIVE)
EXPONENT = Form("a plain number from 0 to 1", low=0.0, high=1.0)
OFFSET_EXPONENT = Form("a plain number from 0 to below 1", low=0.0, high=1.0, excluded=(1.0,))
RATIO = Form("a plain number from 0 to 0.5", low=0.0, high=0.5)
SHAPE_INDEX = Form("a plain number above 0 and at most 300", high=300.0, **_POSITIVE)
POSITIVE = Form("a positive plain number", **_POSITIVE)
POWER = Form("a plain number above 1", low=1.0, excluded=(1.0,))
FILE = Form("the name of a CSV file in the folder of the problem file", is_file=True)


@dataclass(frozen=True)
class Kind:
    """One row of the table.

    Attributes
    ----------
    formula : str
        What the kind is, for people.
    keys : mapping of str to Form
    builds : str or callable
        Name of the class in `fscm` and in `fem_reference`, or (solver, section) -> solid, punch or law in SI.
    optional : tuple of str
        Keys that a file may leave out.
    choices : tuple of tuple of str
        Groups of keys of which a file has one.
    columns : mapping of str to Form
        Of the table that the key `file` names.
    is_of_the_paper : bool
        Whether the problem of three numbers n, k and mu has it.
    """

    formula: str
    keys: Mapping[str, Form]
    builds: str | Callable[[ModuleType, Section], Any]
    optional: tuple[str, ...] = ()
    choices: tuple[tuple[str, ...], ...] = ()
    columns: Mapping[str, Form] = field(default_factory=dict)
    is_of_the_paper: bool = False

    @property
    def required(self) -> list[str]:
        """Names of the keys that every file of this kind has."""
        return [key for key in self.keys if key not in (*self.optional, *sum(self.choices, ()))]

    def build(self, solver: ModuleType, section: Section) -> Any:
        """Return the solid, punch or law by the classes of a solver, `fscm` or `fem_reference`, in SI."""
        if isinstance(self.builds, str):
            return getattr(solver, self.builds)(*(section[key] for key in self.keys))
        return self.builds(solver, section)


def _coating(solver: ModuleType, solid: Section) -> Any:
    ratios = solid.get("nu_coating", solid.get("nu")), solid.get("nu_substrate")
    interface = solid["thickness"], solid["transition"]
    return solver.Coating(solid["E_coating"], solid["E_substrate"], *interface, *ratios)


def _tabulated_modulus(solver: ModuleType, solid: Section) -> Any:
    if ("nu" in solid.columns) == ("nu" in solid.values):
        raise ValueError("nu is needed once, as a column of the table or as a key of the section")
    return solver.TabulatedModulus(solid.columns["z"], solid.columns["E"], solid.columns.get("nu", solid.get("nu")))


def _profile(solver: ModuleType, punch: Section) -> Any:
    radii, heights, growth = punch.columns["r"], punch.columns["height"], punch.get("growth", 2.0)
    if "smoothing" in punch.values:
        return SmoothedProfile(radii, heights, punch["smoothing"], growth)
    return solver.MeasuredPunch(radii, heights, growth)


def _tabulated_law(solver: ModuleType, law: Section) -> Any:
    gaps, tractions, exponent = law.columns["gap"], law.columns["traction"], law.get("tail_exponent")
    z0 = law.get("z0")
    if z0 is None:
        # The work of adhesion over the largest tension.
        table = solver.TabulatedLaw(gaps, tractions, gaps[-1] - gaps[0], exponent)
        z0 = table.work_of_adhesion / -min(tractions)
    return solver.TabulatedLaw(gaps, tractions, z0, exponent)


_SOLIDS = {
    "homogeneous": Kind("E", {"E": MODULUS, "nu": RATIO}, "Homogeneous", is_of_the_paper=True),
    "power-law": Kind(
        "E0 (z/c0)^k",
        {"E0": MODULUS, "c0": LENGTH, "k": EXPONENT, "nu": RATIO},
        "PowerLaw",
        is_of_the_paper=True,
    ),
    "offset-power-law": Kind(
        "E0 ((z + z_s)/c0)^k",
        {"E0": MODULUS, "c0": LENGTH, "k": OFFSET_EXPONENT, "z_s": LENGTH, "nu": RATIO},
        "OffsetPowerLaw",
    ),
    "exponential": Kind(
        "E_depth + (E_surface - E_depth) exp(-z/length)",
        {"E_surface": MODULUS, "E_depth": MODULUS, "length": LENGTH, "nu": RATIO},
        "Exponential",
    ),
    "coating": Kind(
        "E_substrate + (E_coating - E_substrate) (1 - tanh((z - thickness)/transition))/2; transition 0 is sharp",
        {
            "E_coating": MODULUS,
            "E_substrate": MODULUS,
            "thickness": LENGTH,
            "transition": FROM_ZERO,
            "nu": RATIO,
            "nu_coating": RATIO,
            "nu_substrate": RATIO,
        },
        _coating,
        choices=(("nu",), ("nu_coating", "nu_substrate")),
    ),
    "layers": Kind(
        "E of each layer, from the surface downwards, and of the substrate, which is one entry more; sharp interfaces",
        {"E": _list(MODULUS), "nu": _list(RATIO), "thickness": _list(LENGTH)},
        "Layers",
    ),
    "table": Kind(
        "monotone interpolation of the rows, constant beyond them",
        {"file": FILE, "nu": RATIO},
        _tabulated_modulus,
        optional=("nu",),
        columns={
            "z": replace(FROM_ZERO, if_not_rising="sort the rows by z; a step of the modulus is the kind layers"),
            "E": MODULUS,
            "nu": replace(RATIO, is_optional=True),
        },
    ),
}

_PUNCHES = {
    "sphere": Kind(
        "r^2/(2 R), the paraboloid",
        {"R": LENGTH},
        lambda solver, punch: solver.PowerPunch(2.0, punch["R"]),
        is_of_the_paper=True,
    ),
    "ball": Kind("R - sqrt(R^2 - r^2), the true sphere", {"R": LENGTH}, "Ball"),
    "cone": Kind(
        "r/tan(half_angle)",
        {"half_angle": ANGLE},
        lambda solver, punch: solver.PowerPunch(1.0, math.tan(punch["half_angle"])),
        is_of_the_paper=True,
    ),
    "power-law": Kind("r^n/(n Q)", {"n": SHAPE_INDEX, "Q": SHAPE_PARAMETER}, "PowerPunch", is_of_the_paper=True),
    "rounded-cone": Kind(
        "slope (sqrt(r^2 + c^2) - c), c = R slope, with the radius of curvature R of the tip",
        {"R": LENGTH, "slope": POSITIVE},
        lambda solver, punch: solver.RoundedCone(punch["R"] * punch["slope"], punch["slope"]),
    ),
    "rounded-flat": Kind(
        "(r - flat_radius)^2/(2 R) outside of the flat end",
        {"flat_radius": LENGTH, "R": LENGTH},
        lambda solver, punch: RoundedFlat(punch["flat_radius"], punch["R"]),
    ),
    "table": Kind(
        "straight lines between the rows, and beyond the last one its height times (r/r_last)^growth, growth 2 if not "
        "stated",
        {
            "file": FILE,
            "growth": POSITIVE,
            "smoothing": replace(LENGTH, is_uncertain=False),
        },
        _profile,
        optional=("growth", "smoothing"),
        columns={
            "r": replace(FROM_ZERO, if_not_rising="sort the rows by r"),
            "height": _quantity("a length", "m", "1 nm"),
        },
    ),
}

_LAWS = {
    "lennard-jones-9-3": Kind(
        "(8 w/(3 z0)) ((1 + H/z0)^-9 - (1 + H/z0)^-3), w = work_of_adhesion",
        {"work_of_adhesion": ENERGY_PER_AREA, "z0": LENGTH},
        "LennardJones",
        is_of_the_paper=True,
    ),
    "mie": Kind(
        "the same with the exponents m of the repulsion and n of the attraction, 1 < n < m",
        {"work_of_adhesion": ENERGY_PER_AREA, "z0": LENGTH, "m": POWER, "n": POWER},
        "Mie",
    ),
    "table": Kind(
        "a smooth curve through ten rows or more, a wall below and a power beyond; compression is positive",
        {"file": FILE, "z0": LENGTH, "tail_exponent": POWER},
        _tabulated_law,
        optional=("z0", "tail_exponent"),
        columns={
            "gap": _quantity("a length", "m", "1 nm", if_not_rising="sort the rows by gap"),
            "traction": _quantity("a traction", "Pa", "1 MPa"),
        },
    ),
}

#: The kinds of each section, by name.
KINDS: dict[str, dict[str, Kind]] = {"solid": _SOLIDS, "punch": _PUNCHES, "law": _LAWS}


def kind_rows() -> Iterator[dict[str, str]]:
    """Yield the rows of the table for people: section, kind, formula, keys and columns with their units.

    Examples
    --------
    >>> next(row["keys"] for row in kind_rows() if row["kind"] == "rounded-cone")
    'R [m], slope'
    """
    for section, kinds in KINDS.items():
        for name, kind in kinds.items():
            groups = [" and ".join(_named(kind.keys, choice)) for choice in kind.choices]
            keys = [*_named(kind.keys, kind.required), *([" or ".join(groups)] if groups else [])]
            keys += [f"perhaps {key}" for key in _named(kind.keys, kind.optional)]
            columns = ", ".join(_named(kind.columns, kind.columns))
            row = {"kind": name, "section": section, "formula": kind.formula, "keys": ", ".join(keys)}
            yield row | {"columns": columns}


def _named(forms: Mapping[str, Form], names: Iterable[str]) -> list[str]:
    return [forms[name].named(name) for name in names]
