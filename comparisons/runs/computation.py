"""Computation of the tasks of a folder: a stored row is not computed again, and an interruption loses nothing."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Mapping
from concurrent.futures import BrokenExecutor
from contextlib import closing
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from shlex import quote
from typing import Any

from comparisons.console.progress import counting, log, note
from comparisons.model import ComputationFailed
from comparisons.runs.atomic_files import prepare_folder
from comparisons.runs.execution import compute, compute_with_environment
from comparisons.runs.journal import alone_in
from comparisons.runs.reevaluation import drop_changed
from comparisons.runs.row_journal import RowJournal
from comparisons.runs.rows import Key, Row
from comparisons.runs.tasks import Task
from comparisons.runs.time_left import TimeLeft
from comparisons.runs.workers import LOST, Backend, Processes, processes

__all__ = [
    "Completed",
    "checked_jobs",
    "complete",
    "folder_for",
    "log_failures_used",
]


def checked_jobs(jobs: int) -> int:
    """Return the number of processes; `ValueError` if there are none."""
    if jobs < 1:
        raise ValueError(f"--jobs {jobs} is outside 1, 2, ...: the computations need at least one process")
    return jobs


def folder_for(out: Path | None, started: datetime) -> Path:
    """Return the folder for the results, made and found writable: `out`, or one named by the time."""
    return prepare_folder(out or Path("results", "runs", started.astimezone().strftime("%Y-%m-%dT%H-%M-%S")))


@dataclass(frozen=True, slots=True)
class Completed:
    """Rows of all tasks of a run, and their origin.

    Attributes
    ----------
    rows : list
    resumed : int
        How many of them were stored.
    parts : list of dict
        The commands that computed them, as the record of the run holds them.
    evaluated_again : dict or None
        What was evaluated again before stored rows of external models were used, as the record holds it.
    """

    rows: list[Row]
    resumed: int
    parts: list[dict[str, Any]]
    evaluated_again: dict[str, Any] | None


def complete(
    tasks: list[Task],
    folder: Path,
    jobs: int,
    retry_failed: bool = False,
    backend: Backend = processes,
    needed: Callable[[list[Row]], Collection[Key]] | None = None,
) -> Completed:
    """Compute the tasks that the journal of a folder does not have.

    A stored row that failed because its process ended does not count.  A stored row of another version of an external
    model does not, nor does one that failed.  A few of the others are evaluated again; if one differs, all rows of its
    model are computed again.

    Parameters
    ----------
    tasks : list of Task
        All that may be needed.
    folder : Path
        Of the results.
    jobs : int
        Number of processes.
    retry_failed : bool
        Whether stored failures of our own models do not count either.
    backend : Backend
        Where the tasks are computed.
    needed : callable, optional
        Returns the keys of the results that are needed, from the rows that are there: it is called again with the new
        ones, until nothing is missing.  By default all are needed.

    Raises
    ------
    ValueError
        If the folder or a worker is of other code, or another process computes into the folder.
    comparisons.model.ComputationFailed
        If the workers cannot compute.
    """
    wanted = {task.key: task for task in tasks}
    versions = {task.model: task.external.version for task in tasks if task.external}

    def usable(row: Row) -> bool:
        task = wanted.get(row.key)
        same_problem = task is not None and row.digest == task.digest
        return same_problem and versions.get(row.model, row.model_version) == row.model_version

    def again(row: Row) -> bool:
        return row.status == "failed" and (retry_failed or row.model in versions or row.reason == LOST)

    def chosen() -> list[Task]:
        keys = wanted if needed is None else needed([row for row in journal.items if usable(row)])
        return [task for task in tasks if task.key in keys]

    def missing_of(known: Collection[Key]) -> list[Task]:
        return [task for task in chosen() if task.key not in known]

    with alone_in(folder):
        journal = RowJournal(folder)
        journal.drop(lambda row: usable(row) and again(row))
        try:
            external = [(wanted[row.key], row) for row in journal.items if usable(row) and row.model in versions]
            local = backend if isinstance(backend, Processes) else processes
            evaluated_again = (
                drop_changed(external, journal, lambda tasks: compute(tasks, jobs, local)) if external else None
            )
            stored = [row for row in journal.items if usable(row)]
            log_failures_used(Counter(row.model for row in stored if row.status == "failed"))
            known = {row.key for row in stored}
            missing = missing_of(known)
            workers = f"{jobs} processes" if isinstance(backend, Processes) else "a Dask cluster"
            note(f"{len(missing)} computations on {workers}" + (f", {len(known)} are stored" if known else ""))
            while missing:
                left = TimeLeft(missing)
                computing = closing(compute_with_environment(missing, jobs, backend))
                with counting("computing", len(missing)) as count, computing as computed:
                    for row, environment in computed:
                        journal.add(row, environment)
                        known.add(row.key)
                        count(left.after(row))
                missing = missing_of(known)
                if missing:
                    note(f"{len(missing)} computations more, with which these are compared")
        except KeyboardInterrupt:
            log(_safe(journal, folder))
            raise
        except BrokenExecutor as failure:
            raise ComputationFailed(f"{failure}; {_safe(journal, folder)}") from None
        used = {task.key for task in chosen()}
        rows = [row for row in journal.items if usable(row) and row.key in used]
        resumed = sum(row.key in used for row in stored)
        return Completed(rows, resumed, journal.parts_of(rows), evaluated_again)


def log_failures_used(failures: Mapping[str, int]) -> None:
    """Write in one sentence how many stored failures are used, by the names of the models or functions."""
    if failures:
        log(
            f"{sum(failures.values())} stored failures of {', '.join(sorted(failures))} are used; "
            "--retry-failed computes them again"
        )


def _safe(journal: RowJournal, folder: Path) -> str:
    return f"{len(journal.items)} finished computations are safe; go on with --out {quote(str(folder))}"
