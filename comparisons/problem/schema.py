"""The form of a problem file as a JSON schema, from the table of kinds.

`python -m comparisons.problem.schema` writes `comparisons/data/problem.schema.json`.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from comparisons.problem.kinds import KINDS, SECTIONS, Dimension, Key, Kind

__all__ = ["FILE", "schema", "schema_text"]

#: The file that is written.
FILE = Path(__file__).resolve().parent.parent / "data" / "problem.schema.json"

_NUMBER = r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?"
#: A plain number with an uncertainty.
_UNCERTAIN = rf"^\s*({_NUMBER}\s*(\+-|\+/-|±)\s*{_NUMBER}\s*%?|\[\s*{_NUMBER}\s*,\s*{_NUMBER}\s*\])\s*$"

_LIMITS = {"minimum": "at_least", "exclusiveMinimum": "above", "maximum": "at_most", "exclusiveMaximum": "below"}


def schema() -> dict[str, Any]:
    """Return the schema.

    Examples
    --------
    >>> schema()["$defs"]["ratio"]["maximum"]
    0.5
    """
    rows = [kind for section in KINDS.values() for kind in section.values()]
    dimensions = {key.dimension.name: _dimension(key.dimension) for kind in rows for key in kind.keys}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "A problem file",
        "type": "object",
        "required": list(SECTIONS),
        "additionalProperties": False,
        "properties": {
            section: {"description": text, "oneOf": [_kind(section, kind) for kind in KINDS[section].values()]}
            for section, text in SECTIONS.items()
        },
        "$defs": dimensions,
    }


def _kind(section: str, kind: Kind) -> dict[str, Any]:
    form: dict[str, Any] = {
        "title": f"{section} {kind.name}",
        "type": "object",
        "properties": {"kind": {"const": kind.name}, **{key.name: _key(key) for key in kind.keys}},
        "required": ["kind", *kind.required],
        "additionalProperties": False,
    }
    if kind.choices:
        form["oneOf"] = [{"required": list(choice)} for choice in kind.choices]
    return form


def _key(key: Key) -> dict[str, Any]:
    value = {"$ref": f"#/$defs/{key.dimension.name}"}
    return {"type": "array", "minItems": 1, "items": value} if key.is_list else value


def _dimension(dimension: Dimension) -> dict[str, Any]:
    form: dict[str, Any] = {"description": dimension.description}
    if dimension.is_text:
        return {**form, "type": "string", "minLength": 1}
    form["type"] = ["number", "string"]
    if dimension.unit:
        form |= {"unit": dimension.unit, "example": dimension.example}
    else:
        form["pattern"] = _UNCERTAIN
    if not dimension.may_be_uncertain:
        form["uncertain"] = False
    limits = {keyword: getattr(dimension, name) for keyword, name in _LIMITS.items()}
    return form | {keyword: limit for keyword, limit in limits.items() if limit is not None}


def schema_text() -> str:
    """Return the content of the file."""
    return json.dumps(schema(), indent=2, ensure_ascii=False) + "\n"


if __name__ == "__main__":
    FILE.write_text(schema_text(), encoding="utf-8")
