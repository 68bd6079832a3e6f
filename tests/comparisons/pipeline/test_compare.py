"""Comparison of models in cases of a user: table, figure, terminal, notebook, run folder."""

import json
import re
from dataclasses import replace

import pandas as pd
import pytest

import comparisons
from comparisons.cli.main import main
from comparisons.output.errors import comparison_table, error_summary
from comparisons.output.summaries import WIDTH, case_tables
from comparisons.runs.cases import load_grids
from comparisons.runs.csv_format import read_table
from comparisons.runs.frames import frame
from comparisons.runs.record import check_files, read_record
from tests.comparisons.grid_text import PAD, grid_text
from tests.comparisons.rows import row

QUANTITIES = ["pull_off_force", "zero_load_displacement"]
GRID = grid_text(["ten-percent"], "exact", QUANTITIES, n=[2], k=[0, 0.4], mu=[0.1, 1])


@pytest.fixture(autouse=True)
def without_pictures(request, monkeypatch):
    if "with_pictures" not in request.fixturenames:
        monkeypatch.setattr("comparisons.pipeline.compare.Comparison.figure", lambda compared: None)
        monkeypatch.setattr("comparisons.pipeline.compare.save", lambda figure, *paths: None)


@pytest.fixture
def with_pictures():
    """The pictures are drawn."""


def test_every_case_and_model_has_a_row(toys, tmp_path):
    compared = comparisons.compare(["ten-percent", "refuses", "fails"], GRID, folder=tmp_path / "out")
    assert len(compared.table) == 2 * 4 * 3
    is_ten = compared.table["model"] == "ten-percent"
    assert compared.table.loc[is_ten, "kappa"].tolist() == pytest.approx([0.1] * 8)
    # (u of 2.2 + 1.1 u of 2) / 2
    assert compared.table.loc[is_ten, "u_kappa"].tolist() == pytest.approx([1.05e-9] * 8)
    assert compared.table.loc[~is_ten, ["value", "kappa", "u_kappa"]].isna().all(axis=None)
    assert compared.table.loc[~is_ten, "reason"].nunique() == 2
    summary = compared.summary.set_index(["quantity", "model"]).loc["pull_off_force"]
    counts = summary[["asked", "answered", "not_applicable", "failed", "cases"]]
    expected = {"ten-percent": [4, 4, 0, 0, 4], "refuses": [4, 0, 4, 0, 0], "fails": [4, 0, 0, 4, 0]}
    assert {model: row.tolist() for model, row in counts.iterrows()} == expected
    assert [failure.model for failure in compared.failures] == ["fails"] * 8
    shown = repr(compared)
    assert {"ten-percent", "refuses", "fails"} <= set(shown.split())
    assert max(map(len, shown.splitlines())) <= WIDTH
    # A notebook shows escaped tables with every digit.
    hostile = compared.table.replace({"model": {"ten-percent": "<script>alert(1)</script>"}})
    html = replace(compared, table=hostile, summary=error_summary(hostile))._repr_html_()
    assert "<script>" not in html
    assert "&lt;script&gt;" in html
    assert f'<data value="{float(compared.table["kappa"].max())!r}">' in html


def test_paths_are_texts_or_path_objects(toys, tmp_path):
    (tmp_path / "pad.toml").write_text(PAD)
    arguments = {"reference": "exact", "folder": str(tmp_path / "out")}
    compared = comparisons.compare("ten-percent", problem=str(tmp_path / "pad.toml"), **arguments)
    assert compared.table["kappa"].tolist() == pytest.approx([0.1])
    assert compared.folder == tmp_path / "out"
    finished = comparisons.run(GRID, models=["ten-percent"], folder=str(tmp_path / "run"))
    assert finished.folder == tmp_path / "run"
    with pytest.raises(ValueError, match=r"gates\.toml.*Path"):
        comparisons.run(GRID, gates="gates.toml", models=["ten-percent"], folder=tmp_path / "judged")
    # Found and read: it has no gates that this candidate is judged by.
    (tmp_path / "gates.toml").write_text("")
    with pytest.raises(ValueError, match="gate"):
        comparisons.judge_folder(str(tmp_path / "run"), str(tmp_path / "gates.toml"))


