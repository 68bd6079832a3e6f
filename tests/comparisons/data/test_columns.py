"""Descriptions of the columns of the tables: of every committed table, and of no table that there is not."""

import csv
import tomllib
from importlib.resources import files
from pathlib import Path

import pytest

from comparisons.data.columns import FILES, column, title

ROOT = Path(__file__).resolve().parents[3]

#: Folders of committed tables.
FOLDERS = ("results/baseline", "comparisons/data", "fscm/interpolation/data")
TABLES = sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.csv") if path.parent.name != "graded")

#: Files whose tables are all committed; those of a run are in `columns.toml`, and a test of the data package has them.
COMMITTED = [name for name in FILES if name != "columns.toml"]


def header(path):
    with path.open(newline="", encoding="utf-8") as file:
        return next(csv.reader(file))


def contents(name):
    return tomllib.loads(files("comparisons.data").joinpath(name).read_text(encoding="utf-8"))


@pytest.mark.parametrize("path", TABLES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_every_column_of_a_committed_table_has_unit_and_description(path):
    assert title(path.stem)
    assert [name for name in header(path) if column(path.stem, name) is None] == []
    assert all(column(path.stem, name).description for name in header(path))


@pytest.mark.parametrize("name", COMMITTED)
def test_no_description_is_of_a_table_or_of_a_column_that_is_not_there(name):
    described = contents(name)
    headers = {path.stem: header(path) for path in TABLES}
    assert set(described["table"]) - set(headers) == set()
    stale = [
        (table, one)
        for table, content in described["table"].items()
        for one in content.get("column", {})
        if one not in headers[table]
    ]
    assert stale == []
    everywhere = {one for table in described["table"] for one in headers[table]}
    assert [one for one in described["column"] if one not in everywhere] == []


def test_a_column_of_a_figure_does_not_describe_that_of_a_run():
    assert column("fig03_s_curve_points", "load").unit == "P"
    assert column("results", "load") is None
    assert column("a_table_of_my_own", "load") is None
    assert column("fig10_transition", "mu") == column("results", "mu")
