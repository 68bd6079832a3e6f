"""Record of a run (``run.json``): the origin of its numbers, and the checksums of its files.

Written and read through the same JSON Schema (``run.schema.json``), so that a missing entry is found when the
record is written and not years later.  The record has a checksum of its own.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Collection, Mapping, Sequence
from datetime import UTC, datetime
from hashlib import sha256
from pathlib import Path
from shlex import quote
from typing import Any

from jsonschema.exceptions import best_match

from comparisons.console.progress import log
from comparisons.data.contained_paths import path_inside
from comparisons.data.file_names import INPUTS, RECORD, RUN_FILES, VERDICTS, is_of_verdicts
from comparisons.data.input_files import LARGEST_ROWS, LARGEST_TABLE, read_bytes
from comparisons.data.validation import shipped_validator
from comparisons.runs.atomic_files import write_json
from comparisons.runs.environment import differences, environment, fingerprint

#: Version of the schema.
FORMAT = 6


def _problem(content: object) -> str | None:
    error = best_match(shipped_validator("run").iter_errors(content))
    return None if error is None else f"{error.json_path}: {error.message}"


def now() -> str:
    """Return the time as a record has it."""
    return datetime.now(UTC).isoformat(timespec="seconds")


def record_content(
    command_name: str,
    arguments: Mapping[str, Any],
    *,
    started: str,
    parts: Sequence[Mapping[str, Any]],
    seconds: Mapping[str, float],
    **entries: Any,
) -> dict[str, Any]:
    """Return the record of a run, of a sweep or of the paper, without checksums.

    Parameters
    ----------
    command_name : str
        "run", "sweep" or "paper".
    arguments : mapping
        The arguments of the command, by name.
    started : str
        When this command began; a resumed one began with the first of its parts.
    parts : sequence of mapping
        The commands that computed the rows (`comparisons.runs.store.Store.parts`).
    seconds : mapping of str to float
        Computing time by model.
    **entries
        Others of the schema, as rows; those that are None are left out.
    """
    return {
        "format": FORMAT,
        "command_name": command_name,
        "arguments": dict(arguments),
        "command": [Path(sys.argv[0]).name, *sys.argv[1:]],
        "started": parts[0]["started"] if parts else started,
        "finished": now(),
        "seconds": {"run": sum(part["seconds"] for part in parts), "by_model": dict(seconds)},
        "parts": list(parts),
        "verdicts": {},
        **environment(),
        **{name: value for name, value in entries.items() if value is not None},
    }


def write_record(content: dict[str, Any], path: Path, files: Collection[str] | None = None) -> None:
    """Write a record with the checksums of the files beside it.

    Parameters
    ----------
    content : dict
        All but the checksums.
    path : Path
    files : collection of str, optional
        Names of the files that get a checksum; by default those of a run, as far as they exist.

    Raises
    ------
    RuntimeError
        If it does not fit the schema: a defect of the code that made it.
    """
    folder = path.parent
    if files is None:
        paths = [*folder.glob(f"{VERDICTS}.*"), *(folder / INPUTS).rglob("*")]
        files = [*RUN_FILES, *(path.relative_to(folder).as_posix() for path in sorted(paths))]
    sums = {name: _sum_of(folder / name) for name in files if (folder / name).is_file()}
    content = content | {"files": sums}
    content["sha256"] = _own_sum(content)
    if problem := _problem(content):
        raise RuntimeError(f"the record of this run does not fit its schema: {problem}")
    write_json(content, path)


def read_record(path: Path) -> dict[str, Any]:
    """Read a record.

    Raises
    ------
    ValueError
        If there is none, it does not fit the schema, or its own checksum is not that of its
        content; one sentence says which.
    """
    folder = path.parent
    try:
        content = json.loads(read_bytes(path, LARGEST_TABLE).decode())
    except OSError as error:
        raise ValueError(
            f"{path} cannot be read ({error.strerror}): {folder} is not the folder of a finished run"
        ) from None
    except (UnicodeDecodeError, json.JSONDecodeError, RecursionError) as error:
        raise ValueError(f"{path} is not the record of a run: it is not JSON text ({error})") from None
    if problem := _problem(content):
        raise ValueError(f"{path} is not the record of a run: {problem}")
    stated = content.pop("sha256")
    if stated != _own_sum(content):
        raise ValueError(_changed(path, f"run again with --out {quote(str(folder))}"))
    try:  # It may come from elsewhere, and name files outside of its folder.
        for name in content["files"]:
            path_inside(folder, name)
    except ValueError as error:
        raise ValueError(f"{path} is not the record of a run: {error}") from None
    return dict(content)


def check_files(record: dict[str, Any], folder: Path, written_again: bool = False) -> None:
    """Check the files of a run against the checksums in its record; a file that is missing is left to its reader.

    Parameters
    ----------
    record : dict
        As `read_record` returns it.
    folder : Path
        Of the run.
    written_again : bool
        Whether the caller writes the files of verdicts again, without reading them.

    Raises
    ------
    ValueError
        If a file is not the one that was written; the sentence gives its name and the remedy.
    """
    for name, stated in record["files"].items():
        path = path_inside(folder, name)
        remedy = f"write it again by fscm-bench {record['command_name']} with --out {quote(str(folder))}"
        if (written_again and is_of_verdicts(name)) or not path.exists():
            continue
        if not path.is_file():
            raise ValueError(f"{path} is not a regular file, as the run has written it: {remedy}")
        if _sum_of(path) != stated:
            raise ValueError(_changed(path, remedy))


def warn_of_other_code(record: dict[str, Any], folder: Path) -> bool:
    """Write in one sentence if the results of a folder were computed by other code; return whether they were."""
    changed = differences(record["package"]["fingerprint"], fingerprint())
    if changed:
        log(f"the results in {folder} were computed by another version of the code, of NumPy or of SciPy ({changed})")
    return bool(changed)


def _changed(path: Path, remedy: str) -> str:
    return f"{path} was changed after it was written (its SHA-256 is not the one in {RECORD}): {remedy}"


def _sum_of(path: Path) -> str:
    return sha256(read_bytes(path, LARGEST_ROWS)).hexdigest()


def _own_sum(content: dict[str, Any]) -> str:
    return sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
