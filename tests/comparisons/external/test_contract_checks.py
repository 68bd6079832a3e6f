"""Checks of the contract: every defect is found and named, and a right model passes."""

import csv
import math
from types import SimpleNamespace

import pytest

from comparisons.cli.main import main
from comparisons.external.contract_checks import examine
from comparisons.external.physical_model import SCALES, evaluate_in_units
from comparisons.model import Result
from comparisons.quantities import QUANTITIES
from comparisons.registry import create
from fscm.problem import Problem

from .conftest import EXAMPLE, ROWS

#: JKR, so that everything else about the models below is in order.
JKR = """if problem.n != 2 or quantity != "pull_off_force":
    raise NotApplicable("n = 2 and the pull-off force only")
value = (3 + problem.k) / 2
"""
RIGHT = JKR + "return Result(value, 0.0)"
TOO_MUCH = JKR + "return Result(value * (1 + 1e-4 * problem.mu), 0.0)"
COUNTS = JKR + "self.calls = getattr(self, 'calls', 0) + 1\nreturn Result(value + 1e-9 * self.calls, 0.0)"


def findings_of(spec):
    return {finding.check: finding for finding in examine(create(str(spec)))}


def test_a_right_model_passes(capsys):
    assert main(["check-model", f"{EXAMPLE / 'double_hertz.py'}:DoubleHertz"]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "is right in the limit rigid: off Bradley" in printed
    assert "is right in the limit jkr: off JKR" in printed
    assert "3 of 3 calibration values" in printed


@pytest.mark.parametrize(
    ("body", "more", "check", "sentence"),
    [
        (JKR + "return Result(-value, 0.0)", "", "keeps the sign rules", "positive"),
        (JKR + "return Result(-value, 0.0)", "", "is of the right size", "the sign"),
        (JKR + "return Result(value * math.pi, 0.0)", "", "is of the right size", "a factor pi too much"),
        (JKR + "return Result(value / 2, 0.0)", "", "is of the right size", "a factor 2 missing"),
        (JKR + "return Result(value * 1e9, 0.0)", "", "is of the right size", "; its unit is pi Q^(2/n)"),
        (JKR + "return Result(value + 1e-9 * time.perf_counter(), 0.0)", "", "gives the same result again", "clock"),
        (COUNTS, "", "gives the same result again", "kept between evaluations"),
        (RIGHT, 'limits = ("rigid",)', "is right in the limit rigid", "-25 % off Bradley"),
        (TOO_MUCH, 'limits = ("jkr",)', "is right in the limit jkr", "it must come nearer"),
        (RIGHT, 'limits = ("dmt",)', "is right in the limit dmt", "known are rigid, jkr"),
        (RIGHT, 'citation = " "', "has version, citation and domain", "citation is empty"),
    ],
)
def test_what_is_wrong_is_named(write_model, body, more, check, sentence):
    finding = findings_of(write_model(body, more=more))[check]
    assert finding.status == "wrong"
    assert sentence in finding.text


@pytest.mark.parametrize(
    ("body", "sentence"),
    [
        ("raise NotApplicable('nothing')", "none of 25 evaluations gave a value"),
        ("if problem.k:\n    raise ComputationFailed('no root')\n" + RIGHT, "no root"),
    ],
)
def test_a_failed_computation_has_status_4(write_model, capsys, body, sentence):
    assert main(["check-model", write_model(body)]) == 4
    assert sentence in " ".join(capsys.readouterr().out.split())


PHYSICAL = """
def evaluate_physical(self, problem, quantity):
    if problem.n != 2 or problem.k != 0 or quantity != "pull_off_force":
        raise NotApplicable("homogeneous spheres only")
    R, w = problem.Q, problem.work_of_adhesion
    return Result({formula}, 0.0)
"""


@pytest.mark.parametrize(
    ("formula", "status"),
    [
        ("1.5 * math.pi * R * w", "ok"),
        ("1.5 * math.pi * R * w * (1 + problem.z0)", "wrong"),
        ("1.5 * math.pi * R * w ** 1.001", "wrong"),
    ],
)
def test_a_model_of_physical_quantities_does_not_depend_on_units(write_model, formula, status):
    findings = findings_of(write_model("return None", more=PHYSICAL.format(formula=formula)))
    assert findings_of(write_model(RIGHT, "other"))["does not depend on units"].status == "not checked"
    assert findings["does not depend on units"].status == status
    assert status == "wrong" or findings["is of the right size"].status == "ok"


@pytest.mark.parametrize("scales", range(len(SCALES)))
def test_a_result_and_its_bound_are_in_the_same_unit(scales):
    for quantity, row in QUANTITIES.items():
        cases = []
        model = SimpleNamespace(evaluate_physical=lambda case, _, cases=cases: cases.append(case) or Result(6, 2))
        result = evaluate_in_units(model, Problem(2.0, 0.4, 1.0), quantity, scales=scales)
        unit = 1.0 if row.scale == "number" else cases[0].scales[row.scale]
        assert math.isclose(result.value * unit, 6.0, rel_tol=1e-14)
        assert math.isclose(result.u_num * unit, 2.0, rel_tol=1e-14)
    assert QUANTITIES["critical_tabor_number"].scale == "number"


def test_poissons_ratio_reaches_a_physical_model(write_model, capsys):
    spec = write_model("return None", more=PHYSICAL.format(formula="1.5 * math.pi * R * w * (1 + problem.nu)"))
    case = ["--quantity", "pull_off_force", "--n", "2", "--k", "0", "--mu", "1", "--nu", "0.1"]
    assert main(["solve", "--model", spec, *case, "--format", "csv"]) == 0
    # 3/2 pi R dgamma (1 + nu) in units of pi R dgamma.
    row = next(csv.DictReader(capsys.readouterr().out.splitlines()))
    assert float(row["value"]) == pytest.approx(1.65)


def test_a_submission_is_examined_where_it_covers(write_data):
    findings = findings_of(write_data(rows=[ROWS[0].replace(",1.9,", ",-1.9,"), *ROWS[1:]]))
    assert findings["keeps the sign rules"].status == "wrong"
    assert "mu = 0.1 is -1.9" in findings["keeps the sign rules"].text
    assert {findings[name].status for name in ("gives the same result again", "does not depend on units")} == {
        "not checked"
    }
