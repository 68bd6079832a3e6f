"""Form of a problem file: the check of its keys and values by the table of kinds."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from difflib import get_close_matches
from typing import Any

from comparisons.problem.kinds import SECTIONS, Dimension, Key, Kind, kind_of, kinds
from comparisons.problem.source import Source, shown
from comparisons.problem.uncertain import Uncertainty, is_uncertain, uncertain_in_si
from comparisons.problem.units import NotAValue, in_si

__all__ = ["SECTIONS", "checked_section", "kinds", "unit_of"]

#: Limits of a dimension: name, and the comparison that holds.
_LIMITS: dict[str, tuple[Callable[[float, float], bool], str]] = {
    "above": (lambda value, limit: value > limit, "above {:g}"),
    "at_least": (lambda value, limit: value >= limit, "at least {:g}"),
    "at_most": (lambda value, limit: value <= limit, "at most {:g}"),
    "below": (lambda value, limit: value < limit, "below {:g}"),
}


def unit_of(section: str, kind: str, key: str) -> str | None:
    """Return the unit in SI of a key, None for a plain number or a text.

    Examples
    --------
    >>> unit_of("solid", "coating", "thickness"), unit_of("solid", "coating", "nu")
    ('m', None)
    """
    return kind_of(section, kind).by_name[key].dimension.unit


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
    row = known[kind]
    keys = row.by_name
    for key in table:
        if key not in keys and key != "kind":
            near = _near(key, ["kind", *keys])
            raise source.refusal(section, key, f"unknown key {shown(key)} of the kind {kind}; {near}")
    for key in row.required:
        if key not in table:
            needed = _listed(["kind", *row.required])
            raise source.refusal(section, None, f"{key} is missing; the kind {kind} needs {needed}")
    if row.choices and sum(any(key in table for key in choice) for choice in row.choices) != 1:
        choices = " or else ".join(map(_listed, row.choices))
        raise source.refusal(section, None, f"the kind {kind} needs {choices}; give one of these")
    for choice in row.choices:
        for key in choice:
            if key not in table and any(other in table for other in choice):
                raise source.refusal(section, None, f"{key} is missing; {_listed(choice)} stand together")
    values: dict[str, Any] = {"kind": kind}
    uncertain: dict[str, Uncertainty] = {}
    for key in row.keys:
        if key.name not in table:
            continue
        if key.is_list:
            values[key.name] = _checked_list(section, key, table[key.name], source)
            continue
        value, uncertainty = _checked_value(section, key.name, table[key.name], key.dimension, values, source)
        values[key.name] = value
        if uncertainty:
            uncertain[key.name] = uncertainty
    if row.lengths is not None:
        _check_lengths(section, row, values, source)
    return values, uncertain


def _checked_list(section: str, key: Key, value: Any, source: Source) -> tuple[float, ...]:
    """A list of values in SI."""
    dimension = replace(key.dimension, may_be_uncertain=False)
    if not isinstance(value, list):
        raise source.refusal(
            section,
            key.name,
            f"{key.name} = {shown(value)} is no list; write one value for each layer, as [{_example(dimension)}], and "
            f"name one of them {key.name}.1 to vary it",
        )
    if not value:
        raise source.refusal(section, key.name, f"{key.name} is an empty list; write one value or more")
    return tuple(
        _checked_value(section, f"{key.name}.{i}", each, dimension, {}, source)[0]
        for i, each in enumerate(value, start=1)
    )


def _check_lengths(section: str, row: Kind, values: Mapping[str, Any], source: Source) -> None:
    """Refuse lists that do not fit: one is shorter by one than the others."""
    shorter = row.lengths or ""
    count = len(values[shorter])
    for key in row.keys:
        if key.is_list and key.name != shorter and len(values[key.name]) != count + 1:
            raise source.refusal(
                section,
                key.name,
                f"{key.name} has {len(values[key.name])} values and {shorter} has {count}; {key.name} needs one more "
                f"than {shorter}, the last for the substrate",
            )


def _example(dimension: Dimension) -> str:
    return f'"{dimension.example}"' if dimension.example else "0.3"


def _checked_value(
    section: str, key: str, value: Any, dimension: Dimension, before: Mapping[str, Any], source: Source
) -> tuple[Any, Uncertainty | None]:
    written, line = f"{key} = {shown(value)}", key.partition(".")[0]
    if dimension.is_text:
        if not isinstance(value, str) or not value:
            raise source.refusal(section, line, f"{written} must be {dimension.description}")
        return value, None
    unit, remedy, power = dimension.unit, "", 1.0
    if unit == "m^(n-1)":
        # The shape index stands before Q in the table and so has been checked.
        unit, power = "m", before["n"] - 1.0
    if unit and power == 1.0:
        remedy = f', as "{dimension.example}" or a plain number in {unit}'
    elif unit:
        remedy = f', as "{dimension.example}^({power:g})" or a plain number in {unit}^({power:g})'
    uncertainty = None
    try:
        if is_uncertain(value) and dimension.may_be_uncertain:
            number, uncertainty = uncertain_in_si(value, unit or "", power)
        elif is_uncertain(value):
            raise NotAValue("has an uncertainty, which is not admissible here")
        elif unit is None and isinstance(value, str):
            raise NotAValue("is a text")
        else:
            number = in_si(value, unit or "", power)
    except NotAValue as error:
        raise source.refusal(section, line, f"{written} {error}; it is {dimension.description}{remedy}") from None
    for end in uncertainty.limits(number) if uncertainty and uncertainty.is_interval else (number,):
        for name, (holds, words) in _LIMITS.items():
            limit = getattr(dimension, name)
            if limit is not None and not holds(end, limit):
                raise source.refusal(
                    section,
                    line,
                    f"{written} must be {words.format(limit)}; it is {dimension.description}{remedy}",
                )
    if uncertainty and dimension.above is not None and not uncertainty.size < number - dimension.above:
        raise source.refusal(
            section, line, f"{written} has a standard deviation that reaches the end of its range; write a smaller one"
        )
    return number, uncertainty


def _near(name: str, known: Iterable[str]) -> str:
    known = list(known)
    near = get_close_matches(name, known, n=1)
    return f"did you mean {near[0]}?" if near else f"known are {', '.join(known)}"


def _listed(names: Sequence[str]) -> str:
    return ", ".join(names[:-1]) + f" and {names[-1]}" if len(names) > 1 else names[0]
