"""Comparison of models in cases of one's own: table, figure, terminal, notebook, run folder."""

import json
import re
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from rich.console import Console

import comparisons
from comparisons.cli.main import main
from comparisons.judging.summary import coverage_text
from comparisons.output.comparison import WIDTH, case_tables, terminal_tables
from comparisons.output.errors import comparison_table, error_summary
from comparisons.runs.cases import load_grids
from comparisons.runs.frames import frame, read_table
from comparisons.runs.record import check_files, read_record
from tests.comparisons.rows import row

ROOT = Path(__file__).resolve().parents[3]

GRID = """
[[grid]]
id = "mine"
title = "Toys"
reference = "exact"
models = ["ten-percent"]
quantities = ["pull_off_force", "zero_load_displacement"]
n = [2]
k = [0, 0.4]
mu = [0.1, 1]
"""


@pytest.fixture(autouse=True)
def pictures(request, monkeypatch):
    """Whether a picture is drawn; without `drawn` its file is empty: drawing takes longer than all the rest."""
    if "drawn" not in request.fixturenames:
        monkeypatch.setattr("comparisons.pipeline.compare.save", lambda figure, path: path.touch())


@pytest.fixture
def drawn():
    """Pictures are drawn in a test with this fixture."""


def test_every_case_and_model_has_a_row(toys, tmp_path):
    models = ["ten-percent", "refuses", "fails"]
    found = comparisons.compare(models, GRID, folder=tmp_path / "out")
    assert len(found.table) == 2 * 4 * 3
    ten = found.table[found.table["model"] == "ten-percent"]
    assert ten["kappa"].tolist() == pytest.approx([0.1] * 8)
    # (u of 2.2 + 1.1 u of 2) / 2
    assert ten["u_kappa"].tolist() == pytest.approx([1.05e-9] * 8)
    others = found.table[found.table["model"] != "ten-percent"]
    assert others[["value", "kappa", "u_kappa"]].isna().all(axis=None)
    assert set(others["reason"]) == {"it has no such [thing]", "100 iterations were not enough; start nearer"}
    counts = found.summary.set_index(["quantity", "model"])[["asked", "answered", "not_applicable", "failed", "cases"]]
    assert counts.loc["pull_off_force"].to_dict("index") == {
        "ten-percent": {"asked": 4, "answered": 4, "not_applicable": 0, "failed": 0, "cases": 4},
        "refuses": {"asked": 4, "answered": 0, "not_applicable": 4, "failed": 0, "cases": 0},
        "fails": {"asked": 4, "answered": 0, "not_applicable": 0, "failed": 4, "cases": 0},
    }
    assert [row.model for row in found.failures] == ["fails"] * 8


def test_the_folder_is_a_run_folder_that_is_resumed(toys, tmp_path, capsys, monkeypatch, drawn):
    first = comparisons.compare(["ten-percent"], GRID, folder=tmp_path)
    record = read_record(tmp_path / "run.json")
    check_files(record, tmp_path)
    assert {"comparison.csv", "comparison.parquet", "comparison.png", "comparison.pdf"} <= record["files"].keys()
    pd.testing.assert_frame_equal(read_table(tmp_path / "comparison.parquet"), first.table, check_dtype=False)
    for kind in ("png", "pdf"):
        assert (tmp_path / f"comparison.{kind}").stat().st_size > 1000
    capsys.readouterr()
    monkeypatch.setattr("comparisons.pipeline.compare.save", lambda figure, path: path.touch())
    comparisons.compare(["ten-percent", "refuses"], GRID, folder=tmp_path)
    assert "8 computations on 1 processes, 16 are stored" in capsys.readouterr().err
    # A sweep of the folder leaves no comparison of other models in it.
    (tmp_path / "grid-of-a-sweep.toml").write_text(GRID)
    assert main(["sweep", str(tmp_path / "grid-of-a-sweep.toml"), "--out", str(tmp_path), "--jobs", "1"]) == 0
    assert not list(tmp_path.glob("comparison.*"))


def test_the_command_fits_80_columns_and_states_reference_and_coverage(tmp_path, capsys):
    models = ["jkr", "md-improved", "md-original", "dmt", "bradley", "semi-rigid"]
    case = ["--n", "1", "2", "--k", "0.4", "--mu", "0.01", "0.123", "20"]
    assert main(["compare", *models, *case, "--reference", "atlas", "--out", str(tmp_path), "--jobs", "1"]) == 0
    shown = capsys.readouterr()
    lines = shown.out.splitlines()
    assert max(map(len, lines)) <= WIDTH
    assert "pull_off_force: kappa in percent (uncertainty) against atlas" in lines
    heads = [line.split() for line in lines if line.split()[:3] == ["n", "k", "mu"]]
    assert [model for head in heads for model in head[4:]] == models
    # The atlas ends at mu = 10: the models have values there, and no error.
    assert any(re.match(r" *2 +0\.4 +20 +none +no reference", line) for line in lines)
    assert any(re.match(r" *semi-rigid +0 of 6 \(6 n/a\)", line) for line in lines)
    assert any(re.match(r" *jkr +6 of 6 +-\d", line) for line in lines)
    grid = (tmp_path / "grid.toml").read_text()
    assert 'reference = "atlas"' in grid
    assert len(load_grids(grid, tier="quick")[0].cases) == 6


