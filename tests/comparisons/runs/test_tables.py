"""Stored results: exact, ordered, and never half written."""

import csv
import errno
import io
import math
import os
import random
import sys
from unittest.mock import Mock

import numpy as np
import pandas as pd
import pytest

from comparisons.runs.atomic_files import atomic, prepare_folder, writable_file, write_json
from comparisons.runs.csv_format import csv_text, read_table, write_table
from comparisons.runs.frames import curve_frame, frame
from tests.comparisons.rows import row

REFUSED = {"value": None, "u_num": None, "size": None, "iterations": None, "residual": None}
POISSON_RATIOS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.45)
#: A sort that does not keep the order of equal keys shows it from 17 rows on.
POINTS = 200


def cells(table):
    """The cells of the first row of a table in CSV, by column."""
    return next(csv.DictReader(io.StringIO(csv_text(table), newline="")))


def test_csv_gives_every_double_back():
    """Of any bits, and those at the ends."""
    bits = np.random.default_rng(20261).integers(0, 2**64, 200, dtype=np.uint64).view(float)
    values = [*bits[np.isfinite(bits)], -0.0, 5e-324, sys.float_info.max, 0.1 + 0.2]
    mus = [0.1 * number + 0.1 for number in range(len(values))]
    rows = [row(value=value, mu=mu) for value, mu in zip(values, mus, strict=True)]
    written = list(csv.DictReader(io.StringIO(csv_text(frame(rows)), newline="")))
    assert [float(cells["value"]) for cells in written] == values
    assert [float(cells["mu"]) for cells in written] == mus
    assert all(len(cells["mu"]) <= len(repr(mu)) for cells, mu in zip(written, mus, strict=True))


@pytest.mark.parametrize(
    "text", ["=cmd|' /C calc'!A0", "+1+1", "-1+1", "@SUM(A1)", "\t=1", " =1", "\n=1", "'=1", "''-1", "' =1", "'-1"]
)
@pytest.mark.parametrize("column", ["model", "reason"])
def test_no_text_is_a_formula_and_each_is_read_back(text, column, tmp_path):
    table = frame([row(**{column: text})])
    assert cells(table)[column] == f"'{text}"
    write_table(table, tmp_path / "results")
    assert read_table(tmp_path / "results.csv")[column].tolist() == [text]
    assert next(csv.reader(io.StringIO(csv_text(pd.DataFrame({text: [1.0]})), newline=""))) == [f"'{text}"]


def test_a_carriage_return_does_not_begin_a_row_that_is_a_formula():
    assert cells(frame([row(reason="no\r=1+1")]))["reason"] == "no =1+1"
    assert cells(frame([row(reason="\r=1")]))["reason"] == "' =1"


def test_negative_numbers_and_their_texts_are_untouched():
    table = pd.DataFrame({"n": [2.0], "value": [-0.5], "paper_percent": ["-5.2"], "some": [None]})
    assert csv_text(table) == "n,value,paper_percent,some\n2,-0.5,-5.2,\n"
    mixed = pd.DataFrame({"value": pd.Series([-0.1, None], dtype=object)})
    assert csv_text(mixed) == 'value\n-0.1\n""\n'


@pytest.mark.parametrize("seed", range(3))
def test_the_tables_do_not_depend_on_the_order_of_completion(seed):
    rows = [row("fem", nu=nu, value=1.0 + nu) for nu in POISSON_RATIOS]
    curves = [
        row("fem", "force_curve", nu=nu, points=([float(x) for x in range(POINTS)], [0.0] * POINTS, 0.1))
        for nu in POISSON_RATIOS
    ]
    refused = row("jkr", "force_curve", **REFUSED)
    for table_of, ordered in ((frame, rows), (curve_frame, [*curves, refused])):
        shuffled = random.Random(seed).sample(ordered, len(ordered))
        pd.testing.assert_frame_equal(table_of(shuffled), table_of(ordered))
    table = curve_frame([*curves, refused])
    assert table["nu"].tolist()[:-1] == [nu for nu in POISSON_RATIOS for _ in range(POINTS)]
    assert table["x"].tolist()[:-1] == table["point"].tolist()[:-1] == list(range(POINTS)) * len(POISSON_RATIOS)


def test_a_written_table_has_no_clock_and_is_read_with_its_texts_and_marks(tmp_path):
    results = frame([row(), row("dmt", **REFUSED, status="failed", reason='"why",\n no;\x00 2.0')])
    write_table(results.assign(at_end=[True, False], paper_percent=["2.0", ""]), tmp_path / "results")
    stored = read_table(tmp_path / "results.csv")
    written = results.drop(columns="seconds")
    assert list(stored) == [*written, "at_end", "paper_percent"]
    pd.testing.assert_frame_equal(stored[list(written)], written)
    assert (stored["at_end"].tolist(), stored["paper_percent"].tolist()) == ([True, False], ["2.0", ""])
    write_table(curve_frame([]), tmp_path / "curves")
    assert read_table(tmp_path / "curves.csv")["x"].dtype == float
    (tmp_path / "no.csv").write_bytes(b"\xff")
    with pytest.raises(ValueError, match=r"no.csv cannot be read as CSV"):
        read_table(tmp_path / "no.csv")


def test_an_error_while_writing_leaves_the_old_file_and_no_other(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("old")
    with pytest.raises(TypeError), atomic(path) as file:
        file.writelines([b"half of the new", None])
    with pytest.raises(ValueError, match="JSON"):
        write_json({"a": math.nan}, tmp_path / "a.json")
    assert path.read_text() == "old"
    assert os.listdir(tmp_path) == ["a.txt"]


def test_written_files_can_be_read_by_others(tmp_path):
    with atomic(tmp_path / "a") as file:
        file.write(b"x")
    (tmp_path / "b").touch()
    assert (tmp_path / "a").stat().st_mode == (tmp_path / "b").stat().st_mode


def test_paths_that_cannot_be_written_are_refused(tmp_path, monkeypatch):
    (tmp_path / "file").touch()
    for check, path in (
        (prepare_folder, tmp_path / "file" / "folder"),
        (writable_file, tmp_path / "missing" / "a.csv"),
        (writable_file, tmp_path),
    ):
        with pytest.raises(ValueError, match=f"{path} cannot be written"):
            check(path)
    assert os.listdir(tmp_path) == ["file"]
    # No other path helps against a full disk.
    full = OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    monkeypatch.setattr("comparisons.runs.atomic_files.tempfile.TemporaryFile", Mock(side_effect=full))
    for check, path in ((prepare_folder, tmp_path), (writable_file, tmp_path / "a.csv")):
        with pytest.raises(OSError, match=f"{path} cannot be written"):
            check(path)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="Windows has no pipes in folders")
def test_a_device_or_a_pipe_is_not_replaced(tmp_path):
    """As /dev/null would be by root."""
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "link").symlink_to(os.devnull)
    for path in (tmp_path / "pipe", tmp_path / "link"):
        for write in (writable_file, lambda path: write_json({}, path)):
            with pytest.raises(ValueError, match="a device or a pipe"):
                write(path)
    assert (tmp_path / "pipe").is_fifo()
    assert (tmp_path / "link").is_symlink()


@pytest.mark.parametrize("text", ["", "n,k\n2,0,1\n", "n,k\n2\n", "n,n\n2,2\n", 'n,k\n2,"0\n'])
def test_a_table_whose_cells_are_not_those_of_its_columns_is_refused(tmp_path, text):
    (tmp_path / "results.csv").write_text(text)
    with pytest.raises(ValueError, match="results"):
        read_table(tmp_path / "results.csv")
