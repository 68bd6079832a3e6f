"""One model from three sources (package, file, data), with the same results."""

import csv
import hashlib
import io
import json
import subprocess
import sys

import pytest

from comparisons.cli.main import main
from comparisons.external.model_source import close_models
from comparisons.model import HasCurve, Model
from comparisons.pipeline import inputs
from comparisons.quantities import QUANTITIES
from comparisons.registry import create
from comparisons.runs.cases import Case, load_grids
from comparisons.runs.tasks import evaluate

from .conftest import EXAMPLE, light

FILE_SOURCE = f"{EXAMPLE / 'double_hertz.py'}:DoubleHertz"
QUANTITY = "pull_off_force"
CASES = [Case(2, k, mu) for k in (0, 0.4) for mu in (0.1, 1)]


@pytest.fixture
def data_source(tmp_path):
    """Write the predictions of the example as an author would who cannot give the code away."""
    model = create(FILE_SOURCE)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["quantity", "n", "k", "mu", "value", "u_num"])
    for case in CASES:
        result = model.evaluate(case.problem(), QUANTITY)
        writer.writerow([QUANTITY, case.n, case.k, case.mu, repr(result.value), repr(result.u_num)])
    folder = tmp_path / "submission"
    folder.mkdir()
    content = text.getvalue().encode()
    (folder / "predictions.csv").write_bytes(content)
    folder.joinpath("model.toml").write_text(
        f"""
name = "double-hertz"
version = "1.0"
author = "Greenwood & Johnson"
doi = "none"
licence = "CC0-1.0"
domain = "n = 2"
predictions = "predictions.csv"
sha256 = "{hashlib.sha256(content).hexdigest()}"
[units]
{QUANTITY} = "{QUANTITIES[QUANTITY].unit}"
[[covers]]
quantities = ["{QUANTITY}"]
n = [2]
k = [0, 0.4]
mu = [0.1, 1]
"""
    )
    return str(folder)


GRID = f"""
[[grid]]
id = "sources"
title = "The cases of the submission"
tier = "quick"
tags = ["sources"]
reference = "md-improved"
models = ["jkr"]
quantities = ["{QUANTITY}"]
n = [2]
k = [0, 0.4]
mu = [0.1, 1]
"""


GATE = f"""
[[gate]]
id = "GIVEN"
requirement = "The model has the pull-off force of md-improved to 5 %."
quantity = "{QUANTITY}"
candidate = "given"
reference = "md-improved"
cases = {{ tags = ["sources"] }}
metric = "rel"
lower = -0.05
upper = 0.05
max_reference_uncertainty = 1e-6
basis = "measured"
grounds = "a gate of this test"
worst_measured = 0.02
min_cases = 4
tier = "quick"
"""


@pytest.fixture
def gates(tmp_path):
    """A gates file with one gate over the cases of the submission."""
    path = tmp_path / "gates.toml"
    path.write_text(GATE)
    return str(path)


def test_all_sources_give_the_same_rows_and_verdicts(
    data_source, installed_example, gates, tmp_path, monkeypatch, capsys, no_cards
):
    monkeypatch.setattr(inputs, "grids", lambda tier: load_grids(GRID))
    tables, verdicts = [], []
    for number, spec in enumerate((installed_example, FILE_SOURCE, data_source)):
        out = tmp_path / str(number)
        assert main(["run", "--jobs", "1", "--out", str(out), "--verbose", "--gates", gates, "--model", spec]) == 0
        verdicts.append((out / "verdicts.csv").read_text())
        assert f"--model {spec} " in capsys.readouterr().out
        assert main(["judge", str(out), "--gates", gates]) == 0
        assert (out / "verdicts.csv").read_text() == verdicts[-1]
        table = [
            {name: cell for name, cell in row.items() if name not in {"model_version", "seconds"}}
            for row in csv.DictReader((out / "results.csv").read_text().splitlines())
        ]
        tables.append(table)
        kappa = (out / "kappa.csv").read_text()
        assert kappa.count("double-hertz") == len(CASES)
    assert tables[0] == tables[1] == tables[2]
    assert {row["model"] for row in tables[0]} == {"double-hertz", "md-improved"}
    assert verdicts[0] == verdicts[1] == verdicts[2]
    assert sum("PASS" in line for line in verdicts[0].splitlines()) == len(CASES)


@pytest.mark.heavy
def test_the_sources_agree_in_solve(data_source, installed_example, capsys):
    values = []
    for spec in (installed_example, FILE_SOURCE, data_source):
        arguments = ["--quantity", QUANTITY, "--n", "2", "--k", "0.4", "--mu", "1", "--format", "json"]
        assert main(["solve", "--model", spec, *arguments]) == 0
        shown = capsys.readouterr()
        assert shown.err == ""
        result = json.loads(shown.out)
        assert result["model"] == "double-hertz"
        values.append((result["value"], result["u_num"]))
    assert len(set(values)) == 1


