"""Committed figures: all of them, with the numbers that the code computes, and pictures that a page holds.

Figures whose tables follow equilibrium paths are not compared: the solver places the points.  The curves of the quick
tier are compared through their gates.
"""

import shutil
from pathlib import Path
from string import ascii_lowercase

import pandas as pd
import pytest

from comparisons.baseline import main
from comparisons.paper.baseline import PAPER_BASELINE, changes, check, renew
from comparisons.paper.registry import NAMES, paper_figures
from comparisons.runs.csv_format import csv_text

FOLDER = Path(__file__).parents[3] / PAPER_BASELINE
FIGURES = {figure.name: figure for figure in paper_figures()}
#: Figures of closed forms, which take seconds; the others take minutes.
CHEAP = ("2", "12")
#: Every so many pictures are drawn in every test run.
LIGHT = 16


def marked(names, is_light):
    return [pytest.param(name, marks=() if is_light(at, name) else pytest.mark.heavy) for at, name in enumerate(names)]


@pytest.mark.parametrize(
    "name", marked([name for name in NAMES if not FIGURES[name].follows_path], lambda at, name: name in CHEAP)
)
def test_the_numbers_are_those_committed(name, made_of, tmp_path):
    for table, computed in made_of(FIGURES[name].plan).items():
        path = tmp_path / "computed.csv"
        path.write_text(csv_text(computed))
        assert changes(pd.read_csv(FOLDER / FIGURES[name].table_file(table)), pd.read_csv(path)) == []


@pytest.mark.parametrize(
    "name", marked([name for name in NAMES if FIGURES[name].picture], lambda at, name: at % LIGHT == 0)
)
def test_a_picture_is_whole_and_its_panels_are_lettered_in_order(name):
    figure = FIGURES[name]
    files = [path for path in figure.files_in(FOLDER) if path.suffix == ".csv"]
    picture = figure.draw({path.stem[len(figure.stem) :].removeprefix("_"): pd.read_csv(path) for path in files})
    picture.draw_without_rendering()
    box, (width, height) = picture.get_tightbbox(), picture.get_size_inches()
    # Rounding to pixels.
    assert min(box.x0, box.y0, width - box.x1, height - box.y1) > -0.01
    titles = [axes.get_title(loc="left") for axes in picture.axes]
    # Twice where a panel is shown again, enlarged.
    letters = "".join(dict.fromkeys(title[1] for title in titles if title))
    assert letters == ascii_lowercase[: len(letters)]


@pytest.mark.parametrize(
    ("change", "difference"),
    [
        (lambda table: {"kappa": table["kappa"] + 1e-9, "u_kappa": 0.0}, []),
        (lambda table: {"kappa": table["kappa"].mask(table.index == 7, table["kappa"] + 1e-5)}, ["kappa", "1 of 248"]),
        (lambda table: {"kappa": table["kappa"].mask(table.index == 7)}, ["kappa", "1 of 248"]),
        (lambda table: {"model": "jkr"}, ["model", "248 of 248"]),
        (lambda table: {"another": 1.0}, ["another"]),
    ],
)
def test_a_changed_number_text_or_column_is_seen_and_bounds_are_no_values(change, difference, committed):
    stored = committed("fig16_pull_off_by_soft_limit_kappa")
    sentences = changes(stored, stored.assign(**change(stored)))
    assert len(sentences) == bool(difference)
    assert [text for text in difference if text not in sentences[0]] == []


def test_a_folder_is_compared_with_the_committed_figures(tmp_path, monkeypatch):
    monkeypatch.chdir(FOLDER.parents[2])
    for name in ("2", "3", "16"):
        for path in FIGURES[name].files_in(FOLDER):
            shutil.copy(path, tmp_path)
    assert main(["--check", str(tmp_path)]) == 0
    file = "fig16_pull_off_by_soft_limit_kappa.csv"
    table = pd.read_csv(tmp_path / file)
    table.assign(kappa=table["kappa"] + 1e-5).to_csv(tmp_path / file, index=False)
    (tmp_path / "fig02_kernel_functions.csv").unlink()
    # The points of a path may lie elsewhere.
    (tmp_path / "fig03_s_curve_curves.csv").write_text("displacement\n1\n")
    assert main(["--check", str(tmp_path)]) == 1
    assert check(tmp_path)["file"].tolist() == ["fig02_kernel_functions.csv", file]


def test_only_a_whole_set_renews_the_baseline(tmp_path):
    made, target = tmp_path / "made", tmp_path / "target"
    made.mkdir()
    for figure in FIGURES.values():
        (made / f"{figure.stem}.csv").write_text(figure.name)
    (made / "tasks.jsonl").write_text("a journal")
    assert sorted(path.read_text() for path in renew(made, target)) == sorted(NAMES)
    (made / f"{FIGURES['8'].stem}.csv").unlink()
    with pytest.raises(ValueError, match="lacks 8"):
        renew(made, target)
    assert len(list(target.iterdir())) == len(NAMES)
