"""Merging of the shards of a sweep into one folder."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from shlex import quote
from typing import Any

from comparisons.data.input_files import read_text
from comparisons.domain import Domain
from comparisons.model import ComputationFailed
from comparisons.pipeline.finished_run import FinishedRun, write_run
from comparisons.pipeline.inputs import RunInputs, stored_cases
from comparisons.pipeline.shard_folders import checked_records, take_rows
from comparisons.registry import ExternalIdentity
from comparisons.runs.atomic_files import atomic, prepare_folder
from comparisons.runs.computation import Completed
from comparisons.runs.folder import RunFolder
from comparisons.runs.record import now
from comparisons.runs.rows import Row
from comparisons.runs.store import rows_in
from comparisons.runs.tasks import Task

__all__ = ["merge"]


def merge(folders: Sequence[Path], out: Path) -> FinishedRun:
    """Put the rows of finished shards of one sweep into one folder, and write its tables and record.

    The folder is that of the whole sweep.  What it has already is kept.

    Parameters
    ----------
    folders : sequence of Path
        Of the shards, in any order.
    out : Path
        For the results; none of `folders`.

    Returns
    -------
    FinishedRun

    Raises
    ------
    ValueError
        If a folder is not that of a finished sweep, two are not of the same sweep, or two have different results of one
        task.
    comparisons.model.ComputationFailed
        If tasks of the sweep are in none of the folders; the others are then merged.
    """
    started = now()
    records = checked_records(folders, out, _common)
    first = next(iter(records))
    inputs = _inputs(first, records[first])
    wanted = {task.key: task for task in inputs.plan()}
    target = RunFolder(prepare_folder(out))
    if target.grid_text.exists() and read_text(target.grid_text, "the sweep file") != inputs.cases.text:
        raise ValueError(f"{out} has other cases than {first}; choose another folder with --out")
    with rows_in(out) as store:
        usable = partial(_usable, wanted=wanted)
        for folder in records:
            take_rows(folder, store, usable)
        rows = usable(store.items)
        used = {row.key for row in rows}
        parts = store.parts(lambda row: row.key in used)
    with atomic(target.grid_text) as file:
        file.write(inputs.cases.text.encode())
    if missing := len(wanted) - len(rows):
        raise ComputationFailed(
            f"{missing} of {len(wanted)} computations are in none of the folders; merge more of them, or compute what "
            f"is missing by {_command(target, inputs, records[first])}"
        )
    completed = Completed(rows, len(rows), parts, None)
    arguments = {"jobs": 1, "merged": [str(folder) for folder in records]}
    return write_run(target, inputs, completed, arguments, started)


def _common(record: Mapping[str, Any]) -> dict[str, Any]:
    """Entries of the records that all shards of a sweep have in common."""
    return {
        "cases": record["cases_sha256"],
        "models or versions of them": record["models"],
        "option --model": record["arguments"]["model"],
    }


def _inputs(folder: Path, record: dict[str, Any]) -> RunInputs:
    """Return what a sweep computes, as its record has it: external models are not loaded."""
    models, specs = record["arguments"]["model"], record["arguments"]["external"]
    cases = stored_cases(RunFolder(folder), None, models)
    if cases.sha256 != record["cases_sha256"]:
        raise ValueError(f"{RunFolder(folder).grid_text} was changed after it was written: run the sweep again")
    cases = replace(cases, source=record["arguments"]["grid"])
    external = {}
    for name, spec in specs.items():
        said = record["models"][name]
        texts = (said["citation"], said["domain"], said.get("hashed", ""))
        external[name] = ExternalIdentity(name, said["version"], spec, *texts)
    domains = {name: Domain.of_json(tables) for name, tables in record.get("domains", {}).items()}
    return RunInputs(cases, None, models, external, domains)


def _usable(rows: Iterable[Row], wanted: Mapping[Any, Task]) -> list[Row]:
    """Return the rows that are wanted, of the version of their external model that is."""
    return [
        row
        for row in rows
        if row.key in wanted
        and row.digest == wanted[row.key].digest
        and ((external := wanted[row.key].external) is None or external.version == row.model_version)
    ]


def _command(target: RunFolder, inputs: RunInputs, record: Mapping[str, Any]) -> str:
    """Return the command that computes what no folder has, in words where the folder has not all of its inputs."""
    out = quote(str(target.path))
    if inputs.cases.files:
        return f"the command of the sweep without --shard and with --out {out}"
    specs = record["arguments"]["external"]
    models = "".join(f" --model {quote(specs.get(name, name))}" for name in record["arguments"]["model"] or ())
    return f"fscm-bench sweep {quote(str(target.grid_text))} --out {out}{models}"
