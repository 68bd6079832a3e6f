"""``run.json``, the record of where the numbers of a run come from, and its schema.

Written and read through the same JSON Schema (``run.schema.json``), so that what is missing is found when the
record is written and not years later.
"""

from __future__ import annotations

import json
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator
from jsonschema.exceptions import best_match

from comparisons.store import write_json

__all__ = ["read_record", "write_record"]


@lru_cache(maxsize=1)
def _validator() -> Draft202012Validator:
    schema = json.loads(files("comparisons").joinpath("run.schema.json").read_text(encoding="utf-8"))
    Draft202012Validator.check_schema(schema)
    return Draft202012Validator(schema)


def _problem(content: object) -> str | None:
    error = best_match(_validator().iter_errors(content))
    return None if error is None else f"{error.json_path}: {error.message}"


def write_record(content: dict[str, Any], path: Path) -> None:
    """Write a record, atomically.

    Raises
    ------
    RuntimeError
        If it is not of the form that the schema asks for: a defect of the code that made it.
    """
    if problem := _problem(content):
        raise RuntimeError(f"the record of this run does not fit its schema: {problem}")
    write_json(content, path)


def read_record(path: Path) -> dict[str, Any]:
    """Read a record.

    Raises
    ------
    ValueError
        If there is none, or it is not of the form that the schema asks for; one sentence says which.
    """
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise ValueError(
            f"{path} cannot be read ({error.strerror}): {path.parent} is not the folder of a finished run"
        ) from None
    except ValueError:
        raise ValueError(f"{path} is not JSON text") from None
    except RecursionError:
        raise ValueError(f"{path} is not the record of a run: its brackets are nested too deeply") from None
    if problem := _problem(content):
        raise ValueError(f"{path} is not the record of a run: {problem}")
    return dict(content)
