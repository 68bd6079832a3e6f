"""Registry of quantities: one row each."""

import ast
from collections.abc import Iterable
from pathlib import Path

import pytest

import comparisons
from comparisons.model import NotApplicable
from comparisons.problem import Problem
from comparisons.quantities import ALL_QUANTITIES, CURVES, QUANTITIES, Kind, title_of
from comparisons.registry import create

PROBLEM = Problem.dimensionless(n=2, k=0, mu=0.3)


def test_numbers_and_curves_are_the_rows_of_one_registry():
    assert ALL_QUANTITIES == {**QUANTITIES, **CURVES}
    assert {row.kind for row in QUANTITIES.values()} == {Kind.SCALAR}
    assert {row.kind for row in CURVES.values()} == {Kind.CURVE, Kind.FIELD}
    for row in ALL_QUANTITIES.values():
        assert all((row.name, row.symbol, row.title, row.meaning, row.unit))


def test_the_scales_are_those_of_a_physical_problem():
    scales = PROBLEM.posed.in_units(c0=1.0, nu=0.3, Q=1.0, work_of_adhesion=1.0, z0=1.0).units
    assert {row.scale for row in QUANTITIES.values()} <= set(scales)


def test_a_number_is_that_of_the_model():
    model = create("jkr")
    for name in ("pull_off_force", "pull_off_displacement", "zero_load_displacement"):
        result = QUANTITIES[name].evaluate(model, PROBLEM)
        assert result.value == model.evaluate(PROBLEM, name).value
        assert QUANTITIES[name].admits(result.value)


def test_a_curve_has_what_else_the_model_knows_on_it():
    curve = create("jkr").curve(PROBLEM)
    points = CURVES["force_curve"].evaluate(create("jkr"), PROBLEM)
    assert (points.x, points.y) == (curve.displacement.tolist(), curve.load.tolist())
    assert list(points.columns) == list(curve.columns) != []


def test_a_field_that_a_model_does_not_know_is_not_applicable():
    for name in ("pull_off_pressure", "pull_off_gap"):
        with pytest.raises(NotApplicable, match="does not know the surface"):
            CURVES[name].evaluate(create("jkr"), PROBLEM)


@pytest.mark.parametrize("name", ["fscm", "fem"])
def test_a_quantity_that_a_model_does_not_compute_is_not_applicable(name):
    """A row of the registry may be there before a solver computes it."""
    with pytest.raises(NotApplicable, match="gap_at_infinity"):
        create(name, 0.3).evaluate(PROBLEM, "gap_at_infinity")


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


def test_titles_are_names_in_a_sentence():
    assert title_of("critical_tabor_number") == "critical Tabor number"
    assert [title_of(name) for name in CURVES] == [
        "force-displacement curve",
        "pressure at pull-off",
        "gap at pull-off",
    ]


@pytest.mark.parametrize("folder", ["output", "cli", "runs", "judging"])
def test_there_is_no_second_registry(folder):
    """A dictionary of texts by names of quantities would be one."""
    found = [
        path.name
        for path in (Path(comparisons.__file__).parent / folder).rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Dict) and _constants(node.keys) & set(ALL_QUANTITIES) and _constants(node.values)
    ]
    assert found == []


def _constants(nodes: Iterable[ast.expr | None]) -> set[str]:
    return {node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)}
