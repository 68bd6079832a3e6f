"""One model of a table for the page, for LaTeX, for Markdown and for the terminal: columns, and cells made of rows.

A column has a heading and a function that makes a cell of a stored row.  A cell has the text that every medium shows,
and the stored number behind it, by which the page sorts.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import pandas as pd

from comparisons.judging.decision import Verdict
from comparisons.judging.summary import coverage_text
from comparisons.numerics.number_text import error_text, exact, limits_text, percent_text, value_text
from comparisons.problem import PARAMETERS
from comparisons.quantities import title_of
from comparisons.runs.csv_format import csv_text

__all__ = [
    "CASE_LABELS",
    "CASE_NAMES",
    "COLUMNS",
    "Cell",
    "Column",
    "Row",
    "Table",
    "aligned",
    "chosen",
    "is_number",
    "kappa_cell",
    "number",
    "numbers",
    "percents",
    "short_percent",
    "table_csv",
    "table_of",
    "texts_of",
    "value",
    "values",
    "without_empty",
    "words",
]

#: Tables with more rows are laid out when they are opened: a page of a hundred thousand cells is slow on a phone.
_LONG = 250

#: An error in percent on a terminal and beside others is shown to this digit, or to that which its uncertainty leaves.
_LEAST_PERCENT = 5e-3

#: What siunitx reads as a number: sign and digits, decimals, uncertainty, power of ten.
_NUMBER = re.compile(r"-?([0-9]+)(?:\.([0-9]+))?(?:\(([0-9]+)\))?(?:e([+-]?[0-9]+))?")


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
        """The stored number with all its digits, for sorting and checking; empty if the text has them."""
        if self.value is None or (is_number(self.text) and "(" not in self.text and float(self.text) == self.value):
            return ""
        return repr(float(self.value))


@dataclass(frozen=True, slots=True)
class Column:
    """A column.

    Attributes
    ----------
    label : str
        Its heading.
    kind : str
        "words", "prose", "number", "verdict", "code", "head" (of the row) or "marks".
    cell : callable
        From a stored row to its cell.
    paper : bool
        Whether the column is in LaTeX: a command has no room on a page of paper, nor has what stands in another column
        already.
    """

    label: str
    kind: str = "words"
    cell: Callable[[Mapping[str, Any]], Cell] = lambda row: Cell("")
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

    def on_paper(self) -> pd.DataFrame:
        """Return the texts of the columns that have room on paper."""
        places = [place for place, one in enumerate(self.columns) if one.paper and one.kind != "code"]
        rows = [[row.cells[place].text for place in places] for row in self.rows]
        return pd.DataFrame(rows, columns=[self.columns[place].label for place in places], dtype=object)


def table_of(
    id: str,
    caption: str,
    columns: Sequence[Column],
    stored: pd.DataFrame,
    source: str = "",
    note: str = "",
    *,
    group: Callable[[Mapping[str, Any]], str] = lambda row: "",
    lines: Sequence[int | tuple[int, ...]] | None = None,
) -> Table:
    """Return the table of stored rows, without the columns in which no row has anything.

    Examples
    --------
    >>> stored = pd.DataFrame({"model": ["jkr"], "n": [2.0]})
    >>> made = table_of("errors", "Errors", chosen("model", *CASE_LABELS), stored)
    >>> [(one.label, cell.text) for one, cell in zip(made.columns, made.rows[0].cells)]
    [('model', 'jkr'), ('n', '2')]
    """
    rows = [Row([one.cell(row) for one in columns], group(row)) for row in stored.to_dict("records")]
    return without_empty(
        Table(id, caption, tuple(columns), rows, source, note, None if lines is None else tuple(lines))
    )


def without_empty(table: Table) -> Table:
    """Return a table without the columns in which no row has anything."""
    kept = [i for i in range(len(table.columns)) if not table.rows or any(row.cells[i].text for row in table.rows)]
    columns = tuple(table.columns[i] for i in kept)
    return replace(
        table, columns=columns, rows=[replace(row, cells=[row.cells[i] for i in kept]) for row in table.rows]
    )


def texts_of(columns: Sequence[Column], stored: pd.DataFrame) -> pd.DataFrame:
    """Return the texts of the cells of stored rows, by the headings of the columns.

    Examples
    --------
    >>> texts_of(chosen("model", "value"),
    ...          pd.DataFrame({"model": ["jkr"], "value": [1.7884817], "u_num": [2.6e-6]})).values.tolist()
    [['jkr', '1.788482(3)']]
    """
    rows = stored.to_dict("records")
    return pd.DataFrame({one.label: [one.cell(row).text for row in rows] for one in columns}, dtype=object)


def is_number(text: str) -> re.Match[str] | None:
    """Return the parts of a number with its uncertainty: digits, decimals, uncertainty, power of ten.

    Examples
    --------
    >>> is_number("-1.79(2)e-7").groups()
    ('1', '79', '2', '-7')
    """
    return _NUMBER.fullmatch(text)


def aligned(texts: Sequence[str]) -> bool:
    """Whether a column of texts is one of numbers: at least half of those that are not empty.

    Examples
    --------
    >>> aligned(["-5.0(3)", "failed", ""]), aligned(["jkr", "2"]), aligned([])
    (True, True, False)
    """
    filled = [text for text in texts if text]
    return 2 * sum(is_number(text) is not None for text in filled) >= max(len(filled), 1)


def _missing(stored: object) -> bool:
    return stored is None or stored != stored


def words(label: str, name: str, kind: str = "words") -> Column:
    """Return a column of the texts that are stored under a name."""
    return Column(label, kind, lambda row: Cell("" if _missing(row.get(name)) else str(row[name])))


def numbers(label: str, name: str, form: str, *, paper: bool = True) -> Column:
    """Return a column of stored numbers in a format, as ".1e"; without one every digit is shown."""
    return Column(label, "number", lambda row: number(row.get(name), form), paper)


def values(label: str, name: str, u: str) -> Column:
    """Return a column of values to the digits that their uncertainties leave them."""
    return Column(label, "number", lambda row: value(row[name], row[u]))


def percents(label: str, name: str, u: str) -> Column:
    """Return a column of relative errors in percent."""
    return Column(label, "number", lambda row: kappa_cell(row[name], row[u]))


def number(stored: float | None, form: str) -> Cell:
    """A number in a format, or with every digit; empty where there is none.

    Examples
    --------
    >>> number(0.4, "").text, number(1.5e-9, ".1e").text, number(math.inf, ".1e").text, number(None, "").text
    ('0.4', '1.5e-09', '∞', '')
    """
    if stored is None or math.isnan(stored):
        return Cell("")
    if math.isinf(stored):
        return Cell("∞" if stored > 0 else "−∞", float(stored))
    return Cell(format(float(stored), form) if form else exact(stored), float(stored))


def value(stored: float | None, u: float | None) -> Cell:
    """A value to the digit that its uncertainty leaves it.

    Examples
    --------
    >>> value(1.7884817, 2.6e-6)
    Cell(text='1.788482(3)', value=1.7884817, marks=(), more='')
    """
    return Cell("") if stored is None or math.isnan(stored) else Cell(value_text(stored, u), float(stored))


def kappa_cell(kappa: float, u_kappa: float) -> Cell:
    """A relative error, read in percent; the number behind it is the stored fraction.

    Examples
    --------
    >>> kappa_cell(0.066931234, 1e-9)
    Cell(text='6.69312(5)', value=0.066931234, marks=(), more='')
    """
    return Cell("") if math.isnan(kappa) else Cell(percent_text(kappa, u_kappa), float(kappa))


def short_percent(kappa: float, u_kappa: float) -> str:
    """Return a relative error in percent, to the digit that fits beside others.

    Examples
    --------
    >>> short_percent(-0.0494, 1e-9)
    '-4.940(5)'
    """
    return value_text(100 * kappa, max(100 * u_kappa, _LEAST_PERCENT))


def _verdict(row: Mapping[str, Any]) -> Cell:
    return Cell(row["verdict"], float(Verdict(row["verdict"]).rank)) if row["verdict"] else Cell("")


def _error(row: Mapping[str, Any]) -> Cell:
    error = row["error"]
    return Cell("") if _missing(error) else Cell(error_text(error, row["uncertainty"]), float(error))


#: Headings of the parameters of a case and of its problem file.
CASE_LABELS = ("n", "k", "μ", "ν", "problem")
#: The same columns by the names of the command line.
CASE_NAMES = (*(numbers(name, name, "") for name in PARAMETERS), words("problem", "problem"))

#: Columns of more than one table, by their headings.
COLUMNS = {
    one.label: one
    for one in (
        *(words(name, name) for name in ("candidate", "reference", "problem", "unit", "status")),
        *(words(name, name, "head") for name in ("model", "gate")),
        *(words("version", "model_version"), words("reason", "reason", "prose")),
        *(numbers(label, name, "") for label, name in zip("nkμν", PARAMETERS, strict=True)),
        Column("quantity", cell=lambda row: Cell(title_of(row["quantity"]))),
        *(values("value", "value", "u_num"), numbers("u_num", "u_num", ".1e")),
        *(values("candidate's value", "value", "u_num"), values("reference's value", "reference_value", "u_reference")),
        *(percents(label, "kappa", "u_kappa") for label in ("κ (%)", "largest κ (%)")),
        numbers("u of κ", "u_kappa", ".1e"),
        Column("verdict", "verdict", _verdict),
        Column("coverage", cell=lambda row: Cell(coverage_text(row))),
        *(Column(label, "number", _error) for label in ("E(U)", "worst E(U)")),
        numbers("U", "uncertainty", ".1e", paper=False),
        Column("limits", cell=lambda row: Cell(limits_text(row["lower"], row["upper"]))),
    )
}


def chosen(*labels: str) -> list[Column]:
    """Return columns of `COLUMNS` by their headings.

    Examples
    --------
    >>> [one.kind for one in chosen("model", "value")]
    ['head', 'number']
    """
    return [COLUMNS[label] for label in labels]


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
