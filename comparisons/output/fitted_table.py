"""Table of texts that fits the columns of the terminal and shortens no name and no number.

The layouts, from the first that fits: the whole table; texts of several words folded between words; the column of
groups as headings; optional columns left out, and named below; each row as a block of lines, one a column.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import pandas as pd
from rich.cells import cell_len
from rich.console import Console, ConsoleOptions
from rich.text import Text

from comparisons.console.folding import folded

__all__ = ["FittedTable"]

#: Spaces between two columns.
_GAP = 2

#: A text of several words is folded to no fewer columns than this, and never inside a word.
_LEAST_FOLDED = 24


@dataclass(frozen=True)
class FittedTable:
    r"""Table for `rich.console.Console.print`.

    Parameters
    ----------
    texts : DataFrame
        The cells as texts; a line feed starts a new line of its cell.
    title : str
        Empty for none.
    right : collection of str
        The columns whose cells are on the right.
    group : str
        The column that becomes headings where the table is too wide; empty for none.
    optional : sequence of str
        The columns that may be left out where it is still too wide, the first one first.

    Examples
    --------
    >>> table = FittedTable(pd.DataFrame({"model": ["jkr", "dmt"], "domain": ["soft solids", "stiff solids"]}))
    >>> print("\n".join(table.lines(20)))
    model  domain
    ───────────────────
    jkr    soft solids
    dmt    stiff solids
    >>> print("\n".join(table.lines(16)))
    jkr
      domain
        soft solids
    dmt
      domain
        stiff solids
    """

    texts: pd.DataFrame
    title: str = ""
    right: frozenset[str] = frozenset()
    group: str = ""
    optional: Sequence[str] = ()

    @property
    def row_count(self) -> int:
        """Number of rows."""
        return len(self.texts)

    def is_table(self, width: int) -> bool:
        """Whether every column fits; else some are left out, or each row is a block of lines."""
        ungrouped = [name for name in self.texts if name != self.group]
        return self._widths(ungrouped, width) is not None

    def lines(self, width: int) -> list[str]:
        """Return the lines of the table for so many columns, without the title."""
        return [text.plain for text in self._body(width, "─")]

    def blocks(self, width: int) -> list[str]:
        """Return each row as a block of lines: the first cell and, indented, the others with their columns."""
        return [text.plain for text in self._blocks(width)]

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> Iterator[Text]:
        """Yield the lines for the width of the console."""
        if self.title:
            yield from (_line(line, "bold") for line in folded(self.title, options.max_width))
        yield from self._body(options.max_width, "-" if options.ascii_only else "─")

    def _body(self, width: int, rule: str) -> Iterator[Text]:
        every = list(self.texts)
        ungrouped = [name for name in every if name != self.group]
        for heading in dict.fromkeys(("", self.group)):
            columns = ungrouped if heading else every
            if widths := self._widths(columns, width):
                yield from self._table(widths, heading, rule)
                return
        dropped: list[str] = []
        for name in self.optional:
            dropped.append(name)
            columns = [name for name in ungrouped if name not in dropped]
            if widths := self._widths(columns, width):
                yield from self._table(widths, self.group, rule)
                note = f"without {', '.join(dropped)}, for which {width} columns are too few"
                yield from (_line(line, "dim") for line in folded(note, width))
                return
        yield from self._blocks(width)

    def _widths(self, columns: Sequence[str], width: int) -> dict[str, int] | None:
        """Return the widths of these columns, or None where they do not fit."""
        natural = {name: max(map(cell_len, self._cell_lines(name)), default=0) for name in columns}
        room = width - _GAP * (len(columns) - 1)
        excess = sum(natural.values()) - room
        least = {name: self._least(name, natural[name]) for name in columns}
        if excess > sum(natural[name] - least[name] for name in columns):
            return None
        # The widest gives first.
        while excess > 0:
            name = max((name for name in columns if natural[name] > least[name]), key=natural.__getitem__)
            natural[name] -= 1
            excess -= 1
        return natural

    def _cell_lines(self, name: str) -> list[str]:
        return [name, *(line for cell in self.texts[name] for line in cell.split("\n"))]

    def _least(self, name: str, natural: int) -> int:
        words = [word for line in self._cell_lines(name) for word in line.split(" ")]
        return min(natural, max(_LEAST_FOLDED, *map(cell_len, words)))

    def _table(self, widths: dict[str, int], heading: str, rule: str) -> Iterator[Text]:
        places = [list(self.texts).index(name) for name in widths]
        yield _line(self._joined(list(widths), widths), "bold")
        yield _line(rule * (sum(widths.values()) + _GAP * (len(widths) - 1)), "dim")
        before = None
        for row in self.texts.itertuples(index=False, name=None):
            if heading and (now := row[list(self.texts).index(heading)]) != before:
                yield _line(f"{heading}: {now}", "bold")
                before = now
            cells = [folded(row[place], width) for place, width in zip(places, widths.values(), strict=True)]
            for number in range(max(map(len, cells))):
                yield _line(self._joined([cell[number] if number < len(cell) else "" for cell in cells], widths), "")

    def _joined(self, cells: Sequence[str], widths: dict[str, int]) -> str:
        shown = []
        for cell, (name, width) in zip(cells, widths.items(), strict=True):
            blank = " " * (width - cell_len(cell))
            shown.append(blank + cell if name in self.right else cell + blank)
        return (" " * _GAP).join(shown).rstrip()

    def _blocks(self, width: int) -> Iterator[Text]:
        """Yield each row as its first cell and, indented, the others that are not empty."""
        first, *others = self.texts
        label = max(map(cell_len, others), default=0)
        for row in self.texts.to_dict("records"):
            yield from (_line(line, "bold") for line in folded(row[first], width))
            for name in others:
                if not row[name]:
                    continue
                indent = " " * (label + 2 * _GAP)
                longest = max(map(cell_len, row[name].split()), default=0)
                beside = width - len(indent) >= max(_LEAST_FOLDED, longest)
                if not beside:
                    indent = " " * 2 * _GAP
                    yield _line(" " * _GAP + name, "")
                lines = [line for part in row[name].split("\n") for line in folded(part, width - len(indent))]
                if beside:
                    lead = " " * _GAP + name + " " * (label - cell_len(name) + _GAP)
                    yield _line(lead + lines.pop(0), "")
                yield from (_line(indent + line, "") for line in lines)


def _line(text: str, style: str) -> Text:
    # Not markup, and never cut: `folded` has made it as short as its words allow.
    return Text(text, style=style, no_wrap=True, overflow="ignore")
