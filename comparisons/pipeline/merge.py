"""Merging of the shards of a sweep into one folder."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from comparisons.domain import Domain
from comparisons.model import ComputationFailed
from comparisons.pipeline.finished_run import FinishedRun, write_run
from comparisons.pipeline.inputs import RunInputs, load_cases
from comparisons.pipeline.record_content import now
from comparisons.pipeline.results import Results
from comparisons.registry import ExternalIdentity
from comparisons.runs.atomic_files import atomic, prepare_folder
from comparisons.runs.computation import Completed
from comparisons.runs.folder import RunFolder
from comparisons.runs.journal import alone_in
from comparisons.runs.record import read_record
from comparisons.runs.reevaluation import same
from comparisons.runs.row_journal import RowJournal
from comparisons.runs.rows import Row
from comparisons.runs.tasks import Task

__all__ = ["merge"]

#: Entries of the records that all shards of a sweep have in common.
_COMMON = {"cases_sha256": "cases", "models": "models or versions of them"}


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
    records = {folder: _record(folder) for folder in dict.fromkeys(folders)}
    if any(folder.resolve() == out.resolve() for folder in records):
        raise ValueError(f"{out} is one of the folders that are merged; choose another folder with --out")
    first = next(iter(records))
    for folder in records:
        _require_same_sweep(first, records[first], folder, records[folder])
    inputs = _inputs(first, records[first])
    wanted = {task.key: task for task in inputs.plan()}
    target = RunFolder(prepare_folder(out))
    if target.grid_text.exists() and target.grid_text.read_text(encoding="utf-8") != inputs.cases.text:
        raise ValueError(f"{out} has other cases than {first}; choose another folder with --out")
    with alone_in(out):
        journal = RowJournal(out)
        for folder in records:
            with alone_in(folder):
                _take(RowJournal(folder), folder, journal, wanted)
        rows = _usable(journal, wanted)
    with atomic(target.grid_text) as file:
        file.write(inputs.cases.text.encode())
    if missing := len(wanted) - len(rows):
        raise ComputationFailed(
            f"{missing} of {len(wanted)} computations are in none of the folders; merge more of them, or compute what "
            f"is missing by fscm-bench sweep {target.grid_text} --out {out}{_model_option(records[first])}"
        )
    completed = Completed(rows, len(rows), journal.parts_of(rows), None)
    arguments = {"jobs": 1, "merged": [str(folder) for folder in records]}
    return write_run(target, inputs, Results(completed, [], {}), arguments, started)


def _record(folder: Path) -> dict[str, Any]:
    files = RunFolder(folder)
    record = read_record(files.record)
    if record["command_name"] != "sweep":
        raise ValueError(f"{folder} is the folder of fscm-bench {record['command_name']}; only sweeps are merged")
    if not files.journal.exists():
        raise ValueError(f"{files.journal} does not exist: only folders with their journal are merged")
    return record


def _require_same_sweep(first: Path, expected: dict[str, Any], folder: Path, record: dict[str, Any]) -> None:
    different = [words for name, words in _COMMON.items() if record[name] != expected[name]]
    if record["arguments"]["model"] != expected["arguments"]["model"]:
        different.append("option --model")
    if different:
        raise ValueError(f"{folder} and {first} are not shards of one sweep: they differ in their {different[0]}")


def _inputs(folder: Path, record: dict[str, Any]) -> RunInputs:
    """Return what a sweep computes, as its record has it: external models are not loaded."""
    models, specs = record["arguments"]["model"], record["arguments"]["external"]
    cases = load_cases(RunFolder(folder).grid_text, models)
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


def _usable(journal: RowJournal, wanted: dict[Any, Task]) -> list[Row]:
    """Return the rows of a journal that are wanted, of the version of their external model that is."""
    return [
        row
        for row in journal.items
        if row.key in wanted
        and ((external := wanted[row.key].external) is None or external.version == row.model_version)
    ]


def _take(source: RowJournal, folder: Path, journal: RowJournal, wanted: dict[Any, Task]) -> None:
    """Add the rows that a journal does not have, or has as failures only."""
    stored = {row.key: row for row in _usable(journal, wanted)}
    taken = set()
    for row in _usable(source, wanted):
        known = stored.get(row.key)
        if known is None or (known.status == "failed" and row.status != "failed"):
            taken.add(row.key)
        elif row.status != "failed" and not same(known, row):
            raise ValueError(
                f"{folder} has another result than a folder before it for {row.quantity} of {row.model} at "
                f"n = {row.n:g}, k = {row.k:g}, mu = {row.mu:g}: they differ by more than both uncertainties"
            )
    journal.drop(lambda row: row.key in taken)
    journal.take(source, lambda row: row.key in taken)


def _model_option(record: dict[str, Any]) -> str:
    names: Iterable[str] = record["arguments"]["model"] or ()
    specs = record["arguments"]["external"]
    return "".join(f" --model {specs.get(name, name)}" for name in names)
