"""The one table of kinds: what a problem file may state, and what each solver makes of it.

The table is `comparisons/data/kinds.toml`.  The check of a file, the variation of keys, the uncertainties, `fscm-bench
list kinds` and the tables of the documentation follow from it.  Here are the functions that build a kind whose values
are not the arguments of a class in both solvers.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import ModuleType
from typing import TYPE_CHECKING, Any

from comparisons.data.toml_text import shipped
from comparisons.data.validation import known_name, shown
from comparisons.problem.punch_shapes import RoundedFlat, SmoothedProfile

if TYPE_CHECKING:
    from comparisons.problem.problem import Section

#: The sections that every file has, and that of an elastic punch, whose kinds are those of the solid.
SECTIONS = ("solid", "punch", "law")
PUNCH_SOLID = "punch_solid"


@dataclass(frozen=True)
class Form:
    """What the value of a key, or of each row of a column, may be.

    Attributes
    ----------
    description : str
        What it is.
    unit, example : str
        In SI, and a value with a unit; empty for a plain number.
    low, high : float
        Limits in SI.
    excluded : sequence of float
        Limits that are not admissible themselves.
    words : sequence of str
        What the value is one of, if it is a word.
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
    >>> ratio = Form("a plain number from 0 to below 1", low=0.0, high=1.0, excluded=(1.0,))
    >>> ratio.admits(0.0), ratio.admits(1.0)
    (True, False)
    """

    description: str
    unit: str = ""
    example: str = ""
    low: float = -math.inf
    high: float = math.inf
    excluded: Sequence[float] = ()
    words: Sequence[str] = ()
    is_list: bool = False
    is_file: bool = False
    is_uncertain: bool = True
    is_optional: bool = False
    if_not_rising: str = ""

    @property
    def text(self) -> str:
        """The end of a sentence that begins with "must be"."""
        unit = f', as "{self.example}" or a plain number in {self.unit}' if self.unit else ""
        text = self.description + unit
        return f"a list with {text}, for each layer" if self.is_list else text

    def admits(self, value: float) -> bool:
        """Whether a value in SI is within the limits."""
        return self.low <= value <= self.high and value not in self.excluded

    def named(self, name: str) -> str:
        """Return a name with the unit in brackets, as ``thickness [m]``."""
        return f"{name} [{self.unit}]" if self.unit else name


@dataclass(frozen=True)
class Kind:
    """One row of the table.

    Attributes
    ----------
    formula : str
        What the kind is, for people.
    keys : mapping of str to Form
    builds : str or callable
        Name of the class in `fscm` and in `fem_reference`, or (solver, section, keywords) -> solid, punch or law in SI.
    keywords : sequence of str
        Optional keys that the class takes by name.
    optional : sequence of str
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
    builds: str | Callable[..., Any]
    keywords: Sequence[str] = ()
    optional: Sequence[str] = ()
    choices: tuple[tuple[str, ...], ...] = ()
    columns: Mapping[str, Form] = field(default_factory=dict)
    is_of_the_paper: bool = False

    @property
    def required(self) -> list[str]:
        """Names of the keys that every file of this kind has."""
        return [key for key in self.keys if key not in (*self.optional, *sum(self.choices, ()))]

    def build(self, solver: ModuleType, section: Section) -> Any:
        """Return the solid, punch or law by the classes of a solver, `fscm` or `fem_reference`, in SI."""
        keywords = {key: section[key] for key in self.keywords if key in section.values}
        if not isinstance(self.builds, str):
            return self.builds(solver, section, **keywords)
        built = getattr(solver, self.builds, None)
        if built is None:
            raise ValueError(f"{solver.__name__} has no class for the kind {section.kind}: {self.formula}")
        return built(*(section[key] for key in self.required), **keywords)


def _coating(solver: ModuleType, solid: Section, **keywords: float) -> Any:
    ratios = solid.get("nu_coating", solid.get("nu")), solid.get("nu_substrate")
    interface = solid["thickness"], solid.get("transition", 0.0)
    return solver.Coating(solid["E_coating"], solid["E_substrate"], *interface, *ratios, **keywords)


def _tabulated_modulus(solver: ModuleType, solid: Section, **keywords: float) -> Any:
    if ("nu" in solid.columns) == ("nu" in solid.values):
        raise ValueError("nu is needed once, as a column of the table or as a key of the section")
    ratios = solid.columns.get("nu", solid.get("nu"))
    return solver.TabulatedModulus(solid.columns["z"], solid.columns["E"], ratios, **keywords)


def _profile(solver: ModuleType, punch: Section) -> Any:
    radii, heights, growth = punch.columns["r"], punch.columns["height"], punch.get("growth", 2.0)
    if "smoothing" in punch.values:
        return SmoothedProfile(radii, heights, punch["smoothing"], growth)
    return solver.MeasuredPunch(radii, heights, growth)


