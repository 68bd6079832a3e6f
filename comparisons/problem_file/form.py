"""Form of a problem file: the keys of every kind of section, from the JSON schema, and the check of their values."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from difflib import get_close_matches
from functools import lru_cache
from importlib.resources import files
from typing import Any

from comparisons.problem_file.source import Source, shown
from comparisons.problem_file.uncertain import Uncertainty, is_uncertain, uncertain_in_si
from comparisons.problem_file.units import NotAValue, in_si

__all__ = ["SECTIONS", "checked_section", "kinds", "limits_of", "unit_of"]

#: The sections, all required.
SECTIONS = ("solid", "punch", "law")

#: Limits of the schema: keyword, and the comparison that holds.
_LIMITS = {
    "exclusiveMinimum": (lambda value, limit: value > limit, "above {:g}"),
    "minimum": (lambda value, limit: value >= limit, "at least {:g}"),
    "maximum": (lambda value, limit: value <= limit, "at most {:g}"),
    "exclusiveMaximum": (lambda value, limit: value < limit, "below {:g}"),
}


@lru_cache
def _schema() -> dict[str, Any]:
    text = files("comparisons.data").joinpath("problem.schema.json").read_text(encoding="utf-8")
    schema: dict[str, Any] = json.loads(text)
    return schema


def kinds(section: str) -> dict[str, dict[str, Any]]:
    """Return the kinds of a section and the part of the schema for each.

    Examples
    --------
    >>> list(kinds("law"))
    ['lennard-jones-9-3', 'mie', 'table']
    """
    return {part["properties"]["kind"]["const"]: part for part in _schema()["properties"][section]["oneOf"]}


def unit_of(section: str, kind: str, key: str) -> str | None:
    """Return the unit in SI of a key, None for a plain number or a text.

    Examples
    --------
    >>> unit_of("solid", "coating", "thickness"), unit_of("solid", "coating", "nu")
    ('m', None)
    """
    rule = _rule(kinds(section)[kind]["properties"][key])
    unit: str | None = rule.get("unit")
    return unit


def limits_of(section: str, kind: str, key: str) -> tuple[float, float]:
    """Return the ends of the admissible values of a key, in SI.

    Examples
    --------
    >>> limits_of("solid", "coating", "nu_coating"), limits_of("punch", "sphere", "R")
    ((0.0, 0.5), (0.0, inf))
    """
    rule = _rule(kinds(section)[kind]["properties"][key])
    low = rule.get("minimum", rule.get("exclusiveMinimum", -math.inf))
    high = rule.get("maximum", rule.get("exclusiveMaximum", math.inf))
    return float(low), float(high)


def checked_section(
    document: Mapping[str, Any], section: str, source: Source
) -> tuple[dict[str, Any], dict[str, Uncertainty]]:
    """Return the values of a section in SI, its kind and names of files as they are; and what is uncertain of them.

    Raises
    ------
    ValueError
        One sentence with file, line, value and remedy.
    """
    table = document[section]
    if not isinstance(table, Mapping):
        if isinstance(table, list) and all(isinstance(each, Mapping) for each in table):
            raise source.refusal(
                section, None, f"is a list of sections; write one section, [{section}] in single brackets"
            )
        raise source.refusal(
            section, None, f"is {shown(table)} and no table; write a section [{section}] with its keys"
        )
    known = kinds(section)
    if "kind" not in table:
        raise source.refusal(section, None, f"has no kind; write one of {', '.join(known)}")
    kind = table["kind"]
    if not isinstance(kind, str) or kind not in known:
        raise source.refusal(section, "kind", f"kind = {shown(kind)} is unknown; {_near(str(kind), known)}")
    form = known[kind]
    keys = form["properties"]
    for key in table:
        if key not in keys:
            raise source.refusal(section, key, f"unknown key {shown(key)} of the kind {kind}; {_near(key, keys)}")
    for key in form["required"]:
        if key not in table:
            raise source.refusal(section, None, f"{key} is missing; the kind {kind} needs {_listed(form['required'])}")
    choices = [choice["required"] for choice in form.get("oneOf", ())]
    if choices and sum(any(key in table for key in choice) for choice in choices) != 1:
        raise source.refusal(
            section, None, f"the kind {kind} needs {' or else '.join(map(_listed, choices))}; give one of these"
        )
    for choice in choices:
        for key in choice:
            if key not in table and any(other in table for other in choice):
                raise source.refusal(section, None, f"{key} is missing; {_listed(choice)} stand together")
    values: dict[str, Any] = {"kind": kind}
    uncertain: dict[str, Uncertainty] = {}
    for key in keys:
        if key in table and key != "kind":
            values[key], uncertainty = _checked_value(section, key, table[key], _rule(keys[key]), values, source)
            if uncertainty:
                uncertain[key] = uncertainty
    return values, uncertain


def _rule(part: Mapping[str, Any]) -> Mapping[str, Any]:
    rule: Mapping[str, Any] = _schema()["$defs"][part["$ref"].rpartition("/")[2]]
    return rule


def _checked_value(
    section: str, key: str, value: Any, rule: Mapping[str, Any], before: Mapping[str, Any], source: Source
) -> tuple[Any, Uncertainty | None]:
    written = f"{key} = {shown(value)}"
    if rule["type"] == "string":
        if not isinstance(value, str) or not value:
            raise source.refusal(section, key, f"{written} must be {rule['description']}")
        return value, None
    unit, remedy, power = rule.get("unit"), "", 1.0
    if unit == "m^(n-1)":
        # The shape index stands before Q in the schema and so has been checked.
        unit, power = "m", before["n"] - 1.0
    if unit and power == 1.0:
        remedy = f', as "{rule["example"]}" or a plain number in {unit}'
    elif unit:
        remedy = f', as "{rule["example"]}^({power:g})" or a plain number in {unit}^({power:g})'
    uncertainty = None
    try:
        if is_uncertain(value) and rule.get("uncertain", True):
            number, uncertainty = uncertain_in_si(value, unit or "", power)
        elif unit is None and isinstance(value, str):
            raise NotAValue("is a text")
        else:
            number = in_si(value, unit or "", power)
    except NotAValue as error:
        raise source.refusal(section, key, f"{written} {error}; it is {rule['description']}{remedy}") from None
    for end in uncertainty.limits(number) if uncertainty and uncertainty.is_interval else (number,):
        for keyword, (holds, words) in _LIMITS.items():
            if keyword in rule and not holds(end, rule[keyword]):
                limit = words.format(rule[keyword])
                raise source.refusal(section, key, f"{written} must be {limit}; it is {rule['description']}{remedy}")
    if uncertainty and "exclusiveMinimum" in rule and not uncertainty.size < number - rule["exclusiveMinimum"]:
        raise source.refusal(
            section, key, f"{written} has a standard deviation that reaches the end of its range; write a smaller one"
        )
    return number, uncertainty


def _near(name: str, known: Mapping[str, Any]) -> str:
    near = get_close_matches(name, known, n=1)
    return f"did you mean {near[0]}?" if near else f"known are {', '.join(known)}"


def _listed(names: list[str]) -> str:
    return ", ".join(names[:-1]) + f" and {names[-1]}" if len(names) > 1 else names[0]
