"""A comparison as an HTML fragment, which a notebook shows instead of a text."""

from __future__ import annotations

import pandas as pd

from comparisons.judging.summary import coverage_text
from comparisons.output.comparison import place_text, wide
from comparisons.output.report.render import environment
from comparisons.output.report.table import Cell, Column, Row, Table, kappa_cell, value

__all__ = ["notebook_html"]

#: A notebook with more rows is slow; the file of the comparison has all of them.
_MOST_ROWS = 200


def notebook_html(table: pd.DataFrame, summary: pd.DataFrame) -> str:
    """Return the tables of a comparison as HTML: coverage and largest errors, then the errors in every case.

    Parameters
    ----------
    table, summary : DataFrame
        As of `comparisons.output.comparison.comparison_table` and `comparisons.output.error_summary.error_summary`.

    Examples
    --------
    >>> empty = pd.DataFrame({"quantity": [], "reference": [], "model": []})
    >>> "<table" in notebook_html(empty, empty)
    False
    """
    groups = summary.groupby(["quantity", "reference"], sort=False)
    tables = [_summary(str(quantity), str(reference), group) for (quantity, reference), group in groups]
    tables += [_errors(quantity, reference, texts, table) for quantity, reference, texts in wide(table)]
    return environment().get_template("notebook.html").render(tables=tables)


def _summary(quantity: str, reference: str, group: pd.DataFrame) -> Table:
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
        Column("a value in", "number"),
        Column("largest κ (%)", "number"),
        Column("at"),
        Column("rms κ (%)", "number"),
    )
    return Table("summary", f"{quantity}: coverage and errors against {reference}", columns, rows)


def _numbers(row: pd.Series) -> tuple[Cell, Cell, Cell]:
    return kappa_cell(row["largest"], row["u_largest"]), Cell(place_text(row)), kappa_cell(row["rms"], row["u"])


def _errors(quantity: str, reference: str, texts: pd.DataFrame, table: pd.DataFrame) -> Table:
    """Return the errors in every case; pointing at a number shows all its digits."""
    of_table = table[(table["quantity"] == quantity) & (table["reference"] == reference)]
    case = ["n", "k", "mu", "nu"]
    models = list(texts.columns[list(texts.columns).index(reference) + 1 :])
    rows: list[Row] = []
    cases = of_table.groupby(case, sort=False, dropna=False)
    for (_, group), shown in zip(cases, texts.itertuples(index=False), strict=True):
        if len(rows) == _MOST_ROWS:
            break
        kappa = dict(zip(group["model"], group["kappa"], strict=True))
        first = group.iloc[0]
        parameters = [Cell(text) for text in shown[: -len(models) - 1]]
        cells = [Cell(text, kappa.get(model)) for model, text in zip(models, shown[-len(models) :], strict=True)]
        rows.append(Row((*parameters, value(first["reference_value"], first["u_reference"]), *cells)))
    caption = f"{quantity}: κ in percent with its uncertainty, against {reference}"
    if len(rows) < len(texts):
        caption += f" (the first {len(rows)} of {len(texts)} cases; comparison.csv has all)"
    return Table("errors", caption, tuple(Column(name, "number") for name in texts.columns), rows)
