"""Check of the tables of a TOML file by a JSON Schema, with one sentence for an error.

A schema here states for each key what is admissible in its `description`, as the end of a sentence that begins with
"must be", and for each table what it is in its `title` ("a gate").  Numbers may be infinite, as in TOML, but not NaN.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping
from difflib import get_close_matches
from functools import lru_cache
from importlib.resources import files
from typing import Any

from jsonschema import Draft202012Validator
from jsonschema.exceptions import ValidationError
from jsonschema.protocols import Validator
from jsonschema.validators import extend

from comparisons.data.toml_text import is_real

__all__ = ["known_name", "label", "validated"]

#: What is refused first in one table: a misspelt key is also a missing one.
_ORDER = ("additionalProperties", "required")

_NAME = re.compile(r"[A-Za-z0-9]+([-._][A-Za-z0-9.]+)*")

#: Longest value that a sentence shows in full.
_LONGEST = 80


def validated(document: dict[str, Any], schema: str, source: str) -> None:
    """Refuse tables that do not fit a schema.

    Parameters
    ----------
    document : dict
        As `comparisons.data.toml_text.parse` returns it.
    schema : str
        Name of ``<schema>.schema.json`` in this folder.
    source : str
        What was read, for the sentence.

    Raises
    ------
    ValueError
        One sentence: source, table, key, value and what is admissible.

    Examples
    --------
    >>> validated({"grid": [{"id": "mine", "titel": "A sphere"}]}, "cases", "mine.toml")
    Traceback (most recent call last):
    ValueError: mine.toml: grid mine: unknown key 'titel': did you mean title?
    """
    validator = _validator(schema)
    errors = sorted(validator.iter_errors(document), key=_place)
    if errors:
        raise ValueError(f"{source}: {_sentence(errors[0], document, validator.schema)}")


def label(kind: str, table: object, number: int) -> str:
    """Return the name of one of several tables: its id where that is a plain name, otherwise its place in the file.

    Examples
    --------
    >>> label("gate", {"id": "JKR-LIMIT"}, 3), label("gate", {"id": "a gate"}, 3), label("grid", {}, 3)
    ('gate JKR-LIMIT', "gate 3 (id = 'a gate')", 'grid 3')
    """
    if not isinstance(table, Mapping) or "id" not in table:
        return f"{kind} {number}"
    id = table["id"]
    return f"{kind} {id}" if isinstance(id, str) and _NAME.fullmatch(id) else f"{kind} {number} (id = {_shown(id)})"


def known_name(what: str, name: str, known: Iterable[str], where: str) -> None:
    """Refuse a name that is not known.

    Raises
    ------
    ValueError
        One sentence with the nearest known name, or all of them if none is near.

    Examples
    --------
    >>> known_name("model", "jrk", ["jkr", "dmt"], "grid a")
    Traceback (most recent call last):
    ValueError: grid a: unknown model 'jrk': did you mean jkr?
    """
    known = list(known)
    if name not in known:
        raise ValueError(f"{where}: unknown {what} {_shown(name)}{_nearest(name, known)}")


@lru_cache
def _validator(schema: str) -> Validator:
    content = json.loads(files("comparisons.data").joinpath(f"{schema}.schema.json").read_text(encoding="utf-8"))
    Draft202012Validator.check_schema(content)
    types = Draft202012Validator.TYPE_CHECKER.redefine_many(
        {
            "number": lambda _, value: is_real(value) and value == value,
            "integer": lambda _, value: isinstance(value, int) and is_real(value),
        }
    )
    return extend(Draft202012Validator, type_checker=types)(content)


def _place(error: ValidationError) -> tuple[list[tuple[int, str]], int]:
    """Position in the file, tables before what is in them."""
    path = [(part, "") if isinstance(part, int) else (-1, part) for part in error.absolute_path]
    order = _ORDER.index(error.validator) if error.validator in _ORDER else len(_ORDER)
    return (path if order == len(_ORDER) else path[:2]), order


def _sentence(error: ValidationError, document: dict[str, Any], schema: Mapping[str, Any]) -> str:
    path = list(error.absolute_path)
    where = ""
    if len(path) > 1 and isinstance(path[1], int) and isinstance(document[path[0]][path[1]], Mapping):
        where = label(str(path[0]), document[path[0]][path[1]], path[1] + 1) + ": "
    inner = path[2:] if where else path
    table = f"{'.'.join(map(str, inner))}: " if inner else ""
    if error.validator == "additionalProperties":
        known = error.schema["properties"]
        wrong = next(key for key in error.instance if key not in known)
        return f"{where}{table}unknown key {_shown(wrong)}{_nearest(wrong, known)}"
    if error.validator == "required":
        missing = [key for key in error.validator_value if key not in error.instance]
        optional = [key for key in error.schema["properties"] if key not in error.validator_value]
        return (
            f"{where}{table}{', '.join(missing)} missing; {error.schema.get('title', 'it')} has "
            f"{', '.join(error.validator_value)}" + (f" and may have {', '.join(optional)}" if optional else "")
        )
    depth, description = _described(schema, path)
    value: Any = document
    for part in path[:depth]:
        value = value[part]
    key = ".".join(str(part) for part in path[2 if where else 0 : depth])
    if error.validator == "enum":
        near = get_close_matches(str(value), error.validator_value, n=1)
        description = f"one of {', '.join(error.validator_value)}" + (f": did you mean {near[0]}?" if near else "")
    where = where if depth > 1 else ""
    if isinstance(value, list) and len(path) > depth > 1:
        return f"{where}{key} must be {description}; it holds {_shown(error.instance)}"
    return f"{where}{key} = {_shown(value)} must be {description}"


def _described(schema: Mapping[str, Any], path: Iterable[str | int]) -> tuple[int, str]:
    """Return the length of the longest part of a path whose schema has a description, and this description."""
    found, part_of = (0, "otherwise"), schema
    for depth, part in enumerate(path, start=1):
        inner = part_of["items"] if isinstance(part, int) else part_of.get("properties", {}).get(part)
        part_of = part_of["additionalProperties"] if inner is None else inner
        if "$ref" in part_of:
            part_of = schema["$defs"][part_of["$ref"].rpartition("/")[2]] | {**part_of}
        if "description" in part_of:
            found = depth, part_of["description"]
    return found


def _nearest(name: str, known: Iterable[str]) -> str:
    known = list(known)
    near = get_close_matches(name, known, n=1)
    return f": did you mean {near[0]}?" if near else f"; known are {', '.join(known)}"


def _shown(value: object) -> str:
    """Return a value as a sentence shows it: characters that cannot be printed escaped, and not too long."""
    text = ascii(value).lower() if isinstance(value, bool) else ascii(value)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."
