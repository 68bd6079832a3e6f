"""A run with shipped values: the same tables, a few values computed again, no judgement if one is not confirmed."""

import json
import sys
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from functools import partial

import pytest

from comparisons.cli.main import main
from comparisons.data.file_names import RUN_FILES
from comparisons.pipeline.run import run
from comparisons.runs.frames import rows_of
from comparisons.runs.record import read_record
from comparisons.runs.shipped_values import load_shipped, write_shipped
from comparisons.runs.tables import read_table
from tests.comparisons.conftest import GATES, GRID, Toy

#: Two of four cases, for a candidate that has a value and for one that has none.
HALF = GATES.replace("mu = [0.1, 1]", "mu = [1, 1]").replace("min_cases = 4", "min_cases = 2") + GATES.replace(
    "TEN-PERCENT", "REFUSES"
).replace('"ten-percent"', '"refuses"').replace("mu = [0.1, 1]", "k = [0, 0]").replace(
    "min_cases = 4", 'min_cases = 1\nnot_applicable = "leave-out"'
)


@pytest.fixture
def shipped(small_grid, tmp_path, monkeypatch):
    """The folder of a run that computed everything; the values of its reference are then shipped."""
    for module in ("pipeline.results", "runs.shipped_values"):
        monkeypatch.setattr(f"comparisons.{module}.SHIPPED_MODELS", ("exact",))
    monkeypatch.setattr("comparisons.pipeline.results.load_shipped", partial(load_shipped, tmp_path / "shipped"))
    folder = tmp_path / "computed"
    run("quick", folder=folder)
    rows = rows_of(*(read_table(folder / f"{name}.parquet") for name in ("results", "curves")))
    write_shipped(read_record(folder / "run.json"), rows, tmp_path / "shipped")
    return folder


def computed(folder):
    """The model and the parameters of each row that a run has computed."""
    lines = (folder / "journal.jsonl").read_text().splitlines()[1:]
    return [json.loads(line)["entry"]["item"] for line in lines]


def test_shipped_values_give_the_same_files(shipped, tmp_path, capsys):
    finished = run("quick", folder=tmp_path / "new")
    assert finished.counts == {"all": 12, "resumed": 0, "shipped": 4, "ok": 8, "not-applicable": 4}
    assert {row["model"] for row in computed(tmp_path / "new")} == {"ten-percent", "refuses"}
    for name in {path.name for path in shipped.iterdir()} & set(RUN_FILES) - {"results.parquet", "junit.xml"}:
        assert (shipped / name).read_bytes() == (tmp_path / "new" / name).read_bytes(), name
    assert "4 values of exact are shipped with fscm-bench; 3 of them" in capsys.readouterr().err


def test_the_record_names_the_shipped_values_and_those_that_were_computed_again(shipped, tmp_path):
    run("quick", folder=tmp_path / "new")
    record = read_record(tmp_path / "new" / "run.json")
    entry = record["shipped"]
    cases = [f"n = 2, k = {k}, mu = {mu}" for k in ("0", "0.4") for mu in ("0.1", "1")]
    assert entry["rows"] == [{"model": "exact", "quantity": "pull_off_force", "cases": cases}]
    origin = read_record(shipped / "run.json")
    assert entry["origin"]["parts"] == origin["parts"]
    assert entry["origin"]["solvers_sha256"] == origin["package"]["solvers_sha256"]
    again = entry["evaluated_again"]
    assert again["seed"] >= 0
    assert again["models"]["exact"]["same"] is True
    assert len(again["models"]["exact"]["tasks"]) == 3
    assert sum(part["computations"] for part in record["parts"]) == 8
    assert "exact" not in record["seconds"]["by_model"]
    assert "shipped" not in origin


def test_the_report_states_which_values_were_shipped(shipped, tmp_path):
    run("quick", folder=tmp_path / "new")
    assert main(["report", str(tmp_path / "new")]) == 0
    text = (tmp_path / "new" / "report.html").read_text()
    assert "12 results, 4 of them shipped with fscm-bench" in text
    seed = read_record(tmp_path / "new" / "run.json")["shipped"]["evaluated_again"]["seed"]
    assert f"shipped values computed again (seed {seed})" in text
    assert "part 1 of the shipped values" in text


