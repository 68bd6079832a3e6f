"""Checks of the contract: every defect is found and named, and a right model passes."""

import csv

import pytest

from comparisons.cli.main import main
from comparisons.external.contract_checks import examine
from comparisons.external.model_source import close_models
from comparisons.registry import create

from .conftest import EXAMPLE, ROWS, light

#: JKR, so that everything else about the models below is in order.
JKR = """if problem.n != 2 or quantity != "pull_off_force":
    raise NotApplicable("n = 2 and the pull-off force only")
value = (3 + problem.k) / 2
"""
RIGHT = JKR + "return Result(value, 0.0)"


@pytest.fixture(autouse=True)
def wide(monkeypatch):
    """No sentence is folded."""
    monkeypatch.setattr("comparisons.cli.options._WIDTH", 1000)


def found(spec):
    return {finding.check: finding for finding in examine(create(spec))}


def status(capsys, spec):
    code = main(["check-model", spec])
    shown = capsys.readouterr()
    assert shown.err == ""
    return code, shown.out


def test_a_right_model_passes(write_model, capsys):
    code, shown = status(capsys, write_model(RIGHT, more='limits = ("jkr",)'))
    assert code == 0
    assert "wrong" not in shown
    assert "failed" not in shown
    assert shown.count("\n") == 7


@pytest.mark.parametrize(
    ("body", "more", "check", "sentence"),
    light(
        [
            (JKR + "return Result(-value, 0.0)", "", "keeps the sign rules", "positive"),
            (JKR + "return Result(-value, 0.0)", "", "is of the right size", "the sign"),
            (JKR + "return Result(value * math.pi, 0.0)", "", "is of the right size", "a factor pi too much"),
            (JKR + "return Result(value / 2, 0.0)", "", "is of the right size", "a factor 2 missing"),
            (JKR + "return Result(value * 1e9, 0.0)", "", "is of the right size", "its unit is pi Q^(2/n)"),
            (
                JKR + "return Result(value + 1e-12 * time.perf_counter(), 0.0)",
                "",
                "gives the same result again",
                "a random number, a clock",
            ),
            (
                JKR + "self.calls = getattr(self, 'calls', 0) + 1\nreturn Result(value + 1e-9 * self.calls, 0.0)",
                "",
                "gives the same result again",
                "kept between evaluations",
            ),
            (RIGHT, 'limits = ("rigid",)', "is right in the limit rigid", "-25 % off Bradley"),
            (
                JKR + "return Result(value * (1 + 1e-4 * problem.mu), 0.0)",
                'limits = ("jkr",)',
                "is right in the limit jkr",
                "it must come nearer",
            ),
            (RIGHT, 'limits = ("dmt",)', "is right in the limit dmt", "known are rigid, jkr"),
            (RIGHT, 'citation = " "', "has version, citation and domain", "citation is empty"),
        ],
        0,
        2,
        5,
        7,
        10,
    ),
)
def test_what_is_wrong_is_named(write_model, capsys, body, more, check, sentence):
    code, shown = status(capsys, write_model(body, more=more))
    assert code == 1
    (line,) = (line for line in shown.splitlines() if f" {check}: " in line)
    assert line.startswith("wrong")
    assert sentence in line


@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        ("raise NotApplicable('nothing')", "none of 25 evaluations gave a value"),
        ("if problem.k:\n    raise ComputationFailed('no root')\n" + RIGHT, "no root"),
        ("return Result(float('nan'), 0.0)", "not a finite number"),
    ],
)
def test_a_failed_computation_has_status_4(write_model, capsys, body, sentence):
    code, shown = status(capsys, write_model(body))
    assert code == 4
    assert sentence in shown


@pytest.mark.parametrize(
    ("arguments", "sentence"), [(["jkr"], "is a model of fscm-bench"), (["nowhere"], "no installed package")]
)
def test_what_cannot_be_checked_is_wrong_input(capsys, arguments, sentence):
    assert main(["check-model", *arguments]) == 2
    assert sentence in capsys.readouterr().err


PHYSICAL = """
def evaluate_physical(self, problem, quantity):
    if problem.n != 2 or problem.k != 0 or quantity != "pull_off_force":
        raise NotApplicable("homogeneous spheres only")
    R, w = problem.Q, problem.work_of_adhesion
    return Result({formula}, 0.0)
"""


@pytest.mark.parametrize(
    ("formula", "status"),
    light(
        [
            ("1.5 * math.pi * R * w", "ok"),
            ("1.5 * math.pi * R * w * (1 + problem.z0)", "wrong"),
            ("1.5 * math.pi * R * w ** 1.001", "wrong"),
            ("1.5 * math.pi * R * 0.05", "wrong"),
        ],
        0,
        1,
    ),
)
def test_a_model_of_physical_quantities_does_not_depend_on_units(write_model, formula, status):
    findings = found(write_model("return None", more=PHYSICAL.format(formula=formula)))
    assert findings["does not depend on units"].status == status
    if status == "ok":
        assert findings["is of the right size"].status == "ok"


def test_units_are_checked_of_physical_models_alone(write_model, write_data):
    for spec in (write_model(RIGHT), str(write_data())):
        assert found(spec)["does not depend on units"].status == "not checked"


def test_poissons_ratio_reaches_a_physical_model(write_model, capsys):
    formula = "1.5 * math.pi * R * w * (1 + problem.nu)"
    spec = write_model("return None", more=PHYSICAL.format(formula=formula))
    case = ["--quantity", "pull_off_force", "--n", "2", "--k", "0", "--mu", "1", "--nu", "0.1"]
    assert main(["solve", "--model", spec, *case, "--format", "csv"]) == 0
    # 3/2 pi R dgamma (1 + nu) in units of pi R dgamma.
    row = next(csv.DictReader(capsys.readouterr().out.splitlines()))
    assert float(row["value"]) == pytest.approx(1.65)


def test_a_submission_is_examined_where_it_covers(write_data, capsys):
    code, shown = status(capsys, str(write_data()))
    assert code == 0
    assert "4 values" in shown
    assert "2 of 3 calibration values" in shown
    close_models()
    code, shown = status(capsys, str(write_data(rows=[ROWS[0].replace(",1.9,", ",-1.9,"), *ROWS[1:]])))
    assert code == 1
    assert "pull_off_force at n = 2, k = 0, mu = 0.1 is -1.9" in shown


def test_the_example_passes(capsys):
    code, shown = status(capsys, f"{EXAMPLE / 'double_hertz.py'}:DoubleHertz")
    assert code == 0
    assert "is right in the limit rigid: off Bradley" in shown
    assert "3 of 3 calibration values" in shown
