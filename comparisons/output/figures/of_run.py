"""The figures of a run: both Maugis-Dugdale models as in Fig. 16(b), the two references, and any plot of a page."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import zip_longest
from string import ascii_lowercase
from typing import TYPE_CHECKING, Any

import pandas as pd

from comparisons.data.file_names import AGREEMENT, CURVES, KAPPA, KAPPA_FIGURE, REFERENCES
from comparisons.numerics.number_text import number_parts
from comparisons.output import plots
from comparisons.output.style import (
    COLOURS,
    MARKERS,
    ModelStyle,
    lettered,
    model_label,
    model_styles,
    new_figure,
    styled,
)
from comparisons.quantities import QUANTITIES, title_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

__all__ = [
    "draw_agreement",
    "draw_comparison",
    "draw_kappa",
    "draw_plots",
    "figures_of",
    "kappa_handles",
    "kappa_panels",
]

#: Quantity and gradient exponent of the figure of errors; model -> face of the markers (None: the colour of the line).
_QUANTITY, _K = "pull_off_force", 0.4
_FACES = {"md-original": "white", "md-improved": None}

#: Colour in the legend of what is common to every n.
_ANY = "0.45"

_COLUMNS = 4

#: Smaller ratios of a difference to its bound are drawn as this one.
_SMALLEST = 1e-5

#: More panels are too small a part of a figure; room of one entry of the legend in inches.
_MOST_PANELS, _LEGEND_WIDTH, _LEGEND_HEIGHT = 24, 2.3, 0.17

#: Characters of a line beside or above a panel.
_LINE = 28


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
    kappa, differences, points = (tables.get(name, pd.DataFrame()) for name in (KAPPA, AGREEMENT, CURVES))
    if len(kappa):
        kappa = kappa[kappa["model"].isin(_FACES) & (kappa["quantity"] == _QUANTITY) & (kappa["k"] == _K)]
    if len(points):
        points = points[points["model"].isin(("fscm", "fem"))]
    drawings = (KAPPA_FIGURE, kappa, draw_kappa), (AGREEMENT, differences, draw_agreement)
    for stem, table, draw in (*drawings, (REFERENCES, points, lambda table: draw_plots(plots.curves(table)))):
        if len(table):
            with styled():
                yield stem, draw(table)


def draw_comparison(table: pd.DataFrame) -> Figure:
    """Draw kappa in percent, over the number of the case where one over a parameter would have too many panels.

    Parameters
    ----------
    table : DataFrame
        As of `comparisons.output.errors.comparison_table`.
    """
    plot = plots.kappa(table)
    if plot.points["group"].nunique() > _MOST_PANELS:
        plot = plots.kappa(table, "case")
    return draw_plots([plot])


def draw_plots(drawn: Sequence[plots.Plot]) -> Figure:
    """Draw plots of a page side by side, a panel for each of their choices."""
    panels = [(plot, rows) for plot in drawn for _, rows in plot.points.groupby("group", sort=False)]
    columns = min(_COLUMNS, max(len(panels), 1))
    height = max(-(-len(panels) // columns), 1)
    styles = model_styles(model for plot in drawn for model in plot.points["model"])
    width = max(4.8, 2.5 * columns)
    in_legend = max(1, int(width // _LEGEND_WIDTH))
    with styled():
        figure = new_figure(width, 0.7 + 2.4 * height + _LEGEND_HEIGHT * (len(styles) // in_legend))
        handles: dict[str, Any] = {}
        for axes, panel in zip_longest(figure.subplots(height, columns, squeeze=False).flat, panels):
            axes.set_visible(panel is not None)
            if panel is not None:
                plot, rows = panel
                handles |= _panel(axes, plot, rows, styles)
        figure.legend(handles.values(), handles, loc="outside lower center", ncols=in_legend)
    return figure


def _panel(axes: Axes, plot: plots.Plot, rows: pd.DataFrame, styles: Mapping[str, ModelStyle]) -> dict[str, Any]:
    """Draw the points of one choice; return what the legend shows of each model."""
    handles = {}
    for model, points in rows.groupby("model"):
        style = styles[str(model)]
        drawn = style.arguments
        if plot.mark == "both":
            bars = points["high"] - points["y"]
            drawn |= {"yerr": bars, "elinewidth": 0.8, "capsize": 2, "marker": style.symbol, "ms": 3.5}
        handles[style.label] = axes.errorbar(points["x"], points["y"], **drawn)[0]
    axes.axhline(0, color="0.4", lw=0.8)
    options = zip(plot.choices, rows["options"].iloc[0], strict=True)
    # No line ends within "n = 2".
    texts = [f"{column.heading}\u00a0=\u00a0{text}" if number_parts(text) else text for column, text in options]
    axes.set_title(textwrap.fill(", ".join(texts), _LINE), fontsize=8)
    axes.set(xscale=plot.x_scale, xlabel=plot.x_label, ylabel=textwrap.fill(plot.y_label, _LINE))
    if view := plot.views.get(str(rows["group"].iloc[0])):
        axes.set(xlim=view[:2], ylim=view[2:])
    return handles


def draw_kappa(kappa: pd.DataFrame) -> Figure:
    """Draw kappa against mu for every n, both models: left all of it, right the errors of the improved model."""
    figure = new_figure(7.2, 4.2)
    complete, enlarged = figure.subplots(1, 2)
    kappa_panels(complete, enlarged, kappa)
    lettered(complete, "a", f"{title_of(_QUANTITY)}, $k$ = {_K:g}")
    lettered(enlarged, "b", "enlarged")
    figure.legend(handles=kappa_handles(kappa["n"].unique()), loc="outside lower center", ncols=6, columnspacing=1.2)
    return figure


def kappa_handles(shapes: Iterable[float]) -> list[Line2D]:
    """Return what the legend shows: the colour and marker of each n, increasing, and the line of each model."""
    from matplotlib.lines import Line2D

    handles = [
        Line2D([], [], color=COLOURS[index], marker=MARKERS[index], ms=3.5, label=f"$n$ = {n:g}")
        for index, n in enumerate(sorted(shapes))
    ]
    for model, face in _FACES.items():
        style: dict[str, Any] = {"color": _ANY, "marker": MARKERS[0], "ms": 3.5, "mfc": face or _ANY}
        handles.append(Line2D([], [], ls=model_styles([model])[model].line, label=model_label(model), **style))
    return handles


def kappa_panels(complete: Axes, enlarged: Axes, kappa: pd.DataFrame) -> None:
    """Draw kappa (of one quantity and gradient exponent) into two axes: all of it, and near zero."""
    for index, (n, of_shape) in enumerate(kappa.sort_values("mu").groupby("n")):
        for model, face in _FACES.items():
            points = of_shape[of_shape["model"] == model]
            colour, line = COLOURS[index], model_styles([model])[model].line
            style: dict[str, Any] = {"color": colour, "marker": MARKERS[index], "mfc": face or colour, "ms": 3.5}
            error, u = 100 * points["kappa"], 100 * points["u_kappa"]
            for axes in (complete, enlarged) if len(points) else ():
                axes.plot(points["mu"], error, ls=line, label=f"$n$ = {n:g}, {model_label(model)}", **style)
                axes.fill_between(points["mu"], error - u, error + u, color=colour, alpha=0.2)
    for axes in (complete, enlarged):
        axes.set(xscale="log", xlabel=r"Tabor number $\mu$")
        axes.axhline(0, color="0.4", lw=0.8)
    complete.set_ylabel(rf"relative error of the {title_of(_QUANTITY)} $\kappa$ (%)")
    enlarged.set_ylim(-9, 9)


def draw_agreement(agreement: pd.DataFrame) -> Figure:
    """Draw the size of E_n, the difference of two models over the sum of their bounds: at most 1 if both hold.

    Parameters
    ----------
    agreement : DataFrame
        As `comparisons.output.errors.agreement` returns it; at least one row.
    """
    pair = " and ".join(model_label(str(agreement[column].iloc[0])) for column in ("model", "reference"))
    quantities = [name for name in QUANTITIES if name in set(agreement["quantity"])]
    columns = min(_COLUMNS, len(quantities))
    rows = -(-len(quantities) // columns)
    figure = new_figure(9.6, 0.8 + 2.3 * rows)
    panels = figure.subplots(rows, columns, sharey=True, squeeze=False).flat
    for letter, axes, quantity in zip_longest(ascii_lowercase[: len(quantities)], panels, quantities):
        axes.set_visible(quantity is not None)
        axes.axhline(1.0, color="0.4", lw=0.8)
        for index, (n, of_shape) in enumerate(agreement[agreement["quantity"] == quantity].groupby("n")):
            style: dict[str, Any] = {"color": COLOURS[index % len(COLOURS)], "marker": MARKERS[index % len(MARKERS)]}
            # Side by side: cases of one Tabor number would cover each other.
            mu = of_shape["mu"] * 1.06 ** (index - 1.5) * 1.015 ** (10 * of_shape["k"] - 3)
            axes.plot(
                mu,
                of_shape["en"].abs().clip(lower=_SMALLEST),
                ls="none",
                ms=3.5,
                mfc="white",
                label=f"$n$ = {n:g}",
                **style,
            )
        axes.set(xscale="log", yscale="log", xlabel=r"Tabor number $\mu$")
        ticks = sorted(agreement.loc[agreement["quantity"] == quantity, "mu"].unique())
        axes.set_xticks(ticks, [f"{mu:g}" for mu in ticks])
        axes.set_xticks([], minor=True)
        lettered(axes, str(letter), title_of(str(quantity)))
    figure.suptitle(f"Difference of {pair} over the sum of their bounds (below 1: both hold)")
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=max(len(labels), 1))
    return figure
