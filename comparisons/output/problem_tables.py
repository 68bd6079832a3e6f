"""Tables of a sweep over a problem file: values in SI, and relative errors against a reference."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict

import pandas as pd

from comparisons.numerics.kappa import relative_difference, relative_uncertainty
from comparisons.problem_file.overview import REFERENCES
from comparisons.runs.problem_tasks import ProblemRow

__all__ = ["ERROR_COLUMNS", "VALUE_COLUMNS", "problem_errors", "problem_table", "varied_of"]

#: Columns of the table of values; the others are the varied keys, which stand before the value.
VALUE_COLUMNS = (
    *("model", "model_version", "quantity", "value", "u_num", "unit"),
    *("dimensionless_value", "dimensionless_u_num", "dimensionless_unit", "status", "reason", "seconds"),
)
#: Columns of the table of errors, besides the varied keys.
ERROR_COLUMNS = (
    *("model", "quantity", "value", "u_num", "unit"),
    *("reference", "reference_value", "u_reference", "kappa", "u_kappa"),
)

_NUMBERS = ("value", "u_num", "dimensionless_value", "dimensionless_u_num", "seconds")


def varied_of(table: pd.DataFrame) -> list[str]:
    """Return the columns of the varied keys.

    Examples
    --------
    >>> varied_of(pd.DataFrame(columns=["model", "punch.R [m]", "value"]))
    ['punch.R [m]']
    """
    return [name for name in table.columns if name not in VALUE_COLUMNS + ERROR_COLUMNS]


def problem_table(rows: Sequence[ProblemRow]) -> pd.DataFrame:
    """Return the rows as a sorted table; the varied keys are columns.

    Examples
    --------
    >>> row = ProblemRow("fscm", "1", "pull_off_force", {"punch.R [m]": 1e-7}, "ab", 2e-8, 1e-16, "N", "ok", "", 1.0)
    >>> list(problem_table([row]))[2:5]
    ['quantity', 'punch.R [m]', 'value']
    """
    varied = list(rows[0].parameters) if rows else []
    records = []
    for row in rows:
        record = asdict(row)
        scaled = record.pop("dimensionless") or {"unit": ""}
        record |= {f"dimensionless_{name}": number for name, number in scaled.items()} | record.pop("parameters")
        records.append(record)
    before, after = VALUE_COLUMNS[:3], VALUE_COLUMNS[3:]
    table = pd.DataFrame(records, columns=[*before, *varied, *after])
    table = table.astype(dict.fromkeys(_NUMBERS, float))
    return table.sort_values(["quantity", "model", *varied], ignore_index=True)


def problem_errors(table: pd.DataFrame) -> pd.DataFrame:
    """Return the relative error of every model against the reference among them; no rows without a reference.

    Parameters
    ----------
    table : DataFrame
        As of `problem_table`.

    Returns
    -------
    DataFrame
        A row for each model, quantity and problem in which model and reference have values.  The reference is the first
        of `comparisons.problem_file.overview.REFERENCES` that is among the models.

    Examples
    --------
    >>> rows = [ProblemRow(name, "1", "pull_off_force", {"punch.R [m]": 1e-7}, "ab", value, 0.0, "N", "ok", "", 1.0)
    ...         for name, value in (("fscm", 2e-8), ("jkr", 1.9e-8))]
    >>> problem_errors(problem_table(rows))["kappa"].round(12).tolist()
    [-0.05]
    """
    varied = varied_of(table)
    columns = [*ERROR_COLUMNS[:2], *varied, *ERROR_COLUMNS[2:]]
    known = table[table["status"] == "ok"]
    models = set(known["model"])
    reference = next((name for name in REFERENCES if name in models), None)
    if reference is None:
        return pd.DataFrame(columns=columns)
    of_reference = known[(known["model"] == reference) & (known["value"] != 0.0)]
    beside = of_reference[["quantity", *varied, "value", "u_num"]].assign(reference=reference)
    beside = beside.rename(columns={"value": "reference_value", "u_num": "u_reference"})
    joined = known[known["model"] != reference].merge(beside, on=["quantity", *varied])
    pair = joined["value"], joined["reference_value"]
    bounds = joined["u_num"], joined["u_reference"]
    joined["kappa"] = relative_difference(*pair)
    joined["u_kappa"] = relative_uncertainty(pair[0], bounds[0], pair[1], bounds[1])
    return joined[columns].sort_values(["quantity", "model", *varied], ignore_index=True)
