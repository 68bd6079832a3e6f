"""Maps: each curve of a file is one of its own, with a position, a row and a cell of the picture."""

import json
import math
from contextlib import contextmanager

import numpy as np
import pandas as pd
import pytest

from comparisons.cli.main import main
from comparisons.fitting import folder
from comparisons.fitting.fit import Fit, FittedValue
from comparisons.fitting.maps import draw_map
from comparisons.model import ComputationFailed
from comparisons.problem import Problem
from comparisons.runs import store

from .test_fit import PROBE

h5py = pytest.importorskip("h5py")
pytest.importorskip("afmformats")

#: Stiffness in N/m.
STIFFNESS = 0.5


def write_map(path, loads, columns, positions=True, lengths=None, first=0):
    """A file of afmformats: one curve for each lowest load in nN, in rows of a grid of 2 µm by 1 µm."""
    with h5py.File(path, "w") as file:
        file.attrs.update({"software": "afmformats", "software version": "0.18"})
        for number, lowest in enumerate(loads, start=first):
            row, column = divmod(number, columns)
            group = file.create_group(str(number - first))
            group.attrs.update({"imaging mode": "force-distance", "spring constant": STIFFNESS, "enum": number})
            if positions:
                group.attrs.update({"position x": 2e-6 * column, "position y": 1e-6 * row})
                group.attrs.update({"grid index x": column, "grid index y": row})
            points = 60 if lengths is None else lengths[number - first]
            z = np.concatenate([np.linspace(0.0, 100e-9, points), np.linspace(100e-9, 0.0, points)])
            contact_load = np.where(z > 50e-9, 0.2 * (z - 50e-9) - lowest * 1e-9, 0.0)
            group["height (measured)"] = -z
            group["force"] = contact_load + 1e-12 * np.cos(7.0 * np.arange(2 * points))
            group["segment"] = (np.arange(2 * points) >= points).astype(np.uint8)
    return path


def depth(record, problem, *_, **options):
    """In place of a fit, which takes seconds: the value is the depth of the record."""
    value = FittedValue(-float(record.load.min()), 1e-11, "J/m^2", True, dict.fromkeys(("model", "assumptions"), 0.0))
    zeros = dict.fromkeys(("displacement", "load"), (0.0, 0.0))
    return Fit(
        record, "jkr", problem, {"law.work_of_adhesion": value}, zeros, 1.0, 0.5, [], record.position, record.load
    )


@pytest.fixture
def fit_map(tmp_path, monkeypatch):
    """A function that fits a map by `depth`; returns exit status, table, JSON and the names of the pictures."""
    monkeypatch.setattr(folder, "fit_record", depth)
    monkeypatch.setattr(folder, "save", lambda picture, path: path.touch())
    (tmp_path / "probe.toml").write_text(PROBE)

    def run(path, *options):
        out = tmp_path / "fits"
        arguments = ["--problem", str(tmp_path / "probe.toml"), "--free", "law.work_of_adhesion", "--out", str(out)]
        paths = path if isinstance(path, list) else [path]
        status = main(["fit", *map(str, paths), *arguments, "--jobs", "1", *options])
        if not (out / "fits.csv").exists():
            return status, None, None, set()
        table = pd.read_csv(out / "fits.csv", keep_default_na=False, na_values={"value": [""], "x": [""]})
        pictures = {picture.name for picture in out.rglob("*.png")}
        return status, table, json.loads((out / "fits.json").read_text()), pictures

    return run


def test_each_curve_of_a_map_has_a_row_a_position_and_a_picture(fit_map, tmp_path):
    path = write_map(tmp_path / "map.h5", [1.0, 2.0, 3.0, 4.0], columns=2)
    status, table, items, pictures = fit_map(path)
    assert status == 0
    assert table["curve"].tolist() == [f"map.h5#{number}" for number in (1, 2, 3, 4)]
    assert table["value"].tolist() == pytest.approx([1e-9, 2e-9, 3e-9, 4e-9], abs=2e-10)
    assert table["x"].tolist() == pytest.approx([0.0, 2e-6, 0.0, 2e-6])
    assert table["y"].tolist() == pytest.approx([0.0, 0.0, 1e-6, 1e-6])
    assert table["column"].tolist() == [0, 1, 0, 1]
    assert table["row"].tolist() == [0, 0, 1, 1]
    assert table["residual_over_noise"].tolist() == [2.0] * 4
    assert items[3]["position"] == {"x": 2e-6, "y": 1e-6, "column": 1, "row": 1}
    assert pictures == {"map-1.png", "map-2.png", "map-3.png", "map-4.png", "map-map.png"}


def test_files_of_one_curve_each_make_a_map_where_they_have_positions(fit_map, tmp_path):
    paths = [write_map(tmp_path / f"{number}.h5", [1.0 + number], columns=2, first=number) for number in range(4)]
    plain = tmp_path / "plain.csv"
    x = np.linspace(-50.0, 50.0, 60)
    rows = "".join(f"{a:.3f},{max(a, 0.0) + 1e-3 * math.cos(7.0 * a):.6f}\n" for a in x)
    plain.write_text("displacement [nm],load [nN]\n" + rows)
    status, table, _, pictures = fit_map([*paths, plain])
    assert status == 0
    assert len(table) == 5
    assert pictures == {"0.png", "1.png", "2.png", "3.png", "plain.png", "fits-map.png"}


