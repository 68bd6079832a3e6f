"""Measurements of tiny sizes, their processes, CPU time and memory; never a time of another machine."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from comparisons.bench import adhesion_package, cold_starts, elements, pull_off, two_workers
from comparisons.bench.measuring import ENDED, cpu_seconds, measured, memory, reset_peak
from comparisons.bench.part import Part
from comparisons.bench.run import FORM
from comparisons.runs.store import Store

#: The pull-off force for n = 2, k = 0, mu = 1.
FORCE = 1.67066478


@pytest.mark.parametrize(
    ("settings", "error"),
    [
        ({"model": "fscm", "accuracy": 1e-4}, 1e-7),  # measured 1.3e-8
        pytest.param({"model": "fem", "accuracy": "quick"}, 1e-6, marks=pytest.mark.heavy),
        # What it leaves out behind f = 50 is 5e-4 of the force.
        ({"model": "fscm-stieltjes", "segments": 120}, 2e-3),
    ],
)
def test_a_solver_computes_the_pull_off_force(settings, error):
    numbers = pull_off.measure({**settings, "n": 2.0, "k": 0.0, "mu": 1.0})
    assert abs(numbers["value"] - FORCE) < error * FORCE
    assert numbers.keys() == {"value", "u_num", "unknowns", "cpu_seconds"}


@pytest.mark.skipif(not adhesion_package.installed(), reason=adhesion_package.INSTALL)
# Remarks of packages that it imports.
@pytest.mark.filterwarnings("ignore")
def test_the_package_adhesion_solves_the_same_problem_in_its_own_units():
    errors = [abs(adhesion_package.pull_off(1.0, 8.0, points, -0.87338)[0] - FORCE) / FORCE for points in (32, 64)]
    # Measured 5e-2 and 1.4e-3: pixels of 1/2 and 1/4, and the tension behind 8.
    assert errors[1] < 3e-3 < errors[0] < 0.1


def test_every_method_solves_the_same_system():
    settings = {"density": 1.2, "k": 0.4, "nu": 0.25, "shape": (0.5, 0.05, 32.0)}
    solved = {method: elements.measure({**settings, "method": method}) for method in elements.METHODS}
    for method, numbers in solved.items():
        assert numbers["displacement"] == pytest.approx(solved["direct"]["displacement"], rel=1e-8)
        assert numbers["unknowns"] == solved["direct"]["unknowns"]
        assert numbers["residual"] < 1e-9
        assert (numbers["iterations"] > 0) == (method == "pyamg")


def test_a_sweep_is_timed_and_one_with_a_failed_case_is_no_measurement(monkeypatch):
    numbers = two_workers.measure({"model": "jkr", "cases": 7, "workers": 2})
    assert 0.0 < numbers["seconds_of_tasks"] <= numbers["seconds"]
    assert 0.0 <= numbers["idle_seconds"] < numbers["seconds_of_tasks"]
    monkeypatch.setattr(two_workers, "evaluate_task", lambda task: SimpleNamespace(status="failed"))
    with pytest.raises(RuntimeError, match="3 of 3 cases have no value"):
        two_workers.measure({"model": "jkr", "cases": 3, "workers": 1})


def test_commands_are_called_from_a_cold_start():
    bare, numbers = (cold_starts.measure({"command": command}) for command in (cold_starts.BARE, "--help"))
    assert (bare["exit_status"], numbers["exit_status"]) == (0, 0)
    assert 0.0 < bare["cpu_seconds"] < numbers["cpu_seconds"]
    with pytest.raises(RuntimeError, match="exit status 2: "):
        cold_starts.measure({"command": "solve --model nothing --n 2 --k 0 --mu 1 --quantity pull_off_force"})


def process_of(settings):
    return {"process": os.getpid()}


def ended(settings):
    os._exit(1)


def made(measure, own_process=True):
    return measured(Part("test", "", None, measure, None, None, None, own_process), {"size": 3})


def test_each_measurement_has_a_process_of_its_own_and_one_that_ends_is_a_failed_measurement():
    processes = [made(process_of, own_process)["numbers"]["process"] for own_process in (True, True, False)]
    assert len({*processes, os.getpid()}) == 3
    assert processes[2] == os.getpid()
    failed = made(ended)
    assert (failed["status"], failed["reason"], failed["settings"]) == ("failed", ENDED, {"size": 3})


def test_every_repetition_is_another_problem_the_first_output_counts_and_a_long_one_is_not_repeated(monkeypatch):
    seen = []
    assert cpu_seconds(lambda repetition: seen.append(repetition) or repetition)[0] == 0
    assert seen == [0, 1, 2]
    clock = iter([0.0, 5.0])
    monkeypatch.setattr("comparisons.bench.measuring.time.process_time", lambda: next(clock))
    assert cpu_seconds(lambda repetition: repetition) == (0, 5.0)


@pytest.mark.skipif(not Path("/proc/self/status").is_file(), reason="the system has no /proc")
def test_the_peak_is_that_since_it_was_reset():
    before = memory()
    large = np.ones(8_000_000)
    del large
    assert memory("VmHWM") >= before + 60.0
    reset_peak()
    if os.access("/proc/self/clear_refs", os.W_OK):
        assert memory("VmHWM") < before + 40.0


def test_an_interrupted_run_keeps_what_is_finished_and_leaves_no_process(tmp_path):
    command = [sys.executable, "-m", "comparisons", "bench", "--only", "growth", "--out", str(tmp_path), "--quiet"]
    # A group of its own, as a shell makes it: Ctrl-C goes to all its processes.
    process = subprocess.Popen(command, stderr=subprocess.PIPE, text=True, process_group=0)
    log = tmp_path / "store.sqlite-wal"
    while process.poll() is None and (not log.exists() or log.stat().st_size < 25_000):
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGINT)
    # The end of the pipe: no process of the run is left that could write to it.
    _, messages = process.communicate(timeout=120)
    assert process.returncode == 130
    assert f"--out {tmp_path}" in messages
    with Store(tmp_path, FORM) as store:
        assert 1 <= len(store.items) < 25
