"""Fig. 16(b): relative error of the pull-off force of both Maugis-Dugdale models."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import pandas as pd

from comparisons.output.style import COLOURS, MARKERS, lettered, model_label, model_styles, new_figure, styled
from comparisons.quantities import title_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

__all__ = ["draw", "handles", "panels", "shown"]

#: The quantity of the figure.
_QUANTITY = "pull_off_force"

#: Model -> face of the markers (None: the colour of the line); the lines are those of the models everywhere.
_MODELS = {"md-original": "white", "md-improved": None}

#: Colour in the legend of what is common to every n.
_ANY = "0.45"


def draw(kappa: pd.DataFrame, k: float = 0.4) -> Figure:
    """Draw kappa against mu for every n, both models, at one gradient exponent.

    Parameters
    ----------
    kappa : DataFrame
        As `comparisons.output.errors.relative_error` returns it.
    k : float
        Gradient exponent.

    Returns
    -------
    Figure
        Left all of it, right the neighbourhood of zero, where the errors of the improved model are.
    """
    chosen = shown(kappa, k).sort_values("mu")
    with styled():
        figure = new_figure(7.2, 4.2)
        whole, near = figure.subplots(1, 2)
        panels(whole, near, chosen)
        lettered(whole, "a", f"{title_of(_QUANTITY)}, $k$ = {k:g}")
        lettered(near, "b", "enlarged")
        figure.legend(handles=handles(chosen["n"].unique()), loc="outside lower center", ncols=6, columnspacing=1.2)
    return figure


def shown(kappa: pd.DataFrame, k: float = 0.4) -> pd.DataFrame:
    """Return the rows that `draw` draws: a run may have other models, and more shape indices."""
    drawn = kappa["model"].isin(_MODELS)
    return kappa[drawn & (kappa["quantity"] == _QUANTITY) & (kappa["k"] == k)]


def handles(shapes: Iterable[float]) -> list[Line2D]:
    """Return what the legend shows: the colour and marker of each n, increasing, and the line of each model."""
    from matplotlib.lines import Line2D

    found = [
        Line2D([], [], color=COLOURS[index], marker=MARKERS[index], ms=3.5, label=f"$n$ = {n:g}")
        for index, n in enumerate(sorted(shapes))
    ]
    for model, face in _MODELS.items():
        line = model_styles([model])[model].line
        style: dict[str, Any] = {"color": _ANY, "marker": MARKERS[0], "ms": 3.5, "mfc": face or _ANY}
        found.append(Line2D([], [], ls=line, label=model_label(model), **style))
    return found


def panels(whole: Axes, near: Axes, kappa: pd.DataFrame) -> None:
    """Draw kappa (of one quantity and gradient exponent, sorted by mu) into two axes: all of it, and near zero."""
    for index, (n, of_shape) in enumerate(kappa.groupby("n")):
        for model in _MODELS:
            points = of_shape[of_shape["model"] == model]
            for axes in (whole, near) if len(points) else ():
                _plot(axes, points, index, model, f"$n$ = {n:g}, {model_label(model)}")
    for axes in (whole, near):
        axes.set_xscale("log")
        axes.set_xlabel(r"Tabor number $\mu$")
        axes.axhline(0, color="0.4", lw=0.8)
    whole.set_ylabel(rf"relative error of the {title_of(_QUANTITY)} $\kappa$ (%)")
    near.set_ylim(-9, 9)


def _plot(axes: Axes, points: pd.DataFrame, index: int, model: str, label: str) -> None:
    """Draw one model's errors and, where it can be seen, the band of their uncertainty."""
    centre, band = 100 * points["kappa"], 100 * points["u_kappa"]
    colour, line, face = COLOURS[index], model_styles([model])[model].line, _MODELS[model]
    axes.plot(
        points["mu"],
        centre,
        color=colour,
        marker=MARKERS[index],
        mfc=face or colour,
        ms=3.5,
        ls=line,
        label=label,
    )
    axes.fill_between(points["mu"], centre - band, centre + band, color=colour, alpha=0.2)