def test_the_folder_is_a_run_folder_that_is_resumed(toys, with_pictures, tmp_path, capsys):
    compared = comparisons.compare(["ten-percent"], GRID, folder=tmp_path)
    record = read_record(tmp_path / "run.json")
    check_files(record, tmp_path)
    assert {"comparison.csv", "comparison.png", "comparison.pdf"} <= record["files"].keys()
    pd.testing.assert_frame_equal(read_table(tmp_path / "comparison.csv"), compared.table, check_dtype=False)
    for kind in ("png", "pdf"):
        assert (tmp_path / f"comparison.{kind}").stat().st_size > 1000
    # A sweep of the folder computes nothing twice, and leaves no comparison of other models in it.
    (tmp_path / "mine.toml").write_text(GRID)
    capsys.readouterr()
    sweep = ["sweep", str(tmp_path / "mine.toml"), "--model", "ten-percent", "refuses", "--jobs", "1"]
    assert main([*sweep, "--out", str(tmp_path)]) == 0
    assert "8 computations, 1 at a time, 16 are stored" in capsys.readouterr().err
    assert not list(tmp_path.glob("comparison.*"))


def test_the_command_fits_80_columns_and_states_reference_and_coverage(tmp_path, capsys):
    models = ["jkr", "md-improved", "md-original", "dmt", "bradley", "semi-rigid"]
    case = ["--n", "1", "2", "--k", "0.4", "--mu", "0.01", "0.123", "20"]
    assert main(["compare", *models, *case, "--reference", "atlas", "--out", str(tmp_path), "--jobs", "1"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= WIDTH
    at = lines.index("pull-off force: kappa in percent (bound) against atlas,")
    assert lines[at + 1] == "atlas in pi Q^(2/n) dgamma z0^(2/n-1)"
    heads = [line.split() for line in lines if line.split()[:3] == ["n", "k", "μ"]]
    assert [model for head in heads for model in head[4:]] == models
    # The atlas ends at mu = 10: the models have values there, and no error.
    assert any(re.match(r" *2 +0\.4 +20 +none +no reference", line) for line in lines)
    assert any(re.match(r" *semi-rigid +0 of 6 \(6 n/a\)", line) for line in lines)
    assert any(re.match(r" *jkr +6 of 6 +-\d", line) for line in lines)
    (grid,) = load_grids((tmp_path / "grid.toml").read_text(), tiers=None)
    assert (grid.reference, len(grid.cases)) == ("atlas", 6)


def test_all_models_at_equal_ratios_as_latex(tmp_path, capsys, monkeypatch, typeset):
    """Models that are applicable in no case are left out, but for those that are named."""
    models = ("jkr", "jkr-sphere", "semi-rigid", "md-improved", "carpick-ogletree-salmeron", "pietrement-troyon")
    monkeypatch.setattr("comparisons.pipeline.compare.COMPARABLE", models)
    case = ["--n", "2", "--k", "0", "--mu", "0.1:10:4", "--reference", "atlas", "--out", str(tmp_path), "--jobs", "1"]
    assert main(["compare", "jkr-sphere", "--model", "all", *case, "--latex"]) == 0
    typeset(text := capsys.readouterr().out)
    assert text.startswith("% The document needs ")
    assert text.count("usepackage") == 1
    assert ("pdflscape" in text) is (r"\begin{landscape}" in text)
    table = read_table(tmp_path / "comparison.csv")
    assert sorted(set(table["mu"])) == [0.1, 0.464159, 2.15443, 10.0]
    compared = set(models) - {"semi-rigid"}
    assert set(table["model"]) == compared
    assert all(text.count(rf"{{{model}}}") for model in compared)


def test_a_reference_that_needs_no_poisson_ratio_is_the_one_of_a_case_with_it():
    """A case with nu: the finite elements get it, the FSCM does not."""
    text = GRID.replace('"exact"', '"fscm"').replace('"ten-percent"', '"fem"').replace("[0, 0.4]", "[0]")
    rows = [
        row(model, quantity, k=0.0, mu=mu, nu=nu, value=value, u_num=0.0)
        for model, nu, value in (("fem", 0.25, 1.1), ("fscm", None, 1.0))
        for quantity in QUANTITIES
        for mu in (0.1, 1.0)
    ]
    table = comparison_table(frame(rows), load_grids(text + "nu = [0.25]", tiers=None), None)
    assert table["nu"].tolist() == [0.25] * 4
    assert table["kappa"].tolist() == pytest.approx([0.1] * 4)
    texts, _ = case_tables(table)
    assert list(texts.texts) == ["n", "k", "μ", "ν", "fscm", "fem"]


def test_the_keys_of_a_problem_file_make_cases(tmp_path, capsys):
    (tmp_path / "pad.toml").write_text(PAD)
    vary = ["--problem", str(tmp_path / "pad.toml"), "--vary", "law.work_of_adhesion=1, 2 J/m^2"]
    out = ["--out", str(tmp_path / "out"), "--jobs", "1"]
    assert main(["compare", "dmt", *vary, "--reference", "bradley", *out]) == 0
    printed = capsys.readouterr().out
    assert re.search(r" 6\.28318\d* µN", printed)
    assert "dgamma" not in printed
    table = read_table(tmp_path / "out" / "comparison.csv")
    assert table["law.work_of_adhesion [J/m^2]"].tolist() == [1.0, 2.0]
    assert table["problem"].str.extract(r"work_of_adhesion=(\d)")[0].tolist() == ["1", "2"]
    # The force is that of the punch alone, in newtons.
    assert table["value"][1] == pytest.approx(2.0 * table["value"][0])
    assert table["kappa"].tolist() == pytest.approx([0.0, 0.0], abs=1e-9)
    assert set(table["reference"]) == {"bradley"}
    # The keys beside their problem, the unit beside the value.
    names = "quantity model n k mu nu problem law.work_of_adhesion value u_num unit reference reference_value"
    written = [name.partition(" ")[0] for name in read_table(tmp_path / "out" / "kappa.csv")]
    assert written == [*names.split(), "u_reference", "kappa", "u_kappa"]


CASE = ["--n", "2", "--k", "0", "--mu", "1"]


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (["jkr"], "--n and --k and --mu"),
        (["jkr", *CASE[:-1], "-1"], "mu = -1"),
        (["fscm", *CASE], "fscm is the reference"),
        (["jkr", *CASE, "--quantity", "force_curve"], "the curve force_curve"),
        (["jkr", *CASE, "--reference", "jkr"], "jkr is the reference"),
        (["jkr", "--grid", "GRID", "--mu", "1"], "--grid states the cases"),
        (["jkr", "--grid", "GRID", "--quantity", "pull_off_force"], "leave out --quantity"),
        (["no-such-model", *CASE], "unknown model"),
        (CASE, "no model"),
        (["jkr", *CASE[:-1], "0.1:10"], "'0.1:10'"),
        (["jkr", *CASE[:-1], "0:10:5"], "above 0"),
        (["jkr", *CASE[:-1], "1:2:1"], "1 values"),
        (["jkr", *CASE[:-1], "1:1:3"], "too near"),
        (["jkr", *CASE, "--n", "1:2:x"], "'1:2:x'"),
        (["jkr", "--problem", "pad.toml", "--mu", "1"], "leave out --grid, --n, --k, --mu and --nu"),
        (["jkr", *CASE, "--vary", "punch.R=1, 2 um"], "--problem FILE"),
    ],
)
def test_what_cannot_be_compared_is_one_sentence(tmp_path, refused, arguments, named):
    (tmp_path / "grid.toml").write_text(GRID.replace('"exact"', '"fscm"').replace('"ten-percent"', '"jkr"'))
    words = [str(tmp_path / "grid.toml") if word == "GRID" else word for word in arguments]
    refused(["compare", *words, "--out", tmp_path / "out"], named)
    assert not (tmp_path / "out" / "store.sqlite").exists()


