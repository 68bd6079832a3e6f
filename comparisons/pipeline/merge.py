"""Merging of the shards of a sweep into one folder."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from shlex import quote
from typing import Any

from comparisons.data.input_files import read_text
from comparisons.data.validation import known_name
from comparisons.model import ComputationFailed
from comparisons.pipeline.finished_run import FinishedRun, write_run
from comparisons.pipeline.inputs import RunInputs, domains_in, stored_cases
from comparisons.registry import MODELS, ExternalIdentity
from comparisons.runs.atomic_files import atomic, prepare_folder
from comparisons.runs.computation import Completed, is_row_of
from comparisons.runs.folder import RunFolder
from comparisons.runs.record import now, read_record
from comparisons.runs.reevaluation import same
from comparisons.runs.rows import Key, Row
from comparisons.runs.store import Store, rows_in
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
    records = {folder: _record(folder, out) for folder in folders}
    first = folders[0]
    for folder, record in records.items():
        _check_same_sweep(folder, record, first, records[first])
    inputs = _inputs(first, records[first])
    planned = {task.key: task for task in inputs.plan()}
    target = RunFolder(prepare_folder(out))
    if target.grid_text.exists() and read_text(target.grid_text, "the sweep file") != inputs.cases.text:
        raise ValueError(f"{out} has other cases than {first}; choose another folder with --out")
    with rows_in(out) as store:
        for folder in records:
            _take_rows(folder, store, planned)
        rows = _of_sweep(store, planned)
        parts = store.parts(lambda row: row.key in rows)
    with atomic(target.grid_text) as file:
        file.write(inputs.cases.text.encode())
    if missing := len(planned) - len(rows):
        raise ComputationFailed(
            f"{missing} of {len(planned)} computations are in none of the folders: merge more of them, or repeat the "
            f"command of the sweep without --shard and with --out {quote(str(out))}"
        )
    completed = Completed(list(rows.values()), len(rows), parts, None)
    arguments = {"jobs": 1, "merged": [str(folder) for folder in records]}
    return write_run(target, inputs, completed, arguments, started)


def _record(folder: Path, out: Path) -> dict[str, Any]:
    """Return the record of the folder of a sweep, or say in one sentence why it cannot be merged."""
    files = RunFolder(folder)
    record = read_record(files.record)
    if record["command_name"] != "sweep":
        raise ValueError(f"{folder} is the folder of fscm-bench {record['command_name']}; only sweeps are merged")
    if not files.store.exists():
        raise ValueError(f"{files.store} does not exist: only folders with their store are merged")
    if folder.resolve() == out.resolve():
        raise ValueError(f"{out} is one of the folders that are merged; choose another folder with --out")
    # A model that is not ours and that the record does not describe would be loaded, and its code run.
    external, models = record["arguments"]["external"], record["arguments"]["model"] or []
    for name in [*external, *models]:
        known_name("model", name, {*MODELS, *external} & {*record["models"]}, str(files.record))
    return record


def _check_same_sweep(folder: Path, record: Mapping[str, Any], first: Path, expected: Mapping[str, Any]) -> None:
    differing = {
        "cases": record["cases_sha256"] != expected["cases_sha256"],
        "models or versions of them": record["models"] != expected["models"],
        "option --model": record["arguments"]["model"] != expected["arguments"]["model"],
    }
    for words, differs in differing.items():
        if differs:
            raise ValueError(f"{folder} and {first} are not shards of one sweep: they differ in their {words}")


def _inputs(folder: Path, record: dict[str, Any]) -> RunInputs:
    """Return what a sweep computes, as its record has it: external models are not loaded."""
    arguments = record["arguments"]
    cases = stored_cases(RunFolder(folder), None, arguments["model"])
    if cases.sha256 != record["cases_sha256"]:
        raise ValueError(f"{RunFolder(folder).grid_text} was changed after it was written: run the sweep again")
    external = {
        name: ExternalIdentity(name=name, spec=spec, **record["models"][name])
        for name, spec in arguments["external"].items()
    }
    return RunInputs(replace(cases, source=arguments["grid"]), None, arguments["model"], external, domains_in(record))


def _of_sweep(store: Store[Row], planned: Mapping[Key, Task]) -> dict[Key, Row]:
    return {row.key: row for row in store.items if is_row_of(planned.get(row.key), row)}


def _take_rows(folder: Path, store: Store[Row], planned: Mapping[Key, Task]) -> None:
    """Add the rows of a folder that a store does not have, or has as failures only."""
    with rows_in(folder) as shard:
        stored, given = _of_sweep(store, planned), _of_sweep(shard, planned)
        taken = set()
        for key, row in given.items():
            before = stored.get(key)
            if before is None or (before.status == "failed" and row.status != "failed"):
                taken.add(key)
            elif row.status != "failed" and not same(before, row):
                raise ValueError(
                    f"{folder} has another result than a folder before it for {row.quantity} of {row.model} at "
                    f"{row.label}: they differ by more than both uncertainties"
                )
        store.take(shard, lambda row: row.key in taken and is_row_of(planned[row.key], row))
