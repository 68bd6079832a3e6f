"""Computation of the tasks of a folder: a stored row is not computed again, and an interruption loses nothing."""

from __future__ import annotations

import re
from collections.abc import Generator, Iterable
from contextlib import closing
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from typing import Any

from comparisons.console.progress import note
from comparisons.runs.reevaluation import drop_changed
from comparisons.runs.rows import Row
from comparisons.runs.store import rows_in
from comparisons.runs.tasks import Task, batches, evaluate_task, failed_row
from comparisons.runs.workers import each


def checked_jobs(jobs: int) -> int:
    """Return the number of processes; `ValueError` if there are none."""
    if jobs < 1:
        raise ValueError(f"--jobs {jobs} is outside 1, 2, ...: the computations need at least one process")
    return jobs


def folder_for(out: str | Path | None) -> Path:
    """Return the folder for the results: `out`, or one named by the time."""
    return Path(out) if out else Path("results", "runs", datetime.now().astimezone().strftime("%Y-%m-%dT%H-%M-%S"))


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


def is_row_of(task: Task | None, row: Row) -> bool:
    """Whether a stored row is that of a task: of the same problem, by the same version of an external model."""
    return (
        task is not None
        and row.digest == task.problem.digest
        and (task.external is None or task.external.version == row.model_version)
    )


def complete(tasks: list[Task], folder: Path, jobs: int) -> Completed:
    """Compute the tasks that the store of a folder does not have.

    A stored row that failed does not count, nor one of another version of an external model.  A few of the others of
    external models are evaluated again; if one differs, all rows of its model are computed again.

    Parameters
    ----------
    tasks : list of Task
    folder : Path
        Of the results.
    jobs : int
        Number of processes.

    Raises
    ------
    ValueError
        If the folder is of other code, or another process computes into the folder.
    comparisons.model.ComputationFailed
        If the workers cannot compute.
    """
    planned = {task.key: task for task in tasks}

    def counts(row: Row) -> bool:
        return is_row_of(planned.get(row.key), row) and row.status != "failed"

    with rows_in(folder) as store:
        store.drop(lambda row: row.key in planned and not counts(row))
        with store.interruptible():
            evaluated_again = drop_changed(planned, store)
        stored = {row.key for row in store.items if row.key in planned}
        missing = [task for task in tasks if task.key not in stored]
        note(f"{len(missing)} computations, {jobs} at a time" + (f", {len(stored)} are stored" if stored else ""))
        store.complete("computing", len(missing), compute(missing, jobs))
        rows = [row for row in store.items if row.key in planned]
        return Completed(rows, len(stored), store.parts(lambda row: row.key in planned), evaluated_again)


def _evaluate_batch(batch: list[Task]) -> list[Row]:
    return [evaluate_task(task) for task in batch]


def compute(tasks: list[Task], jobs: int) -> Generator[Row]:
    """Evaluate tasks and yield each row, as it is finished.

    A task whose process ends is evaluated once more, alone; if that process ends too, its row has failed.

    Raises
    ------
    concurrent.futures.BrokenExecutor
        If the processes cannot work.

    Examples
    --------
    >>> from comparisons.problem import Problem
    >>> [row.value for row in compute([Task("bradley", "pull_off_force", Problem.dimensionless(2, 0, 1))], 1)]
    [2.0]
    """
    finished = each(
        _evaluate_batch,
        batches(tasks),
        jobs,
        lost=lambda batch: [failed_row(task) for task in batch],
        split=lambda batch: [[task] for task in batch],
    )
    with closing(finished) as batches_done:
        for rows in batches_done:
            yield from rows


def parse_shard(text: str) -> tuple[int, int]:
    """Return the number of a shard, from 1, and that of all shards.

    Raises
    ------
    ValueError
        If the text has another form, or there is no such shard.

    Examples
    --------
    >>> parse_shard("2/3")
    (2, 3)
    >>> parse_shard("4/3")
    Traceback (most recent call last):
    ValueError: shard 4/3 is not one of 1/3, ..., 3/3
    """
    match = re.fullmatch(r"(\d{1,9})/0*([1-9]\d{0,8})", text, re.ASCII)
    if match is None:
        raise ValueError(f"shard {text!r} must be two numbers i/N, such as 2/3 for the second of three")
    number, total = int(match[1]), int(match[2])
    if not 1 <= number <= total:
        raise ValueError(f"shard {number}/{total} is not one of 1/{total}, ..., {total}/{total}")
    return number, total


def tasks_of_shard(shard: str, tasks: Iterable[Task]) -> list[Task]:
    """Return the tasks of a shard of those of the whole sweep, in their order; all shards are about equally expensive.

    All quantities of one problem by one model are in one shard: a solver computes them from one path.  The problems
    of one model after the other go round the shards; neighbours in a plan cost about the same.

    Examples
    --------
    >>> from comparisons.problem import Problem
    >>> spheres = [Problem.dimensionless(2, 0, mu) for mu in (4, 3, 2, 1)]
    >>> tasks = [Task(model, "pull_off_force", sphere) for sphere in spheres for model in ("fscm", "jkr")]
    >>> [(task.model, task.problem.mu) for task in tasks_of_shard("2/2", tasks)]
    [('fscm', 3.0), ('jkr', 3.0), ('fscm', 1.0), ('jkr', 1.0)]
    """
    number, total = parse_shard(shard)
    planned = list(tasks)
    problems = dict.fromkeys(task.problem_key for task in sorted(planned, key=lambda task: task.model))
    selected = set(list(problems)[number - 1 :: total])
    return [task for task in planned if task.problem_key in selected]
