"""Descriptions of the columns of the tables: of every committed table, and of no table that there is not."""

import csv
from pathlib import Path

import pytest

from comparisons.data.columns import column

ROOT = Path(__file__).resolve().parents[3]

#: Folders of committed tables.
FOLDERS = ("results/baseline", "comparisons/data", "fscm/interpolation/data")
TABLES = sorted(path for folder in FOLDERS for path in (ROOT / folder).rglob("*.csv") if path.parent.name != "graded")


def header(path):
    with path.open(newline="", encoding="utf-8") as file:
        return next(csv.reader(file))


@pytest.mark.parametrize("path", TABLES, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_every_column_of_a_committed_table_has_unit_and_description(path):
    assert [name for name in header(path) if column(path.stem, name) is None] == []
    assert all(column(path.stem, name).description for name in header(path))


def test_a_column_of_a_figure_does_not_describe_that_of_a_run():
    assert column("fig03_s_curve_points", "load").unit == "P"
    assert column("results", "load") is None
    assert column("a_table_of_my_own", "load") is None
    assert column("fig10_transition", "mu") == column("results", "mu")