def test_files_of_one_curve_without_positions_make_no_map(fit_map, tmp_path):
    paths = [write_map(tmp_path / f"{number}.h5", [1.0 + number], columns=2, positions=False) for number in range(2)]
    assert fit_map(paths)[3] == {"0.png", "1.png"}


def test_a_terminal_shows_both_ends_of_many_curves(fit_map, tmp_path, capsys):
    loads = np.linspace(1.0, 2.0, 60)
    path = write_map(
        tmp_path / "map.h5", loads, columns=10, lengths=[60 - 57 * (number in (1, 30)) for number in range(60)]
    )
    status, table, _, _ = fit_map(path)
    captured = capsys.readouterr()
    shown = {number for number in range(1, 61) if f"map.h5#{number} " in captured.out}
    assert shown == {*range(1, 6), *range(56, 61)}
    assert "50" in captured.out
    assert str(tmp_path / "fits" / "fits.csv") in captured.out.replace("\n", "")
    assert len(table) == 60
    assert status == 4
    assert "map.h5#31:" in captured.err


def test_a_terminal_shows_all_of_a_few_curves(fit_map, tmp_path, capsys):
    fit_map(write_map(tmp_path / "map.h5", np.linspace(1.0, 2.0, 40), columns=10))
    out = capsys.readouterr().out
    assert all(f"map.h5#{number} " in out for number in range(1, 41))
    assert "..." not in out


def test_bad_curves_of_a_map_are_rows_with_their_own_reason(fit_map, tmp_path, capsys):
    lengths = [60, 4, 60, 60, 3]
    path = write_map(tmp_path / "map.h5", [1.0, 2.0, 3.0, 0.0, 2.0], columns=5, lengths=lengths)
    status, table, _, pictures = fit_map(path, "--format", "json")
    assert status == 4
    assert table["curve"].tolist() == [f"map.h5#{number}" for number in range(1, 6)]
    assert [bool(reason) for reason in table["reason"]] == [False, True, False, False, True]
    assert "8 points" in table["reason"][1]
    assert "6 points" in table["reason"][4]
    assert table["x"][1] == pytest.approx(2e-6)
    assert pictures == {"map-1.png", "map-3.png", "map-4.png", "map-map.png"}
    answer = json.loads(capsys.readouterr().out)
    assert [failure["curve"] for failure in answer["failures"]] == ["map.h5#2", "map.h5#5"]
    assert answer["failures"][0]["position"]["column"] == 1
    assert [fitted["position"]["column"] for fitted in answer["fits"]] == [0, 2, 3]


def test_curves_are_numbered_as_the_file_numbers_them(fit_map, tmp_path):
    """HDF5 lists its groups as words: 0, 1, 10, 11, 2."""
    loads = np.linspace(1.0, 2.1, 12)
    _, table, _, _ = fit_map(write_map(tmp_path / "map.h5", loads, columns=4))
    assert table["curve"].tolist() == [f"map.h5#{number}" for number in range(1, 13)]
    assert (np.diff(table["value"]) > 0.0).all()


def test_an_interrupted_map_keeps_its_finished_curves(fit_map, tmp_path, monkeypatch):
    path = write_map(tmp_path / "map.h5", [1.0, 2.0, 3.0, 4.0], columns=2)
    fitted = []

    def interrupted(record, *given, **options):
        if len(fitted) == 2:
            raise KeyboardInterrupt
        fitted.append(record.name)
        return depth(record, *given)

    monkeypatch.setattr(folder, "fit_record", interrupted)
    assert fit_map(path)[0] not in (0, 4)
    resumed = []
    monkeypatch.setattr(
        folder, "fit_record", lambda record, *given, **_: resumed.append(record.name) or depth(record, *given)
    )
    status, table, _, _ = fit_map(path)
    assert status == 0
    assert len(table) == 4
    assert fitted == ["map.h5#1", "map.h5#2"]
    assert resumed == ["map.h5#3", "map.h5#4"]


def test_a_failed_search_costs_one_curve(fit_map, tmp_path, monkeypatch):
    path = write_map(tmp_path / "map.h5", [1.0, 2.0, 3.0], columns=3)

    def second_fails(record, *given, **_):
        if record.name.endswith("#2"):
            raise ComputationFailed("no values describe it")
        return depth(record, *given)

    monkeypatch.setattr(folder, "fit_record", second_fails)
    status, table, _, _ = fit_map(path)
    assert status == 4
    assert table["reason"].tolist() == ["", "no values describe it", ""]


