"""Events against reference values, numbers of the paper, limits and each other."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fscm import Analysis, NoSuchEvent, Problem, solve, solve_together
from fscm._continuation import equilibrium_path
from fscm._events import brackets, displacement_fold
from fscm.critical import critical_tabor_number
from tests.reference_values import REFERENCE_VALUES, ReferenceValue


@pytest.mark.parametrize("known", REFERENCE_VALUES, ids=str)
def test_reference_values_to_every_digit(known: ReferenceValue) -> None:
    solution = solve(Problem(known.n, known.k, known.mu), known.quantity)
    assert abs(solution.value - known.value) <= 0.5 * known.last_digit + solution.u_num
    assert solution.u_num < 0.1 * known.last_digit


@pytest.mark.parametrize(
    ("k", "printed"),
    [(0.0, 0.70), (0.4, 0.78), *(pytest.param(k, mu, marks=pytest.mark.heavy) for k, mu in ((0.2, 0.75), (0.6, 0.78)))],
)
def test_critical_tabor_numbers(k: float, printed: float) -> None:
    """Sec. 3.3; and hysteresis exists just above and not just below."""
    solution = solve(Problem(2, k, 1.0), "critical_tabor_number")
    assert round(solution.value, 2) == printed
    assert solution.u_num < 1e-7
    with pytest.raises(NoSuchEvent, match="critical Tabor number"):
        solve(Problem(2, k, solution.value * (1 - 2e-3)), "jump_in_displacement")
    assert solve(Problem(2, k, solution.value * (1 + 2e-3)), "hysteresis_energy").value > 0


def test_folds_vanish_as_the_critical_number_is_approached() -> None:
    """The distance of two merging folds falls like (mu - mu_c)^(3/2): the exact rate sees a real cusp."""
    critical = critical_tabor_number(Problem(2, 0, 1.0)).value
    distance = []
    for excess in (0.02, 0.005):
        model = Analysis(Problem(2, 0, critical * (1 + excess)))
        pair = [model.solution(f"jump_{x}_displacement").value for x in ("in", "out")]
        distance.append(pair[0] - pair[1])
    assert math.log(distance[0] / distance[1], 4.0) == pytest.approx(1.5, abs=0.05)


def _bradley(n: float) -> float:
    """Eq. 56."""
    b1 = math.gamma(3 - 2 / n) * math.gamma(2 / n) / math.gamma(3)
    b2 = math.gamma(4 - 2 / n) * math.gamma(6) / math.gamma(10 - 2 / n)
    return 32 * n ** (2 / n) / (9 * n - 2) * b1 * (168 * b2) ** ((3 - 2 / n) / 6)


@pytest.mark.parametrize("n", [1.0, 1.5, 2.0, 5.0])
@pytest.mark.parametrize("k", [0.0, 0.6])
def test_rigid_limit(n: float, k: float) -> None:
    """mu -> 0 is Bradley; the deviation is linear in the compliance M."""
    deviations = []
    for M in (2e-4, 1e-4):
        mu = (M / 2) ** (n / (2 * n + k - 1))
        deviations.append(solve(Problem(n, k, mu), "pull_off_force").value - _bradley(n))
    assert abs(deviations[1]) < 1e-3
    assert deviations[0] / deviations[1] == pytest.approx(2.0, rel=1e-3)


def _jkr(n: float, k: float, mu: float) -> float:
    """Eq. 57."""
    beta = math.gamma(n / 2) * math.gamma((1 + k) / 2) / math.gamma((n + 1 + k) / 2)
    first = (math.cos(k * math.pi / 2) / (2 * math.pi * (1 - k))) ** (n - 2)
    second = ((k + 3) / (n * beta)) ** (k + 3)
    factor = 2 * (2 * n + k - 1) / ((1 + k) * (n + k + 1))
    return factor * (first * second) ** (1 / (2 * n + k - 1)) * mu ** ((2 - n) / n)


@pytest.mark.parametrize(
    ("n", "k"),
    [(1.5, 0.2), *(pytest.param(n, k, marks=pytest.mark.heavy) for n, k in ((2.0, 0.0), (2.0, 0.4), (3.0, 0.3)))],
)
def test_soft_limit(n: float, k: float) -> None:
    """mu -> infinity is JKR; the deviation keeps falling."""
    deviations = [abs(solve(Problem(n, k, mu), "pull_off_force").value / _jkr(n, k, mu) - 1) for mu in (2.5, 5, 10)]
    assert deviations[2] < deviations[1] < deviations[0]
    assert deviations[2] < 0.02


def test_continuity_as_k_vanishes() -> None:
    """k -> 0 tends to the homogeneous solid, linearly in k."""
    names = ("pull_off_force", "pull_off_displacement", "zero_load_displacement")
    base, *near_0 = (solve_together(Problem(2, k, 1.0), names) for k in (0.0, 1e-8, 2e-3, 1e-3))
    for name in names:
        changes = [found[name].value - base[name].value for found in near_0]
        assert abs(changes[0]) < 1e-7
        assert changes[1] / changes[2] == pytest.approx(2.0, rel=1e-2)


@pytest.mark.parametrize("n", [2.0, pytest.param(1.5, marks=pytest.mark.heavy)])
def test_gibson_limit(n: float) -> None:
    """k -> 1 tends to the pointwise solid, linearly in 1 - k."""
    limit = solve(Problem(n, 1.0, 0.5), "pull_off_force").value
    changes = [solve(Problem(n, k, 0.5), "pull_off_force").value - limit for k in (0.9, 0.95, 0.98)]
    assert abs(changes[2]) < 6e-3
    assert changes[0] / changes[1] == pytest.approx(2.0, rel=0.02)
    assert changes[1] / changes[2] == pytest.approx(2.5, rel=0.02)


def _obeys_what_all_obey(n: float, k: float, log_mu: float) -> None:
    """Signs, order of events, and stationarity of the load at pull-off; other tests have values of random problems."""
    problem = Problem(n, k, math.exp(log_mu))
    if (1.03 * problem.compliance) ** (-1 / (1 - k)) < 1e-4:
        return
    model = Analysis(problem)
    force = model.solution("pull_off_force")
    assert force.value > 0
    assert force.u_num < 1e-6 * force.value
    pair = model.event("pull_off")
    assert pair.value.rates("log_scale" if pair.value.follows_edge else "gap").load == pytest.approx(0, abs=1e-6)
    assert model.solution("pull_off_displacement").value < model.solution("zero_load_displacement").value
    # The largest tension anywhere is the strength of the law.
    assert pair.value.pressure.min() > -16 * math.sqrt(3) / 27 - 1e-12
    if brackets(model.points, displacement_fold, rising=False):
        jump_in, jump_out = (model.solution(f"jump_{x}_displacement").value for x in ("in", "out"))
        assert jump_out < jump_in < 0
        assert model.solution("jump_out_gap").value < model.solution("jump_in_gap").value


PROBLEMS = {"n": st.floats(1.0, 6.0), "k": st.floats(0.0, 0.8), "log_mu": st.floats(math.log(0.01), math.log(3.0))}


@given(**PROBLEMS)
@settings(max_examples=3, deadline=None)
def test_random_problems_obey_what_all_obey(n: float, k: float, log_mu: float) -> None:
    _obeys_what_all_obey(n, k, log_mu)


@pytest.mark.heavy
@given(**PROBLEMS)
@settings(max_examples=60, deadline=None)
def test_many_random_problems_obey_what_all_obey(n: float, k: float, log_mu: float) -> None:
    _obeys_what_all_obey(n, k, log_mu)


def test_edge_of_an_extreme_problem_is_resolved() -> None:
    """k = 0.8, mu = 2.5: the cohesive edge is 5e-6 wide, and the tension at it still reaches the strength."""
    state = Analysis(Problem(2, 0.8, 2.5)).event("pull_off").value
    nodes = np.sort(np.abs(state.disc.mesh.nodes - 1.0))
    assert nodes[20] < 5e-6 / state.scale
    assert state.pressure.min() == pytest.approx(-16 * math.sqrt(3) / 27, rel=1e-3)


@pytest.mark.parametrize(
    ("n", "k", "mu"),
    [
        (2.0, 0.6, 3.0),
        (6.0, 0.1, 8.0),
        *(pytest.param(*case, marks=pytest.mark.heavy) for case in ((3.3, 0.5, 4.0), (1.6, 0.7, 1.5))),
    ],
)
def test_jump_in_is_the_first_fold_of_a_finely_stepped_path(n: float, k: float, mu: float) -> None:
    """No fold is stepped over: steps ten times shorter meet the same first fold."""
    problem = Problem(n, k, mu)
    previous = None
    for point in equilibrium_path(problem, 8, 1e-3, longest_step=0.02, start_gap=4.0 + mu):
        if previous is not None and point.rates.displacement < 0.0:
            break
        previous = point
    assert previous is not None
    gap = Analysis(problem).solution("jump_in_gap").value
    assert point.state.central_gap - 0.1 < gap < previous.state.central_gap + 0.1
