"""The committed figures are those the code makes: every one is there, and its numbers have not drifted.

Left out of the comparison are the figures that draw a path: where its points lie is the solver's choice, which rounding
may change (Figs. 3 to 7, 13, 17); the curves of the quick tier are compared through their gates.
"""

from pathlib import Path

import pandas as pd
import pytest

from comparisons.baseline import PAPER_BASELINE, changes, main, renew_paper_baseline
from comparisons.paper.registry import NAMES, paper_figures
from comparisons.runs.csv_format import csv_text

FOLDER = Path(__file__).parents[3] / PAPER_BASELINE
CHEAP = ("2", "11", "12")
COSTLY = ("8", "9", "10", "14", "15", "16", "numbers", "error-maps-shape", "error-maps-gradient", "error-maps-jumps")


def committed(figure, name):
    return pd.read_csv(FOLDER / (f"{figure.stem}_{name}.csv" if name else f"{figure.stem}.csv"))


@pytest.mark.parametrize("name", [*CHEAP, *(pytest.param(name, marks=pytest.mark.heavy) for name in COSTLY)])
def test_the_numbers_are_those_committed(name, tables_of, tmp_path):
    (figure,) = paper_figures([name])
    for table, computed in tables_of(figure).items():
        path = tmp_path / "computed.csv"
        path.write_text(csv_text(computed))
        assert changes(committed(figure, table), pd.read_csv(path)) == []


def test_every_plate_is_there_and_nothing_else():
    stems = {figure.stem: figure for figure in paper_figures()}
    files = {path.name for path in FOLDER.iterdir()}
    for stem, figure in stems.items():
        mine = {name for name in files if name.startswith((f"{stem}.", f"{stem}_"))}
        assert mine, f"{figure.name} is not committed"
        for suffix in (".png", ".pdf"):
            assert (f"{stem}{suffix}" in mine) == (figure.draw is not None)
        assert any(name.endswith(".csv") for name in mine) or figure.name == "1"
        files -= mine
    assert files == set()


def test_a_changed_number_text_or_row_is_seen():
    stored = committed(paper_figures(["16"])[0], "kappa")
    assert changes(stored, stored) == []
    moved = stored.assign(kappa=stored["kappa"].where(stored.index != 7, stored["kappa"] + 1e-5))
    assert changes(stored, moved) == ["kappa: up to 1e-05 apart"]
    assert changes(stored, stored.assign(u_kappa=0.0)) == []
    assert changes(stored, stored.assign(model="jkr")) == ["model: other texts"]
    assert changes(stored, stored.iloc[:-1])[0].startswith("248 rows")
    answered = stored.assign(stated=stored["mu"] > 1.0)
    assert changes(answered, answered) == []
    assert changes(answered, answered.assign(stated=True)) == ["stated: other texts"]
    gone = stored.assign(kappa=stored["kappa"].mask(stored.index == 7))
    assert changes(stored, gone) == ["kappa: a number where there was none, or none where there was"]


def test_only_a_whole_set_is_published(tmp_path, capsys):
    made, target = tmp_path / "made", tmp_path / "target"
    made.mkdir()
    for figure in paper_figures():
        (made / f"{figure.stem}.csv").write_text(figure.name)
    (made / "tasks.jsonl").write_text("a journal")
    target.mkdir()
    (target / "stale.csv").write_text("of a figure that is gone")
    written = renew_paper_baseline(made, target)
    assert sorted(path.name for path in target.iterdir()) == sorted(path.name for path in written)
    assert len(written) == len(NAMES)
    (made / f"{paper_figures(['8'])[0].stem}.csv").unlink()
    assert main([str(made)]) == 2
    assert "lacks 8" in capsys.readouterr().err
    with pytest.raises(ValueError, match="lacks 8"):
        renew_paper_baseline(made, target)
    assert len(list(target.iterdir())) == len(NAMES)
