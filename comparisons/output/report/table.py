"""Names of `comparisons.output.table` for the page of a sweep over a problem file."""

from comparisons.output.latex import latex
from comparisons.output.table import Cell, Column, Row, Table, kappa_cell, number, value, without_empty

__all__ = ["Cell", "Column", "Row", "Table", "kappa_cell", "number", "table_tex", "value", "without_empty"]


def table_tex(table: Table) -> str:
    """Return a table with all its rows in LaTeX, as the page saves it."""
    return latex(table.on_paper(), table.caption, table.id)
