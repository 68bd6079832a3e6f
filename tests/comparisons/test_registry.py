"""Registry of the models, and the contract that each of them keeps."""

import subprocess
import sys
from pathlib import Path

import pytest

from comparisons.model import HasCurve, Model
from comparisons.problem import Problem
from comparisons.registry import MODELS, create
from comparisons.runs.tasks import evaluate

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


def test_an_unknown_name_lists_the_models():
    with pytest.raises(ValueError, match=", ".join(MODELS)):
        create("hertz")


def test_poissons_ratio_reaches_the_model_that_needs_it():
    assert create("fem", 0.1)._poisson_ratio == 0.1
    assert create("jkr", 0.1).name == "jkr"


def test_no_model_is_imported_before_it_is_created():
    program = (
        "import sys; from comparisons.registry import create; create('dmt');"
        "print([name for name in sys.modules if name.split('.')[0] in ('fem_reference', 'skfem', 'pyamg')])"
    )
    root = Path(__file__).resolve().parents[2]
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, cwd=root)
    assert done.stdout.strip() == "[]", done.stderr
