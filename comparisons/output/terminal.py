"""Tables on a terminal, by rich."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from io import StringIO
from typing import TYPE_CHECKING, Any

from rich.box import SIMPLE_HEAD
from rich.console import Group, RenderableType
from rich.table import Table
from rich.text import Text

from comparisons.console.printable import printable
from comparisons.console.safe_console import SafeConsole
from comparisons.numerics.number_text import aligned

if TYPE_CHECKING:
    import pandas as pd


def rich_table(
    table: pd.DataFrame | Mapping[str, Sequence[object]], title: str, formats: Mapping[str, str] | None = None
) -> RenderableType:
    """Return a table for the terminal: numbers on the right, texts folded between words, blank where missing.

    Parameters
    ----------
    table : DataFrame or mapping of str to sequence
        By the headings.
    title : str
    formats : mapping of str to str, optional
        Formats of columns of numbers.

    Examples
    --------
    >>> from rich import print
    >>> print(rich_table({"model": ["jkr"], "kappa": [0.5]}, "errors", {"kappa": "+.2f"}))
    errors
    model  kappa
    ────────────
    jkr    +0.50
    """
    texts = _texts(table, formats or {})
    lines = Table(box=SIMPLE_HEAD, show_edge=False, pad_edge=False, padding=(0, 1, 0, 0), header_style="bold")
    for name, cells in texts.items():
        number = aligned([word for cell in cells for word in cell.replace("\n", ", ").split(", ")])
        # A column of single words gives way to one of sentences.
        unbroken = number or not any(" " in cell for cell in cells)
        width = max(map(len, "\n".join(cells).split("\n"))) if unbroken else None
        lines.add_column(Text(str(name)), justify="right" if number else "left", min_width=width, overflow="fold")
    for row in zip(*texts.values(), strict=True):
        lines.add_row(*map(Text, row))
    return Group(Text(title, style="bold"), lines)


def records(table: pd.DataFrame | Mapping[str, Sequence[object]], title: str) -> RenderableType:
    """Return a table as a block for each row: its first cell and, indented, the others that are not empty.

    Examples
    --------
    >>> from rich import print
    >>> print(records({"model": ["jkr"], "domain": ["soft solids"]}, "models"))
    models
    jkr
      domain  soft solids
    """
    texts = _texts(table, {})
    heading, *names = texts
    blocks: list[RenderableType] = [Text(title, style="bold")]
    for cells in zip(*texts.values(), strict=True):
        row = dict(zip(texts, cells, strict=True))
        block = Table.grid(padding=(0, 2, 0, 0))
        block.add_column(no_wrap=True, min_width=2 + max(map(len, names), default=0))
        block.add_column(overflow="fold")
        for name in filter(row.get, names):
            block.add_row(Text(f"  {name}"), Text(row[name]))
        blocks += [Text(row[heading], style="bold"), block]
    return Group(*blocks)


def plain_text(tables: Iterable[RenderableType], width: int) -> str:
    """Return tables as the lines that a terminal without colours shows.

    Examples
    --------
    >>> plain_text([rich_table({"kappa": [0.5]}, "errors")], 80).split()
    ['errors', 'kappa', '─────', '0.5']
    """
    stream = StringIO()
    console = SafeConsole(file=stream, width=width, color_system=None, highlight=False, markup=False)
    for table in tables:
        console.print(table, crop=False)
    return stream.getvalue().rstrip("\n")


def _texts(table: pd.DataFrame | Mapping[str, Sequence[object]], formats: Mapping[str, str]) -> dict[str, list[str]]:
    return {str(name): [printable(_text(cell, formats.get(str(name), "g"))) for cell in table[name]] for name in table}


def _text(cell: Any, form: str) -> str:
    # A number of NumPy is one of Python.
    cell = cell.item() if hasattr(cell, "item") else cell
    if isinstance(cell, bool):
        return "yes" if cell else ""
    if isinstance(cell, float):
        return "" if math.isnan(cell) else format(cell, form)
    return str(cell)
