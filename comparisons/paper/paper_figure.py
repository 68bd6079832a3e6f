"""A plate: one figure or table of the paper, from calls to tables to the picture of the tables."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure
from rich.table import Table

from comparisons.output.style import save
from comparisons.paper.cache import Answers, Call
from comparisons.runs.tables import atomic, csv_text

__all__ = ["Plate", "Tables", "write"]

#: The data of a plate, by the name of each table.
Tables = dict[str, pd.DataFrame]

#: Each picture for the screen, and as vectors for print.
_FORMATS = (".png", ".pdf")


@dataclass(frozen=True, slots=True)
class Plate:
    """One figure or table.

    Attributes
    ----------
    name : str
        What the user asks for: the number of the figure, or a word for what is not in the paper.
    stem : str
        Start of the names of its files.
    title : str
        What it shows, one line.
    calls : callable
        Returns the calls it needs, the longest first.
    tables : callable
        Makes its tables of the answers; raises `comparisons.model.ComputationFailed` as they do.
    draw : callable or None
        Draws the tables; None for a plate that is a table only.
    texts : callable or None
        Makes texts of the tables, by the suffix of the file each goes to (".md").
    shown : callable or None
        Makes the table that the command prints.
    """

    name: str
    stem: str
    title: str
    calls: Callable[[], Sequence[Call]]
    tables: Callable[[Answers], Tables]
    draw: Callable[[Tables], Figure] | None
    texts: Callable[[Tables], dict[str, str]] | None = None
    shown: Callable[[Tables], Table] | None = None


def write(plate: Plate, tables: Tables, folder: Path) -> list[Path]:
    """Write the CSV of every table, the picture and the texts; return the paths.

    Raises
    ------
    ValueError
        If a file cannot be written.
    """
    figure = plate.draw(tables) if plate.draw else None
    written = []
    for name, table in tables.items():
        path = folder / (f"{plate.stem}_{name}.csv" if name else f"{plate.stem}.csv")
        with atomic(path) as file:
            file.write(csv_text(table).encode())
        written.append(path)
    for suffix, text in (plate.texts(tables) if plate.texts else {}).items():
        path = folder / f"{plate.stem}{suffix}"
        with atomic(path) as file:
            file.write(text.encode())
        written.append(path)
    if figure is not None:
        for path in (folder / f"{plate.stem}{suffix}" for suffix in _FORMATS):
            save(figure, path)
            written.append(path)
    return written
