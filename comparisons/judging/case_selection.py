"""Parameters of problems by which a gate selects its cases: numbers in a range, and words."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from comparisons.data.validation import known_name
from comparisons.problem import PARAMETERS, Problem
from comparisons.problem.kinds import KINDS
from comparisons.problem.units import NotAValue, in_si

#: The number of an entry of a list: "solid.thickness.2" is the second thickness.
_ENTRY = re.compile(r"\.[1-9]\d{0,2}$")


def in_si_units(cases: Mapping[str, Any], where: str) -> dict[str, Any]:
    """Return the cases of a gate with their values in SI.

    Raises
    ------
    ValueError
        One sentence, which begins with `where`, if a parameter is unknown or a value has another dimension.

    Examples
    --------
    >>> in_si_units({"solid.kind": "coating", "solid.thickness": ["10 nm", "50 nm"], "n": [2, 2]}, "gate A")
    {'solid.kind': 'coating', 'solid.thickness': [1e-08, 5e-08], 'n': [2, 2]}
    """
    words = {f"{section}.kind": list(kinds) for section, kinds in KINDS.items()}
    of_kinds = ((section, kind.keys) for section, kinds in KINDS.items() for kind in kinds.values())
    forms = {f"{section}.{key}": form for section, keys in of_kinds for key, form in keys.items()}
    units = {name: form.unit for name, form in forms.items()}
    values: dict[str, Any] = {}
    for name, value in cases.items():
        key = _ENTRY.sub("", name)
        known_name("key of cases", key, [*PARAMETERS, "tags", *words, *units], where)
        if key in words:
            known_name(f"cases.{name}", str(value), words[key], where)
        is_range = name != "tags" and not isinstance(value, str)
        values[name] = _range_in_si(name, value, units.get(key), where) if is_range else value
    return values


def has_parameters(problem: Problem, cases: Mapping[str, Any]) -> bool:
    """Whether a problem has the words, and values inside the ranges, that a gate selects; not if it has no value.

    Examples
    --------
    >>> has_parameters(Problem.dimensionless(2, 0.4, 1), {"k": [0.0, 1.0]})
    True
    """
    return all(_matches(wanted, problem[name]) for name, wanted in cases.items() if name != "tags")


def _matches(wanted: Any, value: Any) -> bool:
    if isinstance(wanted, str) or not isinstance(value, float | int):
        return bool(value == wanted)
    low, high = wanted
    return bool(low <= value <= high)


def _range_in_si(name: str, ends: Any, unit: str | None, where: str) -> list[float]:
    form = "[low, high], two values with low <= high, with their unit if they have one"
    try:
        low, high = ends if unit is None else [in_si(end, unit) for end in ends]
    except NotAValue as error:
        raise ValueError(f"{where}: cases.{name} has a value that {error}; it must be {form}") from None
    if not low <= high:
        raise ValueError(f"{where}: cases.{name} = [{low:g}, {high:g}] must be {form}")
    return [low, high]
