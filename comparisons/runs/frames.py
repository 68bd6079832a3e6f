"""Tables of results: one row for each model, quantity and case, with declared column types."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, replace
from typing import Any

import pandas as pd
import pyarrow as pa

from comparisons.problem import PARAMETERS
from comparisons.runs.case_columns import in_case_order, varied_of, without_empty_problem
from comparisons.runs.rows import Row

__all__ = ["COLUMNS", "CURVE_COLUMNS", "curve_frame", "frame", "typed"]

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
        ("dimensionless_value", _REAL),
        ("dimensionless_u_num", _REAL),
        ("dimensionless_unit", _TEXT),
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


def frame(rows: Iterable[Row]) -> pd.DataFrame:
    """Return the rows as a sorted pandas table with the columns of `COLUMNS`.

    The varied keys of problem files are columns, too; where no case is of a file, there is no column of such ones.
    """
    return _sorted([asdict(row) for row in rows], COLUMNS, "quantity", "model")


def curve_frame(rows: Iterable[Row]) -> pd.DataFrame:
    """Return the curves as a sorted table with the columns of `CURVE_COLUMNS`; those of a file as of `frame`."""
    records = []
    for row in rows:
        whole = asdict(replace(row, points=None)) | {"u_distance": row.points[2] if row.points else None}
        points = zip(*row.points[:2], strict=True) if row.points else [(None, None)]
        records += [whole | {"point": number, "x": x, "y": y} for number, (x, y) in enumerate(points)]
    # The points of a curve are in order already, and the sorting keeps it.
    return _sorted(records, CURVE_COLUMNS, "quantity", "model")


def _sorted(records: list[dict[str, Any]], schema: pa.Schema, *first: str) -> pd.DataFrame:
    varied = {
        name: value for record in records for name, value in record["parameters"].items() if name not in PARAMETERS
    }
    place = schema.get_field_index("problem") + 1
    for name, value in reversed(varied.items()):
        schema = schema.insert(place, pa.field(name, _TEXT if isinstance(value, str) else _REAL))
    table = pa.Table.from_pylist([record | record["parameters"] for record in records], schema=schema)
    return in_case_order(without_empty_problem(table.to_pandas()), *first)


def typed(table: pd.DataFrame, schema: pa.Schema) -> pa.Schema:
    """Return the types of the columns of a table: those of a schema, and of its varied keys."""
    others = pa.Schema.from_pandas(table[varied_of(table)], preserve_index=False)
    return pa.schema([(schema if name in schema.names else others).field(name) for name in table.columns])
