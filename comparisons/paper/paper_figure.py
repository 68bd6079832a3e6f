"""Figures and tables of the paper: tasks, tables made of their results, and the picture of the tables."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure
from rich.console import RenderableType

from comparisons.output.style import save
from comparisons.paper.cache import CachedCall, Results
from comparisons.runs.atomic_files import atomic
from comparisons.runs.csv_format import csv_text

__all__ = ["PaperFigure", "Tables", "write"]

#: The data of a figure, by the name of each table.
Tables = dict[str, pd.DataFrame]

#: Each picture for the screen, and as vectors for print.
_FORMATS = (".png", ".pdf")


@dataclass(frozen=True, slots=True)
class PaperFigure:
    """One figure or table.

    Attributes
    ----------
    name : str
        Number of the figure in the paper, or a name for what is not a figure of the paper.
    stem : str
        Start of the names of its files.
    title : str
        What it shows, one line.
    tasks : callable
        Returns the tasks it needs, the longest first.
    tables : callable
        Makes its tables of the results; raises `comparisons.model.ComputationFailed` if a task it needs has failed.
    draw : callable or None
        Draws the tables; None for a figure that is a table only.
    texts : callable or None
        Makes texts of the tables, by the suffix of the file each goes to (".md").
    shown : callable or None
        Makes the table that the command prints.
    follows_path : bool
        Whether the rows of its tables lie along equilibrium paths.  The solver places these points, so that rounding
        may change where they lie and how many there are.
    """

    name: str
    stem: str
    title: str
    tasks: Callable[[], Sequence[CachedCall]]
    tables: Callable[[Results], Tables]
    draw: Callable[[Tables], Figure] | None
    texts: Callable[[Tables], dict[str, str]] | None = None
    shown: Callable[[Tables], RenderableType] | None = None
    follows_path: bool = False

    def table_file(self, name: str) -> str:
        """Return the name of the CSV file of a table."""
        return f"{self.stem}_{name}.csv" if name else f"{self.stem}.csv"

    def files_in(self, folder: Path) -> list[Path]:
        """Return the files of the figure that a folder holds, sorted."""
        return sorted(folder.glob(f"{self.stem}[._]*"))


def write(paper_figure: PaperFigure, tables: Tables, folder: Path) -> list[Path]:
    """Write the CSV of every table, the picture and the texts; return the paths.

    Raises
    ------
    ValueError
        If a file cannot be written.
    """
    picture = paper_figure.draw(tables) if paper_figure.draw else None
    written = []
    for name, table in tables.items():
        path = folder / paper_figure.table_file(name)
        with atomic(path) as file:
            file.write(csv_text(table).encode())
        written.append(path)
    for suffix, text in (paper_figure.texts(tables) if paper_figure.texts else {}).items():
        path = folder / f"{paper_figure.stem}{suffix}"
        with atomic(path) as file:
            file.write(text.encode())
        written.append(path)
    if picture is not None:
        for path in (folder / f"{paper_figure.stem}{suffix}" for suffix in _FORMATS):
            save(picture, path)
            written.append(path)
    return written
