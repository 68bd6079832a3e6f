"""Reader of CSV files with named columns in physical units."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from comparisons.data.input_files import LARGEST_TABLE, read_text
from comparisons.data.validation import known_name, shown
from comparisons.problem.kinds import Form
from comparisons.problem.units import NotAValue, in_si, unit_factor

_HEADING = re.compile(r"\s*([A-Za-z_]\w*)\s*(?:[\[(]\s*([^\])]*?)\s*[\])])?\s*")


def read_columns(path: Path, columns: Mapping[str, Form]) -> dict[str, tuple[float, ...]]:
    """Return the columns of a CSV file in SI.

    The first row has the names, each with its unit in brackets if that is not the one in SI: ``z [nm],E [GPa]``.  Lines
    that begin with ``#`` are comments.

    Parameters
    ----------
    path : Path
    columns : mapping of str to Form

    Raises
    ------
    ValueError
        One sentence with the file, the line, the value and the remedy.
    """
    text = read_text(path, "the table", LARGEST_TABLE)
    lines = [(i, line) for i, line in enumerate(text.splitlines(), start=1) if line.strip() and line.strip()[0] != "#"]
    if not lines:
        raise ValueError(f"{path}: the table is empty; its first row has the names of the columns {', '.join(columns)}")
    (number, heading), *rows = lines
    factors = _factors(f"{path}, line {number}", heading, columns)
    values: dict[str, list[float]] = {name: [] for name in factors}
    for number, line in rows:
        location = f"{path}, line {number}"
        cells = _cells(location, line)
        if len(cells) != len(factors):
            raise ValueError(f"{location}: {len(cells)} values for {len(factors)} columns; write one for each column")
        for (name, factor), cell in zip(factors.items(), cells, strict=True):
            try:
                values[name].append(_value(cell, factor, columns[name], values[name]))
            except NotAValue as error:
                raise ValueError(f"{location}: {name} = {shown(cell.strip())} {error}") from None
    return {name: tuple(column) for name, column in values.items()}


def _cells(location: str, line: str) -> list[str]:
    try:
        return next(csv.reader([line]))
    except csv.Error as error:
        raise ValueError(f"{location}: {shown(line)} is no row of CSV ({error}); write numbers and commas") from None


def _factors(location: str, heading: str, columns: Mapping[str, Form]) -> dict[str, float]:
    """The factor of the unit of each column, by its name."""
    factors: dict[str, float] = {}
    for cell in _cells(location, heading):
        name, unit = column_heading(cell, columns, location)
        if name in factors:
            raise ValueError(f"{location}: the column {name} stands twice; name each column once")
        try:
            factors[name] = unit_factor(unit, columns[name].unit) if unit and columns[name].unit else 1.0
        except NotAValue as error:
            raise ValueError(f"{location}: the column {name} {error}; write one of {columns[name].unit}") from None
    for name, form in columns.items():
        if name not in factors and not form.is_optional:
            raise ValueError(f"{location}: the column {name} is missing; the names are {', '.join(columns)}")
    return factors


def column_heading(cell: str, columns: Iterable[str], location: str) -> tuple[str, str | None]:
    """Return the name of a column and its unit, None if it states none; `ValueError` if the name is unknown.

    Examples
    --------
    >>> column_heading(" load [nN]", ["load"], "curve.csv")
    ('load', 'nN')
    """
    match = _HEADING.fullmatch(cell)
    if not match:
        remedy = "; separate columns by commas" if ";" in cell else ""
        raise ValueError(
            f"{location}: {shown(cell)} is not a name of a column; the names are {', '.join(columns)}{remedy}"
        )
    known_name("column", match[1], columns, location)
    return match[1], match[2]


def _value(cell: str, factor: float, form: Form, values_before: Sequence[float]) -> float:
    """A cell in SI; `NotAValue` if it is not admissible."""
    try:
        value = in_si(float(cell) * factor, form.unit)
    except ValueError:
        raise NotAValue("is not a number") from None
    if not form.admits(value):
        raise NotAValue(f"is outside its range; it must be {form.text}")
    if form.if_not_rising and values_before and not value > values_before[-1]:
        raise NotAValue(f"is not above the value of the row before it; {form.if_not_rising}")
    return value
