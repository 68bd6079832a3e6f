"""Tables as CSV text that gives every number back exactly and that a spreadsheet does not evaluate."""

from __future__ import annotations

import re
from collections.abc import Collection
from pathlib import Path
from typing import Any

import pandas as pd

from comparisons.problem import PARAMETERS

__all__ = ["csv_text", "read_csv"]

#: Start of a text that a spreadsheet evaluates, or that `csv_text` has marked already: both get an apostrophe, so that
#: a reader can take away one.
_FORMULA = re.compile(r"'*[=+\-@\t]")


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


def read_csv(path: Path, texts: Collection[str]) -> pd.DataFrame:
    """Read a table that `csv_text` has written, with every digit.

    Parameters
    ----------
    path : Path
    texts : collection of str
        Columns of texts; every other one is of numbers, NaN where the cell is empty.
    """
    # The parsers of older versions of pandas are wrong in the last digit; Python's own conversion is exact.
    table = pd.read_csv(path, dtype=str, keep_default_na=False)
    numbers = table.columns.difference(list(texts))
    return table.assign(**{name: [float(text or "nan") for text in table[name]] for name in numbers})


def _parameter(number: float) -> str:
    return "" if pd.isna(number) else repr(float(number)).removesuffix(".0")


def _cell(value: Any) -> Any:
    if not isinstance(value, str):
        return value
    # The CSV writer does not quote a carriage return, at which readers begin another row.
    text = value.replace("\r", " ")
    return f"'{text}" if _FORMULA.match(text.lstrip()) and not _is_number(text) else text


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
