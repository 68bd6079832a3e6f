"""Computing the tasks of a command: what is stored is not computed again, and an interruption loses nothing."""

from __future__ import annotations

import argparse
from concurrent.futures import BrokenExecutor
from contextlib import closing
from dataclasses import asdict
from datetime import datetime
from pathlib import Path

from comparisons.journal import Journal, alone_in
from comparisons.model import ComputationFailed
from comparisons.progress import counting, log
from comparisons.provenance import code_digest
from comparisons.run import Task, compute
from comparisons.store import Row, prepare_folder
from comparisons.workers import usable_cores

__all__ = ["add_jobs", "add_out", "checked_jobs", "complete", "folder_for"]


def add_jobs(parser: argparse.ArgumentParser) -> None:
    """Declare the number of processes."""
    parser.add_argument("--jobs", metavar="N", type=int, default=usable_cores(), help="processes (default: one a core)")


def add_out(parser: argparse.ArgumentParser) -> None:
    """Declare the folder for the results."""
    parser.add_argument(
        "--out",
        metavar="DIR",
        type=Path,
        help="folder for the results (default: results/runs/TIME); resumed if it has some",
    )


def checked_jobs(jobs: int) -> int:
    """Return the number of processes; `ValueError` if there are none."""
    if jobs < 1:
        raise ValueError(f"--jobs {jobs} is outside 1, 2, ...: the computations need at least one process")
    return jobs


def folder_for(out: Path | None, started: datetime) -> Path:
    """Return the folder for the results, made and found writable: `out`, or one named by the time."""
    return prepare_folder(out or Path("results", "runs", started.astimezone().strftime("%Y-%m-%dT%H-%M-%S")))


def complete(tasks: list[Task], folder: Path, jobs: int) -> tuple[list[Row], int]:
    """Return the rows of all tasks, computing those the journal of the folder does not have, and how many it had.

    A stored row of another version of a model from outside does not count.

    Raises
    ------
    ValueError
        If the folder holds results of other code, or another process computes into it.
    comparisons.model.ComputationFailed
        If a worker process dies.
    """
    versions = {task.model: task.outside.version for task in tasks if task.outside}

    def current(row: Row) -> bool:
        return versions.get(row.model, row.model_version) == row.model_version

    with alone_in(folder):
        journal = Journal(folder / "journal.jsonl", code_digest(), lambda line: Row(**line), asdict)
        stored = {row.key for row in journal.entries if current(row)}
        missing = [task for task in tasks if task.key not in stored]
        known = f", {len(tasks) - len(missing)} are stored" if stored else ""
        log(f"{len(missing)} computations on {jobs} processes{known}")
        try:
            with counting("computing", len(missing)) as count, closing(compute(missing, jobs)) as answers:
                for row in answers:
                    journal.add(row)
                    count()
        except KeyboardInterrupt:
            log(_safe(journal))
            raise
        except BrokenExecutor:
            raise ComputationFailed(f"a worker process died (out of memory?); {_safe(journal)}") from None
    wanted = {task.key for task in tasks}
    return [row for row in journal.entries if row.key in wanted and current(row)], len(stored)


def _safe(journal: Journal[Row]) -> str:
    return f"{len(journal.entries)} finished computations are safe; go on with --out {journal.path.parent}"
