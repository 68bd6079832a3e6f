"""Tables of results with declared column types, and stored tables: each as CSV and as Parquet.

The tables of a run are sorted, and the CSV depends on code and cases alone: wall-clock times are only in the Parquet.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from comparisons.data.file_names import CURVES, RESULTS
from comparisons.data.input_files import LARGEST_ROWS, read_bytes
from comparisons.problem import PARAMETERS
from comparisons.runs.atomic_files import atomic
from comparisons.runs.case_columns import in_case_order, varied_of, without_empty_problem
from comparisons.runs.csv_format import csv_text
from comparisons.runs.rows import Row

__all__ = ["COLUMNS", "CURVE_COLUMNS", "curve_frame", "frame", "read_table", "write_table"]

_TEXT, _REAL, _COUNT = pa.string(), pa.float64(), pa.int64()

# What was evaluated, in either table.
_EVALUATION = {
    **dict.fromkeys(("model", "model_version", "quantity"), _TEXT),
    **dict.fromkeys(PARAMETERS, _REAL),
    "problem": _TEXT,
}

#: Column types of the stored table, in order.
COLUMNS = pa.schema(
    _EVALUATION
    | dict.fromkeys(("value", "u_num", "observed_order"), _REAL)
    | {"unit": _TEXT}
    | {"dimensionless_value": _REAL, "dimensionless_u_num": _REAL, "dimensionless_unit": _TEXT}
    | {"status": _TEXT, "reason": _TEXT}
    | {"size": _COUNT, "iterations": _COUNT, "residual": _REAL, "seconds": _REAL}
)

#: Column types of the stored curves: one row a point, and one row for a curve that there is not.
CURVE_COLUMNS = pa.schema(
    _EVALUATION
    | {"point": _COUNT, "x": _REAL, "y": _REAL, "u_distance": _REAL}
    | {"unit": _TEXT, "status": _TEXT, "reason": _TEXT, "seconds": _REAL}
)

#: Stored table of rows -> its column types.
_OF_ROWS = {RESULTS: COLUMNS, CURVES: CURVE_COLUMNS}


def frame(rows: Iterable[Row]) -> pd.DataFrame:
    """Return the rows as a sorted pandas table with the columns of `COLUMNS`.

    The varied keys of problem files are columns, too; where no case is of a file, there is no column of such ones.
    """
    return _sorted([asdict(row) for row in rows], COLUMNS)


def curve_frame(rows: Iterable[Row]) -> pd.DataFrame:
    """Return the curves as a sorted table with the columns of `CURVE_COLUMNS`; those of a file as of `frame`."""
    records = []
    for row in rows:
        record = asdict(replace(row, points=None)) | {"u_distance": row.points[2] if row.points else None}
        points = zip(*row.points[:2], strict=True) if row.points else [(None, None)]
        records += [record | {"point": number, "x": x, "y": y} for number, (x, y) in enumerate(points)]
    # The points of a curve are in order already, and the sorting keeps it.
    return _sorted(records, CURVE_COLUMNS)


def _sorted(records: list[dict[str, Any]], schema: pa.Schema) -> pd.DataFrame:
    varied = {
        name: value for record in records for name, value in record["parameters"].items() if name not in PARAMETERS
    }
    index = schema.get_field_index("problem") + 1
    for name, value in reversed(varied.items()):
        schema = schema.insert(index, pa.field(name, _TEXT if isinstance(value, str) else _REAL))
    table = pa.Table.from_pylist([record | record["parameters"] for record in records], schema=schema)
    return in_case_order(without_empty_problem(table.to_pandas()), "quantity", "model")


def write_table(table: pd.DataFrame, stem: Path) -> None:
    """Write a table as `stem`.csv and `stem`.parquet.

    Tables of rows (`RESULTS` and `CURVES`) have the types of `COLUMNS` and `CURVE_COLUMNS` in the Parquet file, and no
    wall-clock seconds in the CSV.
    """
    schema = _OF_ROWS.get(stem.name)
    in_csv = table
    if schema is not None:
        varied = pa.Schema.from_pandas(table[varied_of(table)], preserve_index=False)
        schema = pa.schema([(schema if name in schema.names else varied).field(name) for name in table.columns])
        in_csv = table.drop(columns="seconds")
    with atomic(stem.with_suffix(".csv")) as file:
        file.write(csv_text(in_csv).encode())
    with atomic(stem.with_suffix(".parquet")) as file:
        pq.write_table(pa.Table.from_pandas(table, schema=schema, preserve_index=False), file)


def read_table(path: Path) -> pd.DataFrame:
    """Read a stored table.

    Raises
    ------
    ValueError
        If there is no such file or it is not Parquet; one sentence says which.
    """
    try:
        return pq.read_table(pa.BufferReader(read_bytes(path, LARGEST_ROWS))).to_pandas()
    except FileNotFoundError:
        raise ValueError(f"{path} does not exist: {path.parent} is not the folder of a finished run") from None
    except (OSError, pa.ArrowException) as error:
        raise ValueError(f"{path} cannot be read as Parquet ({str(error).splitlines()[0]})") from None
