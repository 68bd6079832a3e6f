"""Curves as programs and people export them as text: separators, decimal commas, names of columns, units, branches.

The first row that is no comment names the columns, each with its unit in brackets of any kind.  Semicolons and tabs
separate as commas do, and then a comma in a number is a decimal one.  Texts of two kinds of instruments have forms of
their own: one names columns and units in comments before each segment (JPK), the other has the columns of approach and
retreat side by side (Nanoscope: ``Defl_nm_Ex`` and ``Defl_nm_Rt``).
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from comparisons.data.csv_rows import csv_rows
from comparisons.data.validation import shown
from comparisons.problem.units import NUMBER, NotAValue, unit_factor

__all__ = ["APPROACH", "REST", "RETREAT", "Cells", "Export", "export_of"]

APPROACH, RETREAT, REST = "approach", "retreat", "rest"

#: Words for the motion at a point, in small letters.
_MOTIONS = {
    **dict.fromkeys(("approach", "extend", "extension", "trace", "loading", "load", "forward", "in", "ex"), APPROACH),
    **dict.fromkeys(("retreat", "retract", "withdraw", "retrace", "unloading", "unload", "backward", "out"), RETREAT),
    **dict.fromkeys(("retraction", "rt"), RETREAT),
    **dict.fromkeys(("pause", "dwell", "wait", "hold", "rest"), REST),
}

#: Names of columns in small letters, with blanks between words; of several of one kind the first one here is read.
_NAMES = {
    "displacement": ("displacement", "indentation", "indentation depth", "penetration", "depth", "tip position",
                     "tip sample separation", "separation"),
    "load": ("load", "force", "normal load", "normal force", "vertical force"),
    "height": ("height", "height measured", "measured height", "height sensor", "capacitive sensor height",
               "smoothed capacitive sensor height", "z sensor", "zsensor", "zsnr", "height piezo", "calc ramp", "piezo",
               "z piezo", "piezo position", "position", "z position", "z"),
    "deflection": ("deflection", "vertical deflection", "v deflection", "vdeflection", "defl"),
    "branch": ("branch", "segment", "motion"),
}  # fmt: skip
_COLUMN_OF = {name: column for column, names in _NAMES.items() for name in names}

_BRACKETS = re.compile(r"(.*?)\s*[\[({<]\s*([^\])}>]*?)\s*[\])}>]")
_AFTER_SIGN = re.compile(r"(.*\w)\s*[,/]\s*(\S+)")
_NUMBER = re.compile(NUMBER, re.ASCII)
_COMMA = re.compile(r"[+-]?\d+,\d+(?:[eE][+-]?\d+)?", re.ASCII)
#: A comment of a JPK text that states something.
_STATED = re.compile(r"#\s*(\w+):\s*(.*?)\s*")
#: Units at the end of a name without brackets, as Nanoscope writes them.
_SUFFIXES = {"nm": "nm", "um": "um", "m": "m", "v": "V", "mv": "mV", "pn": "pN", "nn": "nN", "un": "uN"}


class Cells(NamedTuple):
    """A column as it is written: its name, its unit or None, and its cells with decimal points."""

    name: str
    unit: str | None
    values: list[str]


@dataclass(frozen=True)
class Export:
    """A curve as a text has it.

    Attributes
    ----------
    location : str
        Of the heading.
    locations : list of str
        Of the rows.
    columns : dict of str to Cells
        "displacement", "load", "height", "deflection".
    motions : list of str or None
        `APPROACH`, `RETREAT` or `REST` of each row, where the text says it.
    stated : dict of str to str
        What its comments state ("springConstant").
    remarks : list of str
        What was left out.
    """

    location: str
    locations: list[str]
    columns: dict[str, Cells]
    motions: list[str] | None
    stated: Mapping[str, str] = field(default_factory=dict)
    remarks: list[str] = field(default_factory=list)


class _Heading(NamedTuple):
    name: str
    unit: str | None
    column: str | None
    motion: str | None


def _heading(cell: str) -> _Heading:
    """What the name of a column says.

    Examples
    --------
    >>> _heading("Force (nN)")[1:3], _heading("Calc_Ramp_Ex_nm")[1:], _heading("time [s]")[1:3]
    (('nN', 'load'), ('nm', 'height', 'approach'), ('s', None))
    """
    text, unit = cell.strip().strip('"'), None
    for pattern in (_BRACKETS, _AFTER_SIGN):
        if match := pattern.fullmatch(text):
            text, unit = match[1], match[2] or None
            break
    between_words = r"[_\W]+" if "_" in text else r"(?<=[a-z])(?=[A-Z])|\W+"
    words = re.sub(between_words, " ", text).lower().split()
    motion = None
    if unit is None and len(words) > 1 and not _COLUMN_OF.get(" ".join(words)):
        suffixes = [word for word in words if word in _SUFFIXES]
        motion = next((_MOTIONS[word] for word in words[1:] if word in ("ex", "rt")), None)
        unit = _SUFFIXES[suffixes[0]] if suffixes else None
        words = [word for word in words if word not in ("ex", "rt", *suffixes)]
    column = _COLUMN_OF.get(" ".join(words)) or _COLUMN_OF.get("".join(words))
    if column == "deflection" and unit and _is_unit_of(unit, "N"):
        column = "load"
    return _Heading(" ".join(words), unit, column, motion)


def _is_unit_of(unit: str, target: str) -> bool:
    try:
        unit_factor(unit, target)
    except NotAValue:
        return False
    return True


def export_of(text: str, source: str) -> Export:
    r"""Read a text.

    Parameters
    ----------
    text : str
        With ``\n`` at the end of each line.
    source : str
        What it is of, for sentences.

    Raises
    ------
    ValueError
        One sentence with the location, if it is no table, or what a column or a number is cannot be told.

    Examples
    --------
    >>> export = export_of("Height (nm);Force (nN);time (s)\n0,5;1,2;0\n1,5;1,3;1\n", "a.csv")
    >>> export.columns["load"], export.remarks
    (Cells(name='force', unit='nN', values=['1.2', '1.3']), ['the column time (s) was not read'])
    """
    statements = (match for line in text.splitlines() if (match := _STATED.fullmatch(line)))
    stated = {match[1]: match[2] for match in statements}
    if "columns" in stated and "units" in stated:
        return _of_segments(text, source, stated)
    lines = (line for line in text.splitlines() if line.strip() and line.lstrip()[0] not in "#\\")
    first = next((line for line in lines if not line.lstrip('"').startswith("\\")), "")
    delimiter = next((sign for sign in (";", "\t") if sign in first), ",")
    start = text.index(first) if first else 0
    before = text.count("\n", 0, start)
    rows = csv_rows("\n" * before + text[start:], source, by_hand=True, delimiter=delimiter)
    location, cells = next(rows, ("", []))
    if not cells:
        raise ValueError(f"{source}: the table is empty; its first row has the names of the columns")
    locations, table = [], []
    for place_of_row, row in rows:
        locations.append(place_of_row)
        table.append([cell.strip() for cell in row])
    return _assembled(source, location, cells, locations, table, {})


def _of_segments(text: str, source: str, stated: Mapping[str, str]) -> Export:
    """A text that names its columns and the kind of each segment in comments."""
    names, units = stated["columns"].split(), stated["units"].split()
    cells = [f"{name} [{unit}]" for name, unit in zip(names, units, strict=False)] + ["segment"]
    locations, table, motion = [], [], ""
    for number, line in enumerate(text.splitlines(), start=1):
        match = _STATED.fullmatch(line)
        if match and match[1] == "segment":
            motion = match[2]
        if not line.strip() or line.startswith("#"):
            continue
        row = line.split()
        if len(row) != len(names):
            raise ValueError(f"{source}, line {number}: {len(row)} values for {len(names)} columns")
        locations.append(f"{source}, line {number}")
        table.append([*row[: len(units)], motion])
    return _assembled(source, f"{source}, its comment 'columns'", cells, locations, table, stated)


def _assembled(
    source: str,
    location: str,
    cells: list[str],
    locations: list[str],
    table: list[list[str]],
    stated: Mapping[str, str],
) -> Export:
    headings = [_heading(cell) for cell in cells]
    if not any(heading.column for heading in headings):
        names = ", ".join(f"{name} [{unit}]" for name, unit in _EXAMPLES.items())
        raise ValueError(
            f"{location}: none of the columns {shown(', '.join(cell.strip() for cell in cells))} is known; "
            f"the first row names them, as {names}"
        )
    points = _decimal_points(table, headings, locations)
    if any(heading.motion for heading in headings):
        locations, headings, points = _one_below_the_other(locations, headings, points)
    chosen = _chosen(headings, location)
    columns = {
        column: Cells(headings[i].name, headings[i].unit, [row[i] for row in points]) for column, i in chosen.items()
    }
    motions = _motions(columns.pop("branch", None), locations)
    left_out = [_written(h) for i, h in enumerate(headings) if i not in chosen.values()]
    remarks = [f"the column{'s' if len(left_out) > 1 else ''} {', '.join(left_out)} {_WAS[len(left_out) > 1]} not read"]
    return Export(location, locations, columns, motions, stated, remarks if left_out else [])


def _chosen(headings: list[_Heading], location: str) -> dict[str, int]:
    """Return the number of the heading that is read of each kind."""
    chosen: dict[str, int] = {}
    for i, heading in enumerate(headings):
        if heading.column is None:
            continue
        before = headings[chosen[heading.column]] if heading.column in chosen else None
        if before is not None and before.name == heading.name and _is_signal(before.unit) == _is_signal(heading.unit):
            raise ValueError(f"{location}: the column {heading.name} stands twice; name each column once")
        if before is None or _rank(heading) < _rank(before):
            chosen[heading.column] = i
    return chosen


def _rank(heading: _Heading) -> tuple[bool, int]:
    """What is read first: lengths and forces before signals, and the names in their order."""
    names = _NAMES[str(heading.column)]
    return _is_signal(heading.unit), names.index(heading.name) if heading.name in names else len(names)


def _is_signal(unit: str | None) -> bool:
    return unit is not None and not any(_is_unit_of(unit, target) for target in ("m", "N"))


_WAS = {False: "was", True: "were"}
#: Columns of a sentence that asks for them.
_EXAMPLES = {"displacement": "nm", "load": "nN", "height": "nm", "deflection": "nm"}


def _written(heading: _Heading) -> str:
    return f"{heading.name} ({heading.unit})" if heading.unit else heading.name or "without a name"


def _one_below_the_other(
    locations: list[str], headings: list[_Heading], table: list[list[str]]
) -> tuple[list[str], list[_Heading], list[list[str]]]:
    """Put columns of the retreat below those of the approach; cells that are empty end the shorter one."""
    approach = {heading.name + str(heading.unit): i for i, heading in enumerate(headings) if heading.motion == APPROACH}
    pairs = [
        (approach[key], i)
        for i, heading in enumerate(headings)
        if heading.motion == RETREAT and (key := heading.name + str(heading.unit)) in approach
    ]
    named = [headings[i]._replace(motion=None) for i, _ in pairs]
    rows, where = [], []
    for side, motion in enumerate((APPROACH, RETREAT)):
        for location, row in zip(locations, table, strict=True):
            cells = [row[pair[side]] for pair in pairs]
            if all(cells):
                rows.append([*cells, motion])
                where.append(location)
    return where, [*named, _Heading("branch", None, "branch", None)], rows


def _decimal_points(table: list[list[str]], headings: Iterable[_Heading], locations: list[str]) -> list[list[str]]:
    """Replace decimal commas; refuse a text that has both signs in its numbers."""
    commas = [(i, j) for i, row in enumerate(table) for j, cell in enumerate(row) if _COMMA.fullmatch(cell)]
    if not commas:
        return table
    for location, row in zip(locations, table, strict=True):
        for cell in row:
            if "." in cell and _NUMBER.fullmatch(cell):
                first = table[commas[0][0]][commas[0][1]]
                raise ValueError(
                    f"{location}: {shown(cell)} has a decimal point and {shown(first)} in {locations[commas[0][0]]} a "
                    "comma; write one of the two in all numbers"
                )
    written = [list(row) for row in table]
    for i, j in commas:
        written[i][j] = written[i][j].replace(",", ".")
    return written


def _motions(branch: Cells | None, locations: Iterable[str]) -> list[str] | None:
    if branch is None:
        return None
    motions = []
    for location, word in zip(locations, branch.values, strict=True):
        motion = _MOTIONS.get(word.lower())
        if motion is None:
            raise ValueError(
                f"{location}: branch = {shown(word)} is none of {APPROACH} and {RETREAT}, nor a rest (dwell, pause)"
            )
        motions.append(motion)
    return motions
