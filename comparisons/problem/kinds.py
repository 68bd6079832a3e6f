"""The one table of kinds: what a problem file may state, and what each solver makes of it.

A row has the keys of a kind with their dimensions, and a function that builds the kind from the classes of a solver.
Both solvers have the same names and arguments, so that one function serves both.  The form of a file, its JSON schema
(`comparisons.problem.schema`), the variation of keys and the uncertainties follow from this table.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from types import ModuleType
from typing import TYPE_CHECKING, Any

from comparisons.problem.columns import Column
from comparisons.problem.punch_shapes import RoundedFlat, SmoothedProfile

if TYPE_CHECKING:
    from comparisons.problem.problem import Section

__all__ = ["KINDS", "SECTIONS", "Dimension", "Key", "Kind", "kind_of", "kinds"]

#: The sections of a file, all required, and what they describe.
SECTIONS = {"solid": "the half-space", "punch": "the rigid punch", "law": "the surface law"}


@dataclass(frozen=True, slots=True)
class Dimension:
    """What a value is, and its limits in SI.

    Attributes
    ----------
    name, description : str
    unit : str or None
        In SI; None for a plain number.
    example : str or None
        A value with a unit.
    above, at_least, at_most, below : float or None
        Limits; those of `above` and `below` are not admissible themselves.
    is_text : bool
        Whether it is a text and no number.
    may_be_uncertain : bool
        Whether the value may have an uncertainty.
    """

    name: str
    description: str
    unit: str | None = None
    example: str | None = None
    above: float | None = None
    at_least: float | None = None
    at_most: float | None = None
    below: float | None = None
    is_text: bool = False
    may_be_uncertain: bool = True

    @property
    def limits(self) -> tuple[float, float]:
        """Both ends of the admissible values."""
        lows = [limit for limit in (self.at_least, self.above) if limit is not None]
        highs = [limit for limit in (self.at_most, self.below) if limit is not None]
        return (lows or [-math.inf])[0], (highs or [math.inf])[0]


MODULUS = Dimension("modulus", "a positive modulus", "Pa", "2 GPa", above=0)
LENGTH = Dimension("length", "a positive length", "m", "100 nm", above=0)
ANGLE = Dimension(
    "angle",
    "an angle between axis and flank, above 0 and below 90 degrees",
    "rad",
    "70 deg",
    above=0,
    below=math.pi / 2.0,
)
TRANSITION = Dimension("transition", "a length, 0 or more", "m", "20 nm", at_least=0)
ENERGY_PER_AREA = Dimension("energy_per_area", "a positive energy per area", "J/m^2", "50 mJ/m^2", above=0)
SHAPE_PARAMETER = Dimension("shape_parameter", "positive, a length to the power n - 1", "m^(n-1)", "1 um", above=0)
EXPONENT = Dimension("exponent", "a plain number from 0 to 1", at_least=0, at_most=1)
OFFSET_EXPONENT = Dimension("offset_exponent", "a plain number from 0 to below 1", at_least=0, below=1)
RATIO = Dimension("ratio", "a plain number from 0 to 0.5", at_least=0, at_most=0.5)
SHAPE_INDEX = Dimension("shape_index", "a plain number above 0 and at most 300", above=0, at_most=300)
POSITIVE = Dimension("positive", "a positive plain number", above=0)
POWER = Dimension("power", "a plain number above 1", above=1)
FILE = Dimension("file", "the name of a CSV file in the folder of the problem file", is_text=True)
STANDARD_ERROR = Dimension(
    "standard_error", "a positive length without an uncertainty", "m", "1 nm", above=0, may_be_uncertain=False
)


@dataclass(frozen=True, slots=True)
class Key:
    """A key of a kind.

    Attributes
    ----------
    name : str
    dimension : Dimension
    required : bool
    is_list : bool
        Whether its value is a list of one value or more, each without an uncertainty.
    """

    name: str
    dimension: Dimension
    required: bool = True
    is_list: bool = False


@dataclass(frozen=True)
class Kind:
    """One row of the table.

    Attributes
    ----------
    name : str
    keys : tuple of Key
    build : callable
        (solver, section) -> the solid, punch or law by the classes of a solver, `fscm` or `fem_reference`, in SI.
    choices : tuple of tuple of str
        Optional keys of which one group is needed, complete.
    columns, fewest_rows
        Of the table that the key `file` names.
    is_of_the_paper : bool
        Whether the problem of three numbers n, k and mu has it.
    lengths : str or None
        Of lists: which key is shorter by one than the others.
    """

    name: str
    keys: tuple[Key, ...]
    build: Callable[[ModuleType, Section], Any]
    choices: tuple[tuple[str, ...], ...] = ()
    columns: Mapping[str, Column] = field(default_factory=dict)
    fewest_rows: int = 0
    is_of_the_paper: bool = False
    lengths: str | None = None

    @cached_property
    def by_name(self) -> dict[str, Key]:
        """The keys by their names."""
        return {key.name: key for key in self.keys}

    @property
    def required(self) -> list[str]:
        """Names of the keys that every file of this kind has."""
        return [key.name for key in self.keys if key.required]


def _optional(name: str, dimension: Dimension) -> Key:
    return Key(name, dimension, required=False)


def _coating(solver: ModuleType, solid: Section) -> Any:
    ratios = solid.get("nu_coating", solid.get("nu")), solid.get("nu_substrate")
    interface = solid["thickness"], solid["transition"]
    return solver.Coating(solid["E_coating"], solid["E_substrate"], *interface, *ratios)


def _tabulated_modulus(solver: ModuleType, solid: Section) -> Any:
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


_SOLIDS = (
    Kind(
        "power-law",
        (Key("E0", MODULUS), Key("c0", LENGTH), Key("k", EXPONENT), Key("nu", RATIO)),
        lambda solver, solid: solver.PowerLaw(solid["E0"], solid["c0"], solid["k"], solid["nu"]),
        is_of_the_paper=True,
    ),
    Kind(
        "homogeneous",
        (Key("E", MODULUS), Key("nu", RATIO)),
        lambda solver, solid: solver.Homogeneous(solid["E"], solid["nu"]),
        is_of_the_paper=True,
    ),
    Kind(
        "offset-power-law",
        (
            Key("E0", MODULUS),
            Key("c0", LENGTH),
            Key("k", OFFSET_EXPONENT),
            Key("z_s", LENGTH),
            Key("nu", RATIO),
        ),
        lambda solver, solid: solver.OffsetPowerLaw(*(solid[key] for key in ("E0", "c0", "k", "z_s", "nu"))),
    ),
    Kind(
        "exponential",
        (Key("E_surface", MODULUS), Key("E_depth", MODULUS), Key("length", LENGTH), Key("nu", RATIO)),
        lambda solver, solid: solver.Exponential(*(solid[key] for key in ("E_surface", "E_depth", "length", "nu"))),
    ),
    Kind(
        "coating",
        (
            Key("E_coating", MODULUS),
            Key("E_substrate", MODULUS),
            Key("thickness", LENGTH),
            Key("transition", TRANSITION),
            _optional("nu", RATIO),
            _optional("nu_coating", RATIO),
            _optional("nu_substrate", RATIO),
        ),
        _coating,
        choices=(("nu",), ("nu_coating", "nu_substrate")),
    ),
    Kind(
        "layers",
        (
            Key("E", MODULUS, is_list=True),
            Key("nu", RATIO, is_list=True),
            Key("thickness", LENGTH, is_list=True),
        ),
        lambda solver, solid: solver.Layers(solid["E"], solid["nu"], solid["thickness"]),
        lengths="thickness",
    ),
    Kind(
        "table",
        (Key("file", FILE), _optional("nu", RATIO)),
        _tabulated_modulus,
        columns={
            "z": Column("m", low=0.0, rising=True, twice="a step: use the kind layers, which has sharp interfaces"),
            "E": Column("Pa", low=0.0, open=True),
            "nu": Column("1", low=0.0, high=0.5, optional=True),
        },
        fewest_rows=2,
    ),
)

_PUNCHES = (
    Kind(
        "sphere",
        (Key("R", LENGTH),),
        lambda solver, punch: solver.PowerPunch(2.0, punch["R"]),
        is_of_the_paper=True,
    ),
    Kind("ball", (Key("R", LENGTH),), lambda solver, punch: solver.Ball(punch["R"])),
    Kind(
        "cone",
        (Key("half_angle", ANGLE),),
        lambda solver, punch: solver.PowerPunch(1.0, math.tan(punch["half_angle"])),
        is_of_the_paper=True,
    ),
    Kind(
        "power-law",
        (Key("n", SHAPE_INDEX), Key("Q", SHAPE_PARAMETER)),
        lambda solver, punch: solver.PowerPunch(punch["n"], punch["Q"]),
        is_of_the_paper=True,
    ),
    Kind(
        "rounded-cone",
        (Key("R", LENGTH), Key("slope", POSITIVE)),
        lambda solver, punch: solver.RoundedCone(punch["R"] * punch["slope"], punch["slope"]),
    ),
    Kind(
        "rounded-flat",
        (Key("flat_radius", LENGTH), Key("R", LENGTH)),
        lambda solver, punch: RoundedFlat(punch["flat_radius"], punch["R"]),
    ),
    Kind(
        "table",
        (Key("file", FILE), _optional("growth", POSITIVE), _optional("smoothing", STANDARD_ERROR)),
        _profile,
        columns={"r": Column("m", low=0.0, rising=True), "height": Column("m")},
        fewest_rows=2,
    ),
)

_LAWS = (
    Kind(
        "lennard-jones-9-3",
        (Key("work_of_adhesion", ENERGY_PER_AREA), Key("z0", LENGTH)),
        lambda solver, law: solver.LennardJones(law["work_of_adhesion"], law["z0"]),
        is_of_the_paper=True,
    ),
    Kind(
        "mie",
        (Key("work_of_adhesion", ENERGY_PER_AREA), Key("z0", LENGTH), Key("m", POWER), Key("n", POWER)),
        lambda solver, law: solver.Mie(law["work_of_adhesion"], law["z0"], law["m"], law["n"]),
    ),
    Kind(
        "table",
        (Key("file", FILE), _optional("z0", LENGTH), _optional("tail_exponent", POWER)),
        _tabulated_law,
        columns={"gap": Column("m", rising=True), "traction": Column("Pa")},
        fewest_rows=10,
    ),
)

#: The kinds of each section, by name.
KINDS: dict[str, dict[str, Kind]] = {
    section: {kind.name: kind for kind in rows}
    for section, rows in (("solid", _SOLIDS), ("punch", _PUNCHES), ("law", _LAWS))
}


def kinds(section: str) -> dict[str, Kind]:
    """Return the kinds of a section.

    Examples
    --------
    >>> list(kinds("law"))
    ['lennard-jones-9-3', 'mie', 'table']
    """
    return KINDS[section]


def kind_of(section: str, name: str) -> Kind:
    """Return one row of the table."""
    return KINDS[section][name]
