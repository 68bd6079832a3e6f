"""A comparison as an HTML fragment, which a notebook shows instead of a text."""

from __future__ import annotations

import pandas as pd

from comparisons.output.report.render import environment
from comparisons.output.report.tables import case_tables, summary_tables

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
    tables = [*summary_tables(summary), *case_tables(table, _MOST_ROWS)]
    return environment().get_template("notebook.html").render(tables=tables)
