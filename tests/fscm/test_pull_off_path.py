"""The short path to a pull-off against the whole path, and the bound that it begins with."""

import pytest

from fscm import Analysis, Problem, solve, solve_together
from fscm import _pull_off_path as short
from fscm._meshes import Meshes
from fscm._threads import one_thread
from tests.fscm.random_problems import problems
from tests.fscm.solved_once import analysis_of
from tests.marks import heavy

# Rigid to soft; (2, 0.6, 3), (5, 0.6, 3) and (1.5, 0.4, 5) have several shallow folds before contact.
CASES = [(1, 0.2, 1), (2, 0.4, 0.5), (2, 0, 0.01), (0.9, 0.1, 2), (2, 0.6, 3), (5, 0.6, 3), (1.5, 0.4, 5)]


@pytest.mark.parametrize("case", [*CASES[:2], *(pytest.param(case, marks=pytest.mark.heavy) for case in CASES[2:])])
def test_the_pull_off_is_that_of_the_whole_path(case: tuple[float, float, float]) -> None:
    problem = Problem(*case)
    with one_thread():
        path = short.pull_off_path(problem, Meshes())
    assert path is not None
    analysis, solutions = analysis_of(problem), solve_together(problem, ("pull_off_force", "pull_off_displacement"))
    assert len(analysis.points) >= len(path)
    for quantity, solution in solutions.items():
        expected = analysis.solution(quantity)
        assert abs(solution.value - expected.value) <= solution.u_num + expected.u_num


@pytest.mark.parametrize("case", [*CASES[:2], pytest.param(CASES[4], marks=pytest.mark.heavy)])
def test_no_state_apart_carries_more_tension_than_the_rigid_solid(case: tuple[float, float, float]) -> None:
    problem = Problem(*case)
    states = [point.state for point in analysis_of(problem).points if not point.state.follows_edge]
    states = [state for state in states if state.central_gap > problem.law.peak_gap]
    assert states
    for state in states:
        assert -state.load <= short.rigid_tension(problem, state.central_gap)


def test_the_bound_is_close_to_the_closed_form() -> None:
    """n = 2: 2 int t(H) dH = 2 [4 / (1 + H)^2 - 1 / (1 + H)^8] / 3."""
    for gap in (0.3, 1.0, 3.0):
        exact = 2.0 * (4.0 / (1.0 + gap) ** 2 - 1.0 / (1.0 + gap) ** 8) / 3.0
        assert exact <= short.rigid_tension(Problem(2, 0.4, 1.0), gap) < 1.05 * exact


def test_the_whole_path_is_followed_where_the_rigid_solid_might_carry_more(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = Problem(2, 0.4, 0.5)
    expected = solve(problem, "pull_off_force")
    monkeypatch.setattr(short, "_start", lambda problem: 0.5)
    monkeypatch.setattr(short, "rigid_tension", lambda problem, gap: 2.0)
    with one_thread():
        assert short.pull_off_path(problem, Meshes()) is None
    model = Analysis(problem)
    force = model.solution("pull_off_force")
    assert "_traced" in model.__dict__
    assert abs(force.value - expected.value) <= force.u_num + expected.u_num


@pytest.mark.parametrize("index", [452, *heavy(456)])
def test_a_bound_above_the_request_is_reduced(index: int) -> None:
    """On the meshes of 1e-6 the bounds are 1.3e-6 and 1.9e-6 of the force."""
    force = solve(problems()[index], "pull_off_force", 1e-6)
    assert force.u_num <= 1e-6 * force.value
