"""Figures and tables of the paper: the calls they need, the tables of the results, and the picture of the tables."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import pandas as pd
from matplotlib.figure import Figure
from rich.console import RenderableType

from comparisons.output.latex import latex
from comparisons.output.markdown import markdown
from comparisons.output.style import save, styled
from comparisons.paper.cache import CachedCall, Results
from comparisons.runs.atomic_files import atomic
from comparisons.runs.csv_format import csv_text

__all__ = ["PaperFigure", "Plan", "Tables", "calls_of", "given", "lines_of", "results_by", "rows_of", "write"]

T = TypeVar("T")
K = TypeVar("K")

#: The data of a figure, by the name of each table.
Tables = dict[str, pd.DataFrame]

#: What is made of calls: it yields once, the calls, the longest first; is sent their results; and returns what it made.
Plan = Generator[Sequence[CachedCall], Results, T]

#: Each picture for the screen, and as vectors for print.
_FORMATS = (".png", ".pdf")


def calls_of(plan: Plan[Any]) -> list[CachedCall]:
    """Return the calls that a plan needs, each once.

    Examples
    --------
    >>> calls_of(rows_of([({"x": 3}, CachedCall("math:sqrt", (3,)))]))
    [CachedCall(function='math:sqrt', arguments=(3,))]
    """
    return list(dict.fromkeys(next(plan)))


def given(plan: Plan[T], results: Results) -> T:
    """Return what a plan makes of results.

    Raises
    ------
    ComputationFailed
        If a call that it needs has failed.
    """
    next(plan)
    try:
        plan.send(results)
    except StopIteration as end:
        made: T = end.value
        return made
    raise RuntimeError("a plan yields its calls once")


def results_by(calls: Mapping[K, CachedCall]) -> Plan[dict[K, Any]]:
    """Plan the results of calls, by their keys."""
    results = yield list(calls.values())
    return {key: results[call] for key, call in calls.items()}


def rows_of(calls: Iterable[tuple[Mapping[str, Any], CachedCall]]) -> Plan[pd.DataFrame]:
    """Plan a table of one row a call: its keys, and the dictionary that it returns."""
    keyed = list(calls)
    results = yield [call for _, call in keyed]
    return pd.DataFrame([{**key, **results[call]} for key, call in keyed])


def lines_of(key: Mapping[str, Any], found: Mapping[str, Any], names: Iterable[str]) -> pd.DataFrame:
    """Return the lists and numbers of these names in a result as columns, one row without numbers if it has none.

    Examples
    --------
    >>> lines_of({"k": 0.4}, {"load": [0.0, -1.0], "u": 0.1}, ["load", "u"]).values.tolist()
    [[0.4, 0.0, 0.1], [0.4, -1.0, 0.1]]
    """
    return pd.DataFrame({**key, **{name: found.get(name, [math.nan]) for name in names}})


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
        Draws the tables on a page; None for a figure that is a table only.
    size : tuple of float
        Width and height of the page in inches.
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
    plan: Callable[[], Plan[Tables]]
    picture: Callable[[Figure, Tables], None] | None = None
    size: tuple[float, float] = (7.2, 3.4)
    texts: Callable[[Tables], dict[str, str]] | None = None
    shown: Callable[[Tables], RenderableType] | None = None
    follows_path: bool = False

    def tasks(self) -> list[CachedCall]:
        """Return the calls that it needs, the longest first."""
        return calls_of(self.plan())

    def tables(self, results: Results) -> Tables:
        """Return its tables.

        Raises
        ------
        comparisons.model.ComputationFailed
            If a call that it needs has failed.
        """
        return given(self.plan(), results)

    def draw(self, tables: Tables) -> Figure | None:
        """Return the picture of its tables, None for a figure that is a table only."""
        if self.picture is None:
            return None
        with styled():
            figure = Figure(figsize=self.size, layout="constrained")
            self.picture(figure, tables)
        return figure

    def table_file(self, name: str) -> str:
        """Return the name of the CSV file of a table."""
        return f"{self.stem}_{name}.csv" if name else f"{self.stem}.csv"

    def files_in(self, folder: Path) -> list[Path]:
        """Return the files of the figure that a folder holds, sorted."""
        return sorted(folder.glob(f"{self.stem}[._]*"))


def texts_of(whole: pd.DataFrame, short: pd.DataFrame, title: str, notes: str, label: str) -> dict[str, str]:
    """Return a table for reading as a page, and one in LaTeX for which a page of paper has room."""
    return {".md": f"{markdown(whole, title)}\n{notes}\n", ".tex": latex(short, f"{title}. {notes}", label)}


def write(paper_figure: PaperFigure, tables: Tables, folder: Path) -> list[Path]:
    """Write the CSV of every table, the picture and the texts; return the paths.

    Raises
    ------
    ValueError
        If a file cannot be written.
    """
    picture = paper_figure.draw(tables)
    texts = {paper_figure.table_file(name): csv_text(table) for name, table in tables.items()}
    if paper_figure.texts:
        texts |= {f"{paper_figure.stem}{suffix}": text for suffix, text in paper_figure.texts(tables).items()}
    for name, text in texts.items():
        with atomic(folder / name) as file:
            file.write(text.encode())
    written = [folder / name for name in texts]
    if picture is not None:
        for path in (folder / f"{paper_figure.stem}{suffix}" for suffix in _FORMATS):
            save(picture, path)
            written.append(path)
    return written
