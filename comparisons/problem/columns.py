"""Reader of CSV files with named columns in physical units."""

from __future__ import annotations

import csv
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

from comparisons.data.input_files import LARGEST_TABLE, read_text
from comparisons.problem.source import shown
from comparisons.problem.units import NotAValue, check_size, unit_factor

__all__ = ["Column", "read_columns"]

_HEADING = re.compile(r"\s*([A-Za-z_]\w*)\s*(?:[\[(]\s*([^\])]*?)\s*[\])])?\s*")


@dataclass(frozen=True, slots=True)
class Column:
    """What a column holds.

    Attributes
    ----------
    unit : str
        In SI; "1" for plain numbers.
    low, high : float
        Least and largest admissible value.
    open : bool
        Whether the least value is not admissible itself.
    rising : bool
        Whether each value is above the one before it.
    twice : str
        What to do with a value that is equal to the one before it, of a rising column.
    optional : bool
        Whether the file may do without the column.
    """

    unit: str
    low: float = -math.inf
    high: float = math.inf
    open: bool = False
    rising: bool = False
    optional: bool = False
    twice: str = ""

    @property
    def range(self) -> str:
        """The admissible values as an interval."""
        left = "(" if self.open or math.isinf(self.low) else "["
        return f"{left}{self.low:g}, {self.high:g}" + (")" if math.isinf(self.high) else "]")


def read_columns(path: Path, columns: Mapping[str, Column], fewest: int) -> dict[str, tuple[float, ...]]:
    """Return the columns of a CSV file in SI.

    The first row has the names, each with its unit in brackets if that is not the one in SI: ``z [nm],E [GPa]``.  Lines
    that begin with ``#`` are comments.

    Parameters
    ----------
    path : Path
    columns : mapping of str to Column
    fewest : int
        Smallest number of rows.

    Raises
    ------
    ValueError
        One sentence with the file, the line, the value and the remedy.
    """
    text = read_text(path, "the table", LARGEST_TABLE)
    lines = [(i, line) for i, line in enumerate(text.splitlines(), start=1) if line.strip() and line.strip()[0] != "#"]
    example = ",".join(name for name, column in columns.items() if not column.optional)
    if not lines:
        raise ValueError(f"{path}: the table is empty; its first row has the names {example}")
    number, heading = lines[0]
    place = f"{path}, line {number}"
    names, factors = _headings(place, _cells(place, heading), columns, example)
    found: dict[str, list[float]] = {name: [] for name in names}
    for number, line in lines[1:]:
        place = f"{path}, line {number}"
        cells = _cells(place, line)
        if len(cells) != len(names):
            raise ValueError(f"{place}: {len(cells)} values for {len(names)} columns; write one for each of {example}")
        for name, factor, cell in zip(names, factors, cells, strict=True):
            found[name].append(_checked(place, name, columns[name], factor, cell, found[name]))
    rows = len(lines) - 1
    if rows < fewest:
        raise ValueError(f"{path}: the table has {rows} row{'s' * (rows != 1)}; it needs at least {fewest}")
    return {name: tuple(values) for name, values in found.items()}


def _cells(place: str, line: str) -> list[str]:
    try:
        return next(csv.reader([line]))
    except csv.Error as error:
        raise ValueError(f"{place}: {shown(line)} is no row of CSV ({error}); write numbers between commas") from None


def _headings(
    place: str, cells: list[str], columns: Mapping[str, Column], example: str
) -> tuple[list[str], list[float]]:
    """Names of the columns, and the factors of their units."""
    names, factors = [], []
    for cell in cells:
        match = _HEADING.fullmatch(cell)
        if not match:
            raise ValueError(f"{place}: {shown(cell)} is no name of a column; the first row has the names {example}")
        name, unit = match[1], match[2]
        if name not in columns:
            near = get_close_matches(name, columns, n=1)
            remedy = f"did you mean {near[0]}?" if near else f"the columns are {', '.join(columns)}"
            raise ValueError(f"{place}: unknown column {shown(name)}; {remedy}")
        if name in names:
            raise ValueError(f"{place}: the column {name} stands twice; name each column once")
        try:
            factor = unit_factor(unit, columns[name].unit) if unit and columns[name].unit != "1" else 1.0
        except NotAValue as error:
            raise ValueError(f"{place}: the column {name} {error}; write a unit of {columns[name].unit}") from None
        names.append(name)
        factors.append(factor)
    missing = [name for name, column in columns.items() if not column.optional and name not in names]
    if missing:
        raise ValueError(f"{place}: the column {missing[0]} is missing; the first row has the names {example}")
    return names, factors


def _checked(place: str, name: str, column: Column, factor: float, cell: str, before: list[float]) -> float:
    """A cell in SI."""
    try:
        value = float(cell) * factor
    except ValueError:
        raise ValueError(f"{place}: {name} = {shown(cell.strip())} is no number; write one there") from None
    if not math.isfinite(value):
        raise ValueError(f"{place}: {name} = {cell.strip()} is not a finite number; write one or take out the row")
    if column.unit != "1":
        try:
            check_size(value, column.unit)
        except NotAValue as error:
            raise ValueError(f"{place}: {name} = {cell.strip()} {error}; check its unit") from None
    if not column.low <= value <= column.high or (column.open and value == column.low):
        raise ValueError(f"{place}: {name} = {cell.strip()} is outside {column.range}; correct the value")
    if column.twice and before and value == before[-1]:
        raise ValueError(f"{place}: {name} = {cell.strip()} stands in the row before it, too; {column.twice}")
    if column.rising and before and not value > before[-1]:
        raise ValueError(
            f"{place}: {name} = {cell.strip()} is not above the value of the row before it; sort the rows by {name}"
        )
    return value
