"""The figures of a run: one row each."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import pandas as pd

from comparisons.data.file_names import AGREEMENT, CURVES, KAPPA, KAPPA_FIGURE, REFERENCES
from comparisons.output.figures import agreement, kappa, references

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["FIGURES", "figures_of"]


#: Every figure of a run: the stem of its files, the stem of the stored table that it shows, how it is drawn, and which
#: rows it shows; without one there is no figure.
FIGURES: tuple[tuple[str, str, Callable[..., Figure], Callable[..., pd.DataFrame]], ...] = (
    (KAPPA_FIGURE, KAPPA, kappa.draw, kappa.shown),
    (AGREEMENT, AGREEMENT, agreement.draw, pd.DataFrame),
    (REFERENCES, CURVES, references.draw, pd.DataFrame),
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
    for stem, name, draw, rows in FIGURES:
        table = tables.get(name)
        if table is not None and not rows(table).empty:
            yield stem, draw(table)
