"""Rows as tables with declared columns, sorted; the columns of cases, of which a table may leave some out."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Any

import lazy_loader

from comparisons.data.columns import column
from comparisons.data.file_names import CURVES, RESULTS
from comparisons.model import EFFORT
from comparisons.problem import PARAMETERS
from comparisons.problem.kinds import KINDS
from comparisons.problem.problem import split_name
from comparisons.runs.rows import CASE, DIMENSIONLESS, Key, Row, none_if_nan

if TYPE_CHECKING:
    import pandas as pd
else:
    pd = lazy_loader.load("pandas")


def keys_in(table: pd.DataFrame) -> list[Key]:
    """Return the key of each row of a table with the columns model, quantity and `CASE`.

    Examples
    --------
    >>> case = {"n": [2.0], "k": [0.0], "mu": [1.0], "nu": [None]}
    >>> keys_in(pd.DataFrame({"model": ["jkr"], "quantity": ["pull_off_force"], **case}))
    [('jkr', 'pull_off_force', 2.0, 0.0, 1.0, None, '')]
    """
    columns = ["model", "quantity", *CASE]
    return [
        (model, quantity, *(none_if_nan(number) for number in (n, k, mu, nu)), problem)
        for model, quantity, n, k, mu, nu, problem in with_problem(table)[columns].itertuples(index=False, name=None)
    ]


def with_problem(table: pd.DataFrame) -> pd.DataFrame:
    """Return a table of cases with the column `problem`, which it may leave out where no case is of a file.

    Examples
    --------
    >>> with_problem(pd.DataFrame({"n": [2.0]}))["problem"].tolist()
    ['']
    """
    return table if "problem" in table else table.assign(problem="")


def without_empty_problem(table: pd.DataFrame) -> pd.DataFrame:
    """Return a table without the columns of problems of files where no case is of one.

    Examples
    --------
    >>> list(without_empty_problem(pd.DataFrame({"n": [2.0], "problem": [""]})))
    ['n']
    """
    empty = "problem" in table and not (table["problem"].fillna("") != "").any()
    return table.drop(columns=["problem", *DIMENSIONLESS], errors="ignore") if empty else table


def varied_of(table: pd.DataFrame) -> list[str]:
    """Return the columns of the varied keys of problem files.

    Examples
    --------
    >>> varied_of(pd.DataFrame(columns=["model", "punch.R [m]", "value"]))
    ['punch.R [m]']
    """
    return [name for name in table.columns if name.partition(".")[0] in KINDS]


def varied_keys(table: pd.DataFrame) -> list[str]:
    """Return the columns of the keys that tell the cases of one problem file apart; none if there are other cases.

    Examples
    --------
    >>> labels = ["pad.toml; punch.R=1 nm", "pad.toml; punch.R=5 nm"]
    >>> table = pd.DataFrame({"problem": labels, "punch.R [m]": [1e-9, 5e-9]})
    >>> varied_keys(table), varied_keys(table.assign(problem=["pad.toml; punch.R=1 nm", "tip.toml"]))
    (['punch.R [m]'], [])
    """
    files = {split_name(label)[0] for label in with_problem(table)["problem"].fillna("")}
    keys = varied_of(table)
    return keys if len(files) == 1 and "" not in files and table[keys].notna().all(axis=None) else []


def unit_in(column: str) -> tuple[str, str]:
    """Return the key and the unit in SI of the column of a varied key.

    Examples
    --------
    >>> unit_in("punch.R [m]"), unit_in("solid.nu")
    (('punch.R', 'm'), ('solid.nu', '1'))
    """
    key, _, unit = column.removesuffix("]").partition(" [")
    return key, unit or "1"


def in_case_order(table: pd.DataFrame, *leading: str) -> pd.DataFrame:
    """Return a table sorted by some columns and then by the case; problems of a file by its name and the varied keys.

    Examples
    --------
    >>> labels = ["pad.toml; punch.R=10 nm", "pad.toml; punch.R=5 nm"]
    >>> cases = {"n": None, "k": None, "mu": None, "nu": None, "problem": labels, "punch.R [m]": [1e-8, 5e-9]}
    >>> in_case_order(pd.DataFrame(cases))["punch.R [m]"].tolist()
    [5e-09, 1e-08]
    """
    ordered = with_problem(table)
    ordered = ordered.assign(_file=[split_name(label)[0] for label in ordered["problem"]])
    order = [*leading, *PARAMETERS, "_file", *varied_of(table), "problem"]
    return ordered.sort_values(order, ignore_index=True)[list(table.columns)]


#: What was evaluated, in either table.
_EVALUATION = ("model", "model_version", "quantity", *PARAMETERS, "problem")

#: Columns of the table of results, in order; those without a unit in `comparisons.data.columns` are texts.
COLUMNS = (
    *(*_EVALUATION, "value", "u_num", "unit", *DIMENSIONLESS),
    *("status", "reason", *EFFORT),
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
