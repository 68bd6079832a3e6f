"""The registry of quantities: one row each, and everything else reads it."""

import ast
from pathlib import Path

import pytest

import comparisons
from comparisons.model import NotApplicable
from comparisons.quantities import ALL_QUANTITIES, CURVES, QUANTITIES, Kind, title_of
from comparisons.registry import create
from fscm.physical import PhysicalProblem
from fscm.problem import Problem

PROBLEM = Problem(n=2, k=0, mu=0.3)


def test_numbers_and_curves_are_the_rows_of_one_registry():
    assert ALL_QUANTITIES == {**QUANTITIES, **CURVES}
    assert {row.kind for row in QUANTITIES.values()} == {Kind.SCALAR}
    assert {row.kind for row in CURVES.values()} == {Kind.CURVE, Kind.FIELD}
    for row in ALL_QUANTITIES.values():
        assert all((row.name, row.symbol, row.title, row.meaning, row.unit))


def test_the_scales_are_those_of_a_physical_problem():
    scales = PhysicalProblem.from_problem(PROBLEM, nu=0.3, Q=1.0, E_star=1.0, z0=1.0).scales
    assert {row.scale for row in QUANTITIES.values()} <= {*scales, "number"}


@pytest.mark.parametrize("name", ALL_QUANTITIES)
def test_a_row_evaluates_a_model_or_the_model_refuses(name):
    row = ALL_QUANTITIES[name]
    if row.kind is Kind.SCALAR:
        try:
            assert row.admits(row.evaluate(create("bradley"), PROBLEM).value)
        except NotApplicable as refusal:
            assert str(refusal)
    elif row.kind is Kind.FIELD:
        with pytest.raises(NotApplicable, match="does not know the surface"):
            row.evaluate(create("jkr"), PROBLEM)
    else:
        points = row.evaluate(create("jkr"), PROBLEM)
        assert len(points.x) == len(points.y) > 2
        assert all(len(column) == len(points.x) for column in points.columns.values())


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


def test_no_module_of_the_output_has_a_label_of_its_own_for_a_quantity():
    """A dictionary keyed by names of quantities is a second registry."""
    folder = Path(comparisons.__file__).parent
    found = []
    for path in [*(folder / "output").rglob("*.py"), *(folder / "cli").rglob("*.py"), *(folder / "runs").rglob("*.py")]:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            keys = (
                [key.value for key in node.keys if isinstance(key, ast.Constant)] if isinstance(node, ast.Dict) else []
            )
            texts = [value for value in getattr(node, "values", []) if isinstance(value, ast.Constant)]
            if set(keys) & set(ALL_QUANTITIES) and texts:
                found.append(path.name)
    assert found == []
