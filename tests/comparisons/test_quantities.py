"""Registry of quantities: one row each."""

import pytest

from comparisons.model import NotApplicable
from comparisons.problem import Problem
from comparisons.quantities import ALL_QUANTITIES, CURVES, QUANTITIES, title_of
from comparisons.registry import create

PROBLEM = Problem.dimensionless(n=2, k=0, mu=0.3)


def test_rows_have_texts_and_the_scales_of_a_physical_problem():
    scales = PROBLEM.posed.in_units(c0=1.0, nu=0.3, Q=1.0, work_of_adhesion=1.0, z0=1.0).units
    assert {row.scale for row in QUANTITIES.values()} <= set(scales)
    assert {axis.scale for row in CURVES.values() for axis in (row.x, row.y)} <= set(scales)
    for row in ALL_QUANTITIES.values():
        assert all((row.name, row.symbol, row.title, row.meaning, row.unit))
        assert ALL_QUANTITIES[row.name] is row
    assert title_of("pull_off_gap") == "gap at pull-off"


def test_a_value_is_that_of_the_model_and_points_have_what_else_it_knows():
    model = create("jkr")
    curve, points = model.curve(PROBLEM), CURVES["force_curve"].evaluate(model, PROBLEM)
    assert QUANTITIES["pull_off_force"].evaluate(model, PROBLEM).value == pytest.approx(1.5, rel=1e-14)
    assert (points.x, points.y) == (curve.displacement.tolist(), curve.load.tolist())
    assert list(points.columns) == ["contact_radius"]


@pytest.mark.parametrize("quantity", ["pull_off_pressure", "pull_off_gap"])
def test_a_model_without_a_surface_has_no_field_at_pull_off(quantity):
    with pytest.raises(NotApplicable, match="does not know the surface"):
        CURVES[quantity].evaluate(create("jkr"), PROBLEM)


@pytest.mark.parametrize("model", ["fscm", "fem"])
def test_a_quantity_that_a_solver_does_not_compute_yet_is_not_applicable(model):
    with pytest.raises(NotApplicable, match="gap_at_infinity"):
        create(model).evaluate(PROBLEM, "gap_at_infinity")


@pytest.mark.parametrize(
    ("name", "value", "admitted"),
    [
        ("pull_off_force", 0.0, False),
        ("pull_off_force", 1.0, True),
        ("hysteresis_energy", 0.0, True),
        ("hysteresis_energy", -1e-9, False),
        ("jump_in_gap", -0.5, True),
        ("jump_out_gap", -1.0, False),
        ("zero_load_displacement", -3.0, True),
        ("critical_tabor_number", 0.0, False),
    ],
)
def test_the_sign_rule_is_that_of_the_scale(name, value, admitted):
    assert QUANTITIES[name].admits(value) is admitted
