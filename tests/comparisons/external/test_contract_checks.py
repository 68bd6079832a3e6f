"""The contract of a model: `check-model` finds every defect, and the template of `new-model` keeps it."""

import math
import re
import runpy
import tomllib

import pytest

from comparisons import registry
from comparisons.cli.main import main
from comparisons.external.contract_checks import examine
from comparisons.external.model_source import GROUP
from comparisons.judging.gates import load_gates
from comparisons.judging.selection import cases_of
from comparisons.model import ComputationFailed, NotApplicable, Result
from comparisons.runs.cases import grids, grids_for


class Stranger:
    """JKR for n = 2, whose force is changed; it knows its calls and how often its process was started."""

    name = version = citation = domain = hashed = "stranger"
    limits = ()

    def __init__(self, change, **stated):
        self._change = change
        self.starts, self.calls = 1, 0
        vars(self).update(stated)

    def close(self):
        self.starts, self.calls = self.starts + 1, 0

    def evaluate(self, problem, quantity):
        self.calls += 1
        if problem.n != 2 or quantity != "pull_off_force":
            raise NotApplicable("n = 2 and the pull-off force only")
        value = self._change((3 + problem.k) / 2, problem.mu, self)
        if isinstance(value, Exception):
            raise value
        return Result(value, 0.0)


def negative(value, mu, model):
    return -value


LIMITS = {"limits": ("rigid", "jkr")}


@pytest.mark.parametrize(
    ("change", "stated", "wrong"),
    [
        (
            negative,
            {"citation": " ", "limits": ("dmt",)},
            ("is empty", "positive", "known are rigid, jkr", "the positive number"),
        ),
        (lambda value, mu, model: value * math.pi + 1e-9 * model.starts, {}, ("a new process", "2.99 times")),
        (lambda value, mu, model: value / 2 + 1e-9 * model.calls, {}, ("the opposite order", "0.381 times")),
        (lambda value, mu, model: value + 1e-4 * mu, LIMITS, ("-25 % off Bradley", "it must come nearer")),
        # It comes nearer to both limits; of Bradley it stays a quarter off.
        (lambda value, mu, model: value * (1 - 1e-3 * mu / (1 + mu**2)), LIMITS, ("-25 % off Bradley",)),
    ],
)
def test_what_is_wrong_is_named(change, stated, wrong):
    texts = [finding.text for finding in examine(Stranger(change, **stated)) if finding.status == "wrong"]
    assert [words in text for words, text in zip(wrong, texts, strict=True)] == [True] * len(wrong), texts


@pytest.mark.parametrize(
    ("change", "status", "sentence"),
    [
        (lambda *given: NotApplicable("nothing"), 4, "none of 52 evaluations gave a value"),
        (lambda *given: ComputationFailed("no root"), 4, "no root"),
        (negative, 1, "positive"),
        # From Bradley, 2, to JKR.
        (lambda value, mu, model: 2 - (2 - value) * mu / (1 + mu), 0, "3 of 3 calibration values"),
    ],
)
def test_the_status_is_that_of_the_worst_finding(monkeypatch, capsys, change, status, sentence):
    monkeypatch.setattr(registry, "load_model", lambda spec: Stranger(change, **LIMITS))
    assert main(["check-model", "stranger"]) == status
    printed = " ".join(capsys.readouterr().out.split())
    assert sentence in printed
    assert ("limit rigid: off Bradley" in printed) == ("limit jkr: off JKR" in printed) == (status == 0)


def test_a_new_package_is_complete_keeps_the_contract_passes_its_tests_and_is_not_overwritten(
    tmp_path, capsys, monkeypatch, refused
):
    package = tmp_path / "my-model"
    assert main(["new-model", str(package)]) == 0
    printed = capsys.readouterr()
    assert f"check-model {package / 'my_model.py'}:MyModel" in printed.err
    files = [path for path in package.rglob("*") if path.is_file()]
    assert sorted(printed.out.splitlines()) == sorted(map(str, files))
    assert not any(re.search(r"@[A-Z]+@", path.read_text()) for path in files)
    project = tomllib.loads((package / "pyproject.toml").read_text())
    assert project["project"]["entry-points"][GROUP] == {"my-model": "my_model:MyModel"}
    (gate,) = load_gates((package / "gates.toml").read_text().replace('"my-model"', '"jkr"'))
    # A model for k = 0 alone is judged in enough cases.
    assert gate.min_cases == sum(case.k == 0 for case in cases_of(gate, grids_for(grids("quick"), ["jkr"]), ["jkr"]))
    # 1.5 against the FSCM at n = 2, k = 0, mu = 2, the worst of the cases.
    assert gate.worst_measured == pytest.approx(1.5 / 1.58359530 - 1, abs=1e-4)
    before = (package / "my_model.py").read_text()
    refused(["new-model", package], "not an empty folder")
    assert (package / "my_model.py").read_text() == before
    assert main(["check-model", f"{package / 'my_model.py'}:MyModel"]) == 0
    assert "is right in the limit jkr" in capsys.readouterr().out
    monkeypatch.syspath_prepend(package)
    (file,) = package.rglob("test_*.py")
    tests = [value for name, value in runpy.run_path(str(file)).items() if name.startswith("test_")]
    assert len(tests) == 2
    for test in tests:
        test()


NAMES = "<b> 3d given jkr MD.improved comparisons Json lambda true not-applicable my-model-"


@pytest.mark.parametrize("name", NAMES.split())
def test_a_name_that_cannot_be_is_refused(tmp_path, refused, name):
    refused(["new-model", tmp_path / name])
    assert not (tmp_path / name).exists()
