"""The results that a run computes: those that its gates need."""

from comparisons.cli.main import main
from comparisons.pipeline.run import run
from comparisons.runs.store import rows_in
from tests.comparisons.conftest import GATES, GRID

#: Two of the four cases.
HALF = GATES.replace("mu = [0.1, 1]", "mu = [1, 1]").replace("min_cases = 4", "min_cases = 2")
#: Two others, for a candidate that has no value.
REFUSED = (
    HALF.replace("TEN-PERCENT", "REFUSES")
    .replace('"ten-percent"', '"refuses"')
    .replace("mu = [1, 1]", "k = [0, 0]")
    .replace("min_cases = 2", 'min_cases = 1\nnot_applicable = "leave-out"')
)


def test_a_run_of_models_has_the_rows_that_its_gates_need(small_grid, tmp_path):
    finished = run("quick", HALF + REFUSED, ["ten-percent", "refuses"], tmp_path)
    rows = finished.tables.results
    assert {model: len(group) for model, group in rows.groupby("model")} == {"exact": 3, "refuses": 2, "ten-percent": 2}
    assert set(rows.loc[rows["model"] == "ten-percent", "mu"]) == {1.0}
    assert set(rows.loc[rows["model"] == "refuses", "k"]) == {0.0}
    verdicts = finished.judgement.verdicts.astype({"verdict": str}).set_index("gate")["verdict"]
    assert verdicts["TEN-PERCENT"].tolist() == ["PASS", "PASS"]
    assert set(verdicts["REFUSES"]) == {"NOT-APPLICABLE", "ERROR"}
    with rows_in(tmp_path) as store:
        assert len(store.items) == 7
    # A model that no gate names is in the tables of errors.
    named = run("quick", HALF, ["ten-percent", "twelve-percent"], tmp_path / "named").tables.results
    assert named["model"].value_counts().to_dict() == {"exact": 4, "twelve-percent": 4, "ten-percent": 2}


def test_other_gates_compute_what_they_need_into_the_same_folder(small_grid, tmp_path, capsys):
    run("quick", HALF, ["ten-percent"], tmp_path / "new")
    (tmp_path / "all.toml").write_text(GATES)
    assert main(["judge", str(tmp_path / "new"), "--gates", str(tmp_path / "all.toml")]) == 4
    assert "a gate is in error: TEN-PERCENT of ten-percent: ten-percent has no row" in capsys.readouterr().err
    finished = run("quick", GATES, ["ten-percent"], tmp_path / "new")
    assert finished.counts == {"all": 8, "resumed": 4, "ok": 8}
    assert str(finished.verdict) == "PASS"


def test_gates_need_no_other_rows_of_standing_cases_and_all_of_others(small_grid, tmp_path):
    finished = run("quick", HALF, folder=tmp_path / "standing")
    assert finished.counts == {"all": 4, "resumed": 0, "ok": 4}
    assert set(finished.tables.results["model"]) == {"exact", "ten-percent"}
    assert run(GRID.replace('tier = "quick"\n', ""), HALF, folder=tmp_path / "mine").counts["all"] == 12
