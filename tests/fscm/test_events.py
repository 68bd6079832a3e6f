"""Events against reference values, numbers of the paper, limits and each other."""

import math

import pytest

from fscm import Analysis, NoSuchEvent, Problem, solve
from fscm.critical import critical_tabor_number
from tests.fscm.marks import heavy
from tests.fscm.solved_once import analysis_of
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


@pytest.mark.parametrize(("n", "k"), [(1.0, 0.0), (2.0, 0.6), (100.0, 0.2), *heavy((1.5, 0.6), (5.0, 0.0))])
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
    base = (math.cos(k * math.pi / 2) / (2 * math.pi * (1 - k))) ** (n - 2) * ((k + 3) / (n * beta)) ** (k + 3)
    factor = 2 * (2 * n + k - 1) / ((1 + k) * (n + k + 1))
    return factor * base ** (1 / (2 * n + k - 1)) * mu ** ((2 - n) / n)


@pytest.mark.parametrize(
    ("n", "k"),
    [(1.5, 0.2), *heavy((2.0, 0.0), (2.0, 0.4), (3.0, 0.3))],
)
def test_soft_limit(n: float, k: float) -> None:
    """mu -> infinity is JKR; the deviation keeps falling."""
    deviations = [abs(solve(Problem(n, k, mu), "pull_off_force").value / _jkr(n, k, mu) - 1) for mu in (2.5, 5, 10)]
    assert deviations[2] < deviations[1] < deviations[0]
    assert deviations[2] < 0.02
