"""Tables of a comparison: coverage and errors of each model, and the errors in every case."""

from __future__ import annotations

from collections.abc import Iterator

import pandas as pd

from comparisons.judging.summary import coverage_text
from comparisons.output.comparison import place_text, wide
from comparisons.output.report.table import Cell, Column, Row, Table, kappa_cell, value
from comparisons.runs.case_columns import with_problem
from comparisons.runs.rows import CASE

__all__ = ["SUMMARY_FILE", "TABLE_FILE", "case_tables", "summary_tables"]

#: Stored tables behind those here: the summary of the errors, and one row for each case and model.
SUMMARY_FILE, TABLE_FILE = "error_summary.csv", "comparison.csv"


def summary_tables(summary: pd.DataFrame) -> Iterator[Table]:
    """Yield a table for each quantity and reference: in how many cases a model has a value, and its errors.

    Parameters
    ----------
    summary : DataFrame
        As of `comparisons.output.error_summary.error_summary`.
    """
    numbered = summary.assign(line=range(len(summary)))
    for (quantity, reference), group in numbered.groupby(["quantity", "reference"], sort=False):
        rows = [
            Row(
                (
                    Cell(row["model"]),
                    Cell(coverage_text(row)),
                    *((Cell(""),) * 3 if pd.isna(row["largest"]) else _numbers(row)),
                )
            )
            for _, row in group.iterrows()
        ]
        columns = (
            Column("model", "head"),
            Column("a value in"),
            Column("largest κ (%)", "number"),
            Column("at"),
            Column("rms κ (%)", "number"),
        )
        caption = f"{quantity}: coverage and errors against {reference}"
        lines = tuple(group["line"].tolist())
        yield Table(f"summary-{quantity}-{reference}", caption, columns, rows, SUMMARY_FILE, lines=lines)


def _numbers(row: pd.Series) -> tuple[Cell, Cell, Cell]:
    return kappa_cell(row["largest"], row["u_largest"]), Cell(place_text(row)), kappa_cell(row["rms"], row["u"])


def case_tables(table: pd.DataFrame, most: int | None = None) -> Iterator[Table]:
    """Yield a table for each quantity and reference: one row a case, one column a model.

    Pointing at a number shows all its digits.

    Parameters
    ----------
    table : DataFrame
        As of `comparisons.output.comparison.comparison_table`.
    most : int, optional
        Rows that are shown; the caption then states how many there are.
    """
    numbered = with_problem(table).assign(line=range(len(table)))
    for quantity, reference, texts in wide(table):
        of_table = numbered[(numbered["quantity"] == quantity) & (numbered["reference"] == reference)]
        models = list(texts.columns[list(texts.columns).index(reference) + 1 :])
        rows: list[Row] = []
        lines: list[tuple[int, ...]] = []
        cases = of_table.groupby([*CASE], sort=False, dropna=False)
        for (_, group), shown in zip(cases, texts.itertuples(index=False), strict=True):
            if len(rows) == most:
                break
            kappa = {name: float(x) for name, x in zip(group["model"], group["kappa"], strict=True) if pd.notna(x)}
            first = group.iloc[0]
            parameters = [Cell(text) for text in shown[: -len(models) - 1]]
            cells = [Cell(text, kappa.get(model)) for model, text in zip(models, shown[-len(models) :], strict=True)]
            rows.append(Row((*parameters, value(first["reference_value"], first["u_reference"]), *cells)))
            lines.append(tuple(group["line"].tolist()))
        caption = f"{quantity}: κ in percent with its uncertainty, against {reference}"
        if len(rows) < len(texts):
            caption += f" (the first {len(rows)} of {len(texts)} cases; {TABLE_FILE} has all)"
        columns = tuple(Column(name, "number") for name in texts.columns)
        yield Table(f"cases-{quantity}-{reference}", caption, columns, rows, TABLE_FILE, lines=tuple(lines))
