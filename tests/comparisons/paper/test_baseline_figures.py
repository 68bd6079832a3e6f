"""The committed plates are those the code makes: every one is there, and its numbers have not drifted.

Left out of the comparison are the plates that draw a path: where its points lie is the solver's choice, which rounding
may change (Figs. 3 to 7, 13, 17); the curves of the quick tier are compared through their gates.
"""

from pathlib import Path

import pandas as pd
import pytest

from comparisons.paper.registry import NAMES, plates
from comparisons.baseline import PLATES, changes, main, publish_plates
from comparisons.runs.tables import csv_text

FOLDER = Path(__file__).parents[3] / PLATES
CHEAP = ("2", "11", "12")
COSTLY = ("8", "9", "10", "14", "15", "16", "numbers", "error-maps-shape", "error-maps-gradient", "error-maps-jumps")


def committed(plate, name):
    return pd.read_csv(FOLDER / (f"{plate.stem}_{name}.csv" if name else f"{plate.stem}.csv"))


@pytest.mark.parametrize("name", [*CHEAP, *(pytest.param(name, marks=pytest.mark.heavy) for name in COSTLY)])
def test_the_numbers_are_those_committed(name, tables_of, tmp_path):
    (plate,) = plates([name])
    for table, computed in tables_of(plate).items():
        path = tmp_path / "computed.csv"
        path.write_text(csv_text(computed))
        assert changes(committed(plate, table), pd.read_csv(path)) == []


def test_every_plate_is_there_and_nothing_else():
    stems = {plate.stem: plate for plate in plates()}
    files = {path.name for path in FOLDER.iterdir()}
    for stem, plate in stems.items():
        mine = {name for name in files if name.startswith((f"{stem}.", f"{stem}_"))}
        assert mine, f"{plate.name} is not committed"
        for suffix in (".png", ".pdf"):
            assert (f"{stem}{suffix}" in mine) == (plate.draw is not None)
        assert any(name.endswith(".csv") for name in mine) or plate.name == "1"
        files -= mine
    assert files == set()


def test_a_changed_number_text_or_row_is_seen():
    stored = committed(plates(["16"])[0], "kappa")
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
    for plate in plates():
        (made / f"{plate.stem}.csv").write_text(plate.name)
    (made / "calls.jsonl").write_text("a journal")
    target.mkdir()
    (target / "stale.csv").write_text("of a plate that is gone")
    written = publish_plates(made, target)
    assert sorted(path.name for path in target.iterdir()) == sorted(path.name for path in written)
    assert len(written) == len(NAMES)
    (made / f"{plates(['8'])[0].stem}.csv").unlink()
    assert main([str(made)]) == 2
    assert "lacks 8" in capsys.readouterr().err
    with pytest.raises(ValueError, match="lacks 8"):
        publish_plates(made, target)
    assert len(list(target.iterdir())) == len(NAMES)
