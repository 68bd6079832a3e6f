"""Tables of results: one row for each model, quantity and case, with declared column types."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, replace
from typing import Any

import pandas as pd
import pyarrow as pa

from comparisons.runs.case_columns import with_problem, without_empty_problem
from comparisons.runs.rows import CASE, Row

__all__ = ["COLUMNS", "CURVE_COLUMNS", "curve_frame", "frame", "rows_of"]

_TEXT, _REAL, _COUNT = pa.string(), pa.float64(), pa.int64()

# What was evaluated, in either table.
_EVALUATION = [
    ("model", _TEXT),
    ("model_version", _TEXT),
    ("quantity", _TEXT),
    ("n", _REAL),
    ("k", _REAL),
    ("mu", _REAL),
    ("nu", _REAL),
    ("problem", _TEXT),
]

#: Column types of the stored table, in order.
COLUMNS = pa.schema(
    [
        *_EVALUATION,
        ("value", _REAL),
        ("u_num", _REAL),
        ("observed_order", _REAL),
        ("unit", _TEXT),
        ("status", _TEXT),
        ("reason", _TEXT),
        ("size", _COUNT),
        ("iterations", _COUNT),
        ("residual", _REAL),
        ("seconds", _REAL),
    ]
)

#: Column types of the stored curves: one row a point, and one row for a curve that there is not.
CURVE_COLUMNS = pa.schema(
    [
        *_EVALUATION,
        ("point", _COUNT),
        ("x", _REAL),
        ("y", _REAL),
        ("u_distance", _REAL),
        ("unit", _TEXT),
        ("status", _TEXT),
        ("reason", _TEXT),
        ("seconds", _REAL),
    ]
)

_ORDER = ["quantity", "model", *CASE]


def frame(rows: Iterable[Row]) -> pd.DataFrame:
    """Return the rows as a sorted pandas table with the columns of `COLUMNS`; `problem` where a case is of a file."""
    table = pa.Table.from_pylist([asdict(row) for row in rows], schema=COLUMNS)
    return without_empty_problem(table.to_pandas().sort_values(_ORDER, ignore_index=True))


def curve_frame(rows: Iterable[Row]) -> pd.DataFrame:
    """Return the curves as a sorted table with the columns of `CURVE_COLUMNS`; `problem` where a case is of a file."""
    records = []
    for row in rows:
        whole = asdict(replace(row, points=None)) | {"u_distance": row.points[2] if row.points else None}
        points = zip(*row.points[:2], strict=True) if row.points else [(None, None)]
        records += [whole | {"point": number, "x": x, "y": y} for number, (x, y) in enumerate(points)]
    table = pa.Table.from_pylist(records, schema=CURVE_COLUMNS)
    return without_empty_problem(table.to_pandas().sort_values([*_ORDER, "point"], ignore_index=True))


def rows_of(results: pd.DataFrame, curves: pd.DataFrame) -> list[Row]:
    """Return the rows of which `frame` and `curve_frame` have made tables.

    Examples
    --------
    >>> row = Row("mine", "1", "pull_off_force", 2, 0, 1, None, 1.5, 1e-15, "load", "ok", "", None, None, 0.0, 0.1)
    >>> rows_of(frame([row]), curve_frame([])) == [row]
    True
    """
    results, curves = (with_problem(table) for table in (results, curves))
    rows = [Row(**_typed(record, COLUMNS)) for record in results[COLUMNS.names].to_dict("records")]
    whole = [name for name in CURVE_COLUMNS.names if name not in ("point", "x", "y", "u_distance")]
    for _, points in curves.groupby(_ORDER, sort=False, dropna=False):
        points = points.sort_values("point")
        first = _typed(points[whole].to_dict("records")[0], CURVE_COLUMNS)
        found = None
        if first["status"] == "ok":
            found = points["x"].tolist(), points["y"].tolist(), float(points["u_distance"].iloc[0])
        rows.append(Row(**first, value=None, u_num=None, size=None, iterations=None, residual=None, points=found))
    return rows


def _typed(record: dict[Any, Any], schema: pa.Schema) -> dict[str, Any]:
    """Return the entries of a row, None for those that are not there, and counts as integers."""
    types = {_TEXT: str, _REAL: float, _COUNT: int}
    return {name: None if pd.isna(value) else types[schema.field(name).type](value) for name, value in record.items()}
