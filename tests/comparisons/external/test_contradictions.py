"""Models that differ between two processes: failed rows, each with the reason."""

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.external.model_source import close_models
from comparisons.pipeline import inputs
from comparisons.registry import ExternalIdentity, create, identify
from comparisons.runs.cases import Case, load_grids
from comparisons.runs.tasks import Task, evaluate, evaluate_task

from .conftest import light
from .test_hostile_models import CASE, GOOD, GRID

BY_PROCESS = [
    "name = f'stranger-{os.getpid()}'",
    "version = str(os.getpid())",
    "version = str(time.time_ns())",
    "version = os.urandom(8).hex()",
]


# A name, and in the heavy test a version: the next test has every kind.
@pytest.mark.parametrize("more", [BY_PROCESS[0], pytest.param(BY_PROCESS[1], marks=pytest.mark.heavy)])
def test_a_run_goes_on_with_a_model_that_names_itself_by_its_process(
    write_model, no_cards, tmp_path, monkeypatch, more
):
    monkeypatch.setattr(inputs, "grids", lambda tier: load_grids(GRID))
    out = tmp_path / "out"
    specs = [write_model(GOOD, name="good"), write_model(GOOD, more=more)]
    # With two processes each of them opens the model again.
    assert main(["run", "--jobs", "2", "--out", str(out), "--model", *specs]) == 4
    table = pd.read_csv(out / "results.csv", dtype=str)
    assert sorted(table["model"].str.partition("-")[0]) == ["bradley"] * 2 + ["good"] * 2 + ["stranger"] * 2
    rows_of_model = table[table["model"].str.startswith("stranger")]
    assert rows_of_model["model"].nunique() == rows_of_model["model_version"].nunique() == 1
    assert set(rows_of_model["status"]) == {"failed"}
    assert (
        rows_of_model["reason"]
        .str.startswith("the model's name or version changed after it was loaded: it is stranger")
        .all()
    )
    assert set(table.loc[table["model"] == "good", "status"]) == {"ok"}


@pytest.mark.parametrize("more", light(BY_PROCESS, 0, 3))
def test_a_row_is_of_the_model_that_the_run_opened(write_model, more):
    spec = write_model(GOOD, more=more)
    (name,), external = identify([spec])
    close_models()
    row = evaluate_task(Task(name, "pull_off_force", CASE, external[name]))
    assert (row.model, row.model_version) == (name, external[name].version)
    assert (row.status, row.value) == ("failed", None)
    assert row.reason.endswith(f"in a later process, and was {name} {external[name].version}")


@pytest.mark.parametrize("more", ["name = 'jkr' if len(sys.argv) else ''", "name = '<b>'"])
def test_one_that_takes_a_name_it_may_not_have_fails_too(write_model, more):
    first = ExternalIdentity("stranger", "1 (0)", write_model(GOOD, more=more), "A. Author", "tests")
    row = evaluate_task(Task("stranger", "pull_off_force", CASE, first))
    assert (row.model, row.model_version, row.status) == ("stranger", "1 (0)", "failed")


@pytest.mark.parametrize("more", BY_PROCESS[:2])
def test_a_process_that_had_to_be_started_again_is_compared_with_the_first(write_model, more):
    model = create(write_model("if problem.mu == 7:\n    os._exit(1)\n" + GOOD, more=more))
    rows = [evaluate(model, "pull_off_force", Case(2, 0, mu)) for mu in (1, 7, 1, 1)]
    assert [row.status for row in rows] == ["ok", "failed", "failed", "failed"]
    assert "exit status 1" in rows[1].reason
    assert rows[2].reason == rows[3].reason
    assert rows[2].reason.startswith("the model's name or version changed")
    assert {(row.model, row.model_version) for row in rows} == {(model.name, model.version)}


def test_a_file_that_changes_during_a_run_is_noticed(write_model, tmp_path):
    (tmp_path / "table.csv").write_text("1")
    model = create(write_model("if problem.mu == 7:\n    os._exit(1)\n" + GOOD))
    evaluate(model, "pull_off_force", Case(2, 0, 7))
    (tmp_path / "table.csv").write_text("2")
    row = evaluate(model, "pull_off_force", Case(2, 0, 1))
    assert row.status == "failed"
    assert row.reason.startswith("the model's files changed after it was loaded: it is stranger 1 (")
