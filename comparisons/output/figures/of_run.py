"""Plots of a page as figures: those of a run, of a comparison, and the curves of a command."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping, Sequence
from itertools import zip_longest
from typing import TYPE_CHECKING, Any

import pandas as pd

from comparisons.data.file_names import AGREEMENT, CURVES, KAPPA, KAPPA_FIGURE, REFERENCES
from comparisons.numerics.number_text import number_parts
from comparisons.output import plots
from comparisons.output.style import BRANCHES, ModelStyle, model_styles, new_figure, styled
from comparisons.registry import MODELS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

#: The figure of errors shows these models, as Fig. 16(b) of the paper: errors of one quantity against one reference.
_MODELS, _SHOWN = ("md-original", "md-improved"), {"quantity": "pull_off_force", "reference": "fscm", "k": 0.4}

#: Panels in a row.
_COLUMNS = 4

#: More panels are too small a part of a figure; room in the legend of a character, a line and its height in inches.
_MOST_PANELS, _LEGEND_CHARACTER, _LEGEND_LINE = 24, 0.063, 0.8
_LEGEND_HEIGHT = 0.17
#: Length of a line in the legend, in characters' heights: two periods of dash and dot.
_LEGEND_SAMPLE = 4.0

#: A model and the branch of its cycle, empty of other curves.
_Line = tuple[str, str]

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
        kappa = kappa[kappa["model"].isin(_MODELS) & (kappa[list(_SHOWN)] == pd.Series(_SHOWN)).all(axis="columns")]
    if len(kappa):
        yield KAPPA_FIGURE, draw_plots([plots.kappa(kappa)])
    if len(differences):
        yield AGREEMENT, draw_plots([plots.agreement(differences)])
    if len(points) and (drawn := plots.curves(points[points["model"].isin(("fscm", "fem"))])):
        yield REFERENCES, draw_plots(drawn)


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


def draw_values(results: pd.DataFrame) -> Figure | None:
    """Draw the values over each varied number of a problem file; None without one, or with too many panels.

    Parameters
    ----------
    results : DataFrame
        As of `comparisons.runs.frames.frame`.
    """
    drawn = [plot for plot, _ in plots.values_over_keys(results)]
    panels = sum(plot.points["group"].nunique() for plot in drawn)
    return draw_plots(drawn) if 0 < panels <= _MOST_PANELS else None


def draw_plots(drawn: Sequence[plots.Plot]) -> Figure:
    """Draw plots of a page side by side, a panel for each of their choices."""
    panels = [(plot, rows) for plot in drawn for _, rows in plot.points.groupby("group", sort=False)]
    columns = min(_COLUMNS, max(len(panels), 1))
    height = max(-(-len(panels) // columns), 1)
    styles = model_styles(model for plot in drawn for model in plot.points["model"])
    width = max(6.4, 2.5 * columns)
    entries = _legend_entries(drawn)
    longest = max(map(len, entries.values()), default=0)
    in_legend = max(1, int(width // (_LEGEND_LINE + _LEGEND_CHARACTER * longest)))
    with styled():
        figure = new_figure(width, 0.7 + 2.4 * height + _LEGEND_HEIGHT * (len(entries) // in_legend))
        handles: dict[_Line, Any] = {}
        for axes, panel in zip_longest(figure.subplots(height, columns, squeeze=False).flat, panels):
            axes.set_visible(panel is not None)
            if panel is not None:
                plot, rows = panel
                handles |= _panel(axes, plot, rows, styles)
        labels = [entries[line] for line in handles]
        figure.legend(
            handles.values(), labels, loc="outside lower center", ncols=in_legend, handlelength=_LEGEND_SAMPLE
        )
    return figure


def _legend_entries(drawn: Sequence[plots.Plot]) -> dict[_Line, str]:
    """Return the text of each line in the legend: model, branch and largest bound, whose bar may be too small.

    Panels with units of their own have no common bound.
    """
    points = pd.concat([plot.points for plot in drawn])
    largest = (points["high"] - points["y"]).groupby([points["model"], points["branch"]]).max()
    have_bounds = not any(plot.y_labels for plot in drawn)
    unit = next((plot.unit for plot in drawn), "")
    return {
        line: ", ".join([*filter(None, line), *([f"u ≤ {bound:.1e}{unit}"] if bound and have_bounds else [])])
        for line, bound in largest.items()
    }


def _option_text(heading: str, text: str) -> str:
    r"""The text of a choice, of a number with its name; no line ends within "n = 2" or "1 µm".

    Examples
    --------
    >>> _option_text("n", "2"), _option_text("punch.R", "1 nm"), _option_text("quantity", "hysteresis energy")
    ('n\xa0=\xa02', 'punch.R\xa0=\xa01\xa0nm', 'hysteresis energy')
    """
    return f"{heading} = {text}".replace(" ", "\u00a0") if number_parts(text.partition(" ")[0]) else text


def _panel(axes: Axes, plot: plots.Plot, rows: pd.DataFrame, styles: Mapping[str, ModelStyle]) -> dict[_Line, Any]:
    """Draw the points of one choice; return what the legend shows of each line."""
    handles = {}
    # External models stand first in the legend, and above the others.
    for (model, branch), points in sorted(rows.groupby(["model", "branch"]), key=lambda pair: pair[0][0] in MODELS):
        style = styles[str(model)]
        drawn = style.arguments | ({} if model in MODELS else {"zorder": 4})
        drawn |= {"ls": BRANCHES[branch]} if branch else {}
        if plot.mark == "both":
            bars = points["high"] - points["y"]
            drawn |= {"yerr": bars, "elinewidth": 0.8, "capsize": 2, "marker": style.symbol, "ms": 3.5}
        handles[model, branch] = axes.errorbar(points["x"], points["y"], **drawn)[0]
    axes.axhline(0, color="0.4", lw=0.8)
    options = zip(plot.choices, rows["options"].iloc[0], strict=True)
    texts = [_option_text(column.heading, text) for column, text in options]
    axes.set_title(textwrap.fill(", ".join(texts), _LINE), fontsize=8)
    group = str(rows["group"].iloc[0])
    y_label = plot.y_labels.get(group, plot.y_label)
    axes.set(xscale=plot.x_scale, xlabel=plot.x_label, ylabel=textwrap.fill(y_label, _LINE))
    if plot.x_label == "case":
        axes.locator_params("x", integer=True)
    if view := plot.views.get(group):
        axes.set(xlim=view[:2], ylim=view[2:])
    return handles