def test_a_comparison_without_a_value_of_the_reference_is_no_success(tmp_path, capsys):
    """The atlas ends at mu = 10."""
    assert (
        main(["compare", "jkr", *CASE[:-1], "20", "--reference", "atlas", "--out", str(tmp_path), "--jobs", "1"]) == 4
    )
    assert "nothing was evaluated" in capsys.readouterr().err


def test_a_failed_computation_is_the_exit_status(toys, tmp_path, capsys):
    (tmp_path / "grid.toml").write_text(GRID)
    options = ["--grid", str(tmp_path / "grid.toml"), "--out", str(tmp_path / "out"), "--jobs", "1", "--quiet"]
    assert main(["compare", "fails", *options]) == 4
    printed = capsys.readouterr()
    assert printed.out == ""
    assert "100 iterations were not enough" in printed.err
    assert json.loads((tmp_path / "out" / "run.json").read_text())["command_name"] == "sweep"


def test_the_rows_of_a_varied_key_are_in_the_order_of_its_values_and_a_refusal_has_its_reason(tmp_path, capsys):
    (tmp_path / "pad.toml").write_text(PAD)
    vary = ["--problem", str(tmp_path / "pad.toml"), "--vary", "law.work_of_adhesion=20, 100, 3 J/m^2"]
    out = ["--reference", "bradley", "--out", str(tmp_path / "out"), "--jobs", "1"]
    assert main(["compare", "dmt", "jkr-sphere", *vary, *out]) == 0
    printed = capsys.readouterr().out
    assert [line.split()[0] for line in printed.splitlines()[3:6]] == ["3", "20", "100"]
    _, refused, reason = " ".join(printed.split()).partition("n/a in 3 of 3 cases: ")
    assert refused
    assert "ball" in reason
