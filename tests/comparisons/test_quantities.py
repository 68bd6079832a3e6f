"""Registry of quantities: one row each."""

import pytest

from comparisons.problem import Problem
from comparisons.quantities import CURVES, QUANTITIES
from comparisons.registry import create

PROBLEM = Problem.dimensionless(n=2, k=0, mu=0.3)


def test_a_value_is_that_of_the_model_and_points_have_what_else_it_knows():
    model = create("jkr")
    curve, points = model.curve(PROBLEM), CURVES["force_curve"].evaluate(model, PROBLEM)
    assert QUANTITIES["pull_off_force"].evaluate(model, PROBLEM).value == pytest.approx(1.5, rel=1e-14)
    assert (points.x, points.y) == (curve.displacement.tolist(), curve.load.tolist())
    assert list(points.columns) == ["contact_radius"]


@pytest.mark.parametrize(
    ("name", "value", "admitted"),
    [
        ("pull_off_force", 0.0, False),
        ("hysteresis_energy", 0.0, True),
        ("hysteresis_energy", -1e-9, False),
        ("jump_in_gap", -0.5, True),
        ("jump_out_gap", -1.0, False),
        ("critical_tabor_number", 0.0, False),
    ],
)
def test_the_sign_rule_is_that_of_the_scale(name, value, admitted):
    assert QUANTITIES[name].admits(value) is admitted
