"""External models whose numbers changed under the same version."""

from pathlib import Path

import pytest

from comparisons.cli.main import main
from comparisons.external.model_source import close_models
from comparisons.runs.record import read_record
from comparisons.runs.tables import read_table

from .conftest import GATE

PAD = Path(__file__).parents[3] / "docs" / "examples" / "problems" / "graded_pad.toml"


@pytest.fixture
def once(write_model, few_cases, tmp_path, tmp_path_factory, capsys):
    """Return a function that writes the data the model reads, computes, and returns status and messages.

    The data are not in the folder of the model, whose digest would show the change.
    """
    (tmp_path / "gates.toml").write_text(GATE)
    data = tmp_path_factory.mktemp("elsewhere") / "data.txt"

    def go(text, command=("run", "--gates", str(tmp_path / "gates.toml"))):
        data.write_text(text)
        close_models()
        spec = write_model(f"return Result(float(Path({str(data)!r}).read_text()), 0.0)")
        capsys.readouterr()
        status = main([*command, "--jobs", "1", "--out", str(tmp_path / "out"), "--model", spec, "jkr"])
        return status, capsys.readouterr().err

    return go


def values(folder):
    table = read_table(folder / "out" / "results.parquet")
    return table.loc[table["model"] == "stranger", "value"].tolist()


def again(folder):
    return read_record(folder / "out" / "run.json").get("evaluated_again", {"models": {}})["models"].get("stranger")


def test_an_old_pass_does_not_stand_when_the_data_have_changed(once, tmp_path):
    once("2.0")
    assert again(tmp_path) is None
    _, messages = once("2.0")
    assert "0 computations" in messages
    assert again(tmp_path)["same"]
    assert len(again(tmp_path)["tasks"]) == 3
    status, messages = once("2.5")
    assert status == 1
    assert "stranger has changed" in messages
    assert values(tmp_path) == [2.5] * 4
    assert not again(tmp_path)["same"]
    # The rows that were not trusted are gone for good.
    assert "0 computations" in once("2.5")[1]


def test_a_model_that_fails_now_is_not_passed_and_its_failures_are_computed_again(once, tmp_path):
    once("2.0")
    status, messages = once("two")
    assert status == 4
    assert "is failed" in messages
    assert 2.0 not in values(tmp_path)
    once("2.0")
    assert values(tmp_path) == [2.0] * 4


def test_old_rows_of_a_sweep_over_a_problem_file_do_not_stand(once, tmp_path):
    sweep = ["sweep", "--problem", str(PAD), "--vary", "punch.R=1:4:4 um", "--quantity", "pull_off_force"]
    assert once("2.0", sweep)[0] == 0
    first = values(tmp_path)
    status, messages = once("2.0", sweep)
    assert status == 0
    assert "0 computations" in messages
    assert again(tmp_path)["same"]
    status, messages = once("3.0", sweep)
    assert status == 0
    # All of this model, and none of the other.
    assert "4 are stored" in messages
    assert values(tmp_path) == pytest.approx([1.5 * value for value in first])
    assert once("three", sweep)[0] == 4
    assert once("2.0", sweep)[0] == 0
    assert values(tmp_path) == pytest.approx(first)
