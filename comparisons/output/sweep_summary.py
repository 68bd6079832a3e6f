"""Summary of a sweep for the terminal: at most 30 lines at 80 columns, whatever its size."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import pandas as pd

from comparisons.numerics.number_text import case_text, percent_text
from comparisons.output.fitted_table import FittedTable
from comparisons.output.tables import rich_table
from comparisons.runs.rows import Row

__all__ = ["failure_lines", "largest_errors", "summary_tables"]

#: Rows of the table of models and of the table of errors; with titles, columns, rules and the headings of four
#: quantities 27 lines.
_MODELS, _ERRORS = 7, 10

#: Failures that are written one by one.
_FAILURES = 3


def summary_tables(results: pd.DataFrame, curves: pd.DataFrame, kappa: pd.DataFrame) -> list[FittedTable]:
    """Return the tables of a summary: how the computations ended, and the largest error of each quantity and model.

    Parameters
    ----------
    results, curves, kappa : DataFrame
        As `comparisons.pipeline.tables.RunTables` has them.

    Examples
    --------
    >>> results = pd.DataFrame({"model": ["jkr", "dmt"], "status": ["ok", "failed"], "seconds": [0.5, 0.1]})
    >>> [table.row_count for table in summary_tables(results, pd.DataFrame(columns=results.columns), pd.DataFrame())]
    [2]
    """
    counted = _computations(results, curves)
    tables = [_first(counted, _MODELS, "computations", optional=("seconds", "not-applicable"))]
    if len(kappa):
        tables.append(largest_errors(kappa))
    return tables


def largest_errors(kappa: pd.DataFrame) -> FittedTable:
    """Return the largest relative error of each model and quantity, in percent, and its case."""
    return _first(_largest(kappa), _ERRORS, "largest abs(kappa) in percent", group="quantity")


def failure_lines(failures: Sequence[Row]) -> Iterator[str]:
    """Yield a sentence for each of the first failures, and one for the others.

    Examples
    --------
    >>> list(failure_lines([]))
    []
    """
    for row in failures[:_FAILURES]:
        place = case_text({"n": row.n, "k": row.k, "mu": row.mu, "problem": row.problem})
        yield f"{row.model}: {row.quantity} at {place}: {row.reason}"
    if len(failures) > _FAILURES:
        yield f"{len(failures) - _FAILURES} more computations failed; the tables have their reasons"


def _computations(results: pd.DataFrame, curves: pd.DataFrame) -> pd.DataFrame:
    # A curve has a row for each point.
    whole = curves[curves["point"] == 0] if "point" in curves else curves
    tables = [table[["model", "status", "seconds"]] for table in (results, whole)]
    # Not one without rows: older versions of pandas warn that its types will count.
    rows = pd.concat([table for table in tables if len(table)] or tables)
    counts = rows.groupby(["model", "status"]).size().unstack(fill_value=0)
    for status in ("ok", "not-applicable", "failed"):
        if status not in counts:
            counts[status] = 0
    counts = counts[["ok", "not-applicable", "failed"]]
    return counts.assign(seconds=rows.groupby("model")["seconds"].sum().round(1)).reset_index()


def _largest(kappa: pd.DataFrame) -> pd.DataFrame:
    worst = kappa.loc[kappa["kappa"].abs().groupby([kappa["quantity"], kappa["model"]]).idxmax()]
    texts = [percent_text(*pair) for pair in zip(worst["kappa"], worst["u_kappa"], strict=True)]
    found = worst[["quantity", "model", *(name for name in ("n", "k", "mu") if worst[name].notna().any())]]
    shown = found.assign(largest=texts)
    return shown.assign(problem=worst["problem"]) if "problem" in worst else shown


def _first(table: pd.DataFrame, rows: int, title: str, group: str = "", optional: Sequence[str] = ()) -> FittedTable:
    """Return the first rows of a table; the title tells how many there are."""
    if len(table) > rows:
        title += f" (the first {rows} of {len(table)} rows)"
    return rich_table(table.head(rows), title, group=group, optional=optional)
