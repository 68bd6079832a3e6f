"""Models of physical quantities: each result in the units of the problem, its bound with it, and a number as it is."""

import math
from types import SimpleNamespace

import pytest

from comparisons.external.physical_model import SCALES, InUnits
from comparisons.model import Result
from comparisons.quantities import QUANTITIES
from fscm.problem import Problem


@pytest.mark.parametrize("scales", range(len(SCALES)))
def test_a_result_and_its_bound_are_in_the_same_unit(scales):
    for quantity, row in QUANTITIES.items():
        problems = []
        # The list keeps the problem.
        model = SimpleNamespace(
            evaluate_physical=lambda problem, _, kept=problems: kept.append(problem) or Result(6, 2)
        )
        result = InUnits(model, scales=scales).evaluate(Problem(2.0, 0.4, 1.0), quantity)
        unit = 1.0 if row.scale == "number" else problems[0].scales[row.scale]
        assert math.isclose(result.value * unit, 6.0, rel_tol=1e-14)
        assert math.isclose(result.u_num * unit, 2.0, rel_tol=1e-14)
    assert QUANTITIES["critical_tabor_number"].scale == "number"


def test_what_is_no_result_is_left_to_the_worker():
    model = SimpleNamespace(evaluate_physical=lambda problem, quantity: 6.0)
    assert InUnits(model).evaluate(Problem(2.0, 0.4, 1.0), "pull_off_force") == 6.0
