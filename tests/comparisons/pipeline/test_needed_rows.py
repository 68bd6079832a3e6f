"""The results that a run computes: those that its gates need."""

from comparisons.cli.main import main
from comparisons.pipeline.run import run
from comparisons.runs.store import rows_in
from tests.comparisons.conftest import GATES, GRID

#: Two of four cases, for a candidate that has a value and for one that has none.
HALF = GATES.replace("mu = [0.1, 1]", "mu = [1, 1]").replace("min_cases = 4", "min_cases = 2") + GATES.replace(
    "TEN-PERCENT", "REFUSES"
).replace('"ten-percent"', '"refuses"').replace("mu = [0.1, 1]", "k = [0, 0]").replace(
    "min_cases = 4", 'min_cases = 1\nnot_applicable = "leave-out"'
)


def computed(folder):
    """The model and the parameters of each row that a run has computed."""
    with rows_in(folder) as store:
        return store.items


def test_a_run_of_models_has_the_rows_that_its_gates_need(small_grid, tmp_path):
    finished = run("quick", HALF, ["ten-percent", "refuses"], tmp_path / "new")
    rows = finished.tables.results
    assert {model: len(group) for model, group in rows.groupby("model")} == {"exact": 2, "refuses": 2, "ten-percent": 2}
    assert set(rows.loc[rows["model"] != "refuses", "mu"]) == {1.0}
    assert set(rows.loc[rows["model"] == "refuses", "k"]) == {0.0}
    verdicts = finished.judgement.verdicts
    assert verdicts.loc[verdicts["gate"] == "TEN-PERCENT", "verdict"].map(str).tolist() == ["PASS", "PASS"]
    assert set(verdicts.loc[verdicts["gate"] == "REFUSES", "verdict"].map(str)) == {"NOT-APPLICABLE", "ERROR"}
    assert len(computed(tmp_path / "new")) == 6


def test_other_gates_compute_what_they_need_into_the_same_folder(small_grid, tmp_path, capsys):
    half = GATES.replace("mu = [0.1, 1]", "mu = [1, 1]").replace("min_cases = 4", "min_cases = 2")
    run("quick", half, ["ten-percent"], tmp_path / "new")
    whole = tmp_path / "whole.toml"
    whole.write_text(GATES)
    capsys.readouterr()
    assert main(["judge", str(tmp_path / "new"), "--gates", str(whole)]) == 4
    assert "2 results that these gates need are not in" in capsys.readouterr().err
    finished = run("quick", GATES, ["ten-percent"], tmp_path / "new")
    assert finished.counts == {"all": 8, "resumed": 4, "ok": 8}
    assert str(finished.verdict) == "PASS"


def test_gates_of_ones_own_need_no_other_rows(small_grid, tmp_path):
    half = GATES.replace("mu = [0.1, 1]", "mu = [1, 1]").replace("min_cases = 4", "min_cases = 2")
    finished = run("quick", half, folder=tmp_path / "new")
    assert finished.counts == {"all": 4, "resumed": 0, "ok": 4}
    assert set(finished.tables.results["model"]) == {"exact", "ten-percent"}
    own = run(GRID.replace('tier = "quick"\n', ""), half, folder=tmp_path / "own")
    assert own.counts["all"] == 12
