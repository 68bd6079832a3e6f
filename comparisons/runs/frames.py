"""Rows as tables with declared columns, sorted."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, replace
from typing import Any

import pandas as pd

from comparisons.data.columns import column
from comparisons.data.file_names import CURVES, RESULTS
from comparisons.problem import PARAMETERS
from comparisons.runs.case_columns import in_case_order, without_empty_problem
from comparisons.runs.rows import DIMENSIONLESS, Row

# What was evaluated, in either table.
_EVALUATION = ("model", "model_version", "quantity", *PARAMETERS, "problem")

#: Columns of the table of results, in order; those without a unit in `comparisons.data.columns` are texts.
COLUMNS = (
    *(*_EVALUATION, "value", "u_num", "observed_order", "unit", *DIMENSIONLESS),
    *("status", "reason", "size", "iterations", "residual", "seconds"),
)

#: Columns of the table of curves: one row a point, and one row for a curve that there is not.
CURVE_COLUMNS = (*_EVALUATION, "point", "x", "y", "u_distance", "unit", "status", "reason", "seconds")


def frame(rows: Iterable[Row]) -> pd.DataFrame:
    """Return the rows as a sorted pandas table with the columns of `COLUMNS`.

    The varied keys of problem files are columns, too; where no case is of a file, there is no column of such ones.
    """
    return _sorted([asdict(row) for row in rows], COLUMNS, RESULTS)


def curve_frame(rows: Iterable[Row]) -> pd.DataFrame:
    """Return the curves as a sorted table with the columns of `CURVE_COLUMNS`; those of a file as of `frame`."""
    records = []
    for row in rows:
        record = asdict(replace(row, points=None)) | {"u_distance": row.points[2] if row.points else None}
        points = zip(*row.points[:2], strict=True) if row.points else [(None, None)]
        records += [record | {"point": number, "x": x, "y": y} for number, (x, y) in enumerate(points)]
    # The points of a curve are in order already, and the sorting keeps it.
    return _sorted(records, CURVE_COLUMNS, CURVES)


def _sorted(records: list[dict[str, Any]], columns: tuple[str, ...], stem: str) -> pd.DataFrame:
    varied = dict.fromkeys(name for record in records for name in record["parameters"] if name not in PARAMETERS)
    end = columns.index("problem") + 1
    names = [*columns[:end], *varied, *columns[end:]]
    numbers = [name for name in columns if (described := column(stem, name)) and described.unit]
    table = pd.DataFrame([record | record["parameters"] for record in records], columns=names)
    table = table.astype(dict.fromkeys(numbers, float))
    return in_case_order(without_empty_problem(table), "quantity", "model")
