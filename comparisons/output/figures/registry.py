"""The figures of a run: one row each."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import pandas as pd

from comparisons.data.file_names import AGREEMENT, CURVES, KAPPA, KAPPA_FIGURE, REFERENCES
from comparisons.output.figures import agreement, kappa, references

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["FIGURES", "RunFigure", "figures_of"]


@dataclass(frozen=True, slots=True)
class RunFigure:
    """A figure of a run.

    Attributes
    ----------
    stem : str
        Name of its files, without suffix.
    table : str
        Stem of the stored table that it shows.
    draw : callable
        From that table to the figure.
    rows : callable
        The rows of that table that it shows; without one there is no figure.
    """

    stem: str
    table: str
    draw: Callable[[pd.DataFrame], Figure]
    rows: Callable[[pd.DataFrame], pd.DataFrame] = lambda table: table


#: Every figure of a run, with the table that it draws.
FIGURES = (
    RunFigure(KAPPA_FIGURE, KAPPA, kappa.draw, kappa.shown),
    RunFigure(AGREEMENT, AGREEMENT, agreement.draw),
    RunFigure(REFERENCES, CURVES, references.draw),
)


def figures_of(tables: dict[str, pd.DataFrame]) -> Iterator[tuple[str, Figure]]:
    """Draw every figure for which a run has something to show; yield the stem of its files and the figure.

    Parameters
    ----------
    tables : dict of str to DataFrame
        The tables of the run by the stems of their files.

    Examples
    --------
    >>> list(figures_of({"agreement": pd.DataFrame()}))
    []
    """
    for figure in FIGURES:
        table = tables.get(figure.table)
        if table is not None and not figure.rows(table).empty:
            yield figure.stem, figure.draw(table)