def test_the_example_keeps_the_contract(installed_example):
    model = create(installed_example)
    assert isinstance(model, Model)
    assert isinstance(model, HasCurve)
    assert evaluate(model, "jump_in_gap", Case(2, 0, 1)).status == "not-applicable"
    assert evaluate(model, QUANTITY, Case(1, 0, 1)).status == "not-applicable"


def test_an_installed_model_is_listed(installed_example, capsys):
    assert main(["list", "models"]) == 0
    assert "installed by double-hertz" in capsys.readouterr().out


def test_its_curve_is_drawn_beside_ours(installed_example, capsys):
    assert main(["curve", "--model", installed_example, "jkr", "--n", "2", "--k", "0.4", "--mu", "1"]) == 0
    rows = list(csv.DictReader(capsys.readouterr().out.splitlines()))
    loads = [float(row["load"]) for row in rows if row["model"] == "double-hertz"]
    # The curve's own minimum, on 201 points, against the pull-off force of the same model.
    assert -min(loads) == pytest.approx(1.750971, rel=1e-3)


def test_a_run_goes_on_and_notices_that_a_model_changed(write_model, no_cards, gates, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(inputs, "grids", lambda tier: load_grids(GRID))
    out = tmp_path / "out"

    def once(body):
        spec = write_model(body)
        assert main(["run", "--jobs", "1", "--out", str(out), "--gates", gates, "--model", spec]) == 1
        rows = list(csv.DictReader((out / "results.csv").read_text().splitlines()))
        return capsys.readouterr().err, [float(row["value"]) for row in rows if row["model"] == "stranger"]

    messages, values = once("return Result(1.5, 0.0)")
    assert "4 computations on" in messages
    assert "4 computations more" in messages
    assert values == [1.5] * 4
    messages, values = once("return Result(1.5, 0.0)")
    assert "0 computations" in messages
    close_models()
    messages, values = once("return Result(1.6, 0.0)")
    assert "4 computations" in messages
    assert values == [1.6] * 4


def test_two_models_of_one_name_are_refused(write_model, data_source, capsys):
    assert main(["run", "--model", FILE_SOURCE, data_source]) == 2
    assert "two models have the name double-hertz" in capsys.readouterr().err


@pytest.mark.heavy
def test_pip_installs_the_example(tmp_path):
    """The real thing; needs a network for setuptools."""
    site = tmp_path / "site"
    install = [
        sys.executable,
        "-m",
        "pip",
        "install",
        "--no-deps",
        "--quiet",
        "--target",
        str(site),
        str(EXAMPLE),
    ]
    subprocess.run(install, check=True)
    program = f"""
import sys
sys.path.insert(0, {str(site)!r})
from comparisons.cli.main import main
sys.exit(main(["check-model", "double-hertz"]))
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_folder_without_predictions_does_not_hide_an_installed_model(installed_example, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / installed_example).mkdir()
    assert create(installed_example).name == installed_example
    with pytest.raises(ValueError, match=r"neither FILE.py:CLASS nor a program nor a folder"):
        create(f"./{installed_example}")


def test_a_folder_with_predictions_and_an_installed_model_of_its_name_are_told_apart(
    installed_example, write_data, tmp_path, monkeypatch
):
    monkeypatch.chdir(tmp_path)
    write_data().rename(tmp_path / installed_example)
    with pytest.raises(ValueError, match=f"name the folder ./{installed_example}"):
        create(installed_example)
    assert create(f"./{installed_example}").name == "measured"


@pytest.mark.parametrize(
    ("attributes", "sentence"),
    light(
        [
            (
                "name = 'mine'; citation = domain = 'x'",
                "the model has no version; it needs name, version, citation, domain",
            ),
            ("name = version = 'mine'", "the model has no citation, domain; it needs name, version, citation, domain"),
            ("name = version = citation = domain = 'a'; limits = 'jkr'", "limits = str 'jkr' is not a tuple of texts"),
            ("name = version = citation = domain = 'a'; limits = 5", "limits = int 5 is not a tuple of texts"),
        ],
        0,
        2,
    ),
)
def test_a_model_without_an_attribute_is_refused_with_its_name(tmp_path, capsys, attributes, sentence):
    file = tmp_path / "mine.py"
    file.write_text(f"class Mine:\n    {attributes}\n    def evaluate(self, problem, quantity): pass\n")
    assert main(["check-model", f"{file}:Mine"]) == 2
    assert capsys.readouterr().err.startswith(f"fscm-bench: the model {file}:Mine cannot be loaded: {sentence}")