def printed(table, capsys, **options):
    console = Console(width=WIDTH)
    for one in terminal_tables(table, error_summary(table), **options):
        console.print(one)
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= WIDTH
    return lines


def test_a_reference_that_needs_no_poisson_ratio_is_found():
    """A case with nu: the finite elements get it, the FSCM does not."""
    grid = load_grids(GRID.replace('"exact"', '"fscm"').replace('"ten-percent"', '"fem"') + "nu = [0.25]", "quick")
    rows = [
        row(model, quantity, k=k, mu=mu, nu=nu, value=value, u_num=0.0)
        for model, nu, value in (("fem", 0.25, 1.1), ("fscm", None, 1.0))
        for quantity in ("pull_off_force", "zero_load_displacement")
        for k in (0.0, 0.4)
        for mu in (0.1, 1.0)
    ]
    table = comparison_table(frame(rows), grid, None)
    assert table["nu"].tolist() == [0.25] * 8
    assert table["kappa"].tolist() == pytest.approx([0.1] * 8)
    texts, _ = case_tables(table)
    assert list(texts.texts) == ["n", "k", "mu", "nu", "fscm", "fem"]


def fake(models=("a", "b"), quantities=("pull_off_force",), **other):
    base = {"n": 2.0, "k": 0.0, "nu": np.nan, "status": "ok", "value": 1.1, "u_num": 0.0, "reason": ""}
    base |= {"reference": "fscm", "reference_value": 1.0, "u_reference": 1e-9, "kappa": 0.1, "u_kappa": 1e-9}
    rows = [
        base | {"quantity": quantity, "model": model, "mu": mu} | other
        for quantity in quantities
        for mu in (0.1, 1.0, 3.0)
        for model in models
    ]
    return pd.DataFrame(rows)


def test_the_notebook_shows_escaped_tables_with_every_digit():
    table = fake(("<script>alert(1)</script>", "b"))
    html = comparisons.pipeline.compare.Comparison(table, error_summary(table), Path(), ())._repr_html_()
    assert "<script>" not in html
    assert "&lt;script&gt;" in html
    assert html.count("<table") == 2
    assert '<data value="0.1">' in html
    assert "3 of 3" in html


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["jkr"], "the cases need --n and --k and --mu, or a file of them as --grid FILE"),
        (["jkr", "--n", "2", "--mu", "1"], "the cases need --k"),
        (["jkr", "--n", "2", "--k", "0", "--mu", "-1"], "mu = -1"),
        (["fscm", "--n", "2", "--k", "0", "--mu", "1"], "fscm is the reference of the grid comparison"),
        (["jkr", "--n", "2", "--k", "0", "--mu", "1", "--quantity", "force_curve"], "the curve force_curve"),
        (["jkr", "--n", "2", "--k", "0", "--mu", "1", "--quantity", "colour"], "'colour'"),
        (["jkr", "--n", "2", "--k", "0", "--mu", "1", "--reference", "jkr"], "'jkr'"),
        (["jkr", "--n", "2", "--k", "0", "--mu", "nan"], "nan"),
        (["jkr", "--grid", "GRID", "--mu", "1"], "--grid states the cases"),
        (["jkr", "--grid", "GRID", "--quantity", "pull_off_force"], "leave out --quantity"),
        (["no-such-model", "--n", "2", "--k", "0", "--mu", "1"], "unknown model"),
    ],
)
def test_what_cannot_be_compared_is_one_sentence(tmp_path, capsys, arguments, sentence):
    (tmp_path / "grid.toml").write_text(GRID.replace('"exact"', '"fscm"').replace('"ten-percent"', '"jkr"'))
    named = [str(tmp_path / "grid.toml") if word == "GRID" else word for word in arguments]
    assert main(["compare", *named, "--out", str(tmp_path / "out")]) == 2
    shown = capsys.readouterr().err
    assert sentence in shown
    assert shown.count("\n") == 1
    assert not (tmp_path / "out" / "store.sqlite").exists()


def test_a_failed_computation_is_the_exit_status(toys, tmp_path, capsys):
    (tmp_path / "grid.toml").write_text(GRID)
    options = ["--grid", str(tmp_path / "grid.toml"), "--out", str(tmp_path / "out"), "--jobs", "1", "--quiet"]
    assert main(["compare", "fails", *options]) == 4
    shown = capsys.readouterr()
    assert shown.out == ""
    assert "100 iterations were not enough" in shown.err
    record = json.loads((tmp_path / "out" / "run.json").read_text())
    assert record["command_name"] == "sweep"


def test_coverage_is_beside_the_errors():
    table = fake().assign(status=["ok", "not-applicable", "ok", "failed", "ok", "ok"])
    table.loc[table["status"] != "ok", "kappa"] = np.nan
    summary = error_summary(table).set_index("model")
    assert coverage_text(summary.loc["a"]) == "3 of 3"
    assert coverage_text(summary.loc["b"]) == "1 of 3 (1 n/a, 1 failed)"
    assert summary.loc["b", "cases"] == 1
