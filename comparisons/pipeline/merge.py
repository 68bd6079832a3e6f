"""Merging of the shards of a sweep into one folder."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from shlex import quote
from typing import Any

from comparisons.data.file_names import GRID_TEXT, RECORD, STORE
from comparisons.model import ComputationFailed
from comparisons.pipeline.finished_run import FinishedRun, kept_texts, write_run
from comparisons.pipeline.inputs import RunInputs, stored_inputs
from comparisons.runs.atomic_files import prepare_folder
from comparisons.runs.computation import Completed, is_row_of
from comparisons.runs.folder_lock import locked
from comparisons.runs.record import now, read_record
from comparisons.runs.reevaluation import same
from comparisons.runs.rows import Key, Row
from comparisons.runs.store import Store, rows_in
from comparisons.runs.tasks import Task


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
        If a folder is not that of a finished sweep, two are not of the same sweep, two have different results of one
        task, or the copy of the grids would replace a file of a user.
    comparisons.model.ComputationFailed
        If tasks of the sweep are in none of the folders; the others are then merged.
    """
    with ExitStack() as locks:
        # The rows and the record of a shard are of one run.
        for folder in folders:
            if (folder / STORE).exists():
                locks.enter_context(locked(folder))
        inputs, shards = _sweep(folders, out)
        locks.enter_context(locked(prepare_folder(out)))
        return _merged(inputs, shards, out)


def _sweep(folders: Sequence[Path], out: Path) -> tuple[RunInputs, list[Path]]:
    """Return the inputs of a sweep and the folders of its shards, each once."""
    records = {folder: _record(folder, out) for folder in folders}
    sweep, expected = folders[0], records[folders[0]]
    for folder, record in records.items():
        for words, content in _identity(record).items():
            if content != _identity(expected)[words]:
                raise ValueError(f"{folder} and {sweep} are not shards of one sweep: they differ in their {words}")
    inputs = stored_inputs(sweep, expected)
    if inputs.cases.sha256 != expected["cases_sha256"]:
        raise ValueError(f"{sweep / GRID_TEXT} was changed after it was written: run the sweep again")
    return inputs, list(records)


def _merged(inputs: RunInputs, shards: Sequence[Path], out: Path) -> FinishedRun:
    started = now()
    planned = {task.key: task for task in inputs.plan()}
    kept_texts(out, inputs.cases, None)
    with rows_in(out) as store:
        for folder in shards:
            _take_rows(folder, store, planned)
        rows = _of_sweep(store, planned)
        parts = store.parts(lambda row: row.key in rows)
    if missing := len(planned) - len(rows):
        raise ComputationFailed(
            f"{missing} of {len(planned)} computations are in none of the folders: merge more of them, or repeat the "
            f"command of the sweep without --shard and with --out {quote(str(out))}"
        )
    completed = Completed(list(rows.values()), len(rows), parts, None)
    return write_run(out, inputs, completed, started, merged=[str(folder) for folder in shards])


def _record(folder: Path, out: Path) -> dict[str, Any]:
    """Return the record of the folder of a sweep, or say in one sentence why it cannot be merged."""
    record = read_record(folder / RECORD)
    if record["command_name"] != "sweep":
        raise ValueError(f"{folder} is the folder of fscm-bench {record['command_name']}; only sweeps are merged")
    if not (folder / STORE).exists():
        raise ValueError(f"{folder / STORE} does not exist: only folders with their store are merged")
    if folder.resolve() == out.resolve():
        raise ValueError(f"{out} is one of the folders that are merged; choose another folder with --out")
    return record


def _identity(record: Mapping[str, Any]) -> dict[str, Any]:
    """Return what all shards of one sweep have in common, by the words of a sentence."""
    return {
        "cases": record["cases_sha256"],
        "models or versions of them": record["models"],
        "option --model": record["arguments"]["model"],
    }


def _of_sweep(store: Store[Row], planned: Mapping[Key, Task]) -> dict[Key, Row]:
    return {row.key: row for row in store.items if is_row_of(planned.get(row.key), row)}


def _take_rows(folder: Path, store: Store[Row], planned: Mapping[Key, Task]) -> None:
    """Add the rows of a folder that a store does not have, or has as failures only."""
    with rows_in(folder) as shard:
        stored, taken = _of_sweep(store, planned), set()
        for key, row in _of_sweep(shard, planned).items():
            before = stored.get(key)
            if before is None or (before.status == "failed" and row.status != "failed"):
                taken.add(key)
            elif row.status != "failed" and not same(before, row):
                raise ValueError(
                    f"{folder} has another result than a folder before it for {row.quantity} of {row.model} at "
                    f"{row.label}: they differ by more than both uncertainties"
                )
        store.copy(shard, lambda row: row.key in taken and is_row_of(planned[row.key], row))
