"""Execution of tasks by worker processes, each row with the environment that computed it."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import closing
from dataclasses import dataclass
from functools import lru_cache

from comparisons.runs.environment import computing_environment, differences, fingerprint
from comparisons.runs.rows import Row
from comparisons.runs.tasks import Task, batches, evaluate_task, lost_row
from comparisons.runs.workers import Backend, each, processes

__all__ = ["compute", "compute_with_environment"]


@dataclass(frozen=True, slots=True)
class _Computed:
    rows: list[Row]
    environment: dict[str, str]
    fingerprint: str


@lru_cache(maxsize=1)
def _of_this_process() -> tuple[dict[str, str], str]:
    return computing_environment(), fingerprint()


def _evaluate_batch(batch: list[Task]) -> _Computed:
    return _Computed([evaluate_task(task) for task in batch], *_of_this_process())


def _lost_batch(batch: list[Task]) -> _Computed:
    return _Computed([lost_row(task) for task in batch], *_of_this_process())


def _single(batch: list[Task]) -> list[list[Task]]:
    return [[task] for task in batch]


def _solid_of(batch: list[Task]) -> tuple[str, float | str]:
    """Model and exponent, or problem of a file: the fast solver stores tables for each exponent."""
    problem = batch[0].problem
    return batch[0].model, problem.name or problem.k


def compute_with_environment(
    tasks: list[Task], jobs: int, backend: Backend = processes
) -> Generator[tuple[Row, dict[str, str]]]:
    """Evaluate tasks and yield each row, as it is finished, with the environment of the process that computed it.

    A task whose process ends is evaluated once more, alone; if that process ends too, its row has failed.  Closing the
    iterator (`contextlib.closing`) before its end drops what has not begun.

    Parameters
    ----------
    tasks : list of Task
    jobs : int
        Number of processes.
    backend : Backend
        Where they are evaluated.

    Raises
    ------
    ValueError
        If a worker runs other code than this process.
    concurrent.futures.BrokenExecutor
        If the backend cannot work.

    Examples
    --------
    >>> from comparisons.problem import Problem
    >>> task = Task("bradley", "pull_off_force", Problem.dimensionless(2, 0, 1))
    >>> ((row, environment),) = compute_with_environment([task], 1)
    >>> row.value, "cpu" in environment
    (2.0, True)
    """
    _, here = _of_this_process()
    computed = each(
        _evaluate_batch, batches(tasks), jobs, lost=_lost_batch, split=_single, alike=_solid_of, backend=backend
    )
    with closing(computed) as finished:
        for one in finished:
            if changed := differences(here, one.fingerprint):
                raise ValueError(
                    "a worker runs another version of the code, of NumPy or of SciPy than this command "
                    f"({changed}): install the same on every machine, and start the workers again"
                )
            for row in one.rows:
                yield row, one.environment


def compute(tasks: list[Task], jobs: int, backend: Backend = processes) -> Generator[Row]:
    """Evaluate tasks and yield each row as it is finished.

    As `compute_with_environment`.
    """
    with closing(compute_with_environment(tasks, jobs, backend)) as computed:
        for row, _ in computed:
            yield row
