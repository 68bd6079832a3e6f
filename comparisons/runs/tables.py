"""Stored tables: each as CSV and as Parquet.

The tables of a run are sorted, and the CSV depends on code and cases alone: wall-clock times are only in the Parquet.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from pathlib import Path

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from comparisons.data.input_files import LARGEST_ROWS, read_bytes
from comparisons.runs.atomic_files import atomic
from comparisons.runs.csv_format import csv_text
from comparisons.runs.data_package import described, quantities
from comparisons.runs.frames import COLUMNS, CURVE_COLUMNS, typed

__all__ = ["read_table", "write_curves", "write_results", "write_table"]


def write_results(table: pd.DataFrame, stem: Path) -> None:
    """Write a table of rows, as `frame` returns it; the CSV leaves out the wall-clock seconds."""
    write_table(table, stem, schema=COLUMNS, leave_out_of_csv=["seconds"])


def write_curves(table: pd.DataFrame, stem: Path) -> None:
    """Write a table of curves, as `curve_frame` returns it; the CSV leaves out the wall-clock seconds."""
    write_table(table, stem, schema=CURVE_COLUMNS, leave_out_of_csv=["seconds"])


def write_table(
    table: pd.DataFrame,
    stem: Path,
    *,
    schema: pa.Schema | None = None,
    leave_out_of_csv: Iterable[str] = (),
) -> None:
    """Write a table as `stem`.csv and `stem`.parquet, the latter with the types of `schema` if given.

    The Parquet file has unit and description of each column in the metadata of its field, and the units of the
    quantities, as JSON, in the metadata of the table.
    """
    if schema is not None:
        schema = typed(table, schema)
    with atomic(stem.with_suffix(".csv")) as file:
        file.write(csv_text(table.drop(columns=list(leave_out_of_csv))).encode())
    with atomic(stem.with_suffix(".parquet")) as file:
        stored = pa.Table.from_pandas(table, schema=schema, preserve_index=False)
        units = {**(stored.schema.metadata or {}), "quantities": json.dumps(quantities())}
        pq.write_table(stored.cast(described(stem.name, stored.schema)).replace_schema_metadata(units), file)


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
