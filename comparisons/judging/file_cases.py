"""Cases of problem files that a gate selects by keys of the file, as "solid.thickness"."""

from __future__ import annotations

import re
from collections.abc import Mapping
from difflib import get_close_matches
from typing import Any

from comparisons.problem import PARAMETERS
from comparisons.problem.kinds import SECTIONS, kinds
from comparisons.problem.source import shown
from comparisons.problem.units import NotAValue, in_si

__all__ = ["in_si_units", "matches"]


def in_si_units(cases: Mapping[str, Any], where: str) -> dict[str, Any]:
    """Return the cases of a gate with the values of keys of a problem file in SI.

    Raises
    ------
    ValueError
        One sentence, which begins with `where`, if a key is unknown or a value has another dimension.

    Examples
    --------
    >>> in_si_units({"solid.kind": "coating", "solid.thickness": ["10 nm", "50 nm"], "n": [2, 2]}, "gate A")
    {'solid.kind': 'coating', 'solid.thickness': [1e-08, 5e-08], 'n': [2, 2]}
    """
    plain = (*PARAMETERS, "tags")
    return {name: value if name in plain else _checked(name, value, where) for name, value in cases.items()}


def matches(wanted: Any, value: Any) -> bool:
    """Whether a value of a problem is a word, or inside a range; not if the problem has no such value.

    Examples
    --------
    >>> matches([0.0, 1.0], 0.4), matches("coating", "coating"), matches([0.0, 1.0], None)
    (True, True, False)
    """
    if isinstance(wanted, str):
        return bool(value == wanted)
    low, high = wanted
    return isinstance(value, float | int) and low <= value <= high


def _known() -> dict[str, str | None]:
    """Keys of the problem files, with their units."""
    found: dict[str, str | None] = {f"{section}.kind": None for section in SECTIONS}
    for section in SECTIONS:
        for kind in kinds(section).values():
            found |= {f"{section}.{key.name}": key.dimension.unit for key in kind.keys}
    return found


def _checked(name: str, value: Any, where: str) -> Any:
    known = _known()
    plain = re.sub(r"\.[1-9]\d{0,2}$", "", name)
    if plain not in known:
        near = get_close_matches(name, [*known, *PARAMETERS, "tags"], n=1)
        every = f"known are {', '.join((*PARAMETERS, 'tags'))}, and keys of a problem file as solid.kind"
        hint = f"did you mean {near[0]}?" if near else every
        raise ValueError(f"{where}: cases: unknown key {name!r}: {hint}")
    section, _, key = name.partition(".")
    if key == "kind":
        if not isinstance(value, str) or value not in kinds(section):
            raise ValueError(f"{where}: cases.{name} = {shown(value)} must be one of {', '.join(kinds(section))}")
        return value
    if isinstance(value, str):
        return value
    unit = known[plain] or ""
    try:
        low, high = (in_si(end, unit) for end in value)
    except NotAValue as error:
        raise ValueError(
            f"{where}: cases.{name} has a value that {error}; write [low, high], two values with a unit"
        ) from None
    if not low <= high:
        raise ValueError(f"{where}: cases.{name} = {shown(value)} must be [low, high], two values with low <= high")
    return [low, high]
