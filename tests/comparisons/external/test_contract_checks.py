"""Checks of the contract: every defect is found and named, and a right model passes."""

import pytest

from comparisons.cli.main import main
from comparisons.external.contract_checks import examine
from comparisons.registry import create

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
        (JKR + "return Result(-value, 0.0)", "", "is of the right size", "the positive number"),
        (JKR + "return Result(value * math.pi, 0.0)", "", "is of the right size", "2.99 times the accurate one"),
        (JKR + "return Result(value / 2, 0.0)", "", "is of the right size", "0.381 times the accurate one"),
        (JKR + "return Result(value + 1e-9 * time.perf_counter(), 0.0)", "", "gives the same result again", "clock"),
        (COUNTS, "", "gives the same result again", "kept between evaluations"),
        (JKR + "return Result(value + 1e-9 * os.getpid(), 0.0)", "", "gives the same result again", "a new process"),
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


def test_a_submission_is_examined_where_it_covers(write_data):
    findings = findings_of(write_data(rows=[ROWS[0].replace(",1.9,", ",-1.9,"), *ROWS[1:]]))
    assert findings["keeps the sign rules"].status == "wrong"
    assert "mu = 0.1 is -1.9" in findings["keeps the sign rules"].text
    assert findings["gives the same result again"].status == "not checked"
