"""Work on every core: each item once, in processes of one thread, and the rows of tasks with their origin."""

import os
import signal
import subprocess
import sys
import time
from concurrent.futures import BrokenExecutor, Future, ThreadPoolExecutor
from dataclasses import replace
from types import SimpleNamespace

import pytest

from comparisons.model import Result
from comparisons.problem import Problem
from comparisons.runs import workers
from comparisons.runs.computation import compute
from comparisons.runs.tasks import Task, evaluate, evaluate_task
from comparisons.runs.workers import LOST, each, processes
from tests.comparisons.calls import end, fail, nap, threads


def test_one_job_needs_no_worker_and_no_item_no_work():
    assert [process for process, _ in each(threads, [1, 2], 1, lost=str)] == [os.getpid()] * 2
    assert list(each(threads, [], 2, lost=str)) == []


def test_an_exception_of_the_function_is_raised():
    with pytest.raises(ValueError, match="is refused"):
        list(each(fail, [1], 2, lost=str))


def test_an_item_whose_process_ends_is_tried_once_more_and_the_others_go_on(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "2")
    once = str(tmp_path / "once")
    items = ["a", "always", once, "b", "c"]
    outputs = list(each(end, items, 2, lost=lambda item: (item, None)))
    assert dict(outputs) == dict.fromkeys(items, (1,)) | {"always": None}
    assert "(2) is tried once more" in capsys.readouterr().err


def test_processes_that_cannot_work_are_given_up(monkeypatch):
    monkeypatch.setattr(workers, "_DEATHS_IN_SEQUENCE", 2)
    monkeypatch.setattr(workers, "processes", lambda function, items, jobs: ((item, None) for item in items))
    with pytest.raises(BrokenExecutor, match="3 worker processes"):
        list(each(end, ["always"] * 5, 2, lost=str))


def test_processes_end_with_the_call_also_those_at_work():
    outputs = processes(nap, [0, 600, 600], 2)
    _, process = next(outputs)
    started = time.monotonic()
    outputs.close()
    assert time.monotonic() - started < 60
    with pytest.raises(ProcessLookupError):
        os.kill(process, 0)


INTERRUPTED = """
import os, signal, threading
from comparisons.runs.workers import each
threading.Timer({seconds}, os.killpg, (0, signal.SIGINT)).start()
try:
    list(each(sum, [range(10**13)] * 9, 2, lost=sum))
except KeyboardInterrupt:
    pass
"""


@pytest.mark.parametrize("seconds", [0.3, *(pytest.param(seconds, marks=pytest.mark.heavy) for seconds in (0.05, 1.5))])
def test_ctrl_c_leaves_no_traceback(seconds):
    """While the processes start, and while they work."""
    command = [sys.executable, "-c", INTERRUPTED.format(seconds=seconds)]
    ended = subprocess.run(command, process_group=0, capture_output=True, text=True, timeout=600)
    assert (ended.returncode, ended.stderr) == (0, "")


def test_an_interruption_waits_until_all_items_are_queued(monkeypatch):
    queued = []

    class Interrupted(ThreadPoolExecutor):
        def submit(self, *call):
            os.kill(os.getpid(), signal.SIGINT)
            queued.append(call[-1])
            return Future()

    monkeypatch.setattr(workers, "ThreadPoolExecutor", Interrupted)
    with pytest.raises(KeyboardInterrupt):
        list(each(nap, [1, 2, 3], 2, lost=str))
    assert queued == [1, 2, 3]
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


TASKS = [
    Task("bradley", quantity, Problem.dimensionless(2, 0, mu))
    for mu in (2, 1)
    for quantity in ("pull_off_force", "jump_in_gap")
]


def test_a_task_that_ends_its_process_costs_its_own_row(monkeypatch):
    """The others of its batch are tried again, each alone."""
    tried = []

    def tasks_that_end(function, items, jobs):
        tried.append([len(item) for item in items])
        for item in items:
            yield item, None if TASKS[0] in item else function(item)

    monkeypatch.setattr(workers, "processes", tasks_that_end)
    rows = {row.key: row for row in compute(TASKS, 1)}
    assert tried == [[2, 2], [1, 1]]
    assert [rows[task.key].status for task in TASKS] == ["failed", "not-applicable", "ok", "not-applicable"]
    assert rows[TASKS[0].key].reason == LOST


def test_the_time_of_a_row_is_that_of_the_model_or_else_measured():
    timed, sphere = SimpleNamespace(name="timed", version="1"), Problem.dimensionless(2, 0, 1)
    timed.evaluate = lambda *_: Result(1.0, 0.0, seconds=7.0)
    assert evaluate(timed, "pull_off_force", sphere).seconds == 7.0
    timed.evaluate = lambda *_: Result(1.0, 0.0)
    assert 0.0 < evaluate(timed, "pull_off_force", sphere).seconds < 7.0


def test_a_row_does_not_depend_on_what_its_process_computed_before():
    """Of the solver, which keeps meshes and paths: in one process, and each alone in the other order."""
    evaluations = (("jump_out_displacement", 1.5), ("jump_out_displacement", 1), ("pull_off_force", 1))
    tasks = [Task("fscm", quantity, Problem.dimensionless(2, 0.4, mu)) for quantity, mu in evaluations]
    together = {row.key: replace(row, seconds=0) for row in compute(tasks, 1)}
    alone = {row.key: replace(row, seconds=0) for _, row in processes(evaluate_task, tasks[::-1], 2)}
    assert alone == together
