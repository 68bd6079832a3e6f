"""Tables of the page: texts, the stored numbers behind them, and the files that hold them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import pandas as pd

from comparisons.numerics.number_text import exact, percent_text, value_text
from comparisons.output.latex import LatexParts, latex_parts
from comparisons.runs.csv_format import csv_text
from comparisons.runs.rows import PARAMETERS

__all__ = [
    "CASE_COLUMNS",
    "Cell",
    "Column",
    "Row",
    "Table",
    "case_cells",
    "kappa_cell",
    "latex_of",
    "number",
    "parameter",
    "table_csv",
    "table_tex",
    "value",
    "without_empty",
]

#: Tables with more rows are handed over as data and laid out when they are opened: a page of a hundred
#: thousand cells is slow on a phone.
_LONG = 250


@dataclass(frozen=True, slots=True)
class Cell:
    """The text of a cell, and the stored number behind it (None for words).

    `marks` draws small squares above the text: one (verdict, label) each.  `more` is small print below.
    """

    text: str
    value: float | None = None
    marks: tuple[tuple[str, str], ...] = ()
    more: str = ""

    @property
    def exact(self) -> str:
        """The stored number with all its digits, for sorting and checking."""
        return "" if self.value is None else repr(float(self.value))


@dataclass(frozen=True, slots=True)
class Column:
    """Heading of a column; `kind` is "words", "number", "verdict", "code", "head" (of the row) or "marks".

    `paper` is whether the column is in LaTeX: a command has no room on a page of paper, nor has what stands in another
    column already.
    """

    label: str
    kind: str = "words"
    paper: bool = True


@dataclass(frozen=True, slots=True)
class Row:
    """Cells in the order of the columns; `group` is the choice of a plot's controls that the row belongs to."""

    cells: Sequence[Cell]
    group: str = ""


@dataclass(frozen=True, slots=True)
class Table:
    """A table with its caption.

    `source` is the stored table behind it, a name among the files of the page; `lines` are the places of the rows in it
    (a row may be made of several) if they are not in its order.
    """

    id: str
    caption: str
    columns: tuple[Column, ...]
    rows: list[Row]
    source: str = ""
    note: str = ""
    lines: tuple[int | tuple[int, ...], ...] | None = None

    @property
    def long(self) -> bool:
        """Whether the rows are laid out only when they are wanted."""
        return len(self.rows) > _LONG

    def data(self) -> dict[str, Any]:
        """Return what the scripts need, ready for JSON.

        `rows` are [group, cells], a cell being its text or [text, number, small print]; `latex` is what stands around
        the rows, and which columns are in it.
        """
        return {
            "long": self.long,
            "kinds": [column.kind for column in self.columns],
            "rows": [[row.group, [_datum(cell) for cell in row.cells]] for row in self.rows],
            "source": self.source,
            "lines": self.lines,
            "latex": asdict(latex_of(self)) | {"columns": _on_paper(self)},
        }


def _datum(cell: Cell) -> str | list[str]:
    if cell.more:
        return [cell.text, cell.exact, cell.more]
    return cell.text if cell.value is None else [cell.text, cell.exact]


def without_empty(table: Table) -> Table:
    """Return a table without the columns in which no row has anything."""
    kept = [i for i in range(len(table.columns)) if not table.rows or any(row.cells[i].text for row in table.rows)]
    columns = tuple(table.columns[i] for i in kept)
    return replace(
        table, columns=columns, rows=[replace(row, cells=[row.cells[i] for i in kept]) for row in table.rows]
    )


#: Columns of the parameters of a case.
CASE_COLUMNS = (*(Column(label, "number") for label in ("n", "k", "μ", "ν")), Column("problem"))


def case_cells(row: pd.Series) -> tuple[Cell, ...]:
    """The parameters of the case of a stored row, in the order of `CASE_COLUMNS`."""
    return (*(parameter(row[name]) for name in PARAMETERS), Cell(str(row.get("problem") or "")))


def parameter(number: float) -> Cell:
    """A parameter of a case, exact and short; empty where there is none.

    Examples
    --------
    >>> parameter(0.4).text, parameter(float("nan")).text
    ('0.4', '')
    """
    return Cell("") if pd.isna(number) else Cell(exact(number), float(number))


def value(number: float, u: float) -> Cell:
    """A value to the digit that its uncertainty leaves it.

    Examples
    --------
    >>> value(1.7884817, 2.6e-6)
    Cell(text='1.788482(3)', value=1.7884817, marks=(), more='')
    """
    return Cell("") if pd.isna(number) else Cell(value_text(number, u), float(number))


def number(stored: float, form: str) -> Cell:
    """A number in a given format, e.g. an uncertainty as ".1e"; empty where there is none."""
    return Cell("") if pd.isna(stored) else Cell(_infinite(stored) or format(float(stored), form), float(stored))


def _infinite(stored: float) -> str:
    return "" if math.isfinite(stored) else ("∞" if stored > 0 else "−∞")


def kappa_cell(kappa: float, u_kappa: float) -> Cell:
    """A relative error, read in percent; the number behind it is the stored fraction.

    Examples
    --------
    >>> kappa_cell(0.066931234, 1e-9)
    Cell(text='6.69312(5)', value=0.066931234, marks=(), more='')
    """
    return Cell(percent_text(kappa, u_kappa), float(kappa))


def _on_paper(table: Table) -> list[int]:
    return [place for place, column in enumerate(table.columns) if column.paper and column.kind != "code"]


def _paper_rows(table: Table) -> list[list[str]]:
    places = _on_paper(table)
    return [[row.cells[place].text for place in places] for row in table.rows]


def latex_of(table: Table) -> LatexParts:
    """Return what stands around the rows of a table in LaTeX."""
    headings = [table.columns[place].label for place in _on_paper(table)]
    return latex_parts(headings, _paper_rows(table), table.caption, table.id)


def table_tex(table: Table) -> str:
    """Return a table with all its rows in LaTeX, as the page saves it."""
    return latex_of(table).text(_paper_rows(table))


def table_csv(table: Table) -> str:
    """Return the cells of a table as CSV, for one that no stored table is behind: texts, and numbers with all digits.

    Examples
    --------
    >>> print(table_csv(Table("t", "T", (Column("x"),), [Row((Cell("0.3", 1 / 3),))])), end="")
    x
    0.3333333333333333
    """
    rows = [[cell.exact or cell.text for cell in row.cells] for row in table.rows]
    return csv_text(pd.DataFrame(rows, columns=[column.label for column in table.columns], dtype=object))
