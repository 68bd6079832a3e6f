"""Figure of a comparison: relative errors of models over the parameter that varies most, with their uncertainty."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pandas as pd

from comparisons.output.style import ModelStyle, model_styles, new_figure, styled
from comparisons.quantities import title_of
from comparisons.runs.rows import CASE

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["draw"]

#: More panels of one quantity are too small to read: all cases are then points of one panel.
_MOST_PANELS = 12
_COLUMNS = 4

#: Room of one entry of the legend in inches: that of the longest label of our models, and of one line.
_LEGEND_WIDTH, _LEGEND_HEIGHT = 2.3, 0.17

_LETTERS = {"mu": r"\mu", "k": "k", "n": "n"}
_LABELS = {"mu": r"Tabor number $\mu$", "k": r"gradient exponent $k$", "n": r"shape index $n$"}
_LABELS |= {"case": "case, in the order of the table"}


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
    rows = table[table["kappa"].notna()]
    of_files = "problem" in rows
    if of_files:
        rows = rows.assign(case=1 + rows.groupby([*CASE], sort=False, dropna=False).ngroup())
    x = "case" if of_files else max(_LETTERS, key=lambda name: rows[name].nunique())
    others = [name for name in ("n", "k", "mu") if name != x]
    groups = dict(list(rows.groupby(["quantity", "reference"], sort=False)))
    panels = {key: list(group.groupby(others)) for key, group in groups.items()}
    lines = not of_files and all(len(of_group) <= _MOST_PANELS for of_group in panels.values())
    if not lines:
        panels = {key: [((), group)] for key, group in groups.items()}
    columns = min(_COLUMNS, max(map(len, panels.values()), default=1))
    # Each quantity begins a row of its own.
    places = [
        place
        for key, of_group in panels.items()
        for place in [(*key, *panel) for panel in of_group] + [None] * (-len(of_group) % columns)
    ]
    styles = model_styles(rows["model"])
    width, height = max(4.8, 2.5 * columns), max(len(places) // columns, 1)
    in_legend = max(1, int(width // _LEGEND_WIDTH))
    with styled():
        figure = new_figure(width, 0.7 + 2.4 * height + _LEGEND_HEIGHT * (len(styles) // in_legend))
        lattice = figure.subplots(height, columns, squeeze=False, sharex=True).ravel().tolist()
        for index, (axes, place) in enumerate(zip(lattice, places, strict=False)):
            axes.set_visible(place is not None)
            if place is None:
                continue
            quantity, reference, held, drawn = place
            for name, style in styles.items():
                _plot(axes, drawn[drawn["model"] == name].sort_values(x), x, style, lines)
            axes.axhline(0, color="0.4", lw=0.8)
            axes.set_title(", ".join(f"${_LETTERS[name]}$ = {v:g}" for name, v in zip(others, held, strict=False)))
            axes.set_xscale("log" if x == "mu" and rows["mu"].nunique() > 1 else "linear")
            if index % columns == 0:
                axes.set_ylabel(f"{title_of(quantity)}\n$\\kappa$ against {reference} (%)")
            if index + columns >= len(places) or places[index + columns] is None:
                axes.set_xlabel(_LABELS[x])
                axes.tick_params(labelbottom=True)
        bars = {bar.get_label(): bar[0] for axes in lattice for bar in axes.containers}
        figure.legend([*bars.values()], [*bars], loc="outside lower center", ncols=in_legend)
    return figure


def _plot(axes: Any, rows: pd.DataFrame, x: str, style: ModelStyle, lines: bool) -> None:
    """Draw one model's errors and, where it can be seen, their uncertainty."""
    if len(rows):
        drawn: Any = {"color": style.colour, "ls": style.line if lines else "none", "marker": style.symbol, "ms": 3.5}
        error, u = 100 * rows["kappa"], 100 * rows["u_kappa"]
        axes.errorbar(rows[x], error, yerr=u, elinewidth=0.8, capsize=2, label=style.label, **drawn)
