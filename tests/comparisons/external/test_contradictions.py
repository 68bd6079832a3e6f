"""Models that differ between two processes: failed rows, each with the reason."""

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.external.model_source import close_models
from comparisons.registry import ExternalIdentity, create, identify
from comparisons.runs.cases import Case
from comparisons.runs.tasks import Task, evaluate, evaluate_task

from .conftest import CASE, GOOD

BY_PROCESS = "version = os.urandom(8).hex()"


def test_a_run_goes_on_with_a_model_that_names_itself_by_its_process(write_model, few_cases, tmp_path):
    specs = [write_model(name="good"), write_model(more="name = f'stranger-{os.getpid()}'")]
    # With two processes each of them opens the model again.
    assert main(["run", "--jobs", "2", "--out", str(tmp_path / "out"), "--model", *specs]) == 4
    table = pd.read_csv(tmp_path / "out" / "results.csv", dtype=str)
    strange = table[table["model"].str.startswith("stranger")]
    assert strange["model"].nunique() == strange["model_version"].nunique() == 1
    assert strange["status"].tolist() == ["failed"] * 4
    assert strange["reason"].str.contains("name or version changed").all()
    assert table.loc[table["model"] == "good", "status"].tolist() == ["ok"] * 4


def test_a_row_is_of_the_model_that_the_run_opened(write_model):
    (name,), external = identify([write_model(more=BY_PROCESS)])
    close_models()
    row = evaluate_task(Task(name, "pull_off_force", CASE, external[name]))
    assert (row.model, row.model_version, row.status) == (name, external[name].version, "failed")


@pytest.mark.parametrize("more", ["name = 'jkr'", "name = '<b>'"])
def test_one_that_takes_a_name_it_may_not_have_fails_too(write_model, more):
    first = ExternalIdentity("stranger", "1 (0)", write_model(more=more), "A. Author", "tests")
    row = evaluate_task(Task("stranger", "pull_off_force", CASE, first))
    assert (row.model, row.model_version, row.status) == ("stranger", "1 (0)", "failed")


def test_a_process_that_had_to_be_started_again_is_compared_with_the_first(write_model):
    model = create(write_model(f"if problem.mu == 7:\n    os._exit(1)\n{GOOD}", more=BY_PROCESS))
    rows = [evaluate(model, "pull_off_force", Case(2, 0, mu)) for mu in (1, 7, 1, 1)]
    assert [row.status for row in rows] == ["ok", "failed", "failed", "failed"]
    assert "exit status 1" in rows[1].reason
    assert rows[2].reason == rows[3].reason
    assert "name or version changed" in rows[2].reason


def test_a_file_that_changes_during_a_run_is_noticed(write_model, tmp_path):
    (tmp_path / "table.csv").write_text("1")
    model = create(write_model())
    model.close()
    (tmp_path / "table.csv").write_text("2")
    row = evaluate(model, "pull_off_force", Case(2, 0, 1))
    assert row.status == "failed"
    assert row.reason.startswith("the model's files changed")
