"""The figures of a run: both Maugis-Dugdale models as in Fig. 16(b), and the two references beside each other."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from string import ascii_lowercase
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd

from comparisons.data.file_names import AGREEMENT, CURVES, KAPPA, KAPPA_FIGURE, REFERENCES
from comparisons.output.style import COLOURS, MARKERS, lettered, model_label, model_styles, new_figure, styled
from comparisons.quantities import CURVES as CURVE_QUANTITIES
from comparisons.quantities import QUANTITIES, title_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

__all__ = ["draw_agreement", "draw_kappa", "draw_references", "figures_of", "kappa_handles", "kappa_panels"]

#: Quantity and gradient exponent of the figure of errors; model -> face of the markers (None: the colour of the line).
_QUANTITY, _K = "pull_off_force", 0.4
_FACES = {"md-original": "white", "md-improved": None}

#: Colour in the legend of what is common to every n.
_ANY = "0.45"

#: Differences of the references below this, far below any stated uncertainty, are drawn on the lower edge.
_SMALLEST = 1e-13
_COLUMNS = 4

#: Quantity of both references -> limits of x, and of y.
_PANELS: dict[str, Any] = {"force_curve": ((-4.5, 2.5), (-2.0, 1.0)), "pull_off_pressure": ((0.0, 3.0), (None, None))}


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
    kappa = tables.get(KAPPA, pd.DataFrame(columns=["model", "quantity", "k"]))
    kappa = kappa[kappa["model"].isin(_FACES) & (kappa["quantity"] == _QUANTITY) & (kappa["k"] == _K)]
    for stem, table, draw in (
        (KAPPA_FIGURE, kappa, draw_kappa),
        (AGREEMENT, tables.get(AGREEMENT, kappa.head(0)), draw_agreement),
        (REFERENCES, tables.get(CURVES, kappa.head(0)), draw_references),
    ):
        if len(table):
            with styled():
                yield stem, draw(table)


def draw_kappa(kappa: pd.DataFrame) -> Figure:
    """Draw kappa against mu for every n, both models: left all of it, right the errors of the improved model."""
    figure = new_figure(7.2, 4.2)
    whole, enlarged = figure.subplots(1, 2)
    kappa_panels(whole, enlarged, kappa)
    lettered(whole, "a", f"{title_of(_QUANTITY)}, $k$ = {_K:g}")
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


def kappa_panels(whole: Axes, enlarged: Axes, kappa: pd.DataFrame) -> None:
    """Draw kappa (of one quantity and gradient exponent) into two axes: all of it, and near zero."""
    for index, (n, of_shape) in enumerate(kappa.sort_values("mu").groupby("n")):
        for model, face in _FACES.items():
            points = of_shape[of_shape["model"] == model]
            colour, line = COLOURS[index], model_styles([model])[model].line
            style: dict[str, Any] = {"color": colour, "marker": MARKERS[index], "mfc": face or colour, "ms": 3.5}
            error, u = 100 * points["kappa"], 100 * points["u_kappa"]
            for axes in (whole, enlarged) if len(points) else ():
                axes.plot(points["mu"], error, ls=line, label=f"$n$ = {n:g}, {model_label(model)}", **style)
                axes.fill_between(points["mu"], error - u, error + u, color=colour, alpha=0.2)
    for axes in (whole, enlarged):
        axes.set(xscale="log", xlabel=r"Tabor number $\mu$")
        axes.axhline(0, color="0.4", lw=0.8)
    whole.set_ylabel(rf"relative error of the {title_of(_QUANTITY)} $\kappa$ (%)")
    enlarged.set_ylim(-9, 9)


def draw_agreement(agreement: pd.DataFrame) -> Figure:
    """Draw the differences of two models as points, and their combined uncertainty as dashes.

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
    panels = figure.subplots(rows, columns, sharey=True, squeeze=False).ravel().tolist()
    for letter, axes, quantity in zip(ascii_lowercase, panels, quantities, strict=False):
        _differences(axes, agreement[agreement["quantity"] == quantity], sorted(agreement["n"].unique()))
        lettered(axes, letter, title_of(quantity))
    for axes in panels[len(quantities) :]:
        axes.set_visible(False)
    # The lowest panel of each column.
    for axes in panels[max(len(quantities) - columns, 0) : len(quantities)]:
        axes.set_xlabel(r"Tabor number $\mu$")
    figure.supylabel("difference (force and energy: relative; else in $z_0$)", fontsize=9)
    figure.suptitle(f"Difference of {pair} (points), and the sum of their bounds (dashes)")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    return figure


def _differences(axes: Axes, rows: pd.DataFrame, shapes: list[float]) -> None:
    for index, n in enumerate(shapes):
        of_shape = rows[rows["n"] == n]
        style: dict[str, Any] = {"ls": "none", "color": COLOURS[index % len(COLOURS)]}
        # Side by side: cases of one Tabor number would cover each other.
        mu = of_shape["mu"] * 1.06 ** (index - 1.5) * 1.015 ** (10 * of_shape["k"] - 3)
        axes.plot(mu, of_shape["claimed"], marker="_", ms=5, **style)
        size = np.maximum(of_shape["difference"].abs(), _SMALLEST)
        axes.plot(mu, size, marker=MARKERS[index % len(MARKERS)], ms=3.5, mfc="white", label=f"$n$ = {n:g}", **style)
    axes.set(xscale="log", yscale="log")
    ticks = sorted(rows["mu"].unique())
    axes.set_xticks(ticks, [f"{mu:g}" for mu in ticks])
    axes.set_xticks([], minor=True)


def draw_references(curves: pd.DataFrame) -> Figure:
    """Draw the stored curves of both references: a line for the FSCM, points for the finite elements.

    Parameters
    ----------
    curves : DataFrame
        As a run stores them in ``curves.csv``.
    """
    figure = new_figure(7.2, 4.0)
    for letter, axes, (quantity, (x_limits, y_limits)) in zip(
        "ab", figure.subplots(1, 2), _PANELS.items(), strict=True
    ):
        drawn = curves[(curves["quantity"] == quantity) & (curves["status"] == "ok")]
        for index, ((n, k, mu), case) in enumerate(drawn.groupby(["n", "k", "mu"])):
            label = f"$n$ = {n:g}, $k$ = {k:g}, $\\mu$ = {mu:g}"
            for model, points in case.sort_values("point").groupby("model"):
                line = {"lw": 2.6, "alpha": 0.35} if model == "fscm" else {"ls": "none", "marker": "o", "ms": 2.5}
                style: dict[str, Any] = line | {"color": COLOURS[index % len(COLOURS)], "mfc": "white"}
                axes.plot(points["x"], points["y"], label=f"{model_label(str(model))}, {label}", **style)
        axes.axhline(0, color="0.4", lw=0.8)
        axes.set(xlim=x_limits, ylim=y_limits, xlabel=CURVE_QUANTITIES[quantity].x.figure_label)
        axes.set_ylabel(CURVE_QUANTITIES[quantity].y.figure_label)
        lettered(axes, letter)
    handles, labels = figure.axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=2)
    return figure
