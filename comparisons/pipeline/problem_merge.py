"""Merging of the shards of a sweep over a problem file."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from shlex import quote
from typing import Any

from comparisons.model import ComputationFailed
from comparisons.pipeline.problem_inputs import stored_inputs, stored_problems
from comparisons.pipeline.problem_sweep import FinishedProblemSweep, write_problem_sweep
from comparisons.pipeline.record_content import now
from comparisons.pipeline.shard_folders import checked_records, take_rows
from comparisons.runs.atomic_files import prepare_folder
from comparisons.runs.computation import Completed
from comparisons.runs.folder import RunFolder
from comparisons.runs.journal import alone_in
from comparisons.runs.problem_tasks import ProblemRow, ProblemTask, digest_of, plan_problems, problem_journal
from comparisons.runs.record import PROBLEM_SWEEP

__all__ = ["merge_problem_sweeps"]


def merge_problem_sweeps(folders: Sequence[Path], out: Path) -> FinishedProblemSweep:
    """Put the rows of finished shards of one sweep into one folder, and write its table and record.

    What the folder has already is kept.

    Parameters
    ----------
    folders : sequence of Path
        Of the shards, in any order.
    out : Path
        For the results; none of `folders`.

    Raises
    ------
    ValueError
        If a folder is not that of a finished sweep over a problem file, two are not of the same sweep, or two have
        different results of one computation.
    comparisons.model.ComputationFailed
        If computations of the sweep are in none of the folders; the others are then merged.
    """
    started = now()
    records = checked_records(folders, out, PROBLEM_SWEEP, _common)
    first, expected = next(iter(records.items()))
    wanted = _plan(first, expected)
    inputs = stored_inputs(first, expected)
    target = RunFolder(prepare_folder(out))
    inputs.check(target)

    def usable(rows: Iterable[ProblemRow]) -> list[ProblemRow]:
        return [row for row in rows if row.key in wanted and wanted[row.key].version == row.model_version]

    with alone_in(out):
        journal = problem_journal(out)
        for folder in records:
            take_rows(folder, problem_journal, journal, usable, _place)
        rows = usable(journal.items)
        keys = {row.key for row in rows}
        parts = journal.parts(lambda row: row.key in keys and wanted[row.key].version == row.model_version)
    if missing := len(wanted) - len(rows):
        raise ComputationFailed(
            f"{missing} of {len(wanted)} computations are in none of the folders; merge more of them, or compute what "
            f"is missing by the command without --shard and with --out {quote(str(out))}"
        )
    arguments = {name: value for name, value in expected["arguments"].items() if name != "shard"}
    arguments |= {"jobs": 1, "merged": [str(folder) for folder in records], "out": str(out)}
    completed = Completed(rows, len(rows), parts, None)
    return write_problem_sweep(
        target, completed, arguments, started, expected["cases_sha256"], expected["models"], inputs
    )


def _common(record: Mapping[str, Any]) -> dict[str, Any]:
    """Entries of the records that all shards of a sweep have in common."""
    return {
        "problems, models or quantities": record["cases_sha256"],
        "versions of the models": record["models"],
        "varied keys": record["arguments"]["vary"],
    }


def _plan(folder: Path, record: Mapping[str, Any]) -> dict[Any, ProblemTask]:
    """Return every task of the whole sweep by its key: external models are not loaded."""
    arguments, models = record["arguments"], record["models"]
    specs = {name: (arguments["external"].get(name, name), models[name]["version"]) for name in arguments["model"]}
    tasks = plan_problems(stored_problems(folder, record, arguments["vary"]), specs, arguments["quantity"])
    if digest_of(tasks) != record["cases_sha256"]:
        raise ValueError(f"a file in {RunFolder(folder).inputs} was changed after it was written: run the sweep again")
    return {task.key: task for task in tasks}


def _place(row: ProblemRow) -> str:
    where = ", ".join(f"{name} = {value}" for name, value in row.parameters.items())
    return f"{row.quantity} of {row.model} at {where}"
