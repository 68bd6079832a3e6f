"""Merging of the shards of a sweep over a problem file."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from comparisons.model import ComputationFailed
from comparisons.pipeline.problem_sweep import COMMAND, FinishedProblemSweep, write_problem_sweep
from comparisons.pipeline.record_content import now
from comparisons.runs.atomic_files import prepare_folder
from comparisons.runs.folder import RunFolder
from comparisons.runs.journal import alone_in
from comparisons.runs.part_journal import PartJournal
from comparisons.runs.problem_tasks import ProblemRow, problem_journal
from comparisons.runs.record import read_record

__all__ = ["is_problem_sweep", "merge_problem_sweeps"]


def is_problem_sweep(folder: Path) -> bool:
    """Whether a folder is that of a finished sweep over a problem file; `ValueError` as `read_record`."""
    return bool(read_record(RunFolder(folder).record)["command_name"] == COMMAND)


def merge_problem_sweeps(folders: Sequence[Path], out: Path) -> FinishedProblemSweep:
    """Put the rows of finished shards of one sweep into one folder, and write its table and record.

    Parameters
    ----------
    folders : sequence of Path
        Of the shards, in any order.
    out : Path
        For the results; none of `folders`.

    Raises
    ------
    ValueError
        If a folder is not that of a finished sweep over a problem file, or two are not of the same sweep.
    comparisons.model.ComputationFailed
        If computations of the sweep are in none of the folders; the others are then merged.
    """
    started = now()
    records = {folder: read_record(RunFolder(folder).record) for folder in dict.fromkeys(folders)}
    first, expected = next(iter(records.items()))
    for folder, record in records.items():
        _check(first, expected, folder, record)
        if folder.resolve() == out.resolve():
            raise ValueError(f"{out} is one of the folders that are merged; choose another folder with --out")
    target = RunFolder(prepare_folder(out))
    versions = {name: model["version"] for name, model in expected["models"].items()}
    quantities = expected["arguments"]["quantity"]
    total = expected["arguments"]["computations"]
    with alone_in(out):
        journal = problem_journal(out)
        for folder in records:
            with alone_in(folder):
                source = problem_journal(folder)
                _take(source, journal, versions, quantities)
        rows, parts = journal.items, journal.parts()
    if missing := total - len(rows):
        raise ComputationFailed(
            f"{missing} of {total} computations are in none of the folders; merge more of them, or compute what is "
            f"missing by the command without --shard and with --out {out}"
        )
    arguments = {name: value for name, value in expected["arguments"].items() if name != "shard"}
    arguments |= {"jobs": 1, "merged": [str(folder) for folder in records], "out": str(out)}
    return write_problem_sweep(
        target, rows, len(rows), parts, arguments, started, expected["cases_sha256"], expected["models"]
    )


def _check(first: Path, expected: dict[str, Any], folder: Path, record: dict[str, Any]) -> None:
    if record["command_name"] != COMMAND:
        raise ValueError(
            f"{folder} is the folder of fscm-bench {record['command_name']}, and {first} is of sweep --problem"
        )
    for name, words in (("cases_sha256", "problems, models or quantities"), ("models", "versions of the models")):
        if record[name] != expected[name]:
            raise ValueError(f"{folder} and {first} are not shards of one sweep: they differ in their {words}")


def _take(
    source: PartJournal[ProblemRow], journal: PartJournal[ProblemRow], versions: dict[str, str], quantities: list[str]
) -> None:
    """Add the rows that a journal does not have, or has as failures only."""
    known = {row.key for row in journal.items if row.status != "failed"}
    taken = {
        row.key
        for row in source.items
        if row.key not in known and versions.get(row.model) == row.model_version and row.quantity in quantities
    }
    journal.drop(lambda row: row.key in taken)
    journal.take(source, lambda row: row.key in taken)
