"""Measurements of tiny sizes, their processes, CPU time and memory; never a time of another machine."""

from pathlib import Path

import numpy as np
import pytest

from comparisons.bench import cold_starts, pull_off
from comparisons.bench.pull_off import cost_of_pull_off, cpu_seconds, peak_memory

#: The pull-off force for n = 2, k = 0, mu = 1.
FORCE = 1.67066478


@pytest.mark.parametrize(
    ("model", "setting", "error"),
    [
        ("fscm", "1e-04", 1e-7),  # measured 1.3e-8
        pytest.param("fem", "quick", 1e-6, marks=pytest.mark.heavy),
        # What it leaves out behind f = 50 is 5e-4 of the force.
        ("fscm-stieltjes", "120", 2e-3),
    ],
)
def test_a_solver_computes_the_pull_off_force(model, setting, error):
    numbers = cost_of_pull_off(2.0, 0.0, 1.0, model, setting)
    assert abs(numbers["value"] - FORCE) < error * FORCE
    assert numbers.keys() == {"value", "u_num", "unknowns", "cpu_seconds", "cold_seconds", "megabytes"}


def test_the_first_problem_is_a_neighbour_and_no_problem_comes_twice(monkeypatch):
    numbers = []
    solver = lambda problem, setting: numbers.append(problem.mu) or (1.0, 0.0, 7)  # noqa: E731
    monkeypatch.setitem(pull_off._SOLVERS, "fscm", solver)
    assert cost_of_pull_off(2.0, 0.0, 3.0, "fscm", "1e-04")["unknowns"] == 7
    assert numbers[:2] == pytest.approx([3.3, 3.0], rel=1e-12)
    assert len(set(numbers)) == len(numbers) > 2


def test_commands_are_called_from_a_cold_start():
    bare, numbers = map(cold_starts.cold_start, (cold_starts.BARE, "--help"))
    assert (bare["exit_status"], numbers["exit_status"]) == (0, 0)
    assert 0.0 < bare["cpu_seconds"] < numbers["cpu_seconds"]
    with pytest.raises(RuntimeError, match="exit status 2: "):
        cold_starts.cold_start("solve --model nothing --n 2 --k 0 --mu 1 --quantity pull_off_force")


def test_every_repetition_is_another_problem_the_first_output_counts_and_a_long_one_is_not_repeated(monkeypatch):
    seen = []
    assert cpu_seconds(lambda repetition: seen.append(repetition) or repetition)[0] == 0
    assert seen == [0, 1, 2]
    clock = iter([0.0, 5.0])
    monkeypatch.setattr("comparisons.bench.pull_off.time.process_time", lambda: next(clock))
    assert cpu_seconds(lambda repetition: repetition) == (0, 5.0)


@pytest.mark.skipif(not Path("/proc/self/status").is_file(), reason="the system has no /proc")
def test_the_peak_of_the_memory_includes_what_is_free_again():
    before = peak_memory()
    large = np.ones(30_000_000)
    del large
    assert peak_memory() >= max(before, 240.0)
