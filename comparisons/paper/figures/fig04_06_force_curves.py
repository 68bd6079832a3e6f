"""Figs. 4 and 6: families of force-displacement curves, over Tabor numbers and over gradient exponents."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, MARKERS, lettered, styled
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.tasks import curve

__all__ = ["OVER_GRADIENTS", "OVER_TABOR_NUMBERS"]

_SHAPES = (1.0, 1.5, 2.0, 5.0)
_TABOR_NUMBERS = (0.1, 0.3, 0.5, 1.0, 1.5, 2.0, 3.0)
#: k = 1 is the Gibson limit.
_GRADIENTS = (0.0, 0.2, 0.4, 0.6, 1.0)

_CASES_4 = [(n, 0.4, mu) for n in _SHAPES for mu in _TABOR_NUMBERS]
_CASES_6 = [(2.0, k, mu) for mu in (0.5, 1.0) for k in _GRADIENTS]
#: Ranges of displacement and load of each panel.
_RANGES_4 = {
    1.0: ((-5.0, 13.0), (-17.5, 2.5)),
    1.5: ((-5.0, 6.0), (-3.6, 1.0)),
    2.0: ((-6.0, 6.0), (-2.15, 0.6)),
    5.0: ((-7.0, 4.0), (-1.75, 0.5)),
}
_RANGES_6 = {0.5: ((-4.0, 1.5), (-2.15, 0.8)), 1.0: ((-4.0, 2.5), (-2.15, 0.8))}


def _tasks(cases: Iterable[tuple[float, float, float]]) -> Sequence[CachedCall]:
    # The cone and large Tabor numbers take longest.
    return [CachedCall.of(curve, "fscm", *case) for case in sorted(cases, key=lambda case: (case[0], -case[2]))]


def _tables(cases: Iterable[tuple[float, float, float]], results: Results) -> Tables:
    parts = []
    for n, k, mu in cases:
        found = results[CachedCall.of(curve, "fscm", n, k, mu)]
        if found["status"] == "ok":
            points = {name: found[name] for name in ("displacement", "u_displacement", "load", "u_load")}
            parts.append(pd.DataFrame({"n": n, "k": k, "mu": mu, "status": "ok"} | points))
        else:
            parts.append(pd.DataFrame([{"n": n, "k": k, "mu": mu, "status": found["status"]}]))
    return {"": pd.concat(parts, ignore_index=True)}


def _family(axes: Axes, curves: pd.DataFrame, name: str, symbol: str, values: Sequence[float]) -> None:
    for index, value in enumerate(values):
        part = curves[curves[name] == value]
        label = f"{symbol} = {value:g}" + (" (Gibson)" if (name, value) == ("k", 1.0) else "")
        # Dashes would hide folds; markers at equal distances tell the curves apart in grey.
        style: dict[str, Any] = {
            "color": COLOURS[index],
            "marker": MARKERS[index],
            "ms": 3.0,
            "mfc": "white",
            "lw": 1.0,
        }
        axes.plot(part["displacement"], part["load"], markevery=(0.03 * (1 + index), 0.24), label=label, **style)
    axes.axhline(0.0, color="0.4", lw=0.8)


def _finish(figure: Figure, panels: Sequence[Axes], columns: int) -> None:
    for letter, axes in zip("abcd", panels, strict=False):
        lettered(axes, letter, axes.get_title())
        axes.set_title("")
    # Two panels a row.
    for axes in panels[-2:]:
        axes.set_xlabel(r"displacement $\delta/z_0$")
    for axes in panels[::2]:
        axes.set_ylabel(r"load $\bar P$")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=columns)


def _draw_4(tables: Tables) -> Figure:
    with styled():
        figure = Figure(figsize=(7.2, 6.0), layout="constrained")
        panels = figure.subplots(2, 2).ravel()
        for n, axes in zip(_SHAPES, panels, strict=True):
            curves = tables[""][tables[""]["n"] == n]
            _family(axes, curves, "mu", r"$\mu$", _TABOR_NUMBERS)
            axes.set(xlim=_RANGES_4[n][0], ylim=_RANGES_4[n][1], title=f"$n$ = {n:g}, $k$ = 0.4")
        _finish(figure, list(panels), len(_TABOR_NUMBERS))
    return figure


def _draw_6(tables: Tables) -> Figure:
    with styled():
        figure = Figure(figsize=(7.2, 3.6), layout="constrained")
        panels = figure.subplots(1, 2).ravel()
        for (mu, ranges), axes in zip(_RANGES_6.items(), panels, strict=True):
            _family(axes, tables[""][tables[""]["mu"] == mu], "k", "$k$", _GRADIENTS)
            axes.set(xlim=ranges[0], ylim=ranges[1], title=rf"$n$ = 2, $\mu$ = {mu:g}")
        _finish(figure, list(panels), len(_GRADIENTS))
    return figure


OVER_TABOR_NUMBERS = PaperFigure(
    name="4",
    stem="fig04_force_curves_over_tabor_numbers",
    title="Force-displacement curves for k = 0.4 and four shapes, over the Tabor number",
    tasks=lambda: _tasks(_CASES_4),
    tables=lambda results: _tables(_CASES_4, results),
    draw=_draw_4,
    follows_path=True,
)

OVER_GRADIENTS = PaperFigure(
    name="6",
    stem="fig06_force_curves_over_gradients",
    title="Force-displacement curves for n = 2, mu = 0.5 and 1, over the gradient exponent",
    tasks=lambda: _tasks(_CASES_6),
    tables=lambda results: _tables(_CASES_6, results),
    draw=_draw_6,
    follows_path=True,
)
