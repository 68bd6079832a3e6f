"""Tasks of a sweep with the times at which a worker process began and ended them.

Worker processes import this module and what it needs, but no tables and figures.
"""

from __future__ import annotations

import os
import time
from dataclasses import dataclass

import numpy as np

from comparisons.runs.cases import Case
from comparisons.runs.tasks import Task, evaluate_task

__all__ = ["EXPONENTS", "Timed", "exponent", "idle_seconds", "sweep", "timed"]

#: Gradient exponents k of the sweep.
EXPONENTS = (0.0, 0.1, 0.2, 0.3, 0.4)
_LEAST_MU, _LARGEST_MU = 0.1, 1.0


@dataclass(frozen=True, slots=True)
class Timed:
    """Process of a task, when it began and ended by the clock of all processes, its CPU time and its status."""

    process: int
    begin: float
    end: float
    cpu_seconds: float
    status: str


def sweep(model: str, cases: int) -> list[Task]:
    """Return so many small cases of a model, in the order of a run: the largest Tabor numbers first.

    Examples
    --------
    >>> [(task.case.k, task.case.mu) for task in sweep("jkr", 6)]
    [(0.0, 1.0), (0.1, 1.0), (0.2, 1.0), (0.3, 1.0), (0.4, 1.0), (0.0, 0.1)]
    """
    numbers = np.geomspace(_LARGEST_MU, _LEAST_MU, -(-cases // len(EXPONENTS)))
    found = [Task(model, "pull_off_force", Case(2.0, k, float(mu))) for mu in numbers for k in EXPONENTS]
    return found[:cases]


def exponent(task: Task) -> float:
    """Return what the tables of the solver depend on."""
    return task.case.k


#: Whether this process has evaluated a task.
_started = False


def timed(task: Task) -> Timed:
    """Evaluate a task.  The first of a process is evaluated before as well: imports belong to the start."""
    global _started
    if not _started:
        evaluate_task(task)
        _started = True
    begin, cpu = time.time(), time.process_time()
    status = evaluate_task(task).status
    return Timed(os.getpid(), begin, time.time(), time.process_time() - cpu, status)


def idle_seconds(done: list[Timed]) -> dict[int, float]:
    """Return the time that each process had no task in, from the first begin of all to the last end of all.

    Examples
    --------
    >>> idle_seconds([Timed(7, 0.0, 2.0, 2.0, "ok"), Timed(8, 0.5, 1.0, 0.5, "ok"), Timed(8, 1.0, 1.5, 0.5, "ok")])
    {7: 0.0, 8: 1.0}
    """
    whole = max(one.end for one in done) - min(one.begin for one in done)
    processes = sorted({one.process for one in done})
    return {name: whole - sum(one.end - one.begin for one in done if one.process == name) for name in processes}
