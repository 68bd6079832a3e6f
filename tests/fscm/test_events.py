"""Events against reference values, numbers of the paper and the rigid limit."""

import math

import pytest

from fscm import NoSuchEvent, Problem, solve
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
