"""Stored results: exact, ordered, and never half written."""

import csv
import io
import math
import os

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given
from hypothesis import strategies as st

from comparisons.runs.atomic_files import atomic, prepare_folder, writable_file, write_json
from comparisons.runs.case_columns import DIMENSIONLESS
from comparisons.runs.csv_format import csv_text, plain_text
from comparisons.runs.frames import COLUMNS, frame
from comparisons.runs.tables import write_results
from tests.comparisons.rows import row

REFUSED = {"value": None, "u_num": None, "size": None, "iterations": None, "residual": None}


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_csv_gives_every_double_back(value):
    text = csv_text(frame([row(value=value)]))
    assert float(text.splitlines()[1].split(",")[7]) == value


@given(st.floats(min_value=1e-3, max_value=1e3))
def test_parameters_are_short_and_exact(mu):
    assert float(csv_text(frame([row(mu=mu)])).splitlines()[1].split(",")[5]) == mu


def test_values_have_17_digits_and_parameters_do_not():
    cells = csv_text(frame([row(mu=0.1, value=0.1)])).splitlines()[1].split(",")
    assert cells[5] == "0.1"
    assert cells[7] == "0.10000000000000001"


FORMULAS = ["=cmd|' /C calc'!A0", "+1+1", "-1+1", "@SUM(A1)", "\t=1", " =1", "\n=1", "'=1", "''-1+1"]


@pytest.mark.parametrize("text", FORMULAS)
@pytest.mark.parametrize("column", ["model", "model_version", "reason"])
def test_no_text_is_a_formula_and_each_is_read_back(text, column):
    cells = next(csv.DictReader(io.StringIO(csv_text(frame([row(**{column: text})])), newline="")))
    assert cells[column][0] == "'"
    assert plain_text(cells[column]) == text


def test_a_carriage_return_does_not_begin_a_row_that_is_a_formula():
    text = csv_text(frame([row(reason="no\r=1+1")]))
    assert [cells["reason"] for cells in csv.DictReader(io.StringIO(text, newline=""))] == ["no =1+1"]
    assert plain_text(next(csv.DictReader(io.StringIO(csv_text(frame([row(reason="\r=1")])))))["reason"]) == " =1"


@given(st.text(st.characters(exclude_characters="\r", exclude_categories=["Cs"])))
def test_every_text_is_read_back(text):
    written = csv_text(pd.DataFrame({"reason": [text]}))
    [cells] = list(csv.reader(io.StringIO(written, newline="")))[1:] or [[""]]
    assert plain_text(cells[0] if cells else "") == text


def test_negative_numbers_and_their_texts_are_untouched():
    table = pd.DataFrame({"n": [2.0], "value": [-0.5], "paper_percent": ["-5.2"], "some": [None]})
    assert csv_text(table) == "n,value,paper_percent,some\n2,-0.5,-5.2,\n"
    mixed = pd.DataFrame({"value": pd.Series([-0.1, None], dtype=object)})
    assert csv_text(mixed) == 'value\n-0.1\n""\n'


def test_a_name_of_a_column_is_no_formula():
    assert csv_text(pd.DataFrame({"=1+1": [1.0]})) == "'=1+1\n1\n"


def test_the_table_does_not_depend_on_the_order_of_completion(tmp_path):
    rows = [
        row("jkr", mu=2.0),
        row("dmt", mu=1.0, **REFUSED, status="not-applicable", reason='no, "not" here'),
        row("jkr", mu=0.5),
    ]
    write_results(frame(rows), tmp_path / "a")
    write_results(frame(reversed(rows)), tmp_path / "b")
    assert (tmp_path / "a.csv").read_bytes() == (tmp_path / "b.csv").read_bytes()
    assert (tmp_path / "a.parquet").read_bytes() == (tmp_path / "b.parquet").read_bytes()


def test_parquet_keeps_types_and_csv_leaves_out_the_clock(tmp_path):
    rows = [row(), row("dmt", **REFUSED, status="failed", reason="why")]
    write_results(frame(rows), tmp_path / "results")
    stored = pq.read_table(tmp_path / "results.parquet")
    without_files = [field for field in COLUMNS if field.name not in ("problem", *DIMENSIONLESS)]
    assert stored.schema.equals(pa.schema(without_files))
    assert stored.to_pylist()[0]["value"] is None
    assert stored.to_pylist()[1]["size"] == 0
    csv = pd.read_csv(tmp_path / "results.csv")
    assert list(csv) == [field.name for field in without_files if field.name != "seconds"]
    assert csv.loc[1, "value"] == 1.5


def test_an_error_while_writing_leaves_the_old_file_and_no_other(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("old")
    with pytest.raises(TypeError), atomic(path) as file:
        file.writelines([b"half of the new", None])
    assert path.read_text() == "old"
    assert os.listdir(tmp_path) == ["a.txt"]


def test_written_files_can_be_read_by_others(tmp_path):
    with atomic(tmp_path / "a") as file:
        file.write(b"x")
    (tmp_path / "b").touch()
    assert (tmp_path / "a").stat().st_mode == (tmp_path / "b").stat().st_mode


def test_json_refuses_nan(tmp_path):
    with pytest.raises(ValueError, match="JSON"):
        write_json({"a": math.nan}, tmp_path / "a.json")
    assert os.listdir(tmp_path) == []


def test_places_that_cannot_be_written_are_refused(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(ValueError, match="cannot be written"):
        prepare_folder(tmp_path / "file" / "folder")
    with pytest.raises(ValueError, match="cannot be written"):
        writable_file(tmp_path / "missing" / "a.csv")
    with pytest.raises(ValueError, match="it is a folder"):
        writable_file(tmp_path)
    assert sorted(os.listdir(tmp_path)) == ["file"]
