"""External models whose numbers changed under the same version."""

from pathlib import Path

import pytest

from comparisons.cli.main import main
from comparisons.external.model_source import close_models
from comparisons.pipeline import inputs
from comparisons.pipeline.finished_run import described
from comparisons.registry import identify
from comparisons.runs.cases import load_grids
from comparisons.runs.record import read_record
from comparisons.runs.tables import read_table

GRID = """
[[grid]]
id = "changed data"
title = "Data that a model reads"
tier = "quick"
reference = "bradley"
models = ["dmt"]
quantities = ["pull_off_force", "pull_off_displacement"]
n = [2]
k = [0, 0.4]
mu = [0.1, 1]
"""
GATE = """
[[gate]]
id = "CLOSE"
requirement = "The force is that of Bradley."
quantity = "pull_off_force"
candidate = "given"
reference = "bradley"
cases = { mu = [0.1, 1] }
metric = "rel"
lower = -0.01
upper = 0.01
max_reference_uncertainty = 1e-6
basis = "derived"
grounds = "a gate of this test"
min_cases = 4
tier = "quick"

[[gate]]
id = "FINITE"
requirement = "The displacement is a number."
quantity = "pull_off_displacement"
candidate = "given"
reference = "bradley"
cases = { mu = [0.1, 1] }
metric = "abs"
lower = -1e6
upper = 1e6
max_reference_uncertainty = 1e-6
basis = "derived"
grounds = "a gate that needs another quantity"
min_cases = 4
tier = "quick"
"""
TASKS = 8
PAD = Path(__file__).parents[3] / "docs" / "examples" / "problems" / "graded_pad.toml"
BODY = "return Result(float(Path({data!r}).read_text()), 0.0)"


@pytest.fixture
def once(write_model, no_cards, tmp_path, tmp_path_factory, monkeypatch, capsys):
    """Return a function that writes the data the model reads, runs, and returns status and messages.

    The data are not in the folder of the model, whose digest would show the change.
    """
    monkeypatch.setattr(inputs, "grids", lambda tier: load_grids(GRID))
    (tmp_path / "gates.toml").write_text(GATE)
    data = tmp_path_factory.mktemp("elsewhere") / "data.txt"
    options = ["--jobs", "1", "--out", str(tmp_path / "out"), "--gates", str(tmp_path / "gates.toml")]

    def go(text, *more, body=BODY):
        data.write_text(text)
        close_models()
        spec = write_model(body.format(data=str(data)))
        capsys.readouterr()
        status = main(["run", *options, "--model", spec, *more])
        return status, capsys.readouterr().err

    return go


def values(folder):
    table = read_table(folder / "results.parquet")
    return table.loc[table["model"] == "stranger", "value"].tolist()


def test_an_old_pass_does_not_stand_when_the_data_have_changed(once, tmp_path):
    assert once("2.0")[0] == 0
    status, messages = once("2.5")
    assert status == 1
    assert "stranger has changed (pull_off_" in messages
    assert f"was 2 and is 2.5): its stored results ({TASKS}) are all computed again" in messages
    assert f"{TASKS} computations" in messages
    assert values(tmp_path / "out") == [2.5] * TASKS
    again = read_record(tmp_path / "out" / "run.json")["evaluated_again"]["models"]["stranger"]
    assert not again["same"]
    # The rows that were not trusted are gone for good.
    status, messages = once("2.5")
    assert status == 1
    assert "0 computations" in messages


def test_unchanged_results_are_used_and_the_record_has_what_was_evaluated_again(once, tmp_path):
    once("2.0")
    assert "evaluated_again" not in read_record(tmp_path / "out" / "run.json")
    status, messages = once("2.0")
    assert status == 0
    assert "0 computations" in messages
    again = read_record(tmp_path / "out" / "run.json")["evaluated_again"]
    assert again["seed"] >= 0
    assert again["models"]["stranger"]["same"]
    tasks = again["models"]["stranger"]["tasks"]
    assert len(tasks) == 3
    assert {task["quantity"] for task in tasks} == {"pull_off_force", "pull_off_displacement"}


def test_a_model_that_fails_now_is_not_passed_for_what_it_was(once, tmp_path):
    once("2.0")
    status, messages = once("two")
    assert status == 4
    assert "was 2 and is failed" in messages
    assert all(value != 2.0 for value in values(tmp_path / "out"))


def test_failures_of_an_external_model_are_always_computed_again(once, tmp_path):
    assert once("two")[0] == 4
    status, messages = once("2.0")
    assert status == 0
    assert f"{TASKS} computations" in messages
    assert values(tmp_path / "out") == [2.0] * TASKS


class Hashed:
    """An external model that states what its version covers."""

    hashed = "its folder, 3 files"

    def __init__(self, model):
        self.version, self.citation, self.domain = model.version, model.citation, model.domain


def test_what_was_hashed_is_in_the_record(write_model):
    names, models = identify([write_model("return Result(2.0, 0.0)")])
    assert described(set(names), {name: Hashed(model) for name, model in models.items()}) == {
        "stranger": {
            "version": models["stranger"].version,
            "citation": "A. Author",
            "domain": "tests",
            "hashed": "its folder, 3 files",
        }
    }


@pytest.fixture
def sweep_problem(write_model, tmp_path, tmp_path_factory, capsys):
    """Return a function that writes the data the model reads, sweeps over a problem file, and returns its messages."""
    data = tmp_path_factory.mktemp("elsewhere") / "data.txt"
    options = ["--vary", "punch.R=1:4:4 um", "--jobs", "1", "--out", str(tmp_path / "out")]

    def go(text):
        data.write_text(text)
        close_models()
        spec = write_model(BODY.format(data=str(data)))
        capsys.readouterr()
        models = ["--model", spec, "jkr", "--quantity", "pull_off_force", "pull_off_displacement"]
        status = main(["sweep", "--problem", str(PAD), *options, *models])
        return status, capsys.readouterr().err

    return go


def test_old_rows_of_a_sweep_over_a_problem_file_do_not_stand(sweep_problem, tmp_path):
    def dimensionless():
        table = read_table(tmp_path / "out" / "results.parquet")
        return table.loc[table["model"] == "stranger", "dimensionless_value"].tolist()

    def again():
        record = read_record(tmp_path / "out" / "run.json")
        return record.get("evaluated_again", {"models": {"stranger": None}})["models"]["stranger"]

    assert sweep_problem("2.0")[0] == 0
    assert again() is None
    status, messages = sweep_problem("2.0")
    assert status == 0
    assert "0 computations" in messages
    assert again()["same"]
    assert len(again()["tasks"]) == 3
    assert {task["quantity"] for task in again()["tasks"]} == {"pull_off_force", "pull_off_displacement"}
    assert {name for task in again()["tasks"] for name in task["parameters"]} == {"punch.R [m]"}
    status, messages = sweep_problem("3.0")
    assert status == 0
    assert "stranger has changed" in messages
    # All of this model, and none of the other.
    assert "8 computations, 8 are stored" in messages
    assert dimensionless() == pytest.approx([3.0] * 8)
    assert not again()["same"]
    # A model that fails now.
    status, messages = sweep_problem("three")
    assert status == 4
    assert "is failed" in messages
    assert sweep_problem("2.0")[0] == 0
    assert dimensionless() == pytest.approx([2.0] * 8)
