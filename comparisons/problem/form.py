"""Text of a problem file, and the check of its sections by the table of kinds, with their values in SI."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from comparisons.data.validation import shown
from comparisons.problem.kinds import KINDS, PUNCH_SOLID, Form, Kind, absent, known_word
from comparisons.problem.uncertain import Uncertainty, uncertain_in_si
from comparisons.problem.units import NotAValue, in_si, magnitude_in_si


@dataclass(frozen=True, slots=True)
class Source:
    r"""A problem file.

    Examples
    --------
    >>> source = Source(Path("pad.toml"), "[solid]\nkind = 'power-law'\nE0 = -1\n")
    >>> source.refusal("solid.E0 = -1 must be positive", "solid", "E0")
    ValueError('pad.toml, line 3: solid.E0 = -1 must be positive')
    """

    path: Path
    text: str

    def place(self, section: str, key: str | None = None) -> str:
        """File and line of a key, or else of its section; the file where neither is written on a line of its own."""
        table, name = re.escape(section), re.escape(key or "kind")
        header = re.compile(rf"\s*(\[{{1,2}}\s*[\"']?{table}[\"']?\s*\]|{table}\s*[.=])")
        entry = re.compile(rf"\s*({table}\s*\.\s*)?[\"']?{name}[\"']?\s*[.=]")
        line_of_section, inside = 0, False
        for number, line in enumerate(self.text.splitlines(), start=1):
            begins = bool(header.match(line))
            inside = begins or (inside and not line.lstrip().startswith("["))
            line_of_section = line_of_section or number * begins
            if key and inside and entry.match(line):
                return f"{self.path}, line {number}"
        return f"{self.path}, line {line_of_section}" if line_of_section else str(self.path)

    def refusal(self, sentence: str, section: str, key: str | None = None) -> ValueError:
        """Return the error with file and line before its sentence."""
        return ValueError(f"{self.place(section, key)}: {sentence}")


def kind_of(section: str, table: object, source: Source) -> Kind:
    """Return the kind of a section as it is in the file, whose keys are those of the kind.

    Raises
    ------
    ValueError
        One sentence with file, line and remedy.
    """
    if not isinstance(table, Mapping):
        form = f"one section, [{section}] in single brackets, with a kind and its keys"
        raise source.refusal(f"{section} = {shown(table)} must be {form}", section)
    if "kind" not in table:
        raise source.refusal(f"{section}: kind missing; it is one of {', '.join(KINDS[section])}", section)
    name = str(table["kind"])
    if name not in KINDS[section] and (remedy := absent(name)):
        raise source.refusal(f"{section}.kind = {shown(name)}: {remedy}", section, "kind")
    known_word(f"{section}.kind", name, KINDS[section], source.place(section, "kind"))
    kind = KINDS[section][name]
    for key in table:
        if key not in ("kind", *kind.keys) and (reason := _of_another(section, name, key) or absent(key)):
            raise source.refusal(f"{section}.{key}: {reason}", section, key)
        known_word("key", key, ["kind", *kind.keys], f"{source.place(section, key)}: {section}")
    if missing := [key for key in kind.required if key not in table]:
        has = f"a {section} of the kind {name} has {', '.join(kind.required)}"
        raise source.refusal(f"{section}: {', '.join(missing)} missing; {has}", section)
    stated = tuple(key for choice in kind.choices for key in choice if key in table)
    if kind.choices and stated not in kind.choices:
        choices = " or else ".join(" and ".join(choice) for choice in kind.choices)
        raise source.refusal(f"{section} must be a {name} with {choices}", section)
    return kind


def _of_another(section: str, name: str, key: str) -> str:
    """Where a key belongs that a kind does not have; nothing for one that no section near has."""
    of_solids = {key for kind in KINDS["solid"].values() for key in kind.keys}
    if section == "punch" and key in of_solids:
        return f"a punch has a shape alone; the solid of an elastic punch is the section [{PUNCH_SOLID}], with its kind"
    if section == PUNCH_SOLID and key == "friction":
        return "friction is one for both bodies; write it in [solid]"
    others = [other for other, kind in KINDS[section].items() if key in kind.keys]
    return f"{key} is a key of the kind {' or '.join(others)}, not of {name}" if key == "R_solid" and others else ""


def values_in_si(
    section: str, table: Mapping[str, Any], source: Source
) -> tuple[dict[str, Any], dict[str, Uncertainty]]:
    """Return the values of a section in SI, names of files as they are; and what is uncertain of them.

    Parameters
    ----------
    section : str
    table : mapping
        As in the file, with the keys of its kind.
    source : Source

    Raises
    ------
    ValueError
        One sentence with file, line, value and remedy.
    """
    values: dict[str, Any] = {}
    uncertain: dict[str, Uncertainty] = {}
    for key, form in KINDS[section][table["kind"]].keys.items():
        if key not in table:
            continue
        written = table[key]
        # The shape index stands before Q in the table of kinds.
        power = values["n"] - 1.0 if form.unit == "m^(n-1)" else 1.0
        try:
            if form.is_file:
                values[key] = _filled(written, str, "name")
            elif form.words:
                values[key] = _word(written, form)
            elif form.is_list:
                values[key] = tuple(_value(entry, form, power)[0] for entry in _filled(written, list, "list of values"))
            else:
                values[key], spread = _value(written, form, power)
                uncertain |= {key: spread} if spread else {}
        except NotAValue as error:
            sentence = f"{section}.{key} = {shown(written)} {error}; it must be {form.text}"
            raise source.refusal(sentence, section, key) from None
    return values, uncertain


def _filled(written: Any, wanted: type, name: str) -> Any:
    """A name or a list as it is written; `NotAValue` if it is none, or empty."""
    if not isinstance(written, wanted) or not written:
        raise NotAValue(f"is not a {name}")
    return written


def _word(written: object, form: Form) -> str:
    """A word as it is written; `NotAValue` if it is none of the form."""
    if written not in form.words:
        raise NotAValue(f"is not one of {', '.join(form.words)}")
    return str(written)


def _value(written: object, form: Form, power: float) -> tuple[float, Uncertainty | None]:
    """A value in SI, with its uncertainty if it has one; `NotAValue` if it is not admissible."""
    unit = form.unit.removesuffix("^(n-1)")
    written = magnitude_in_si(written, unit, power)
    uncertain = uncertain_in_si(written, unit, power)
    if uncertain and not form.is_uncertain:
        raise NotAValue("has an uncertainty, which is not admissible here")
    if isinstance(written, str) and not unit and not uncertain:
        raise NotAValue("is a text")
    value, spread = uncertain or (in_si(written, unit, power), None)
    low, high = spread.limits(value) if spread else (value, value)
    ends = {low, high} if spread is None or spread.is_interval else {value}
    if not form.admits(0.0):
        # A standard deviation may reach 0 where 0 is admissible.
        ends.add(low)
    if form.unit == "Pa" and isinstance(written, str) and 0.0 < value < 1.0:
        raise NotAValue("is below 1 Pa: mPa is millipascal, and MPa megapascal")
    if not all(map(form.admits, ends)):
        raise NotAValue("reaches outside its range" if spread else "is outside its range")
    return value, spread
