"""The JSON schema of a problem file, from the table of kinds; `python -m comparisons.problem.schema` prints it."""

from __future__ import annotations

import json
from typing import Any

from comparisons.problem.kinds import KINDS, SECTIONS, Kind

__all__ = ["schema"]


def schema() -> dict[str, Any]:
    """Return the schema.

    Examples
    --------
    >>> list(schema()["properties"])
    ['solid', 'punch', 'law']
    """
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "a problem file",
        "type": "object",
        "required": list(SECTIONS),
        "additionalProperties": False,
        "properties": {section: _section(section, kinds) for section, kinds in KINDS.items()},
    }


def _section(section: str, kinds: dict[str, Kind]) -> dict[str, Any]:
    return {
        "type": "object",
        "title": f"{SECTIONS[section]}, of one of the kinds {', '.join(kinds)},",
        "description": f"one section, [{section}] in single brackets, with a kind and its keys",
        "required": ["kind"],
        "properties": {"kind": {"enum": list(kinds)}},
        "allOf": [
            {"if": {"properties": {"kind": {"const": name}}, "required": ["kind"]}, "then": _kind(section, name, kind)}
            for name, kind in kinds.items()
        ],
    }


def _kind(section: str, name: str, kind: Kind) -> dict[str, Any]:
    form: dict[str, Any] = {
        "title": f"a {section} of the kind {name}",
        "properties": {"kind": True, **kind.keys},
        "required": ["kind", *kind.required],
        "additionalProperties": False,
    }
    if kind.choices:
        form["oneOf"] = [_alone(choice, kind.choices) for choice in kind.choices]
        form["description"] = f"a {name} with {' or else '.join(map(' and '.join, kind.choices))}"
    return form


def _alone(choice: tuple[str, ...], choices: tuple[tuple[str, ...], ...]) -> dict[str, Any]:
    """All keys of a choice, and none of another one."""
    excluded = {key: False for group in choices if group != choice for key in group}
    return {"required": list(choice), "properties": excluded}


if __name__ == "__main__":
    print(json.dumps(schema(), indent=2, ensure_ascii=False))
