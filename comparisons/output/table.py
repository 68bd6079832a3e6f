"""The model of a table: a description of its columns, and the stored rows that every format shows by it.

A column has a heading, the text of a row that every format shows, and the name of the stored number behind it, by
which a page sorts.  The modules `latex`, `markup` and `terminal` beside this one write the texts.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any

import pandas as pd

from comparisons.judging.summary import coverage_text
from comparisons.numerics.number_text import error_text, exact, limits_text, percent_text, value_text
from comparisons.problem import PARAMETERS
from comparisons.problem.units import si_text
from comparisons.quantities import title_of
from comparisons.runs.frames import unit_in

#: A stored row.
Record = Mapping[str, Any]

#: A relative error beside others is shown to this digit of a percent, or to that which its uncertainty leaves.
SHORT_PERCENT = 5e-3


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
        "words", "prose" (which wraps), "verdict", "link" (to the report in the folder that the row names) or "code"
        (a command, for which a page of paper has no room).
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
        One row for each row of the table.
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
    note: str = ""
    fold: str = ""
    group: Callable[[Record], str] | None = None

    @cached_property
    def records(self) -> list[dict[str, Any]]:
        """The stored rows."""
        return [{str(name): cell for name, cell in row.items()} for row in self.stored.to_dict("records")]

    @cached_property
    def texts(self) -> pd.DataFrame:
        """The texts by the headings, without columns in which no row has one."""
        texts = {column.heading: [column.text(row) for row in self.records] for column in self.columns}
        table = pd.DataFrame(texts, dtype=object)
        return table.loc[:, (table != "").any()] if len(table) else table

    @property
    def filled(self) -> list[Column]:
        """The columns of the texts."""
        return [column for column in self.columns if column.heading in self.texts]

    @property
    def on_paper(self) -> pd.DataFrame:
        """The texts without commands."""
        return self.texts[[column.heading for column in self.filled if column.kind != "code"]]


def _missing(stored: object) -> bool:
    return stored is None or stored != stored


def words(heading: str, name: str = "", kind: str = "words") -> Column:
    """Return a column of the texts that are stored under a name, that of the heading if none is given."""
    name = name or heading
    return Column(heading, lambda row: "" if _missing(row.get(name)) else str(row[name]), kind=kind)


def of_number(heading: str, name: str, text: Callable[[Record], str]) -> Column:
    """Return a column of texts that show a stored number, empty where it is missing."""
    return Column(heading, lambda row: "" if _missing(row.get(name)) else text(row), name)


def numbers(heading: str, name: str = "", form: str = "") -> Column:
    """Return a column of stored numbers in a format, as ".1e"; without one every digit is shown.

    Examples
    --------
    >>> column = numbers("u", "u_num", ".1e")
    >>> [column.text({"u_num": number}) for number in (1.5e-9, math.inf, math.nan, None)]
    ['1.5e-09', '∞', '', '']
    """
    name = name or heading

    def text(row: Record) -> str:
        number = float(row[name])
        if math.isinf(number):
            return "∞" if number > 0.0 else "−∞"
        return format(number, form) if form else exact(number)

    return of_number(heading, name, text)


def values(heading: str, name: str, u: str) -> Column:
    """Return a column of values to the digits that their uncertainties leave them."""
    return of_number(heading, name, lambda row: value_text(row[name], row[u]))


def percents(heading: str, name: str, u: str, **least: float) -> Column:
    """Return a column of relative errors in percent; the number behind one is the stored fraction.

    Examples
    --------
    >>> percents("error", "kappa", "u_kappa").text({"kappa": 0.066931234, "u_kappa": 1e-9})
    '6.69312(5)'
    """
    return of_number(heading, name, lambda row: percent_text(row[name], row[u], **least))


def physical_text(row: Record) -> str:
    """Return the value of a stored row with its unit, or its status where there is none."""
    if row["status"] != "ok":
        return str(row["status"])
    return si_text(float(row["value"]), float(row["u_num"]), str(row["unit"]))


def key_text(value: float | str, unit: str) -> str:
    """Return the value of a varied key; a power of a unit has no prefix, and nothing is shown where there is none.

    Examples
    --------
    >>> key_text(0.05, "J/m^2"), key_text(1e-12, "m^2"), key_text("tip.csv", "1")
    ('50 mJ/m^2', '1e-12 m^2', 'tip.csv')
    """
    if isinstance(value, str):
        return value
    if pd.isna(value):
        return ""
    rounded = float(f"{value:.6g}")
    return f"{rounded:g} {unit}" if "^" in unit.partition("/")[0] else si_text(rounded, 0.0, unit)


def key_columns(names: Iterable[str]) -> list[Column]:
    """Return the columns of varied keys, by the names of their stored columns."""
    return [Column(unit_in(name)[0], partial(_key_text, name), name) for name in names]


def _key_text(name: str, row: Record) -> str:
    return key_text(row[name], unit_in(name)[1])


#: Headings of the parameters of a case and of its problem file.
CASE = ("n", "k", "μ", "ν", "problem")

#: Columns of more than one table, by their headings.
_COLUMNS = {
    column.heading: column
    for column in (
        *map(words, ("model", "gate", "candidate", "reference", "problem", "unit", "status")),
        words("version", "model_version"),
        words("reason", kind="prose"),
        words("verdict", kind="verdict"),
        *(numbers(heading, name) for heading, name in zip("nkμν", PARAMETERS, strict=True)),
        *(numbers(name, form=".0f") for name in ("asked", "answered", "failed", "cases")),
        Column("quantity", lambda row: title_of(row["quantity"])),
        values("value", "value", "u_num"),
        numbers("u_num", form=".1e"),
        values("candidate's value", "value", "u_num"),
        values("reference's value", "reference_value", "u_reference"),
        percents("κ (%)", "kappa", "u_kappa"),
        of_number("largest |κ| (%)", "size", lambda row: percent_text(row["largest"], row["u_largest"])),
        percents("rms κ (%)", "rms", "u"),
        numbers("u of κ", "u_kappa", ".1e"),
        Column("coverage", coverage_text),
        Column("limits", lambda row: limits_text(row["lower"], row["upper"])),
        of_number("E(U)", "error", lambda row: error_text(row["error"], row["uncertainty"])),
    )
}


def columns(*headings: str) -> list[Column]:
    """Return columns of more than one table by their headings."""
    return [_COLUMNS[heading] for heading in headings]
