"""Measurements of tiny sizes, their processes, CPU time and memory; never a time of another machine."""

from pathlib import Path

import numpy as np
import pytest

from comparisons.bench import cold_starts, work_precision
from comparisons.bench.work_precision import cost_of_pull_off, peak_memory

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
    assert abs(cost_of_pull_off(2.0, 0.0, 1.0, model, setting)["value"] - FORCE) < error * FORCE


def test_no_problem_comes_twice_the_first_output_counts_and_a_long_one_is_not_repeated(monkeypatch):
    """The first problem is a neighbour, the second that of the measurement; the clock ticks before and after each."""
    solved = []
    solver = lambda problem, setting: solved.append(problem.mu) or {"value": problem.mu, "unknowns": 7}  # noqa: E731  # one line
    monkeypatch.setitem(work_precision._SOLVERS, "fscm", solver)
    for ticks, count, seconds in (([0, 0.125, 10, 10.5, 20, 20.25, 30, 31], 4, 0.25), ([0, 0.125, 10, 15], 2, 5)):
        solved.clear()
        clock = iter(ticks)
        monkeypatch.setattr("comparisons.bench.work_precision.time.process_time", lambda clock=clock: next(clock))
        numbers = cost_of_pull_off(2.0, 0.0, 3.0, "fscm", "1e-04")
        assert solved[:2] == pytest.approx([3.3, 3.0], rel=1e-12)
        assert len(set(solved)) == len(solved) == count
        assert (numbers["value"], numbers["unknowns"]) == (3.0, 7)
        assert (numbers["cold_seconds"], numbers["cpu_seconds"]) == (0.125, seconds)


def test_commands_are_called_from_a_cold_start():
    bare, numbers = map(cold_starts.cold_start, (cold_starts.BARE, "--help"))
    assert (bare["exit_status"], numbers["exit_status"]) == (0, 0)
    assert 0.0 < bare["cpu_seconds"] < numbers["cpu_seconds"]
    with pytest.raises(RuntimeError, match="exit status 2: "):
        cold_starts.cold_start("solve --model nothing --n 2 --k 0 --mu 1 --quantity pull_off_force")


@pytest.mark.skipif(not Path("/proc/self/status").is_file(), reason="the system has no /proc")
def test_the_peak_of_the_memory_includes_what_is_free_again():
    before = peak_memory()
    large = np.ones(30_000_000)
    del large
    assert peak_memory() >= max(before, 240.0)
