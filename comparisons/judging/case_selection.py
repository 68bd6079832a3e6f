"""Parameters of problems by which a gate selects its cases: numbers in a range, and words."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from comparisons.data.validation import known_name
from comparisons.problem import PARAMETERS, Problem
from comparisons.problem.kinds import SECTIONS, kinds
from comparisons.problem.units import NotAValue, in_si

__all__ = ["has_parameters", "in_si_units"]

_FORM = "[low, high], two values with low <= high, with their unit if they have one"


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
    units = _units()
    for name in cases:
        # "solid.thickness.2" is the second entry of a list.
        known_name("key of cases", re.sub(r"\.[1-9]\d{0,2}$", "", name), units, where)
    return {
        name: value if name == "tags" else _in_si(name, value, units[re.sub(r"\.\d+$", "", name)], where)
        for name, value in cases.items()
    }


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


def _units() -> dict[str, str | list[str]]:
    """Unit of each parameter; of a kind its words."""
    units: dict[str, str | list[str]] = dict.fromkeys((*PARAMETERS, "tags"), "")
    for section in SECTIONS:
        units[f"{section}.kind"] = list(kinds(section))
        for kind in kinds(section).values():
            units |= {f"{section}.{key.name}": key.dimension.unit or "" for key in kind.keys}
    return units


def _in_si(name: str, value: Any, unit: str | list[str], where: str) -> Any:
    if not isinstance(unit, str):
        known_name(f"cases.{name}", str(value), unit, where)
        return value
    if isinstance(value, str):
        return value
    try:
        low, high = value if name in PARAMETERS else [in_si(end, unit) for end in value]
    except NotAValue as error:
        raise ValueError(f"{where}: cases.{name} has a value that {error}; it must be {_FORM}") from None
    if not low <= high:
        raise ValueError(f"{where}: cases.{name} = [{low:g}, {high:g}] must be {_FORM}")
    return [low, high]