def test_a_value_that_is_not_confirmed_is_not_judged(shipped, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(sys.modules["toy_models"], "exact", lambda: Toy("exact", lambda problem: 2.0 + 1e-7))
    assert main(["run", "--jobs", "1", "--out", str(tmp_path / "new")]) == 4
    *_, sentence = capsys.readouterr().err.splitlines()
    assert "a shipped value of exact is not confirmed here" in sentence
    assert "was 2 and is 2.0000001" in sentence
    assert "--recompute" in sentence
    assert not (tmp_path / "new" / "verdicts.csv").exists()
    assert not (tmp_path / "new" / "run.json").exists()
    assert main(["run", "--jobs", "1", "--recompute", "--out", str(tmp_path / "new")]) == 0
    assert read_record(tmp_path / "new" / "run.json")["rows"]["all"] == 12


def test_the_processes_that_computed_confirm_the_shipped_values(shipped, tmp_path, monkeypatch):
    started = []

    class InThisProcess:
        def submit(self, function, item):
            future = Future()
            future.set_result(function(item))
            return future

        def shutdown(self, **_):
            pass

    monkeypatch.setattr("comparisons.runs.workers._pool", lambda: started.append(InThisProcess()) or started[-1])
    finished = run("quick", folder=tmp_path / "new", jobs=2)
    assert finished.counts["shipped"] == 4
    assert len(started) == 2


def test_a_process_that_dies_in_the_check_is_one_sentence(shipped, tmp_path, monkeypatch, capsys):
    def dying(*_):
        raise BrokenProcessPool

    monkeypatch.setattr("comparisons.pipeline.results.evaluate_again", dying)
    assert main(["run", "--jobs", "1", "--out", str(tmp_path / "new")]) == 4
    assert "a worker process ended early" in capsys.readouterr().err.splitlines()[-1]


def test_everything_is_computed_on_demand(shipped, tmp_path, capsys):
    finished = run("quick", folder=tmp_path / "new", recompute=True)
    assert finished.counts == {"all": 12, "resumed": 0, "ok": 8, "not-applicable": 4}
    assert "shipped" not in capsys.readouterr().err


def test_values_of_other_solvers_are_computed_and_one_sentence_says_so(shipped, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("comparisons.runs.shipped_values.solver_digest", lambda: "f" * 64)
    finished = run("quick", folder=tmp_path / "new")
    assert finished.counts["all"] == len(computed(tmp_path / "new")) == 12
    assert capsys.readouterr().err.count("the shipped values are of other solvers") == 1


def test_a_sweep_computes_its_own_values(shipped, tmp_path):
    finished = run(GRID.replace('tier = "quick"\n', ""), folder=tmp_path / "new")
    assert finished.counts == {"all": 12, "resumed": 0, "ok": 8, "not-applicable": 4}


@pytest.mark.parametrize("recompute", [True, False])
def test_a_run_of_models_has_the_rows_that_its_gates_need(shipped, tmp_path, recompute):
    finished = run("quick", HALF, ["ten-percent", "refuses"], tmp_path / "new", recompute=recompute)
    rows = finished.tables.results
    assert {model: len(group) for model, group in rows.groupby("model")} == {"exact": 2, "refuses": 2, "ten-percent": 2}
    assert set(rows.loc[rows["model"] != "refuses", "mu"]) == {1.0}
    assert set(rows.loc[rows["model"] == "refuses", "k"]) == {0.0}
    verdicts = finished.judgement.verdicts
    assert verdicts.loc[verdicts["gate"] == "TEN-PERCENT", "verdict"].map(str).tolist() == ["PASS", "PASS"]
    assert set(verdicts.loc[verdicts["gate"] == "REFUSES", "verdict"].map(str)) == {"NOT-APPLICABLE", "ERROR"}
    assert len(computed(tmp_path / "new")) == (6 if recompute else 4)


def test_other_gates_compute_what_they_need_into_the_same_folder(shipped, tmp_path, capsys):
    half = GATES.replace("mu = [0.1, 1]", "mu = [1, 1]").replace("min_cases = 4", "min_cases = 2")
    run("quick", half, ["ten-percent"], tmp_path / "new", recompute=True)
    whole = tmp_path / "whole.toml"
    whole.write_text(GATES)
    capsys.readouterr()
    assert main(["judge", str(tmp_path / "new"), "--gates", str(whole)]) == 4
    assert "2 results that these gates need are not in" in capsys.readouterr().err
    finished = run("quick", GATES, ["ten-percent"], tmp_path / "new", recompute=True)
    assert finished.counts == {"all": 8, "resumed": 4, "ok": 8}
    assert str(finished.verdict) == "PASS"


def test_gates_of_ones_own_need_no_other_rows(shipped, tmp_path):
    half = GATES.replace("mu = [0.1, 1]", "mu = [1, 1]").replace("min_cases = 4", "min_cases = 2")
    finished = run("quick", half, folder=tmp_path / "new")
    assert finished.counts == {"all": 4, "resumed": 0, "shipped": 2, "ok": 4}
    assert set(finished.tables.results["model"]) == {"exact", "ten-percent"}
    own = run(GRID.replace('tier = "quick"\n', ""), half, folder=tmp_path / "own")
    assert own.counts["all"] == 12
