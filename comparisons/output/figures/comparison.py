"""Figure of a comparison: relative errors of models over the parameter that varies most, with their uncertainty."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pandas as pd

from comparisons.output.style import ModelStyle, model_styles, new_figure, styled
from comparisons.quantities import title_of
from comparisons.runs.rows import CASE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

__all__ = ["draw"]

#: More panels of one quantity are too small to read: all cases are then points of one panel.
_MOST_PANELS = 12
_COLUMNS = 4

#: Room of one entry of the legend in inches: that of the longest label of our models, and of one line.
_LEGEND_WIDTH, _LEGEND_HEIGHT = 2.3, 0.17

_LABELS = {"mu": r"Tabor number $\mu$", "k": r"gradient exponent $k$", "n": r"shape index $n$"}

#: Column and label where problems of files are among the cases.
_CASE, _CASE_LABEL = "case", "case, in the order of the table"


def draw(table: pd.DataFrame) -> Figure:
    """Draw kappa in percent: a row of panels for each quantity and reference, a panel for each pair of the others.

    Parameters
    ----------
    table : DataFrame
        As of `comparisons.output.errors.comparison_table`.

    Returns
    -------
    Figure
        Over mu, k or n, whichever has most values (the first of those with equally many); over the number of the case
        if one is the problem of a file.
    """
    known = table[table["kappa"].notna()]
    of_files = "problem" in known
    if of_files:
        known = known.assign(**{_CASE: 1 + known.groupby([*CASE], sort=False, dropna=False).ngroup()})
    x = _CASE if of_files else max(_LABELS, key=lambda name: known[name].nunique())
    others = [name for name in ("n", "k", "mu") if name != x]
    groups = list(known.groupby(["quantity", "reference"], sort=False))
    panels = {key: list(group.groupby(others)) for key, group in groups}
    # A panel of points for cases that are no product of lists.
    lines = not of_files and all(len(of_group) <= _MOST_PANELS for of_group in panels.values())
    if not lines:
        panels = {key: [((), group)] for key, group in groups}
    columns = min(_COLUMNS, max((len(of_group) for of_group in panels.values()), default=1))
    rows = sum(-(-len(of_group) // columns) for of_group in panels.values())
    styles = model_styles(known["model"])
    width = max(4.8, 2.5 * columns)
    in_legend = max(1, int(width // _LEGEND_WIDTH))
    with styled():
        figure = new_figure(width, 0.7 + 2.4 * max(rows, 1) + _LEGEND_HEIGHT * (len(styles) // in_legend))
        every = iter(figure.subplots(max(rows, 1), columns, squeeze=False, sharex=True).ravel().tolist())
        for (quantity, reference), of_group in panels.items():
            for index in range(-(-len(of_group) // columns) * columns):
                axes = next(every)
                if index >= len(of_group):
                    axes.set_visible(False)
                    continue
                values, rows_of_panel = of_group[index]
                for name, style in styles.items():
                    _plot(axes, rows_of_panel[rows_of_panel["model"] == name], x, style, lines)
                axes.set_title(", ".join(f"${_letter(name)}$ = {v:g}" for name, v in zip(others, values, strict=False)))
                if index % columns == 0:
                    axes.set_ylabel(f"{title_of(quantity)}\n$\\kappa$ against {reference} (%)")
        _finish(figure, x, known)
        handles = [_handle(style, lines) for style in styles.values()]
        figure.legend(handles=handles, loc="outside lower center", ncols=in_legend)
    return figure


def _letter(name: str) -> str:
    return r"\mu" if name == "mu" else name


def _finish(figure: Figure, x: str, known: pd.DataFrame) -> None:
    """Draw zero, scale the parameter, and write its name below the last panel of each column."""
    last: dict[int, Axes] = {}
    for axes in figure.axes:
        place = axes.get_subplotspec()
        if not axes.get_visible() or place is None:
            continue
        axes.axhline(0, color="0.4", lw=0.8)
        if x == "mu" and known["mu"].nunique() > 1:
            axes.set_xscale("log")
        if x == _CASE:
            axes.locator_params(axis="x", integer=True)
        last[place.colspan.start] = axes
    for axes in last.values():
        axes.set_xlabel(_LABELS.get(x, _CASE_LABEL))
        axes.tick_params(labelbottom=True)


def _arguments(style: ModelStyle, lines: bool) -> dict[str, Any]:
    dashes = style.line if lines else "none"
    return {"color": style.colour, "ls": dashes, "marker": style.symbol, "ms": 3.5}


def _plot(axes: Axes, rows: pd.DataFrame, x: str, style: ModelStyle, lines: bool) -> None:
    """Draw one model's errors and, where it can be seen, their uncertainty."""
    rows = rows.sort_values(x)
    arguments = _arguments(style, lines)
    axes.errorbar(rows[x], 100 * rows["kappa"], yerr=100 * rows["u_kappa"], elinewidth=0.8, capsize=2, **arguments)


def _handle(style: ModelStyle, lines: bool) -> Line2D:
    from matplotlib.lines import Line2D

    return Line2D([], [], label=style.label, **_arguments(style, lines))
