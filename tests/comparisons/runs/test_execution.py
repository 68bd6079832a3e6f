"""Execution of tasks: the environment of every row, workers of other code, time left."""

import math
from dataclasses import replace

import pytest

from comparisons.problem import Problem
from comparisons.runs import execution
from comparisons.runs.execution import compute_with_environment
from comparisons.runs.tasks import Task, evaluate_task
from comparisons.runs.time_left import TimeLeft
from comparisons.runs.workers import LOST, processes

TASKS = [
    Task("bradley", quantity, Problem.dimensionless(2, 0, mu))
    for mu in (2, 1)
    for quantity in ("pull_off_force", "jump_in_gap")
]


def elsewhere(environment, code):
    """A backend whose worker has another environment and perhaps other code."""

    def backend(function, items, jobs):
        for item in items:
            yield item, execution._Computed(function(item).rows, environment, code)

    return backend


def test_a_row_has_the_environment_of_its_worker():
    _, here = execution._of_this_process()
    computed = list(compute_with_environment(TASKS, 1, elsewhere({"cpu": "another"}, here)))
    assert [row.key for row, _ in computed] == [task.key for task in TASKS]
    assert all(environment == {"cpu": "another"} for _, environment in computed)


def test_a_worker_of_other_code_is_refused():
    _, here = execution._of_this_process()
    with pytest.raises(ValueError, match=r"a worker runs another version .*NumPy .*, now NumPy 0\.") as refused:
        list(compute_with_environment(TASKS, 1, elsewhere({}, here.replace("NumPy ", "NumPy 0."))))
    assert "install the same on every machine" in str(refused.value)


def test_a_task_that_ends_its_process_costs_its_own_row():
    def backend(function, items, jobs):
        for item in items:
            yield item, None if TASKS[0] in item else function(item)

    rows = {row.key: row for row, _ in compute_with_environment(TASKS, 1, backend)}
    assert [rows[task.key].status for task in TASKS] == ["failed", "not-applicable", "ok", "not-applicable"]
    assert rows[TASKS[0].key].reason == LOST


def test_the_time_left_only_falls_and_ends_at_zero():
    """Rows of two models, the cheap ones much cheaper than stated, and a machine that is slow for a while."""
    cheap = [evaluate_task(Task("jkr", "pull_off_force", Problem.dimensionless(2, 0, mu))) for mu in range(1, 21)]
    tasks = [Task("jkr", "pull_off_force", Problem.dimensionless(2, 0, mu)) for mu in range(1, 21)]
    dear = [Task("fem", "pull_off_force", Problem.dimensionless(2, 0, mu)) for mu in range(1, 6)]
    time = [0.0]
    left = TimeLeft([*tasks, *dear], clock=lambda: time[0])
    seen = []
    for row in cheap:
        time[0] += 0.05
        seen.append(left.after(row))
    for number, task in enumerate(dear):
        seconds = 20.0 if number == 1 else 4.0
        time[0] += seconds
        seen.append(left.after(replace(cheap[0], model=task.model, seconds=seconds)))
    assert seen == sorted(seen, reverse=True)
    assert seen[-1] == 0.0
    assert all(value > 0 for value in seen[:-1])
    # Before the first row of the dear model is there, nothing is known of its cost.
    assert seen[:20] == [math.inf] * 20
    assert math.isfinite(seen[20])


def test_the_first_of_many_tasks_give_no_estimate():
    """A closed form that ends at once while the first task of a solver is at work: the start of a run."""
    tasks = [
        Task(model, "pull_off_force", Problem.dimensionless(2, 0, mu))
        for mu in range(1, 101)
        for model in ("jkr", "fscm")
    ]
    row = evaluate_task(tasks[0])
    time = [2.0]
    left = TimeLeft(tasks, clock=lambda: time[0])
    estimates = []
    for task in tasks[:-2]:
        time[0] += 0.1 if task.model == "fscm" else 1e-4
        estimates.append(left.after(replace(row, model=task.model, seconds=0.1 if task.model == "fscm" else 1e-5)))
    # A twentieth of the rows of both models.
    assert estimates[:9] == [math.inf] * 9
    assert 9.0 < estimates[9] < 11.0
    assert max(estimates[9:]) == estimates[9]


def test_a_row_does_not_depend_on_what_its_process_computed_before():
    """Of the solver, which keeps meshes and paths: in one process, and each alone in the other order."""
    quantities = ("pull_off_force", "jump_out_displacement")
    tasks = [Task("fscm", quantity, Problem.dimensionless(2, 0.4, mu)) for mu in (1.5, 1) for quantity in quantities]
    together = {row.key: replace(row, seconds=0) for row, _ in compute_with_environment(tasks, 1)}
    alone = {row.key: replace(row, seconds=0) for _, row in processes(evaluate_task, tasks[::-1], 2)}
    assert alone == together
