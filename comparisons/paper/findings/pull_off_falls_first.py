"""Finding: at n = 1.5 the pull-off force falls first with the Tabor number, and so does its displacement."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, LINES, lettered, styled
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.tasks import quantity

__all__ = ["PULL_OFF_FALLS_FIRST"]

_N = 1.5
_GRADIENTS = (0.0, 0.2, 0.4, 0.6)
_TABOR_NUMBERS = (0.01, 0.03, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 0.7, 1.0)
_FEM = ((0.0, 0.01), (0.0, 0.3), (0.4, 0.01), (0.4, 0.05))
_DISPLACEMENT_NUMBERS = (0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.3)
_FEM_DISPLACEMENTS = ((0.4, 0.01), (0.4, 0.1))


def _cases() -> list[tuple[str, str, float, float]]:
    force, place = "pull_off_force", "pull_off_displacement"
    return [
        *(("fscm", force, k, mu) for k in _GRADIENTS for mu in _TABOR_NUMBERS),
        *(("fem", force, k, mu) for k, mu in _FEM),
        *(("fscm", place, 0.4, mu) for mu in _DISPLACEMENT_NUMBERS),
        *(("fem", place, k, mu) for k, mu in _FEM_DISPLACEMENTS),
    ]


def _tasks() -> Sequence[CachedCall]:
    return [CachedCall.of(quantity, model, name, _N, k, mu) for model, name, k, mu in _cases()]


def _tables(results: Results) -> Tables:
    rows = [
        {"model": model, "quantity": name, "n": _N, "k": k, "mu": mu}
        | results[CachedCall.of(quantity, model, name, _N, k, mu)]
        for model, name, k, mu in _cases()
    ]
    return {"": pd.DataFrame(rows)}


def _draw(tables: Tables) -> Figure:
    table = tables[""]
    with styled():
        figure = Figure(figsize=(7.2, 3.4), layout="constrained")
        left, right = figure.subplots(1, 2)
        for axes, name, gradients in (
            (left, "pull_off_force", _GRADIENTS),
            (right, "pull_off_displacement", (0.4,)),
        ):
            of_name = table[table["quantity"] == name]
            for k in gradients:
                index = _GRADIENTS.index(k)
                part = of_name[(of_name["k"] == k) & (of_name["model"] == "fscm")]
                axes.plot(part["mu"], part["value"], color=COLOURS[index], ls=LINES[index], label=f"fscm, $k$ = {k:g}")
            fem = of_name[of_name["model"] == "fem"]
            axes.plot(fem["mu"], fem["value"], ls="none", marker="x", ms=6, color="0.2", zorder=3, label="fem")
            axes.set(xscale="log", xlabel=r"Tabor number $\mu$")
        left.set(ylabel=r"pull-off force $-\bar P_c$", ylim=(2.1, 2.3))
        right.set(ylabel=r"displacement at pull-off $\delta_c/z_0$")
        lettered(left, "a", f"$n$ = {_N:g}")
        lettered(right, "b", f"$n$ = {_N:g}, $k$ = 0.4")
        figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=5)
    return figure


PULL_OFF_FALLS_FIRST = PaperFigure(
    name="finding-falls-first",
    stem="finding_falls_first",
    title="Pull-off force and its displacement at n = 1.5, which fall before they rise",
    tasks=_tasks,
    tables=_tables,
    draw=_draw,
)
