"""Registries of the models of a folder, with the contract that each of them keeps, and of the quantities."""

import pytest

from comparisons.data.toml_text import shipped
from comparisons.model import HasCurve, Model
from comparisons.problem import Problem
from comparisons.quantities import CURVES, QUANTITIES
from comparisons.registry import MODELS, create
from comparisons.runs.tasks import evaluate
from tests.reference_values import REFERENCE_VALUES

#: Models that take more than a second a value; their own tests evaluate them.
SLOW = {"fscm-stieltjes", "fscm-stieltjes-400", "fem"}


@pytest.mark.parametrize("name", MODELS)
def test_a_model_has_its_texts_and_a_pull_off_force_or_the_reason_why_not(name):
    model = create(name)
    assert isinstance(model, Model)
    assert isinstance(model, HasCurve)
    assert model.name == name
    assert all(isinstance(text, str) and text for text in (model.version, model.citation, model.domain))
    row = None if name in SLOW else evaluate(model, "pull_off_force", Problem.dimensionless(2, 0.4, 1))
    if row and row.status == "ok":
        # Between the rigid limit 2 and the JKR limit 1.7, a little more where a model is wrong.
        assert 1.6 < row.value <= 2.1
        assert 0 <= row.u_num < (1e-4 if name == "atlas" else 1e-6)
    elif row:
        assert row.status == "not-applicable"
        assert row.reason


def test_the_texts_that_a_list_prints_are_those_of_the_models():
    texts = {name: {text: getattr(create(name), text) for text in ("version", "domain", "citation")} for name in MODELS}
    listed = shipped("models.toml")
    assert listed == texts
    assert [*listed] == [*MODELS]


def test_poissons_ratio_reaches_the_model_that_needs_it():
    assert create("fem", 0.1)._poisson_ratio == 0.1
    assert create("jkr", 0.1).name == "jkr"


def test_a_value_is_that_of_the_model_and_points_have_what_else_it_knows():
    model, problem = create("jkr"), Problem.dimensionless(n=2, k=0, mu=0.3)
    curve, points = model.curve(problem), CURVES["force_curve"].evaluate(model, problem)
    assert QUANTITIES["pull_off_force"].evaluate(model, problem).value == pytest.approx(1.5, rel=1e-14)
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


def test_every_number_has_a_reference_value():
    """A new quantity needs a value that the code under test has not computed."""
    assert {row.quantity for row in REFERENCE_VALUES} == set(QUANTITIES)
