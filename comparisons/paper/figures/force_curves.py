"""Figs. 4, 6 and 13: families of force-displacement curves, over Tabor numbers, gradient exponents and models."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import product
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, MARKERS, MODEL_LINES
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, by_model, gradient, held, legend_below, level, of_model, panels
from comparisons.paper.paper_figure import Plan, Tables, lines_of, paper_figure
from comparisons.paper.tasks import curve

__all__ = ["curves"]

Case = tuple[float, float, float]
Range = tuple[float, float]

#: Ranges of displacement and load of each panel, by shape index.
_SHAPES: dict[float, tuple[Range, Range]] = {
    1.0: ((-5.0, 13.0), (-17.5, 2.5)),
    1.5: ((-5.0, 6.0), (-3.6, 1.0)),
    2.0: ((-6.0, 6.0), (-2.15, 0.6)),
    5.0: ((-7.0, 4.0), (-1.75, 0.5)),
}
#: The same by Tabor number.
_TABOR_PANELS: dict[float, tuple[Range, Range]] = {
    0.5: ((-4.0, 1.5), (-2.15, 0.8)),
    1.0: ((-4.0, 2.5), (-2.15, 0.8)),
}
_TABOR_NUMBERS = (0.1, 0.3, 0.5, 1.0, 1.5, 2.0, 3.0)
#: k = 1 is the Gibson limit.
_GRADIENTS = (0.0, 0.2, 0.4, 0.6, 1.0)
_K, _MU = 0.4, 1.0
#: Fig. 13 ends to the left where the FSCM's load has faded to this share of the pull-off force.
_FAINT = 0.04


def curves(cases: Iterable[Case]) -> Plan[Tables]:
    """Plan the table of the curves of the FSCM in these cases."""
    results = yield {case: CachedCall.of(curve, "fscm", *case) for case in cases}
    columns = ["displacement", "u_displacement", "load", "u_load"]
    parts = [
        lines_of({"n": n, "k": k, "mu": mu, "status": path["status"]}, path, columns)
        for (n, k, mu), path in results.items()
    ]
    return {"": pd.concat(parts, ignore_index=True)}


def _family(axes: Axes, table: pd.DataFrame, name: str, ranges: tuple[Range, Range]) -> None:
    for index, (value, path) in enumerate(table.groupby(name)):
        # Dashes would hide folds; markers at equal distances tell the curves apart in grey.
        marked: Any = {"color": COLOURS[index], "marker": MARKERS[index], "markevery": (0.03 * (1 + index), 0.24)}
        label = gradient(value) if name == "k" else held(mu=value)
        axes.plot(path["displacement"], path["load"], ms=3.0, mfc="white", lw=1.0, label=label, **marked)
    level(axes)
    axes.set(xlim=ranges[0], ylim=ranges[1])


def _over_tabor_numbers(figure: Figure, tables: Tables) -> None:
    words = [held(n=n, k=_K) for n in _SHAPES]
    lattice = panels(figure, 2, 2, words, LABELS["displacement"], LABELS["load"])
    for axes, (n, ranges) in zip(lattice, _SHAPES.items(), strict=True):
        _family(axes, tables[""][tables[""]["n"] == n], "mu", ranges)
    legend_below(figure, len(_TABOR_NUMBERS))


@paper_figure(_over_tabor_numbers, size=(7.2, 6.0), follows_path=True)
def fig04_force_curves_over_tabor_numbers() -> Plan[Tables]:
    """Force-displacement curves for k = 0.4 and four shapes, over the Tabor number."""
    return (yield from curves((n, _K, mu) for n in _SHAPES for mu in _TABOR_NUMBERS))


def _over_gradients(figure: Figure, tables: Tables) -> None:
    words = [held(n=2, mu=mu) for mu in _TABOR_PANELS]
    lattice = panels(figure, 1, 2, words, LABELS["displacement"], LABELS["load"])
    for axes, (mu, ranges) in zip(lattice, _TABOR_PANELS.items(), strict=True):
        _family(axes, tables[""][tables[""]["mu"] == mu], "k", ranges)
    legend_below(figure, len(_GRADIENTS))


@paper_figure(_over_gradients, size=(7.2, 3.6), follows_path=True)
def fig06_force_curves_over_gradients() -> Plan[Tables]:
    """Force-displacement curves for n = 2, mu = 0.5 and 1, over the gradient exponent."""
    return (yield from curves((2.0, k, mu) for mu in _TABOR_PANELS for k in _GRADIENTS))


def _over_models(figure: Figure, tables: Tables) -> None:
    words = [held(n=n, k=_K, mu=_MU) for n in _SHAPES]
    lattice = panels(figure, 2, 2, words, LABELS["displacement"], LABELS["load"])
    for axes, (_, of_shape) in zip(lattice, tables[""].groupby("n"), strict=True):
        by_model(axes, of_shape, "displacement", "load")
        level(axes)
        (exact,) = of_model(of_shape, "fscm")
        depth = -of_shape["load"].min()
        seen = exact.loc[exact["load"].between(-depth, 0.35 * depth) & (exact["load"].abs() > _FAINT * depth)]
        axes.set(ylim=(-1.12 * depth, 0.35 * depth))
        axes.set_xlim(seen["displacement"].min() - 0.5, seen["displacement"].max() + 0.5)
    # Eqs. 66-69 hold in contact only; there both curves end.
    legend_below(figure, 3, title="M-D-$n$-$k$ as far as there is contact, $a > 0$", title_fontsize=8)


@paper_figure(_over_models, size=(7.2, 5.6), follows_path=True)
def fig13_force_curve_models() -> Plan[Tables]:
    """Force-displacement curves of both Maugis-Dugdale models, which end at first contact, and the FSCM."""
    places = product(_SHAPES, MODEL_LINES)
    results = yield {(n, model): CachedCall.of(curve, model, n, _K, _MU) for n, model in places}
    columns = ["displacement", "load", "u_displacement", "u_load"]
    parts = [
        lines_of({"n": n, "k": _K, "mu": _MU, "model": model}, path, columns).assign(
            status=path["status"], reason=path["reason"]
        )
        for (n, model), path in results.items()
    ]
    return {"": pd.concat(parts, ignore_index=True)}