def test_many_curves_have_pictures_only_if_asked(fit_map, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(folder, "MOST_PICTURES", 3)
    monkeypatch.setattr("comparisons.cli.commands.fit.MOST_PICTURES", 3)
    path = write_map(tmp_path / "map.h5", [1.0, 2.0, 3.0, 4.0], columns=2)
    assert fit_map(path)[3] == {"map-map.png"}
    assert "--pictures" in capsys.readouterr().err
    assert fit_map(path, "--pictures")[3] == {"map-map.png", *(f"map-{number}.png" for number in range(1, 5))}


@pytest.mark.parametrize("out", [True, False])
def test_progress_counts_curves_and_not_files(fit_map, tmp_path, monkeypatch, out):
    counted = {}

    @contextmanager
    def counting(_, count):
        counted[count] = []
        yield lambda: counted[count].append(1)

    monkeypatch.setattr(store if out else folder, "counting", counting)
    path = write_map(tmp_path / "map.h5", [1.0, 2.0, 3.0], columns=3)
    if out:
        fit_map(path)
    else:
        folder.fit_files([path], Problem.load(tmp_path / "probe.toml"), ["law.work_of_adhesion"], None)
    assert {count: len(advances) for count, advances in counted.items()} == {3: 3}


def test_a_file_without_positions_is_no_map(fit_map, tmp_path):
    path = write_map(tmp_path / "map.h5", [1.0, 2.0], columns=2, positions=False)
    _, table, items, pictures = fit_map(path)
    assert "x" not in table
    assert items[0]["position"] == dict.fromkeys(("x", "y", "column", "row"))
    assert pictures == {"map-1.png", "map-2.png"}


def item(number, value, columns=3, determined=True, placed=("x", "y", "column", "row")):
    """A curve of a map as the folder has it; without a value it has no fit."""
    row, column = divmod(number, columns)
    position = {"x": 2e-6 * column, "y": 1e-6 * row, "column": column, "row": row}
    of_key = {"value": value, "u": 0.1, "unit": "Pa", "determined": determined}
    fitted = {"residual": 3.0, "noise": 2.0, "parameters": {"solid.E0": of_key}}
    return {
        "file": "m.h5",
        "position": {name: place if name in placed else None for name, place in position.items()},
        "fits": [] if value is None else [fitted],
    }


def panels(figure):
    """Colours by panel and the positions of its cells."""
    shown = {}
    for axes in figure.axes:
        cells = [part for part in axes.collections if part.get_array() is not None and axes.get_title(loc="left")]
        for part in cells:
            centres = np.array([path.vertices[:4].mean(axis=0) for path in part.get_paths()])
            shown[axes.get_title(loc="left")[4:]] = centres, np.ma.filled(part.get_array(), np.nan)
    return shown


def test_a_map_shows_values_uncertainties_and_quality_where_they_were_measured():
    items = [item(0, 1e6), item(1, 2e6), item(2, None), item(3, 4e6), item(4, 5e6, determined=False), item(5, 6e6)]
    figure = draw_map(items, ["solid.E0"])
    shown = panels(figure)
    assert set(shown) == {"solid.E0 (MPa)", "u of solid.E0 (%)", "residuals / noise"}
    centres, values = shown["solid.E0 (MPa)"]
    assert centres[5] == pytest.approx([4.0, 1.0])
    assert values == pytest.approx([1.0, 2.0, math.nan, 4.0, math.nan, 6.0], nan_ok=True)
    assert shown["u of solid.E0 (%)"][1][3] == pytest.approx(2.5e-6)
    assert shown["residuals / noise"][1] == pytest.approx([1.5, 1.5, math.nan, 1.5, 1.5, 1.5], nan_ok=True)
    marked = {line.get_label(): line.get_xydata().tolist() for line in figure.axes[0].get_lines()}
    assert marked["no fit"] == [[4.0, 0.0]]
    assert marked["not determined"] == [[2.0, 1.0]]


@pytest.mark.parametrize(
    ("placed", "size"),
    [(("x", "y", "column", "row"), (2.0, 1.0)), (("x", "y"), (1.0, 1.0)), (("column", "row"), (1.0, 1.0))],
)
def test_cells_are_as_large_as_the_step_of_the_grid(placed, size):
    figure = draw_map([item(number, 1e6, placed=placed) for number in range(6)], ["solid.E0"])
    (cells,) = figure.axes[0].collections
    corners = cells.get_paths()[0].vertices
    assert np.ptp(corners, axis=0) == pytest.approx(size)


def test_a_map_without_positions_or_at_one_has_no_picture():
    assert draw_map([item(0, 1e6, placed=()), item(1, 1e6)], ["solid.E0"]) is None
    assert draw_map([item(0, 1e6), item(0, 2e6)], ["solid.E0"]) is None
    assert draw_map([], ["solid.E0"]) is None


def test_a_map_of_curves_without_a_fit_is_drawn():
    assert draw_map([item(0, None), item(1, None)], ["solid.E0"]) is not None


def test_outliers_leave_the_colours_of_the_others():
    figure = draw_map([item(number, 1e12 if number == 7 else 1e6 + number, 10) for number in range(100)], ["solid.E0"])
    (cells,) = figure.axes[0].collections
    assert cells.get_clim()[1] < 1.1