def _tabulated_law(solver: ModuleType, law: Section) -> Any:
    gaps, tractions, exponent = law.columns["gap"], law.columns["traction"], law.get("tail_exponent")
    z0 = law.get("z0")
    if z0 is None:
        # The work of adhesion, or the depth of the well if none adheres, over the largest tension.
        table = solver.TabulatedLaw(gaps, tractions, gaps[-1] - gaps[0], exponent)
        work = table.work_of_adhesion
        depth = max(float(table.energy(gap - gaps[0])) for gap in gaps) + work
        z0 = (work if work > 0.0 else depth) / -min(tractions)
    return solver.TabulatedLaw(gaps, tractions, z0, exponent)


#: Kinds that are no class of the solvers, by section and name.
_BUILDERS: dict[str, Callable[..., Any]] = {
    "solid.coating": _coating,
    "solid.table": _tabulated_modulus,
    "punch.sphere": lambda solver, punch: solver.Sphere(punch["R"], punch.get("R_solid")),
    "punch.rounded-cone": lambda solver, punch: solver.RoundedCone(punch["R"] * punch["slope"], punch["slope"]),
    "punch.rounded-flat": lambda solver, punch: RoundedFlat(punch["flat_radius"], punch["R"]),
    "punch.table": _profile,
    "law.table": _tabulated_law,
}

_TABLES = shipped("kinds.toml")


def _forms(names: Mapping[str, str]) -> dict[str, Form]:
    """The forms of keys by their names, perhaps as "list of modulus"."""
    forms = {}
    for key, name in names.items():
        form = Form(**_TABLES["form"][name.removeprefix("list of ")])
        forms[key] = replace(form, is_list=True, is_uncertain=False) if name.startswith("list of ") else form
    return forms


def _kind(table: str, name: str, row: Mapping[str, Any], every: Mapping[str, Any]) -> Kind:
    forms = {"keys": _forms(row["keys"] | every.get("keys", {})), "columns": _forms(row.get("columns", {}))}
    lists = {
        "choices": tuple(map(tuple, row.get("choices", ()))),
        "optional": (*row.get("optional", ()), *every.get("keys", {})),
        "keywords": tuple(every.get("keywords", ())),
    }
    return Kind(**{"builds": _BUILDERS.get(f"{table}.{name}", ""), **row, **forms, **lists})


def _kinds(section: str, table: str) -> dict[str, Kind]:
    """The kinds of a section, whose rows are those of a table of the file."""
    every = _TABLES["every"].get(section, {})
    return {name: _kind(table, name, row, every) for name, row in _TABLES[table].items()}


#: The kinds of each section, by name.
KINDS = {name: _kinds(name, name) for name in SECTIONS} | {PUNCH_SOLID: _kinds(PUNCH_SOLID, "solid")}

#: What every solid may state, besides its elasticity, of its surface.
SURFACE_KEYS = tuple(_TABLES["every"]["solid"]["keys"])


def absent(name: str) -> str:
    """Return what to do about a section, a key or a kind that is absent here or has another name; nothing of others.

    Examples
    --------
    >>> absent("solid_temperature").partition(":")[0], absent("E0")
    ('nothing here depends on a temperature', '')
    >>> absent("diameter")
    'state the radius R, half the diameter'
    """
    words = {name, *re.split(r"[-_ ]", name)}
    for row in _TABLES["absent"]:
        if name in row.get("names", ()) or words & {*row.get("words", ())}:
            return str(row["remedy"])
    return ""


def known_word(noun: str, name: str, known: Iterable[str], where: str) -> None:
    """Refuse a kind or a key that is not known, as `known_name`, which knows no names of textbooks.

    Raises
    ------
    ValueError
        One sentence.

    Examples
    --------
    >>> known_word("key", "radius", ["R", "R_solid"], "punch")
    Traceback (most recent call last):
    ValueError: punch: unknown key 'radius': did you mean R?
    """
    names = list(known)
    if name not in names and (near := meant(name, names)):
        raise ValueError(f"{where}: unknown {noun} {shown(name)}: did you mean {near}?")
    known_name(noun, name, names, where)


def meant(name: str, known: Iterable[str]) -> str:
    """Return the one of some kinds or keys that has another name in other programs; nothing if none has.

    Examples
    --------
    >>> meant("modulus", ["E0", "c0"]), meant("modulus", ["R"])
    ('E0', '')
    """
    names = list(known)
    rows = (row["known"] for row in _TABLES["meant"] if name in row["names"])
    return next((word for words in rows for word in words if word in names), "")


def kind_rows() -> Iterator[dict[str, str]]:
    """Yield the rows of the table for people: section, kind, formula, keys and columns with their units.

    Examples
    --------
    >>> next(row["keys"] for row in kind_rows() if row["kind"] == "rounded-cone")
    'R [m], slope'
    """
    for section in SECTIONS:
        for name, kind in KINDS[section].items():
            groups = [" and ".join(_named(kind.keys, choice)) for choice in kind.choices]
            keys = [*_named(kind.keys, kind.required), *([" or ".join(groups)] if groups else [])]
            keys += [f"perhaps {key}" for key in _named(kind.keys, kind.optional)]
            columns = ", ".join(_named(kind.columns, kind.columns))
            row = {"kind": name, "section": section, "formula": kind.formula, "keys": ", ".join(keys)}
            yield row | {"columns": columns}


def _named(forms: Mapping[str, Form], names: Iterable[str]) -> list[str]:
    return [forms[name].named(name) for name in names]
