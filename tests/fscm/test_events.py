"""Events and quantities: reference values, limits, the pull-off without the whole path, several at once, refusals."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fscm import (
    Analysis,
    Coating,
    LennardJones,
    Mie,
    NoSuchEvent,
    PowerPunch,
    Problem,
    RoundedCone,
    Solution,
    profile,
    solve,
    solve_together,
    trace,
)
from fscm import _known_minimum as known_module
from fscm import analysis as module
from fscm._known_minimum import known_minimum
from fscm._path import pull_off_path as short
from fscm._threads import one_thread
from fscm.accuracy import Meshes
from fscm.folds import folds_between
from fscm.quantities import TABLE
from tests.fscm.random_problems import problems
from tests.fscm.solved_once import analysis_of
from tests.marks import heavy
from tests.reference_values import REFERENCE_VALUES, ReferenceValue


@pytest.mark.parametrize("row", REFERENCE_VALUES, ids=str)
def test_reference_values_to_every_digit(row: ReferenceValue) -> None:
    solution = analysis_of(Problem(row.n, row.k, row.mu)).solution(row.quantity)
    assert abs(solution.value - row.value) <= 0.5 * row.last_digit + solution.u_num
    assert solution.u_num < 0.1 * row.last_digit


@pytest.mark.parametrize(
    ("k", "printed"),
    [(0.4, 0.78), *heavy((0.0, 0.70), (0.2, 0.75), (0.6, 0.78))],
)
def test_critical_tabor_numbers(k: float, printed: float) -> None:
    """Sec. 3.3; and hysteresis exists just above and not just below."""
    solution = solve(Problem(2, k, 1.0), "critical_tabor_number")
    assert round(solution.value, 2) == printed
    assert solution.u_num < 1e-7
    with pytest.raises(NoSuchEvent, match="critical Tabor number"):
        solve(Problem(2, k, solution.value * (1 - 2e-3)), "jump_in_displacement")
    assert solve(Problem(2, k, solution.value * (1 + 2e-3)), "hysteresis_energy").value > 0


def _bradley(n: float) -> float:
    """Eq. 56."""
    b1 = math.gamma(3 - 2 / n) * math.gamma(2 / n) / math.gamma(3)
    b2 = math.gamma(4 - 2 / n) * math.gamma(6) / math.gamma(10 - 2 / n)
    return 32 * n ** (2 / n) / (9 * n - 2) * b1 * (168 * b2) ** ((3 - 2 / n) / 6)


@pytest.mark.parametrize(("n", "k"), [(1.0, 0.0), (2.0, 0.6), (100.0, 0.2), *heavy((1.5, 0.6), (5.0, 0.0))])
def test_rigid_limit(n: float, k: float) -> None:
    """mu -> 0 is Bradley; the deviation is linear in the compliance M."""
    deviations = []
    for M in (2e-4, 1e-4):
        mu = (M / 2) ** (n / (2 * n + k - 1))
        deviations.append(solve(Problem(n, k, mu), "pull_off_force").value - _bradley(n))
    assert abs(deviations[1]) < 1e-3
    assert deviations[0] / deviations[1] == pytest.approx(2.0, rel=1e-3)


# Rigid to soft; (2, 0.6, 3), (5, 0.6, 3) and (1.5, 0.4, 5) have several shallow folds before contact.
CASES = [(1, 0.2, 1), (2, 0.4, 0.5), (2, 0, 0.01), (0.9, 0.1, 2), (2, 0.6, 3), (5, 0.6, 3), (1.5, 0.4, 5)]


@pytest.mark.parametrize("case", [*CASES[:2], *(pytest.param(case, marks=pytest.mark.heavy) for case in CASES[2:])])
def test_the_pull_off_of_the_short_path_is_that_of_the_whole_path(
    case: tuple[float, float, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    problem = Problem(*case)
    with one_thread():
        path = short.pull_off_path(problem, Meshes())
    assert path is not None
    assert len(analysis_of(problem).points) >= len(path)
    monkeypatch.setattr(module, "known_minimum", lambda problem, meshes: None)
    assert_pull_off_is_that_of_the_whole_path(problem)


# Corners of the range of the atlas; flat and sharp, rigid and soft.
KNOWN = [
    (2, 0.4, 0.5),
    (1, 0, 0.3),
    *heavy(((1, 0.6, 5),), ((6, 0.8, 0.01),), ((6, 0, 10),), ((1, 0.8, 10),), ((1, 0, 0.01),)),
]


@pytest.mark.parametrize("case", KNOWN)
def test_the_pull_off_from_the_stored_states_is_that_of_the_whole_path(
    case: tuple[float, float, float], monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(problem: Problem, meshes: Meshes) -> None:
        raise AssertionError("no path is needed")

    monkeypatch.setattr(module, "pull_off_path", refuse)
    assert_pull_off_is_that_of_the_whole_path(Problem(*case))


@pytest.mark.heavy
def test_a_path_is_rarely_needed_in_the_range_of_the_atlas() -> None:
    random = np.random.default_rng(20261129)
    parameters = 1.0 / random.uniform(1 / 6, 1, 100), random.uniform(0, 0.8, 100), 10.0 ** random.uniform(-2, 1, 100)
    with one_thread():
        brackets = [known_minimum(Problem(*map(float, case)), Meshes()) for case in zip(*parameters, strict=True)]
    assert sum(bracket is None for bracket in brackets) <= 1


def test_a_minimum_that_the_atlas_does_not_have_is_not_taken(monkeypatch: pytest.MonkeyPatch) -> None:
    """Another minimum of the load is at most 0.27 times as deep as the deepest one."""
    problem, value = Problem(2, 0.4, 0.5), known_module.atlas
    for share in (0.27, 1.0 / 0.27):
        monkeypatch.setattr(known_module, "atlas", lambda *at: value(*at)._replace(value=share * value(*at).value))  # noqa: B023
        with one_thread():
            assert known_minimum(problem, Meshes()) is None
    force = Analysis(problem).solution("pull_off_force")
    monkeypatch.undo()
    expected = solve(problem, "pull_off_force")
    assert abs(force.value - expected.value) <= force.u_num + expected.u_num


OTHERS = [
    Problem(6.1, 0.4, 0.5),
    Problem(2, 0.81, 0.5),
    Problem(2, 0, 10.1),
    Problem(2, 0, 1.0, law=Mie(m=12, n=6)),
    Problem(2, 0, 1.0, punch=RoundedCone(2.0)),
    Problem(Coating(3.0, 1.0, 1.0, 0.5, 0.3), PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0)),
]


@pytest.mark.parametrize("problem", OTHERS, ids=str)
def test_states_are_known_only_of_power_laws_in_the_range_of_the_atlas(
    monkeypatch: pytest.MonkeyPatch, problem: Problem
) -> None:
    def refuse(problem: Problem, meshes: Meshes) -> None:
        raise AssertionError("no state of this problem is stored")

    monkeypatch.setattr(known_module, "_first", refuse)
    assert known_minimum(problem.dimensionless, Meshes()) is None


def assert_pull_off_is_that_of_the_whole_path(problem: Problem) -> None:
    analysis, solutions = Analysis(problem), solve_together(problem, ("pull_off_force", "pull_off_displacement"))
    assert analysis.points
    for quantity, solution in solutions.items():
        expected = analysis.solution(quantity)
        assert abs(solution.value - expected.value) <= solution.u_num + expected.u_num


@pytest.mark.parametrize("case", [*CASES[:2], pytest.param(CASES[4], marks=pytest.mark.heavy)])
def test_no_state_apart_carries_more_tension_than_the_rigid_solid(case: tuple[float, float, float]) -> None:
    problem = Problem(*case)
    states = [point.state for point in analysis_of(problem).points if not point.state.anchor.in_contact]
    states = [state for state in states if state.central_gap > problem.law.peak_gap]
    assert states
    for state in states:
        assert -state.load <= short.rigid_tension(problem, state.central_gap)


def test_the_whole_path_is_followed_where_the_rigid_solid_might_carry_more(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = Problem(2, 0.4, 0.5)
    expected = solve(problem, "pull_off_force")
    monkeypatch.setattr(module, "known_minimum", lambda problem, meshes: None)
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


# A stiff solid, which does not jump, and a soft one.
STIFF, SOFT = Problem(2, 0, 0.1), Problem(2, 0.4, 1.0)
PATH_QUANTITIES = [name for name in TABLE if name != "critical_tabor_number"]


def test_quantities_of_one_path_together_are_those_alone() -> None:
    solutions = solve_together(SOFT, reversed(PATH_QUANTITIES))
    assert list(solutions) == PATH_QUANTITIES[::-1]
    for name in ("jump_out_gap", "hysteresis_energy"):
        solution = solutions[name]
        assert isinstance(solution, Solution)
        assert solution.value == pytest.approx(solve(SOFT, name).value, rel=1e-12)


@pytest.mark.parametrize("problem", [STIFF, Problem(2, 1, 0.3)], ids=["graded", "Gibson"])
def test_a_quantity_that_does_not_exist_is_returned_as_the_exception(problem: Problem) -> None:
    solutions = solve_together(problem, PATH_QUANTITIES)
    missing = {name for name, solution in solutions.items() if isinstance(solution, NoSuchEvent)}
    assert missing == {name for name in PATH_QUANTITIES if name.startswith("jump") or name == "hysteresis_energy"}
    assert solutions["pull_off_force"].value > 0


@pytest.mark.parametrize("problem", [STIFF, Problem(2, 1, 0.3)], ids=["graded", "Gibson"])
def test_an_unknown_quantity_or_accuracy_is_refused_before_anything_is_computed(problem: Problem) -> None:
    with pytest.raises(ValueError, match="unknown quantity 'weight'; known are pull_off_force"):
        solve_together(problem, ["pull_off_force", "weight"])
    with pytest.raises(ValueError, match="unknown accuracy 'best'; it is a relative error or one of quick"):
        solve(problem, "pull_off_force", accuracy="best")


def test_an_unknown_event_is_refused_with_the_known_names() -> None:
    with pytest.raises(ValueError, match="unknown event 'jump_in_gap'; known are pull_off, jump_in, jump_out, zero"):
        Analysis(STIFF).event("jump_in_gap")
    with pytest.raises(ValueError, match="unknown jump 'pull_off'; known are jump_in, jump_out"):
        Analysis(STIFF).landing("pull_off")


def test_paths_and_fields_are_as_accurate_as_requested() -> None:
    coarse, fine = (trace(SOFT, accuracy) for accuracy in (1e-6, 1e-9))
    assert fine.u_load < 0.1 * coarse.u_load
    assert abs(coarse.load.min() - fine.load.min()) <= coarse.u_load + fine.u_load
    coarse, fine = (profile(SOFT, "zero_load", accuracy) for accuracy in (1e-6, 1e-9))
    assert coarse.radius.size < fine.radius.size
    inner = coarse.radius < 3.0
    between = np.interp(coarse.radius[inner], fine.radius, fine.gap)
    np.testing.assert_allclose(coarse.gap[inner], between, atol=1e-2)  # linear between the nodes of the finer mesh


def _point(segment: int, load_rate: float) -> SimpleNamespace:
    rates = SimpleNamespace(load=load_rate, displacement=-1.0)
    return SimpleNamespace(segment=segment, rates=rates, state=SimpleNamespace(parameter="gap", orientation=-1.0))


def test_a_fold_at_a_change_of_segment_is_a_fold() -> None:
    """The last state of a segment is the first of the next, on another mesh: in a coil its rates may change sign."""
    before, after = _point(0, -1e-11), _point(1, 1e-11)
    assert folds_between(before, after) == [(after.state, "load", False)]
    assert folds_between(before, _point(1, -1e-11)) == []


@pytest.mark.heavy
@pytest.mark.parametrize("mu", [1e4, 3e4, 1e5])
def test_the_jump_out_at_large_tabor_numbers_is_that_of_jkr(mu: float) -> None:
    """At mu = 3e4 the path coils up seven times where contact begins, and no part in contact was found to be stable."""
    solution = solve(Problem(2, 0, mu), "jump_out_displacement")
    assert solution.value == pytest.approx(-0.75 * math.pi ** (2.0 / 3.0) * mu, rel=1e-7)
