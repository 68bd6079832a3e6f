"""Use of the references by a model: what is seen, and what is harmless."""

from pathlib import Path

import pytest

from comparisons.registry import create, identify
from comparisons.runs.cases import Case
from comparisons.runs.tasks import NOT_INDEPENDENT, Task, evaluate_task

from .conftest import light

ROOT = Path(__file__).resolve().parents[3]
SHIPPED = ROOT / "comparisons" / "data" / "shipped"
CASE = Case(2, 0.4, 1)


def observed(spec):
    model = create(spec)
    model.evaluate(CASE.problem(), "pull_off_force")
    return model


@pytest.mark.parametrize(
    ("body", "fact"),
    light(
        [
            ("import fscm\nfscm.solve\nreturn Result(1.0, 0)", "imports fscm"),
            ("import fscm\nreturn Result(float(fscm.atlas(2, 0, 1, quantity).value), 0)", "imports fscm"),
            ("from fscm.errors import NotConverged\nfrom fscm import solve\nreturn Result(1.0, 0)", "imports fscm"),
            ("import importlib\nimportlib.import_module('fscm.solver')\nreturn Result(1.0, 0)", "imports fscm"),
            ("import fem_reference\nreturn Result(1.0, 0)", "imports fem_reference"),
            (
                "import sys, fscm.solver\nfor name in [m for m in sys.modules if m.startswith('fscm')]:\n"
                "    del sys.modules[name]\nreturn Result(1.0, 0)",
                "imports fscm",
            ),
            (f"open({str(ROOT / 'fscm' / 'solver.py')!r}).read()\nreturn Result(1.0, 0)", "imports fscm"),
            (
                f"open({str(SHIPPED / 'results.csv')!r}).close()\nreturn Result(1.0, 0)",
                "reads the shipped values of the references (results.csv)",
            ),
            (
                "from importlib.resources import files\n"
                "files('comparisons.data').joinpath('shipped/results.csv').read_text()\nreturn Result(1.0, 0)",
                "reads the shipped values of the references (results.csv)",
            ),
        ],
        0,
        4,
        5,
        6,
        8,
    ),
)
def test_the_use_of_a_reference_is_seen(write_model, body, fact):
    assert fact in observed(write_model(body)).uses


def test_an_import_when_the_model_is_loaded_is_seen(write_model):
    spec = write_model("return Result(1.0, 0)", more="from fscm import solve")
    assert observed(spec).uses == ("imports fscm",)


@pytest.mark.parametrize(
    "body",
    light(
        [
            "return Result(1.5, 0)",
            "from fscm import Problem\nfrom fscm.punch import PowerPunch\nimport scipy.optimize\nreturn Result(1.5, 0)",
            "from comparisons.models.jkr import JKR\nreturn JKR().evaluate(problem, quantity)",
            "open(__file__).close()\nreturn Result(1.5, 0)",
        ],
        1,
        2,
    ),
)
def test_what_states_a_problem_is_no_use_of_a_reference(write_model, body):
    model = observed(write_model(body))
    assert (model.uses, model.starts_programs) == ((), False)


def test_other_programs_are_noted_because_nothing_is_seen_in_them(write_model):
    model = observed(write_model("import subprocess\nsubprocess.run(['true'])\nreturn Result(1.5, 0)"))
    assert (model.uses, model.starts_programs) == ((), True)


def test_the_row_of_a_dependent_value_states_it(write_model):
    spec = write_model("import fem_reference\nreturn Result(1.0, 0)")
    (name,), external = identify([spec])
    row = evaluate_task(Task(name, "pull_off_force", CASE, external[name]))
    assert (row.status, row.reason) == ("ok", f"{NOT_INDEPENDENT} imports fem_reference")
