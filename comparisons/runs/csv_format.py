"""Tables as CSV files that give every number and every text back exactly and that a spreadsheet does not evaluate."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import lazy_loader

from comparisons.data.columns import column
from comparisons.data.csv_rows import csv_rows
from comparisons.data.input_files import LARGEST_ROWS, read_bytes, utf8_text
from comparisons.problem import PARAMETERS
from comparisons.runs.atomic_files import write_file

if TYPE_CHECKING:
    import pandas as pd
else:
    pd = lazy_loader.load("pandas")

#: Start of a text that a spreadsheet evaluates, or that `csv_text` has marked already: both get an apostrophe, so that
#: a reader can take away one.
_FORMULA = re.compile(r"[\s']*[=+\-@\t]")

#: The column of wall-clock times, which no file has.
SECONDS = "seconds"

#: The column of what is true or false.
_FLAG = "at_end"


def csv_text(table: pd.DataFrame) -> str:
    """Return a table as CSV with 17 significant digits, which give every double back exactly.

    The parameters of a case are written as short as they can be exactly: 0.4, not 0.40000000000000002.  A text that a
    spreadsheet would evaluate as a formula gets an apostrophe before it.

    Examples
    --------
    >>> print(csv_text(pd.DataFrame({"mu": [0.4], "value": [0.4], "reason": ["=1+1"]})), end="")
    mu,value,reason
    0.4,0.40000000000000002,'=1+1
    """
    columns = {}
    for name in table:
        if name in PARAMETERS:
            columns[name] = table[name].map(_parameter)
        elif not pd.api.types.is_numeric_dtype(table[name]):
            cells = [_cell(value) for value in table[name]]
            columns[name] = pd.Series(cells, index=table.index, dtype=object)
    # Models may name columns of their curves.
    safe = table.assign(**columns).rename(columns=_cell)
    return safe.to_csv(index=False, float_format="%.17g", lineterminator="\n")


def write_table(table: pd.DataFrame, stem: Path) -> None:
    """Write a table as `stem`.csv, without wall-clock seconds: the file depends on code and cases alone."""
    write_file(stem.with_suffix(".csv"), csv_text(table.drop(columns=SECONDS, errors="ignore")))


def read_table(path: Path) -> pd.DataFrame:
    """Read a table that `write_table` has written, with every digit.

    A column is of texts if `comparisons.data.columns` states no unit for it, or if a cell is not a number.  An empty
    cell of the others is NaN.

    Raises
    ------
    ValueError
        If there is no such file or it is not CSV; one sentence says which.
    """
    try:
        rows = csv_rows(utf8_text(path, read_bytes(path, LARGEST_ROWS)), path.name)
        heading, cells = next(rows, ("", []))[1], [row for _, row in rows]
        if not heading or len(set(heading)) < len(heading):
            raise ValueError("it has no heading, or a column twice")
    except FileNotFoundError:
        raise ValueError(f"{path} does not exist: {path.parent} is not the folder of a finished run") from None
    except (OSError, ValueError) as error:
        raise ValueError(f"{path} cannot be read as CSV ({str(error).splitlines()[0]})") from None
    columns = zip(*cells, strict=True) if cells else ((),) * len(heading)
    return pd.DataFrame(
        {name: _read_column(name, of_name, path.stem) for name, of_name in zip(heading, columns, strict=True)}
    )


def _read_column(name: str, cells: Sequence[str], stem: str) -> pd.Series:
    if name == _FLAG:
        return pd.Series([cell == "True" for cell in cells], dtype=bool)
    # Python's own conversion is exact.
    described = column(stem, name)
    if described is None or described.unit:
        try:
            return pd.Series([float(text or "nan") for text in cells], dtype=float)
        except ValueError:
            pass
    return pd.Series([_text(cell) for cell in cells], dtype=str)


def _parameter(number: float) -> str:
    return "" if pd.isna(number) else repr(float(number)).removesuffix(".0")


def _cell(value: Any) -> Any:
    if not isinstance(value, str):
        return value
    # The CSV writer does not quote a carriage return, at which readers begin another row.
    text = value.replace("\r", " ")
    return f"'{text}" if _FORMULA.match(text) and not _is_number(text) else text


def _text(cell: str) -> str:
    """Return what `_cell` was given."""
    return cell.removeprefix("'") if _FORMULA.match(cell) else cell


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
