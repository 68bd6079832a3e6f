"""Every registered model keeps the contract of `comparisons.model`."""

import pytest

from comparisons.model import Model, TracesCurve
from comparisons.registry import MODELS, create
from comparisons.runs.cases import Case
from comparisons.runs.tasks import evaluate

#: Models that take more than a second an answer; their own tests ask them.
SLOW = {"fscm-stieltjes", "fscm-stieltjes-400", "fem"}


@pytest.mark.parametrize("name", MODELS)
def test_a_model_says_what_it_is(name):
    model = create(name)
    assert isinstance(model, Model)
    assert isinstance(model, TracesCurve)
    assert model.name == name
    assert all(isinstance(text, str) and text for text in (model.version, model.citation, model.domain))


@pytest.mark.parametrize("name", sorted(MODELS.keys() - SLOW))
def test_a_model_answers_the_pull_off_force_or_says_why_not(name):
    row = evaluate(create(name), "pull_off_force", Case(2, 0.4, 1))
    assert row.status in {"ok", "not-applicable"}
    if row.status == "ok":
        # Between the rigid limit 2 and the JKR limit 1.7, a little more where a model is wrong.
        assert 1.6 < row.value <= 2.1
        assert 0 <= row.u_num < 1e-6
    else:
        assert row.reason


def test_an_unknown_name_lists_the_known():
    with pytest.raises(ValueError, match=", ".join(MODELS)):
        create("hertz")


def test_poissons_ratio_reaches_the_model_that_needs_it():
    assert create("fem", 0.1)._poisson_ratio == 0.1
    assert create("jkr", 0.1).name == "jkr"
