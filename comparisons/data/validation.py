"""Check of the tables of a TOML file by a JSON Schema, with one sentence for an error.

A schema here states for each key what is admissible in its `description`, as the end of a sentence that begins with
"must be", and for each table what it is in its `title` ("a gate").  Numbers may be infinite, as in TOML, but not NaN.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator, Mapping
from datetime import date, time
from difflib import get_close_matches
from functools import lru_cache
from importlib.resources import files
from itertools import islice
from typing import TYPE_CHECKING, Any

from comparisons.console.printable import is_line
from comparisons.data.toml_text import is_real

if TYPE_CHECKING:
    from jsonschema.exceptions import ValidationError
    from jsonschema.protocols import Validator

#: What is refused first in one table: a misspelt key is also a missing one.
_ORDER = ("additionalProperties", "required")

_NAME = re.compile(r"[A-Za-z0-9]+([-._][A-Za-z0-9.]+)*")

#: Longest value that a sentence shows in full.
_LONGEST = 80

#: So many errors are collected, of which the first one in the file is named: each has a copy of the value and takes a
#: tenth of a millisecond, and a list of the wrong kind has one for each entry.
_MOST_ERRORS = 100

#: Longest name whose nearest known name is searched: a megabyte would take minutes.
_LONGEST_NAME = 100


def validated(document: Mapping[str, Any], schema: str, source: str) -> None:
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
    validator = shipped_validator(schema)
    try:
        errors = sorted(islice(validator.iter_errors(document), _MOST_ERRORS), key=_position)
    except RecursionError:
        raise ValueError(f"{source}: its tables are nested too deeply") from None
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
    return f"{kind} {id}" if isinstance(id, str) and _NAME.fullmatch(id) else f"{kind} {number} (id = {shown(id)})"


def known_name(noun: str, name: str, known_names: Iterable[str], where: str) -> None:
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
    names = list(known_names)
    if name not in names:
        raise ValueError(f"{where}: unknown {noun} {shown(name)}{_nearest(name, names)}")


@lru_cache
def shipped_validator(schema: str) -> Validator:
    """Return the validator of ``<schema>.schema.json`` in this folder, for which a number may be infinite."""
    # It takes a fifth of the start of the process of an external model, which validates nothing.
    from jsonschema import FormatChecker
    from jsonschema.validators import Draft202012Validator, extend

    content = json.loads(files("comparisons.data").joinpath(f"{schema}.schema.json").read_text("utf-8"))
    Draft202012Validator.check_schema(content)
    types = Draft202012Validator.TYPE_CHECKER.redefine_many(
        {
            "number": lambda _, value: is_real(value) and value == value,
            "integer": lambda _, value: isinstance(value, int) and is_real(value),
        }
    )
    formats = FormatChecker(formats=())
    formats.checks("line")(lambda value: not isinstance(value, str) or is_line(value))
    formats.checks("day")(lambda value: not isinstance(value, str) or _is_day(value))
    return extend(Draft202012Validator, {"pattern": _pattern}, type_checker=types)(content, format_checker=formats)


def _pattern(validator: Validator, pattern: str, instance: object, schema: object) -> Iterator[ValidationError]:
    """Yield an error where a text has not the form of a pattern, whose ``$`` is the end of the text.

    In JSON Schema it is; in Python's regular expressions a line feed may follow.
    """
    from jsonschema.exceptions import ValidationError

    if isinstance(instance, str) and not re.search(re.sub(r"\$$", r"\\Z", pattern), instance):
        yield ValidationError(f"{shown(instance)} does not match {pattern!r}")


def _is_day(text: str) -> bool:
    try:
        return date.fromisoformat(text).isoformat() == text
    except ValueError:
        return False


def _position(error: ValidationError) -> tuple[list[tuple[int, str]], int]:
    """Position in the file, tables before what is in them."""
    path = [(step, "") if isinstance(step, int) else (-1, step) for step in error.absolute_path]
    order = _ORDER.index(error.validator) if error.validator in _ORDER else len(_ORDER)
    return (path if order == len(_ORDER) else path[:2]), order


def _sentence(error: ValidationError, document: Mapping[str, Any], schema: Mapping[str, Any]) -> str:
    path = list(error.absolute_path)
    where = ""
    if len(path) > 1 and isinstance(path[1], int) and isinstance(document[path[0]][path[1]], Mapping):
        where = label(str(path[0]), document[path[0]][path[1]], path[1] + 1) + ": "
    inner = path[2:] if where else path
    table = f"{'.'.join(map(str, inner))}: " if inner else ""
    if error.validator == "additionalProperties":
        wrong = next(key for key in error.instance if key not in error.schema["properties"])
        return f"{where}{table}unknown key {shown(wrong)}{_nearest(wrong, error.schema['properties'])}"
    if error.validator == "required":
        missing = [key for key in error.validator_value if key not in error.instance]
        has = f"{error.schema.get('title', 'it')} has {', '.join(error.validator_value)}"
        return f"{where}{table}{', '.join(missing)} missing; {has}"
    depth, description = _described(schema, path)
    if error.validator == "oneOf" or (depth < len(path) and "description" in error.schema):
        depth, description = len(path), error.schema["description"]
    depth = len(path) if error.validator == "enum" else depth
    value: Any = document
    for step in path[:depth]:
        value = value[step]
    key = ".".join(str(step) for step in path[2 if where else 0 : depth])
    if error.validator == "enum":
        names = error.validator_value
        near = nearest_name(str(value), names)
        description = f"one of {', '.join(names)}" + (f": did you mean {near}?" if near else "")
    where = where if depth > 1 else ""
    if error.validator == "oneOf":
        return f"{where}{key} must be {description}"
    if isinstance(value, list) and len(path) > depth > 1:
        return f"{where}{key} must be {description}; it holds {shown(error.instance)}"
    return f"{where}{key} = {shown(value)} must be {description}"


def _described(schema: Mapping[str, Any], path: Iterable[str | int]) -> tuple[int, str]:
    """Return the length of the longest part of a path whose schema has a description, and this description."""
    deepest, form = (0, "otherwise"), schema
    for depth, step in enumerate(path, start=1):
        inner = form["items"] if isinstance(step, int) else form.get("properties", {}).get(step)
        form = form.get("additionalProperties", {}) if inner is None else inner
        if "$ref" in form:
            form = schema["$defs"][form["$ref"].rpartition("/")[2]] | {**form}
        if "description" in form:
            deepest = depth, form["description"]
    return deepest


def _nearest(name: str, names: Iterable[str]) -> str:
    near = nearest_name(name, names)
    return f": did you mean {near}?" if near else f"; known are {', '.join(names)}"


def nearest_name(name: str, names: Iterable[str]) -> str:
    """Return the known name that is most like another; nothing if none is near.

    Examples
    --------
    >>> nearest_name("jrk", ["jkr", "dmt"]), nearest_name("weight", ["jkr", "dmt"])
    ('jkr', '')
    """
    near = get_close_matches(name, names, n=1) if len(name) <= _LONGEST_NAME else []
    return near[0] if near else ""


def shown(value: object) -> str:
    """Return a value as a sentence shows it: characters that cannot be printed escaped, and not too long.

    Examples
    --------
    >>> shown(True), shown("2 GPa")
    ('true', "'2 GPa'")
    """
    text = value.isoformat() if isinstance(value, date | time) else ascii(value)
    text = text.lower() if isinstance(value, bool) else text
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."
