"""A run: complete, repeatable, and not lost when it is interrupted."""

import json

import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.data.file_names import VERDICT_FILES
from comparisons.runs import computation as computing
from comparisons.runs.cases import load_grids
from comparisons.runs.computation import compute

FILES = {
    "store.sqlite",
    "results.csv",
    "results.parquet",
    "kappa.csv",
    "kappa.parquet",
    "largest_kappa.csv",
    "largest_kappa.parquet",
    "run.json",
    "datapackage.json",
    "gates.toml",
    "curves.csv",
    "curves.parquet",
    *VERDICT_FILES,
}

STANDING = """
[[grid]]
id = "standing"
title = "Closed forms"
tier = "quick"
reference = "bradley"
models = ["jkr"]
quantities = ["pull_off_force"]
n = [1.5, 2]
k = [0, 0.4]
mu = [0.5, 1]
"""


def run(folder, *more):
    return main(["run", "--jobs", "1", "--out", str(folder), *more])


def read(folder, name="results.csv"):
    return (folder / name).read_bytes()


def test_a_run_leaves_its_tables_and_record(small_grid, tmp_path, capsys):
    assert run(tmp_path / "out") == 0
    assert {path.name for path in (tmp_path / "out").iterdir()} == FILES
    captured = capsys.readouterr()
    assert "ten-percent" in captured.out
    assert "10.000(5)" in captured.out
    assert "results are in" in captured.err
    # Of models that the paper does not know there is nothing to show beside its numbers.
    assert "the paper prints" not in captured.out
    table = pd.read_parquet(tmp_path / "out" / "results.parquet")
    assert table.groupby("status").size().to_dict() == {"not-applicable": 4, "ok": 8}
    kappa = pd.read_csv(tmp_path / "out" / "kappa.csv")
    assert kappa["kappa"].tolist() == pytest.approx([0.1] * 4)
    assert kappa["u_kappa"].tolist() == pytest.approx([(1e-9 + 1.1e-9) / 2] * 4)


def test_the_record_says_where_the_numbers_come_from(small_grid, tmp_path):
    run(tmp_path, "--tier", "full")
    record = json.loads(read(tmp_path, "run.json"))
    assert record["arguments"]["tier"] == "full"
    assert record["arguments"]["out"] == str(tmp_path)
    assert record["rows"] == {"all": 12, "resumed": 0, "ok": 8, "not-applicable": 4}
    assert {"commit", "dirty", "version", "code_sha256"} <= record["package"].keys()
    assert {"cpu", "cores", "system"} <= record["machine"].keys()
    assert all(library["threads"] == 1 for library in record["blas"])
    assert record["started"] <= record["finished"]
    assert set(record["seconds"]["by_model"]) == {"exact", "ten-percent", "refuses"}


def test_the_figure_and_numbers_of_the_paper_are_shown_where_there_are_some(tmp_path, monkeypatch, capsys):
    grid = STANDING.replace('"jkr"', '"md-improved"').replace("1.5, 2", "2")
    monkeypatch.setattr("comparisons.pipeline.inputs.grids", lambda tier: load_grids(grid))
    run(tmp_path)
    assert (tmp_path / "fig16b_kappa.png").exists()
    assert "the paper prints, for k = 0.4" in capsys.readouterr().out
    monkeypatch.setattr("comparisons.pipeline.tables.save", lambda figure, path: path.touch())
    run(tmp_path, "--verbose")
    assert "paper_percent" in capsys.readouterr().out


def interrupt_after(count, error=KeyboardInterrupt):
    def interrupted(tasks, jobs, backend):
        for number, row in enumerate(compute(tasks, jobs, backend)):
            if number == count:
                raise error
            yield row

    return interrupted


def test_an_interrupted_run_goes_on_where_it_was(small_grid, tmp_path, monkeypatch, capsys):
    run(tmp_path / "whole")
    with monkeypatch.context() as patch:
        patch.setattr(computing, "compute", interrupt_after(5))
        assert run(tmp_path / "cut") == 130
    assert "5 finished computations are safe" in capsys.readouterr().err
    assert run(tmp_path / "cut") == 0
    assert "7 computations on 1 processes, 5 are stored" in capsys.readouterr().err
    assert read(tmp_path / "cut") == read(tmp_path / "whole")
    assert json.loads(read(tmp_path / "cut", "run.json"))["rows"]["resumed"] == 5


def test_a_failed_computation_costs_its_own_rows_and_the_exit_status(small_grid, tmp_path, capsys):
    assert run(tmp_path, "--model", "ten-percent", "fails", "--model", "broken", "picky", "nonsense") == 4
    table = pd.read_csv(tmp_path / "results.csv").set_index("model")
    assert set(table.loc["ten-percent", "status"]) == {"ok"}
    for name, why in {
        "fails": "100 iterations",
        "broken": "ZeroDivisionError",
        "picky": "outside",
        "nonsense": "nan",
    }.items():
        assert set(table.loc[name, "status"]) == {"failed"}
        assert table.loc[name, "reason"].str.contains(why).all()
        assert table.loc[name, "value"].isna().all()
    captured = capsys.readouterr()
    assert "16 failed" in captured.out
    assert "more computations failed" in captured.err


def test_verbose_prints_every_case_and_every_gate(small_grid, tmp_path, capsys):
    assert run(tmp_path, "--verbose") == 0
    captured = capsys.readouterr().out
    assert captured.count(" 10.00000(5)") >= 4
    assert "fscm-bench solve --model ten-percent" in captured


def test_quiet_prints_what_does_not_pass_and_nothing_else(small_grid, tmp_path, capsys):
    assert run(tmp_path / "right", "--quiet") == 0
    assert capsys.readouterr() == ("", "")
    (tmp_path / "gates.toml").write_text(small_grid.replace("upper = 0.11", "upper = 0.095"))
    assert run(tmp_path / "wrong", "--quiet", "--gates", str(tmp_path / "gates.toml")) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("FAIL TEN-PERCENT of ten-percent against exact: E = 0.100000(5)")
    assert "fscm-bench solve --model ten-percent" in captured.err
    assert main(["judge", str(tmp_path / "wrong"), "--quiet"]) == 1
    assert capsys.readouterr().err.startswith("FAIL TEN-PERCENT")
