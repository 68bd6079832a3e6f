"""Measurements of tiny sizes: their numbers, and never a time."""

import math
from types import SimpleNamespace

import pytest

from comparisons.bench import adhesion_package, cold_starts, growth, linear_systems, pull_off, timed_tasks, two_workers
from fscm import Problem

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


def test_the_finite_elements_get_a_physical_problem_whose_load_is_scaled_back(monkeypatch):
    problems = []

    def solve(problem, quantity, accuracy):
        problems.append(problem)
        load = math.pi * problem.punch.Q * problem.law.work_of_adhesion
        return SimpleNamespace(value=FORCE * load, u_num=1e-7 * load, size=10)

    monkeypatch.setattr(pull_off.fem_reference, "solve", solve)
    numbers = pull_off.measure({"model": "fem", "accuracy": "quick", "n": 2.0, "k": 0.0, "mu": 1.0})
    assert numbers["value"] == pytest.approx(FORCE)
    assert numbers["u_num"] == pytest.approx(1e-7)
    # Repetitions are other problems.
    assert len(set(map(repr, problems))) == 3


@pytest.mark.skipif(not adhesion_package.installed(), reason=adhesion_package.INSTALL)
# Remarks of packages that it imports.
@pytest.mark.filterwarnings("ignore")
def test_the_package_adhesion_solves_the_same_problem_in_its_own_units():
    found = [adhesion_package.pull_off(1.0, 8.0, points, -0.87338).force for points in (32, 64)]
    errors = [abs(force - FORCE) / FORCE for force in found]
    # Measured 5e-2 and 1.4e-3: pixels of 1/2 and 1/4, and the tension behind 8.
    assert errors[1] < 3e-3 < errors[0] < 0.1


def test_the_edge_is_narrower_on_a_softer_solid():
    widths = [pull_off.edge_width(Problem(2, 0, mu)) for mu in (0.5, 1.0, 5.0)]
    assert widths == sorted(widths, reverse=True)
    settings = {"varied": "mu", "model": "fscm", "n": 2.0, "k": 0.0, "mu": 1.0, "accuracy": 1e-4}
    assert growth.measure(settings)["edge_width"] == widths[1]


def test_every_method_solves_the_same_system():
    settings = {"density": 1.2, "k": 0.4, "nu": 0.25, "shape": (0.5, 0.05, 32.0)}
    found = {method: linear_systems.measure({**settings, "method": method}) for method in linear_systems.METHODS}
    for method, numbers in found.items():
        assert numbers["displacement"] == pytest.approx(found["direct"]["displacement"], rel=1e-8)
        assert numbers["unknowns"] == found["direct"]["unknowns"]
        assert numbers["residual"] < 1e-9
        assert (numbers["iterations"] > 0) == (method == "pyamg")


@pytest.mark.parametrize("workers", [1, 2])
def test_a_sweep_is_timed(workers):
    numbers = two_workers.measure({"model": "jkr", "cases": 7, "workers": workers})
    assert 0.0 < numbers["seconds_of_tasks"] <= numbers["seconds"]
    assert 0.0 <= numbers["idle_seconds"] < numbers["seconds_of_tasks"]


def test_a_sweep_with_a_failed_case_is_no_measurement(monkeypatch):
    monkeypatch.setattr(timed_tasks, "evaluate_task", lambda task: SimpleNamespace(status="failed"))
    with pytest.raises(RuntimeError, match="3 of 3 cases have no value"):
        two_workers.measure({"model": "jkr", "cases": 3, "workers": 1})


def test_commands_are_called_from_a_cold_start():
    for command in (cold_starts.BARE, "--help"):
        numbers = cold_starts.measure({"command": command})
        assert numbers["exit_status"] == 0
        assert numbers["cpu_seconds"] > 0.0
    with pytest.raises(
        RuntimeError, match=r"exit status 2: .*usage|exit status 2: (fscm-bench|python -m comparisons): "
    ):
        cold_starts.measure({"command": "solve --model nothing --n 2 --k 0 --mu 1 --quantity pull_off_force"})


def test_the_model_of_the_user_is_written_into_an_empty_folder(tmp_path):
    arguments = cold_starts._arguments("run --model my.py:My", tmp_path)
    assert arguments[2:] == ["run", "--model", f"{tmp_path}/my/my.py:My", "--out", f"{tmp_path}/out"]
    assert (tmp_path / "my" / "my.py").is_file()
