"""Committed figures: all of them, with the numbers that the code computes.

Figures whose tables follow equilibrium paths are not compared: the solver places the points.  The curves of the quick
tier are compared through their gates.
"""

import shutil
from pathlib import Path

import pandas as pd
import pytest

from comparisons.baseline import main
from comparisons.paper.baseline import PAPER_BASELINE, changes, check, renew
from comparisons.paper.registry import NAMES, paper_figures
from comparisons.runs.csv_format import csv_text

FOLDER = Path(__file__).parents[3] / PAPER_BASELINE
#: Figures of closed forms, which take seconds; the others take minutes.
CHEAP = ("1", "2", "12")
COMPARED = [
    pytest.param(figure.name, marks=() if figure.name in CHEAP else pytest.mark.heavy)
    for figure in paper_figures()
    if not figure.follows_path
]


def committed(figure, name):
    return pd.read_csv(FOLDER / figure.table_file(name))


@pytest.mark.parametrize("name", COMPARED)
def test_the_numbers_are_those_committed(name, tables_of, tmp_path):
    (figure,) = paper_figures([name])
    for table, computed in tables_of(figure).items():
        path = tmp_path / "computed.csv"
        path.write_text(csv_text(computed))
        assert changes(committed(figure, table), pd.read_csv(path)) == []


def test_every_figure_is_there_and_nothing_else():
    files = set(FOLDER.iterdir())
    for figure in paper_figures():
        found = set(figure.files_in(FOLDER))
        assert found, f"{figure.name} is not committed"
        for suffix in (".png", ".pdf"):
            assert (FOLDER / f"{figure.stem}{suffix}" in found) == (figure.draw is not None)
        assert any(path.suffix == ".csv" for path in found) or not figure.tasks()
        assert found <= files, "two figures share a file"
        files -= found
    assert files == set()


def test_a_changed_number_text_or_row_is_seen():
    stored = committed(paper_figures(["16"])[0], "kappa")
    assert changes(stored, stored) == []
    moved = stored.assign(kappa=stored["kappa"].where(stored.index != 7, stored["kappa"] + 1e-5))
    assert changes(stored, moved) == ["kappa: up to 1e-05 apart"]
    assert changes(stored, stored.assign(u_kappa=0.0)) == []
    assert changes(stored, stored.assign(model="jkr")) == ["model: other texts"]
    assert changes(stored, stored.iloc[:-1])[0].startswith("248 rows")
    with_booleans = stored.assign(stated=stored["mu"] > 1.0)
    assert changes(with_booleans, with_booleans) == []
    assert changes(with_booleans, with_booleans.assign(stated=True)) == ["stated: other texts"]
    gone = stored.assign(kappa=stored["kappa"].mask(stored.index == 7))
    assert changes(stored, gone) == ["kappa: a number where there was none, or none where there was"]


def test_bounds_of_every_name_are_no_values():
    stored = committed(paper_figures(["surface-modulus"])[0], "")
    bounds = [name for name in stored.columns if name.endswith("u_num") or name.startswith("u_")]
    assert {"u_num", "graded_u_num", "homogeneous_u_num", "u_fscm"} == set(bounds)
    assert changes(stored, stored.assign(**{name: 2.0 * stored[name] for name in bounds})) == []
    assert changes(stored, stored.assign(graded_value=2.0 * stored["graded_value"])) != []


def test_a_folder_is_compared_with_the_committed_figures(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(FOLDER.parents[2])
    for name in ("2", "3", "16"):
        for path in paper_figures([name])[0].files_in(FOLDER):
            shutil.copy(path, tmp_path)
    assert main(["--check", str(tmp_path)]) == 0
    assert "agrees with the baseline" in capsys.readouterr().out
    file = "fig16_pull_off_by_soft_limit_kappa.csv"
    table = pd.read_csv(tmp_path / file)
    table.assign(kappa=table["kappa"] + 1e-5).to_csv(tmp_path / file, index=False)
    (tmp_path / "fig02_kernel_functions.csv").unlink()
    # The points of a path may lie elsewhere.
    (tmp_path / "fig03_s_curve_curves.csv").write_text("displacement\n1\n")
    assert main(["--check", str(tmp_path)]) == 1
    assert check(tmp_path)[["figure", "difference"]].to_numpy().tolist() == [
        ["2", f"there is no file {tmp_path / 'fig02_kernel_functions.csv'}"],
        ["16", "kappa: up to 1e-05 apart"],
    ]
    # Outside a clone: the same, by the tables that are installed.
    monkeypatch.chdir(tmp_path)
    assert main(["--check", str(tmp_path)]) == 1
    monkeypatch.setattr("comparisons.runs.committed._INSTALLED", ())
    capsys.readouterr()
    assert main(["--check", str(tmp_path)]) == 2
    assert "results/baseline/paper of the baseline is neither in" in capsys.readouterr().err


def test_only_a_whole_set_renews_the_baseline(tmp_path, capsys):
    made, target = tmp_path / "made", tmp_path / "target"
    made.mkdir()
    for figure in paper_figures():
        (made / f"{figure.stem}.csv").write_text(figure.name)
    (made / "tasks.jsonl").write_text("a journal")
    target.mkdir()
    (target / "stale.csv").write_text("of a figure that does not exist")
    written = renew(made, target)
    assert sorted(path.name for path in target.iterdir()) == sorted(path.name for path in written)
    assert len(written) == len(NAMES)
    (made / f"{paper_figures(['8'])[0].stem}.csv").unlink()
    assert main([str(made)]) == 2
    assert "lacks 8" in capsys.readouterr().err
    with pytest.raises(ValueError, match="lacks 8"):
        renew(made, target)
    assert len(list(target.iterdir())) == len(NAMES)
