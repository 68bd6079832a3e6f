"""Names of `comparisons.output.table` for the page of a sweep over a problem file."""

from comparisons.output.table import Cell, Column, Row, Table, kappa_cell, number, value, without_empty

__all__ = ["Cell", "Column", "Row", "Table", "kappa_cell", "number", "value", "without_empty"]
