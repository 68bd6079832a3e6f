"""Tables on a terminal, by rich: a row a line, or a row as a block of lines where a line has no room for it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal

import numpy as np
import pandas as pd
from rich.box import SIMPLE_HEAD
from rich.console import Console, ConsoleOptions, Group, RenderableType
from rich.table import Table
from rich.text import Text

from comparisons.console.printable import printable
from comparisons.output.table import aligned

__all__ = ["records", "rich_table"]

#: Spaces between two columns.
_GAP = 2


class _Fitted:
    """A table, or its rows as blocks where names and numbers have no room in a line."""

    def __init__(self, texts: pd.DataFrame, title: str) -> None:
        self._table = Table(box=SIMPLE_HEAD, show_edge=False, pad_edge=False, padding=(0, 1, 0, 0), header_style="bold")
        self._title, self._blocks, self._least = Text(title, style="bold"), _blocks(texts), -_GAP
        for name, cells in texts.items():
            lines = [line for cell in cells for line in cell.split("\n")]
            number = aligned([part for line in lines for part in line.split(", ")])
            whole = number or not any(" " in line for line in lines)
            words = [*name.split(), *(lines if whole else " ".join(lines).split())]
            width = max(map(len, words), default=0)
            self._least += width + _GAP
            justify: Literal["left", "right"] = "right" if number else "left"
            self._table.add_column(Text(name), justify=justify, no_wrap=whole, min_width=width, overflow="fold")
        for row in texts.itertuples(index=False):
            self._table.add_row(*map(Text, row))

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> Iterator[RenderableType]:
        yield self._title
        yield self._table if self._least <= options.max_width else self._blocks


def rich_table(table: pd.DataFrame, title: str, formats: Mapping[str, str] | None = None) -> RenderableType:
    """Return a table for the terminal: numbers on the right, texts folded between words, blank where missing.

    Where names and numbers have no room in a line, each row is a block of lines.

    Parameters
    ----------
    table : DataFrame
    title : str
    formats : mapping of str to str, optional
        Formats of columns of numbers.

    Examples
    --------
    >>> from rich import print
    >>> print(rich_table(pd.DataFrame({"model": ["jkr"], "kappa": [0.5]}), "errors", {"kappa": "+.2f"}))
    errors
    model  kappa
    ────────────
    jkr    +0.50
    """
    return _Fitted(_texts(table, formats or {}), title)


def records(table: pd.DataFrame, title: str) -> RenderableType:
    """Return a table as a block for each row: its first cell and, indented, the others that are not empty.

    Examples
    --------
    >>> from rich import print
    >>> print(records(pd.DataFrame({"model": ["jkr"], "domain": ["soft solids"]}), "models"))
    models
    jkr
      domain  soft solids
    """
    return Group(Text(title, style="bold"), _blocks(_texts(table, {})))


def _blocks(texts: pd.DataFrame) -> Group:
    first, *others = texts
    parts: list[RenderableType] = []
    for row in texts.to_dict("records"):
        block = Table.grid(padding=(0, 2, 0, 0))
        block.add_column(no_wrap=True, min_width=2 + max(map(len, others), default=0))
        block.add_column(overflow="fold")
        for name in others:
            if row[name]:
                block.add_row(Text(f"  {name}"), Text(row[name]))
        heading = f"{first} {row[first]}" if aligned([row[first]]) else row[first]
        parts += [Text(heading, style="bold"), block]
    return Group(*parts)


def _texts(table: pd.DataFrame, formats: Mapping[str, str]) -> pd.DataFrame:
    return pd.DataFrame(
        {str(name): [printable(_text(cell, formats.get(str(name), "g"))) for cell in table[name]] for name in table},
        dtype=object,
    )


def _text(cell: object, form: str) -> str:
    if isinstance(cell, bool | np.bool_):
        return "yes" if cell else ""
    if isinstance(cell, float | np.floating):
        return "" if np.isnan(cell) else format(cell, form)
    return str(cell)
