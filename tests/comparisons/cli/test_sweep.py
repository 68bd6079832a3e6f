"""Sweeps over grids of the user: numbers, errors, refused input."""

import pytest

from comparisons.cli.main import main
from comparisons.runs.csv_format import read_table
from tests.comparisons.grid_text import grid_text

GRID = grid_text(
    ["jkr", "bradley"], "md-improved", ["pull_off_force", "jump_in_displacement"], n=[2], k=[0, 0.4], mu=[0.5, 2]
)


def sweep(tmp_path, text=GRID, *options):
    (tmp_path / "grid.toml").write_text(text)
    return main(["sweep", str(tmp_path / "grid.toml"), "--jobs", "1", "--out", str(tmp_path / "out"), *options])


def test_the_errors_of_every_model(tmp_path, capsys):
    assert sweep(tmp_path) == 0
    kappa = read_table(tmp_path / "out" / "kappa.csv")
    assert len(kappa) == 2 * 4
    assert (kappa["reference"] == "md-improved").all()
    # A JKR pull-off force does not know mu: (3 + k) / 2 for a paraboloid.
    jkr = kappa[kappa["model"] == "jkr"]
    assert jkr["value"].tolist() == pytest.approx([1.5, 1.5, 1.7, 1.7])
    rows = read_table(tmp_path / "out" / "results.csv")
    assert (rows.loc[rows["quantity"] == "jump_in_displacement", "status"] == "not-applicable").all()
    lines = capsys.readouterr().out.splitlines()
    assert any(line.split()[:4] == ["jkr", "4", "4", "0"] for line in lines)
    assert "largest abs(kappa) in percent" in "\n".join(lines)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        (GRID + 'tier = "quick"', "grid mine: unknown key 'tier': the grids of a sweep have none"),
        (GRID.replace("mu = [0.5, 2]", "mu = [1" + "0" * 400 + "]"), "mu must be a list of at least one number"),
        (GRID.replace("n = [2]", f"n = {[1] * 2000}").replace("0.5, 2", "1, " * 999), "3996000 combinations"),
    ],
)
def test_what_is_refused(tmp_path, capsys, text, why):
    assert sweep(tmp_path, text) == 2
    assert why in capsys.readouterr().err
