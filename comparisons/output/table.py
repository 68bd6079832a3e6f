"""The model of a table: a description of its columns (``layout.toml``), and the stored rows that every format shows.

A column has a heading, the text of a row that every format shows, and the name of the stored number behind it, by
which a page sorts.  The modules `latex`, `markup` and `terminal` beside this one write the texts.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import lazy_loader

from comparisons.judging.summary import coverage_text
from comparisons.numerics.number_text import SHORT_PERCENT, error_text, exact, limits_text, percent_text, value_text
from comparisons.problem.units import si_text
from comparisons.quantities import title_of
from comparisons.runs.frames import unit_in

if TYPE_CHECKING:
    import pandas as pd
else:
    pd = lazy_loader.load("pandas")

#: A stored row.
Record = Mapping[str, Any]


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
        return pd.DataFrame(cells(self.columns, self.records), dtype=object)

    @property
    def filled(self) -> list[Column]:
        """The columns of the texts."""
        return [column for column in self.columns if column.heading in self.texts]

    @property
    def on_paper(self) -> pd.DataFrame:
        """The texts without commands."""
        return self.texts[[column.heading for column in self.filled if column.kind != "code"]]


def cells(columns: Sequence[Column], rows: Sequence[Record]) -> dict[str, list[str]]:
    """Return the texts of rows by the headings, without columns in which no row has one.

    Examples
    --------
    >>> cells([column("model"), column("note")], [{"model": "jkr"}, {"model": "dmt"}])
    {'model': ['jkr', 'dmt']}
    """
    texts = {column.heading: [column.text(row) for row in rows] for column in columns}
    return {heading: column for heading, column in texts.items() if any(column) or not rows}


def _missing(stored: object) -> bool:
    return stored is None or stored != stored


#: Texts of a number and its bound, by the names of the forms.
_BOUNDED: Mapping[str, Callable[[float, float], str]] = {
    "percent": percent_text,
    "short percent": partial(percent_text, last=SHORT_PERCENT),
    "value": value_text,
    "error": error_text,
}


def _number_text(number: float, form: str) -> str:
    if math.isinf(number):
        return "∞" if number > 0.0 else "−∞"
    return exact(number) if form == "exact" else format(number, form)


def column(heading: str, name: str = "", form: str = "", u: str = "", by: str = "", kind: str = "words") -> Column:
    """Return a column of what is stored under a name, that of the heading if none is given; empty where it is missing.

    Parameters
    ----------
    heading, name : str
    form : str
        Of a number: "exact" for every digit, a format as ".1e", or one of `_BOUNDED`; empty of a text.
    u : str
        Name of the bound of the number.
    by : str
        Name of the number by which a page sorts, if it is another.
    kind : str
        As of `Column`.

    Examples
    --------
    >>> rounded = column("u", "u_num", ".1e")
    >>> [rounded.text({"u_num": number}) for number in (1.5e-9, math.inf, math.nan, None)]
    ['1.5e-09', '∞', '', '']
    >>> column("error", "kappa", "percent", "u_kappa").text({"kappa": 0.066931234, "u_kappa": 1e-9})
    '6.69312'
    """
    name = name or heading

    def text(row: Record) -> str:
        if _missing(row.get(name)):
            return ""
        if u:
            return _BOUNDED[form](row[name], row[u])
        return _number_text(float(row[name]), form) if form else str(row[name])

    return Column(heading, text, (by or name) if form else "", kind)


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

#: Columns, tables and captions of plots.
LAYOUT: Any = tomllib.loads(files(__package__).joinpath("layout.toml").read_text(encoding="utf-8"))

#: Columns of more than one table, by their headings.
_COLUMNS = {heading: column(heading, **described) for heading, described in LAYOUT["column"].items()} | {
    "quantity": Column("quantity", lambda row: title_of(row["quantity"])),
    "coverage": Column("coverage", coverage_text),
    "limits": Column("limits", lambda row: limits_text(row["lower"], row["upper"])),
}


def columns(*headings: str) -> list[Column]:
    """Return columns of more than one table by their headings."""
    return [_COLUMNS[heading] for heading in headings]


def laid_out(name: str, stored: pd.DataFrame, *made: Column, **more: Any) -> Table:
    """Return a table that ``layout.toml`` describes.

    Parameters
    ----------
    name : str
        In that file, and the id of the table.
    stored : DataFrame
    *made : Column
        Those of its columns that the program makes, each in the place of its heading.
    **more
        Other attributes of the table, or in place of those of the file.

    Examples
    --------
    >>> rows = pd.DataFrame({"entry": ["seconds"], "content": [9.0]})
    >>> laid_out("provenance", rows).texts
         entry content
    0  seconds     9.0
    """
    described = LAYOUT["table"][name]
    known = _COLUMNS | {made_column.heading: made_column for made_column in made}
    listed = [column(**entry) if isinstance(entry, dict) else known[entry] for entry in described["columns"]]
    return Table(**({"id": name} | described | {"columns": listed, "stored": stored} | more))
