"""The model of a table: a description of its columns, and the stored rows that every format shows by it.

A column has a heading, the text of a row that every format shows, and the name of the stored number behind it, by
which a page sorts.  `comparisons.output.formats` makes Markdown, LaTeX, HTML and tables of a terminal of the texts.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import pandas as pd

from comparisons.judging.summary import coverage_text
from comparisons.numerics.number_text import error_text, exact, limits_text, percent_text, value_text
from comparisons.problem import PARAMETERS
from comparisons.quantities import title_of

__all__ = ["CASE", "Column", "Record", "Table", "columns", "numbers", "percents", "short_percent", "values", "words"]

#: A stored row.
Record = Mapping[str, Any]

#: An error in percent on a terminal and beside others is shown to this digit, or to that which its uncertainty leaves.
_LEAST_PERCENT = 5e-3


@dataclass(frozen=True, slots=True)
class Column:
    """A column.

    Attributes
    ----------
    heading : str
    text : callable
        From a stored row to the text of its cell.
    number : str
        Name of the stored number that the cell shows; empty of a text.
    kind : str
        "words", "prose" (which wraps), "verdict" or "code" (a command, for which a page of paper has no room).
    small : callable or None
        From a stored row to small print below its cell on a page.
    """

    heading: str
    text: Callable[[Record], str]
    number: str = ""
    kind: str = "words"
    small: Callable[[Record], str] | None = None


@dataclass(frozen=True)
class Table:
    """A table of stored rows.

    Attributes
    ----------
    id, caption : str
    columns : sequence of Column
    stored : DataFrame
        One row for each row of the table; its index, or its column `lines`, has the places of the rows in `source`.
    source : str
        Name of the stored table among the files of a page; empty where the rows are stored nowhere else.
    note : str
        A paragraph before the table on a page.
    fold : str
        On a page, the words that unfold the table; empty of a table that is always seen.
    group : callable or None
        From a stored row to the choice of a plot's controls that it belongs to.

    Examples
    --------
    >>> stored = pd.DataFrame({"model": ["jkr"], "n": [2.0], "value": [1.7884817], "u_num": [2.6e-6], "reason": [None]})
    >>> Table("t", "Values", columns("model", "n", "value", "reason"), stored).texts
      model  n        value
    0   jkr  2  1.788482(3)
    """

    id: str
    caption: str
    columns: Sequence[Column]
    stored: pd.DataFrame
    source: str = ""
    note: str = ""
    fold: str = ""
    group: Callable[[Record], str] | None = None

    @property
    def file(self) -> str:
        """Name of the stored table that a page saves rows of."""
        return self.source or f"{self.id}.csv"

    @cached_property
    def records(self) -> list[dict[str, Any]]:
        """The stored rows."""
        return [{str(name): cell for name, cell in row.items()} for row in self.stored.to_dict("records")]

    @cached_property
    def texts(self) -> pd.DataFrame:
        """The texts by the headings, without columns in which no row has one."""
        every = {column.heading: [column.text(row) for row in self.records] for column in self.columns}
        table = pd.DataFrame(every, dtype=object)
        return table.loc[:, (table != "").any()] if len(table) else table

    @property
    def seen(self) -> list[Column]:
        """The columns of the texts."""
        return [column for column in self.columns if column.heading in self.texts]

    @property
    def on_paper(self) -> pd.DataFrame:
        """The texts without commands."""
        return self.texts[[column.heading for column in self.seen if column.kind != "code"]]


def _missing(stored: object) -> bool:
    return stored is None or stored != stored


def words(heading: str, name: str, kind: str = "words") -> Column:
    """Return a column of the texts that are stored under a name."""
    return Column(heading, lambda row: "" if _missing(row.get(name)) else str(row[name]), kind=kind)


def _numbers(heading: str, name: str, text: Callable[[Record], str]) -> Column:
    return Column(heading, lambda row: "" if _missing(row.get(name)) else text(row), name)


def numbers(heading: str, name: str, form: str = "") -> Column:
    """Return a column of stored numbers in a format, as ".1e"; without one every digit is shown.

    Examples
    --------
    >>> column = numbers("u", "u_num", ".1e")
    >>> [column.text({"u_num": number}) for number in (1.5e-9, math.inf, math.nan, None)]
    ['1.5e-09', '∞', '', '']
    """

    def text(row: Record) -> str:
        number = float(row[name])
        if math.isinf(number):
            return "∞" if number > 0.0 else "−∞"
        return format(number, form) if form else exact(number)

    return _numbers(heading, name, text)


def values(heading: str, name: str, u: str) -> Column:
    """Return a column of values to the digits that their uncertainties leave them."""
    return _numbers(heading, name, lambda row: value_text(row[name], row[u]))


def percents(heading: str, name: str, u: str) -> Column:
    """Return a column of relative errors in percent; the number behind one is the stored fraction.

    Examples
    --------
    >>> percents("error", "kappa", "u_kappa").text({"kappa": 0.066931234, "u_kappa": 1e-9})
    '6.69312(5)'
    """
    return _numbers(heading, name, lambda row: percent_text(row[name], row[u]))


def short_percent(kappa: float, u_kappa: float) -> str:
    """Return a relative error in percent, to the digit that fits beside others.

    Examples
    --------
    >>> short_percent(-0.0494, 1e-9)
    '-4.940(5)'
    """
    return value_text(100 * kappa, max(100 * u_kappa, _LEAST_PERCENT))


#: Headings of the parameters of a case and of its problem file.
CASE = ("n", "k", "μ", "ν", "problem")

#: Columns of more than one table, by their headings.
_COLUMNS = {
    column.heading: column
    for column in (
        *(words(name, name) for name in ("model", "gate", "candidate", "reference", "problem", "unit", "status")),
        *(
            words("version", "model_version"),
            words("reason", "reason", "prose"),
            words("verdict", "verdict", "verdict"),
        ),
        *(numbers(heading, name) for heading, name in zip("nkμν", PARAMETERS, strict=True)),
        Column("quantity", lambda row: title_of(row["quantity"])),
        *(values("value", "value", "u_num"), numbers("u_num", "u_num", ".1e")),
        *(values("candidate's value", "value", "u_num"), values("reference's value", "reference_value", "u_reference")),
        *(percents("κ (%)", "kappa", "u_kappa"), numbers("u of κ", "u_kappa", ".1e")),
        *(Column("coverage", coverage_text), Column("limits", lambda row: limits_text(row["lower"], row["upper"]))),
        _numbers("E(U)", "error", lambda row: error_text(row["error"], row["uncertainty"])),
    )
}


def columns(*headings: str) -> list[Column]:
    """Return columns of more than one table by their headings."""
    return [_COLUMNS[heading] for heading in headings]
