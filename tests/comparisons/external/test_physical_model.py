"""Models of physical quantities: each result in the units of the problem, its bound with it, and a number as it is."""

import math
from types import SimpleNamespace

import pytest

from comparisons.external.physical_model import SCALES, InUnits
from comparisons.model import Result
from comparisons.quantities import QUANTITIES
from fscm.problem import Problem


def evaluated(quantity, scales, result=None):
    """A model that returns the value 6 with the bound 2; and the unit of the quantity, from the problem it got."""
    problems = []

    def evaluate_physical(problem, name):
        problems.append(problem)
        assert name == quantity
        return Result(6.0, 2.0) if result is None else result

    model = SimpleNamespace(
        name="mine", version="1", citation="none", domain="all", evaluate_physical=evaluate_physical
    )
    returned = InUnits(model, scales=scales).evaluate(Problem(2.0, 0.4, 1.0), quantity)
    return returned, problems[0]


@pytest.mark.parametrize("scales", range(len(SCALES)))
@pytest.mark.parametrize("quantity", QUANTITIES)
def test_a_result_and_its_bound_are_in_the_same_unit(quantity, scales):
    result, problem = evaluated(quantity, scales)
    kind = QUANTITIES[quantity].scale
    unit = 1.0 if kind == "number" else problem.scales[kind]
    assert math.isclose(result.value * unit, 6.0, rel_tol=1e-14)
    assert math.isclose(result.u_num * unit, 2.0, rel_tol=1e-14)


def test_a_number_has_no_unit():
    assert QUANTITIES["critical_tabor_number"].scale == "number"
    result, _ = evaluated("critical_tabor_number", 0)
    assert (result.value, result.u_num) == (6.0, 2.0)


def test_what_is_no_result_is_left_to_the_worker():
    returned, _ = evaluated("pull_off_force", 0, result=6.0)
    assert returned == 6.0
