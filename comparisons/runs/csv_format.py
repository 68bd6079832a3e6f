"""Tables as CSV text that gives every number back exactly and that a spreadsheet does not evaluate."""

from __future__ import annotations

import math
import re
from collections.abc import Collection
from pathlib import Path
from typing import Any

import pandas as pd

from comparisons.problem import PARAMETERS

__all__ = ["csv_text", "plain_text", "read_csv"]

#: Start of a text that a spreadsheet evaluates, or that `csv_text` has marked already: both get an apostrophe, so that
#: `plain_text` can take away one.
_FORMULA = re.compile(r"'*[=+\-@\t]")


def csv_text(table: pd.DataFrame) -> str:
    """Return a table as CSV with 17 significant digits, which give every double back exactly.

    The parameters of a case are written as short as they can be exactly: 0.4, not 0.40000000000000002.  A text that a
    spreadsheet would evaluate as a formula gets an apostrophe before it; `plain_text` takes it away.

    Examples
    --------
    >>> print(csv_text(pd.DataFrame({"mu": [0.4], "value": [0.4], "reason": ["=1+1"]})), end="")
    mu,value,reason
    0.4,0.40000000000000002,'=1+1
    """
    table = _without_formulas(table)
    short = {
        name: table[name].map(lambda x: "" if pd.isna(x) else repr(float(x)).removesuffix(".0"))
        for name in PARAMETERS
        if name in table
    }
    return table.assign(**short).to_csv(index=False, float_format="%.17g", lineterminator="\n")


def plain_text(cell: str) -> str:
    """Return the text that `csv_text` wrote as a cell.

    Examples
    --------
    >>> plain_text("'=1+1"), plain_text("-0.5"), plain_text("it's")
    ('=1+1', '-0.5', "it's")
    """
    return cell[1:] if cell.startswith("'") and _FORMULA.match(cell[1:].lstrip()) else cell


def read_csv(path: Path, texts: Collection[str]) -> pd.DataFrame:
    """Read a table that `csv_text` has written, with every digit: Python's own conversion of numbers is exact.

    Parameters
    ----------
    path : Path
    texts : collection of str
        Columns of texts; every other one is of numbers, NaN where the cell is empty.
    """
    table = pd.read_csv(path, dtype=str, keep_default_na=False)
    numbers = {
        name: table[name].map(lambda text: float(text) if text else math.nan).astype(float)
        for name in table.columns.difference(list(texts))
    }
    words = {name: table[name].map(plain_text) for name in table.columns.intersection(list(texts))}
    return table.assign(**numbers, **words)


def _without_formulas(table: pd.DataFrame) -> pd.DataFrame:
    changed = {}
    for name in table.columns.difference(PARAMETERS, sort=False):
        if not pd.api.types.is_numeric_dtype(table[name]):
            cells = [_cell(value) for value in table[name]]
            # A column without formulas keeps its type, on which the digits of its numbers depend.
            if any(cell is not value for cell, value in zip(cells, table[name], strict=True)):
                changed[name] = pd.Series(cells, index=table.index, dtype=object)
    # Models may name columns of their curves.
    return table.assign(**changed).rename(columns=_cell)


def _cell(value: Any) -> Any:
    if not isinstance(value, str):
        return value
    # The CSV writer does not quote a carriage return, at which readers begin another row.
    text = value.replace("\r", " ") if "\r" in value else value
    return f"'{text}" if _FORMULA.match(text.lstrip()) and not _is_number(text) else text


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
