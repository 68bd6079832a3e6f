"""Tables of a comparison: one row for each case with a column for each model, and the summary of the errors."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np
import pandas as pd
from rich.console import RenderableType

from comparisons.judging.summary import coverage_text
from comparisons.numerics.number_text import exact, value_text
from comparisons.output.table import Column, Record, Table, columns, numbers, percents, short_percent, words
from comparisons.output.terminal import rich_table
from comparisons.problem import PARAMETERS
from comparisons.runs.case_columns import with_problem
from comparisons.runs.rows import CASE

__all__ = ["SUMMARY_FILE", "TABLE_FILE", "WIDTH", "case_tables", "summary_tables", "terminal_tables"]

#: Stored tables behind those of a comparison.
SUMMARY_FILE, TABLE_FILE = "error_summary.csv", "comparison.csv"

#: Columns of the tables where no terminal states its own; cases that a terminal shows; spaces between columns.
WIDTH, _ROWS, _GAP = 80, 40, 2

#: The reference is shown to this digit, or to the digit that its uncertainty leaves it.
_LEAST_REFERENCE = 5e-7

_PARAMETERS = (*(numbers(name, name) for name in PARAMETERS), words("problem", "problem"))


def _error_text(row: Record) -> str:
    """Return kappa in percent, or the reason why there is none in a word or two."""
    if row["status"] != "ok":
        return "n/a" if row["status"] == "not-applicable" else str(row["status"])
    return "no reference" if np.isnan(row["kappa"]) else short_percent(row["kappa"], row["u_kappa"])


def _reference_text(row: Record) -> str:
    """Return the value of the reference to seven decimals, or digits, at most."""
    value, u = row["reference_value"], row["u_reference"]
    return value_text(value, max(u, _LEAST_REFERENCE * min(abs(value), 1.0))) or "none"


def _worst_case(row: Record) -> str:
    named = [f"{name}={exact(row[name])}" for name in PARAMETERS if not np.isnan(row[name])]
    return str(row.get("problem") or " ".join(named))


def case_tables(table: pd.DataFrame) -> Iterator[Table]:
    """Yield a table for each quantity and reference: one row for each case, with kappa of each model in percent.

    Parameters
    ----------
    table : DataFrame
        As of `comparisons.output.errors.comparison_table`.
    """
    numbered = with_problem(table).assign(line=range(len(table)))
    numbered["text"] = [_error_text(row) for row in numbered.to_dict("records")]
    for (quantity, reference), group in numbered.groupby(["quantity", "reference"], sort=False):
        group = group.assign(case=group.groupby([*CASE], sort=False, dropna=False).ngroup())
        wide = group.drop_duplicates("case").set_index("case").assign(lines=group.groupby("case")["line"].agg(list))
        of_models = [
            group.pivot(index="case", columns="model", values=name).add_prefix(f"{name} ") for name in ("text", "kappa")
        ]
        models = [
            Column(model, partial(_stored_text, f"text {model}"), f"kappa {model}")
            for model in dict.fromkeys(group["model"])
        ]
        yield Table(
            f"cases-{quantity}-{reference}",
            f"{quantity}: kappa in percent (uncertainty) against {reference}",
            [*_PARAMETERS, Column(str(reference), _reference_text, "reference_value"), *models],
            pd.concat([wide, *of_models], axis="columns"),
            TABLE_FILE,
        )


def _stored_text(name: str, row: Record) -> str:
    return "" if pd.isna(row[name]) else str(row[name])


def summary_tables(summary: pd.DataFrame) -> Iterator[Table]:
    """Yield a table for each quantity and reference: in how many cases a model has a value, and its errors in percent.

    Parameters
    ----------
    summary : DataFrame
        As of `comparisons.output.errors.error_summary`.
    """
    shown = [*columns("model"), Column("a value in", coverage_text), percents("largest", "largest", "u_largest")]
    shown += [Column("at", _worst_case), percents("rms", "rms", "u")]
    for (quantity, reference), group in summary.reset_index(drop=True).groupby(["quantity", "reference"], sort=False):
        caption = f"{quantity}: coverage, largest and root mean square kappa in percent, against {reference}"
        yield Table(f"summary-{quantity}-{reference}", caption, shown, group, SUMMARY_FILE)


def terminal_tables(
    table: pd.DataFrame, summary: pd.DataFrame, every: bool = False, width: int = WIDTH
) -> Iterator[RenderableType]:
    """Yield the tables of a comparison for a terminal: errors with as many models as fit, and the summary.

    Parameters
    ----------
    table, summary : DataFrame
        As of `comparisons.output.errors`: `comparison_table` and `error_summary`.
    every : bool
        Whether all cases are shown; else the first `_ROWS`.
    width : int
        Columns of the terminal.
    """
    for cases in case_tables(table):
        shown = cases if every else replace(cases, stored=cases.stored.head(_ROWS))
        limit = "" if len(shown.stored) == len(cases.stored) else f", first {_ROWS} of {len(cases.stored)} cases"
        models = [column.heading for column in cases.columns if column.number.startswith("kappa ")]
        fixed = [name for name in shown.texts if name not in models]
        widths = {name: _GAP + max(map(len, [name, *shown.texts[name]])) for name in shown.texts}
        free = width + _GAP - sum(widths[name] for name in fixed)
        beside = max(int(free // max(widths[name] for name in models)), 1)
        for start in range(0, len(models), beside):
            yield rich_table(shown.texts[[*fixed, *models[start : start + beside]]], cases.caption + limit)
    for of_quantity in summary_tables(summary):
        yield rich_table(of_quantity.texts, of_quantity.caption)
