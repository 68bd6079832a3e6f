"""The contract of a model: `check-model` finds every defect, and the template of `new-model` keeps it."""

import re
import runpy
import tomllib

import pytest

from comparisons.cli.main import main
from comparisons.external.contract_checks import examine
from comparisons.external.model_source import GROUP
from comparisons.judging.gates import load_gates
from comparisons.registry import create

from .conftest import EXAMPLE

#: JKR, so that everything else about the models below is in order.
JKR = """if problem.n != 2 or quantity != "pull_off_force":
    raise NotApplicable("n = 2 and the pull-off force only")
value = (3 + problem.k) / 2
"""
RIGHT = JKR + "return Result(value, 0.0)"


def test_a_right_model_passes(capsys):
    assert main(["check-model", f"{EXAMPLE / 'double_hertz.py'}:DoubleHertz"]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert "is right in the limit rigid: off Bradley" in printed
    assert "is right in the limit jkr: off JKR" in printed
    assert "3 of 3 calibration values" in printed


COUNTS = "setattr(self, 'calls', getattr(self, 'calls', 0) + 1) or value / 2 + 1e-9 * self.calls"


@pytest.mark.parametrize(
    ("value", "more", "wrong"),
    [
        ("-value", 'citation = " "\nlimits = ("dmt",)', "is empty|positive|known are rigid, jkr|the positive number"),
        ("value * math.pi + 1e-9 * os.getpid()", "", "a new process|2.99 times the accurate one"),
        (COUNTS, "", "the opposite order|0.381 times the accurate one"),
        ("value + 1e-4 * problem.mu", 'limits = ("rigid", "jkr")', "-25 % off Bradley|it must come nearer"),
    ],
)
def test_what_is_wrong_is_named(write_model, value, more, wrong):
    findings = examine(create(write_model(f"{JKR}return Result({value}, 0.0)", more=more)))
    texts = [finding.text for finding in findings if finding.status == "wrong"]
    sentences = wrong.split("|")
    assert [sentence in text for sentence, text in zip(sentences, texts, strict=True)] == [True] * len(sentences), texts


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
