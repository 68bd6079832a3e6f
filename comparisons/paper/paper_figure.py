"""Figures and tables of the paper: the calls they need, the tables of the results, and the picture of the tables."""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Iterable, Mapping
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Any, TypeVar

import pandas as pd
from matplotlib.figure import Figure
from rich.console import RenderableType

from comparisons.data.toml_text import shipped
from comparisons.output.latex import latex
from comparisons.output.markup import markdown
from comparisons.output.style import save, styled
from comparisons.output.terminal import records
from comparisons.paper.cache import CachedCall, Outcome
from comparisons.runs.atomic_files import write_file
from comparisons.runs.csv_format import csv_text

T = TypeVar("T")
K = TypeVar("K")

#: The data of a figure, by the name of each table; the main table has the empty name.
Tables = dict[str, pd.DataFrame]

#: What is made of calls: it yields once, the calls by keys of its own; is sent their results; and returns what it made.
Plan = Generator[Mapping[Any, CachedCall], Mapping[Any, Any], T]

#: Each picture for the screen, and as vectors for print.
_FORMATS = (".png", ".pdf")


def calls_of(plan: Plan[Any]) -> list[CachedCall]:
    """Return the calls that a plan needs, each once.

    Examples
    --------
    >>> calls_of(rows_of(pow, cases(base=[2], exp=[3, 4, 3])))
    [CachedCall(function='builtins:pow', arguments=(2, 3)), CachedCall(function='builtins:pow', arguments=(2, 4))]
    """
    return list(dict.fromkeys(next(plan).values()))


def given(plan: Plan[T], outcomes: Mapping[CachedCall, Outcome]) -> T:
    """Return what a plan makes of the outcomes of its calls.

    Raises
    ------
    ComputationFailed
        If a call that it needs has failed.
    """
    return _made(plan, {key: outcomes[call].get() for key, call in next(plan).items()})


def _made(plan: Plan[T], results: Mapping[Any, Any]) -> T:
    try:
        plan.send(results)
    except StopIteration as end:
        made: T = end.value
        return made
    raise RuntimeError("a plan yields its calls once")


def together(plans: Mapping[K, Plan[T]]) -> Plan[dict[K, T]]:
    """Plan what several plans make, by their keys."""
    calls = {key: next(plan) for key, plan in plans.items()}
    results = yield {(key, name): call for key, of_plan in calls.items() for name, call in of_plan.items()}
    return {key: _made(plan, {name: results[key, name] for name in calls[key]}) for key, plan in plans.items()}


def result_of(function: Callable[..., Any], *arguments: float | str, **named: float | str) -> Plan[Any]:
    """Plan the result of one call."""
    results = yield {"": CachedCall.of(function, *arguments, **named)}
    return results[""]


def cases(**values: Iterable[Any]) -> list[dict[str, Any]]:
    """Return every combination of values, by their names.

    Examples
    --------
    >>> cases(n=[2.0], k=[0.0, 0.4])
    [{'n': 2.0, 'k': 0.0}, {'n': 2.0, 'k': 0.4}]
    """
    return [dict(zip(values, combination, strict=True)) for combination in product(*values.values())]


def rows_of(
    function: Callable[..., Any], keys: Iterable[Mapping[str, Any]], *names: str, **fixed: float | str
) -> Plan[pd.DataFrame]:
    """Plan the table of a function: its arguments in each row, and its result, of which these names, by default all.

    A result that lacks a name has NaN there.  What is fixed are arguments that the table does not show.
    """
    rows = list(keys)
    results = yield {index: CachedCall.of(function, **row, **fixed) for index, row in enumerate(rows)}
    columns = [{name: results[index].get(name, math.nan) for name in names} or results[index] for index in results]
    return table_of({**row, **of_row} for row, of_row in zip(rows, columns, strict=True))


def table_of(rows: Iterable[Mapping[str, Any]]) -> pd.DataFrame:
    """Return a table of rows of the same names; lists of one length make as many rows, with the numbers repeated.

    Examples
    --------
    >>> table_of([{"k": 0.4, "load": [0.0, -1.0]}, {"k": 0.6, "load": 2.0}]).values.tolist()
    [[0.4, 0.0], [0.4, -1.0], [0.6, 2.0]]
    """
    columns: dict[str, list[Any]] = {}
    for row in rows:
        length = max(len(value) if isinstance(value, list) else 1 for value in row.values())
        for name, value in row.items():
            columns.setdefault(name, []).extend(value if isinstance(value, list) else [value] * length)
    return pd.DataFrame(columns)


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
