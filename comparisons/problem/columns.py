"""Reader of CSV files with named columns in physical units."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from comparisons.data.csv_rows import csv_rows
from comparisons.data.input_files import LARGEST_TABLE, read_text
from comparisons.data.validation import known_name, shown
from comparisons.problem.kinds import Form
from comparisons.problem.units import NUMBER, NotAValue, in_si, unit_factor

_HEADING = re.compile(r"\s*([A-Za-z_]\w*)\s*(?:[\[(]\s*([^\])]*?)\s*[\])])?\s*")
_NUMBER = re.compile(NUMBER, re.ASCII)

#: A usual unit of what has one in SI, for the line that a table lacks.
_USUAL = {"m": "nm", "Pa": "MPa", "": ""}


@dataclass(frozen=True, slots=True)
class Columns:
    """Columns of a CSV text as they are written.

    Attributes
    ----------
    location : str
        Of the heading: file and line.
    units : dict of str to str or None
        The unit of each column by its name, None if the heading states none.
    cells : dict of str to list of str
        The cells of each column, without blanks around them.
    locations : list of str
        Of the rows.
    """

    location: str
    units: dict[str, str | None]
    cells: dict[str, list[str]]
    locations: list[str]


def columns_of(text: str, source: str, names: Iterable[str]) -> Columns:
    r"""Return the columns of a CSV text, whose first row has their names, each with its unit in brackets or without.

    Parameters
    ----------
    text : str
    source : str
        What it is of, for the sentence that refuses it.
    names : iterable of str
        Of the columns that are known.

    Raises
    ------
    ValueError
        One sentence with the location, if it is no such text, a name is unknown or stands twice, or a row has another
        number of cells.

    Examples
    --------
    >>> columns = columns_of("z [nm], E [GPa]\n0, 1\n", "pad.csv", ["z", "E"])
    >>> columns.units, columns.cells
    ({'z': 'nm', 'E': 'GPa'}, {'z': ['0'], 'E': ['1']})
    """
    rows = csv_rows(text, source, by_hand=True)
    location, heading = next(rows, ("", []))
    if not heading:
        raise ValueError(f"{source}: the table is empty; its first row has the names of the columns {', '.join(names)}")
    units: dict[str, str | None] = {}
    for cell in heading:
        name, unit = _name_and_unit(cell, names, location)
        if name in units:
            raise ValueError(f"{location}: the column {name} stands twice; name each column once")
        units[name] = unit
    locations, cells = [], []
    for place_of_row, row in rows:
        locations.append(place_of_row)
        cells.append([cell.strip() for cell in row])
    return Columns(location, units, {name: [row[i] for row in cells] for i, name in enumerate(units)}, locations)


def read_columns(path: Path, columns: Mapping[str, Form]) -> dict[str, tuple[float, ...]]:
    """Return the columns of a CSV file in SI.

    The first row has the names, each with its unit in brackets if it has one: ``z [nm],E [GPa]``.  Lines that begin
    with ``#`` are comments.

    Parameters
    ----------
    path : Path
    columns : mapping of str to Form

    Raises
    ------
    ValueError
        One sentence with the file, the line, the value and the remedy.
    """
    written = columns_of(read_text(path, "the table", LARGEST_TABLE), str(path), columns)
    for name, form in columns.items():
        if name not in written.units and not form.is_optional:
            raise ValueError(f"{written.location}: the column {name} is missing; the names are {', '.join(columns)}")
    if bare := [name for name, unit in written.units.items() if columns[name].unit and not unit]:
        heading = ",".join(_with_unit(name, unit or _USUAL[columns[name].unit]) for name, unit in written.units.items())
        in_si_units = " and ".join(_with_unit(name, columns[name].unit) for name in bare)
        raise ValueError(
            f"{written.location}: no unit of {' and '.join(bare)}; write the line of the names as {heading}, or in SI "
            f"as {in_si_units}"
        )
    values: dict[str, list[float]] = {}
    for name, unit in written.units.items():
        form, column = columns[name], values.setdefault(name, [])
        factor = factor_of(written, name, unit, form.unit) if unit and form.unit else 1.0
        for location, cell in zip(written.locations, written.cells[name], strict=True):
            try:
                column.append(_value(cell, factor, form, column))
            except NotAValue as error:
                raise ValueError(f"{location}: {name} = {shown(cell)} {error}") from None
    return {name: tuple(column) for name, column in values.items()}


def _with_unit(name: str, unit: str) -> str:
    return f"{name} [{unit}]" if unit else name


def factor_of(columns: Columns, name: str, unit: str, target: str, remedy: str = "") -> float:
    """Return the number of target units that the unit of a column is.

    Raises
    ------
    ValueError
        One sentence with the location, if the unit is unknown or of another dimension.
    """
    try:
        return unit_factor(unit, target)
    except NotAValue as error:
        raise ValueError(f"{columns.location}: the column {name} {error}; write one of {target}{remedy}") from None


def number_of(cell: str) -> float:
    """Return the number that a cell is; `NotAValue` if it is not a decimal number.

    Examples
    --------
    >>> number_of("-1.5e-3")
    -0.0015
    """
    if _NUMBER.fullmatch(cell):
        return float(cell)
    is_comma = _NUMBER.fullmatch(cell.replace(",", ".", 1))
    raise NotAValue("is not a number" + ("; write a point in location of the decimal comma" if is_comma else ""))


def _name_and_unit(cell: str, names: Iterable[str], location: str) -> tuple[str, str | None]:
    match = _HEADING.fullmatch(cell)
    if not match:
        line = ",".join(f"{name} [unit]" for name in names)
        remedy = f"; write the line of the names as {line}"
        if ";" in cell or "\t" in cell:
            remedy = "; separate columns by commas"
        elif _NUMBER.fullmatch(cell.strip()):
            remedy = f"; write a line before the numbers, as {line}"
        raise ValueError(
            f"{location}: {shown(cell)} is not a name of a column; the names are {', '.join(names)}{remedy}"
        )
    try:
        known_name("column", match[1], names, location)
    except ValueError as error:
        raise ValueError(f"{error}; a unit stands in brackets, as {next(iter(names))} [unit]") from None
    return match[1], match[2]


def _value(cell: str, factor: float, form: Form, values_before: Sequence[float]) -> float:
    """A cell in SI; `NotAValue` if it is not admissible."""
    value = in_si(number_of(cell) * factor, form.unit)
    if not form.admits(value):
        raise NotAValue(f"is outside its range; it must be {form.text}")
    if form.if_not_rising and values_before and not value > values_before[-1]:
        raise NotAValue(f"is not above the value of the row before it; {form.if_not_rising}")
    return value
