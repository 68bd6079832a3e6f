"""A sweep of small cases with one and with two worker processes."""

from __future__ import annotations

import os
import time
from typing import NamedTuple

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.bench.drawing import bars
from comparisons.bench.part import Numbers, Part, Settings
from comparisons.problem import Problem
from comparisons.runs.tasks import Task, evaluate_task
from comparisons.runs.workers import processes

__all__ = ["WORKERS"]

#: Cases of the sweep.
CASES = 200
#: Gradient exponents and Tabor numbers of the sweep, the largest first as in a run.
_EXPONENTS, _MU = (0.0, 0.1, 0.2, 0.3, 0.4), (1.0, 0.1)
#: Share of a core that a worker has at least on an idle machine; the rest is the transfer of tasks and results.
_IDLE = 0.9


class Timed(NamedTuple):
    """Process of a task, when it began and ended by the clock of all processes, its CPU time and its status."""

    process: int
    begin: float
    end: float
    cpu_seconds: float
    status: str


def plan(full: bool) -> list[Settings]:
    """Return the sweep with one and with two workers."""
    return [{"model": "fscm", "cases": CASES, "workers": workers} for workers in (1, 2)]


def _sweep(model: str, cases: int) -> list[Task]:
    numbers = np.geomspace(*_MU, -(-cases // len(_EXPONENTS)))
    tasks = [
        Task(model, "pull_off_force", Problem.dimensionless(2.0, k, float(mu))) for mu in numbers for k in _EXPONENTS
    ]
    return tasks[:cases]


#: Whether this process has evaluated a task.
_started = False


def _timed(task: Task) -> Timed:
    """Evaluate a task.  The first of a process is evaluated before as well: imports belong to the start."""
    global _started
    if not _started:
        evaluate_task(task)
        _started = True
    begin, cpu = time.time(), time.process_time()
    status = evaluate_task(task).status
    return Timed(os.getpid(), begin, time.time(), time.process_time() - cpu, status)


def measure(settings: Settings) -> Numbers:
    """Return the time of a sweep from the start of the command, and from the begin of its first task.

    ``idle_seconds`` is the time, on average, in which a process had no task after the first began.

    Raises
    ------
    RuntimeError
        If a case fails.
    """
    tasks, begin = _sweep(settings["model"], settings["cases"]), time.time()
    done = [timed for _, timed in processes(_timed, tasks, settings["workers"]) if timed]
    if lost := len(tasks) - sum(timed.status == "ok" for timed in done):
        raise RuntimeError(f"{lost} of {len(tasks)} cases have no value")
    begin_of_tasks, end_of_tasks = min(timed.begin for timed in done), max(timed.end for timed in done)
    busy = sum(timed.end - timed.begin for timed in done) / len({timed.process for timed in done})
    return {
        "seconds": end_of_tasks - begin,
        "seconds_of_tasks": end_of_tasks - begin_of_tasks,
        "cpu_seconds": sum(timed.cpu_seconds for timed in done),
        "idle_seconds": end_of_tasks - begin_of_tasks - busy,
    }


def ratios(rows: pd.DataFrame) -> pd.DataFrame:
    """Add the time with one worker over the time with so many, with and without the start of the processes."""
    single = rows[(rows["workers"] == 1) & (rows["status"] == "ok")].set_index("cases")
    for name, column in (("ratio", "seconds_of_tasks"), ("ratio_with_start", "seconds")):
        rows = rows.assign(**{name: rows["cases"].map(single[column]) / rows[column]})
    return rows


def draw(rows: pd.DataFrame) -> Figure:
    """Draw the time of the sweep as bars."""
    names = [f"{workers:.0f} worker{'s' * (workers > 1)}" for workers in rows["workers"]]
    title = f"Sweep of {rows['cases'].max():.0f} pull-off forces by fscm"
    return bars(names, rows["seconds"], "wall-clock time (s)", title)


def summary(rows: pd.DataFrame) -> list[str]:
    """Return the speed of two workers over that of one, and whether the machine was busy with other work."""
    lines = [
        f"{row['workers']:.0f} workers / 1 on {row['cases']:.0f} cases: {row['ratio']:.2f} times as fast "
        f"({row['ratio_with_start']:.2f} with their start)"
        for row in rows[rows["workers"] > 1].to_dict("records")
    ]
    share = float((rows["cpu_seconds"] / rows["seconds_of_tasks"] / rows["workers"]).min())
    if share < _IDLE:
        lines.append(f"  (the machine was busy: a worker had {share:.2f} of a core; repeat on an idle machine)")
    return lines


WORKERS = Part("workers", "a sweep with one and two worker processes", plan, measure, ratios, draw, summary)
