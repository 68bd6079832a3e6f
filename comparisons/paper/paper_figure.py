"""Figures and tables of the paper: the plan of their tables, and the picture of the tables."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pandas as pd
from matplotlib.figure import Figure
from rich.console import RenderableType

from comparisons.data.toml_text import shipped
from comparisons.output.latex import latex
from comparisons.output.markup import markdown
from comparisons.output.style import save, styled
from comparisons.output.terminal import records
from comparisons.paper.plan import Plan
from comparisons.runs.atomic_files import write_file
from comparisons.runs.csv_format import csv_text

#: The data of a figure, by the name of each table; the main table has the empty name.
Tables = dict[str, pd.DataFrame]

#: Each picture for the screen, and as vectors for print.
_FORMATS = (".png", ".pdf")


#: The main table of a figure as texts: all columns, those for a terminal, and those for paper.
Reading = tuple[pd.DataFrame, pd.DataFrame, pd.DataFrame]


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
    plan : callable
        Returns the plan of its tables.
    picture : callable or None
        Draws the tables on a page, the main one as `table`, the others by their names; None for a figure that is a
        table only.
    size : tuple of float
        Width and height of the page in inches.
    reading : callable or None
        Makes texts of the main table; None for a figure whose tables are numbers only.  The file of data of the same
        stem has the notes that stand below them.
    follows_path : bool
        Whether the rows of its tables lie along equilibrium paths.  The solver places these points, so that rounding
        may change where they lie and how many there are.
    """

    name: str
    stem: str
    title: str
    plan: Callable[[], Plan[Tables]]
    picture: Callable[..., None] | None = None
    size: tuple[float, float] = (7.2, 3.4)
    reading: Callable[[pd.DataFrame], Reading] | None = None
    follows_path: bool = False

    def draw(self, tables: Tables) -> Figure | None:
        """Return the picture of its tables, None for a figure that is a table only."""
        if self.picture is None:
            return None
        with styled():
            figure = Figure(figsize=self.size, layout="constrained")
            self.picture(figure, **{name or "table": table for name, table in tables.items()})
        return figure

    def texts(self, tables: Tables) -> dict[str, str]:
        """Return the main table for reading as a page, and in LaTeX, by the suffix of the file each goes to."""
        if not self.reading:
            return {}
        whole, _, on_paper = self.reading(tables[""])
        notes = shipped(f"{self.stem}.toml")["notes"]
        tex = latex(on_paper, f"{self.title}. {notes}", self.stem.replace("_", "-"))
        return {".md": f"{markdown(whole, self.title)}\n{notes}\n", ".tex": tex}

    def printed(self, tables: Tables) -> RenderableType | None:
        """Return the table that the command prints, None for a figure whose tables are numbers only."""
        return records(self.reading(tables[""])[1], self.title) if self.reading else None

    def table_file(self, name: str) -> str:
        """Return the name of the CSV file of a table."""
        return f"{self.stem}_{name}.csv" if name else f"{self.stem}.csv"

    def files_in(self, folder: Path) -> list[Path]:
        """Return the files of the figure that a folder holds, sorted."""
        return sorted(folder.glob(f"{self.stem}[._]*"))

    def write(self, tables: Tables, folder: Path) -> list[Path]:
        """Write the CSV of every table, the picture and the texts; return the paths.

        Raises
        ------
        ValueError
            If a file cannot be written.
        """
        picture = self.draw(tables)
        texts = {self.table_file(name): csv_text(table) for name, table in tables.items()}
        texts |= {f"{self.stem}{suffix}": text for suffix, text in self.texts(tables).items()}
        for name, text in texts.items():
            write_file(folder / name, text)
        pictures = [folder / f"{self.stem}{suffix}" for suffix in _FORMATS] if picture else []
        if picture:
            save(picture, *pictures)
        return [*(folder / name for name in texts), *pictures]


#: Every figure by its name; `comparisons.paper.registry` imports the modules that declare them.
FIGURES: dict[str, PaperFigure] = {}


def paper_figure(
    picture: Callable[..., None] | None = None, *, name: str | None = None, **options: Any
) -> Callable[[Callable[[], Plan[Tables]]], Callable[[], Plan[Tables]]]:
    """Declare the figure of a plan: the plan's name is the stem of its files, its docstring the title.

    Parameters
    ----------
    picture, **options
        As of `PaperFigure`.
    name : str, optional
        By default the number of a stem as ``fig03_s_curve``, of another stem the stem with hyphens.
    """

    def declare(plan: Callable[[], Plan[Tables]]) -> Callable[[], Plan[Tables]]:
        stem, title = plan.__name__, (plan.__doc__ or "").strip().removesuffix(".")
        number = stem[3:5].lstrip("0") if stem.startswith("fig") else stem.replace("_", "-")
        FIGURES[name or number] = PaperFigure(name or number, stem, title, plan, picture, **options)
        return plan

    return declare
