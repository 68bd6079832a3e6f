"""Finding: the displacement at jump-out is not proportional to the Tabor number for sharp punches."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, LINES, MARKERS, styled
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.statements.sources import number, tasks_of

__all__ = ["JUMP_OUT"]

_K, _NAME = 0.0, "jump_out_displacement"
_SHAPES = (1.0, 1.5, 2.0, 5.0)
_TABOR_NUMBERS = (1.25, 1.5, 2.0, 3.0, 5.0)
_FEM = (1.5, 3.0)


def _cases() -> list[tuple[str, tuple[float, float, float]]]:
    fscm = [("fscm", (n, _K, mu)) for n in _SHAPES for mu in _TABOR_NUMBERS]
    fem = [("fem", (n, _K, mu)) for n in _SHAPES for mu in _FEM]
    return [*fscm, *fem, *(("jkr", (n, _K, 1.0)) for n in _SHAPES)]


def _tasks() -> Sequence[CachedCall]:
    return [call for model, case in _cases() for call in tasks_of(model, _NAME, case)]


def _tables(results: Results) -> Tables:
    rows: list[dict[str, Any]] = []
    for model, case in _cases():
        found = number(results, model, _NAME, case)
        values = {"displacement": found.value, "u_displacement": found.u, "over_mu": -found.value / case[2]}
        rows.append({"model": model, **dict(zip(("n", "k", "mu"), case, strict=True)), **values})
    return {"": pd.DataFrame(rows)}


def _draw(tables: Tables) -> Figure:
    table = tables[""]
    with styled():
        figure = Figure(figsize=(5.0, 3.6), layout="constrained")
        axes = figure.subplots()
        for index, n in enumerate(_SHAPES):
            exact, fem, jkr = (table[(table["n"] == n) & (table["model"] == m)] for m in ("fscm", "fem", "jkr"))
            style = {"color": COLOURS[index], "ls": LINES[index], "marker": MARKERS[index], "ms": 3.5}
            axes.plot(exact["mu"], exact["over_mu"], label=f"fscm, $n$ = {n:g}", **style)
            axes.plot(fem["mu"], fem["over_mu"], ls="none", marker="x", ms=7, color="0.2")
            axes.axhline(float(jkr["over_mu"].iloc[0]), color=COLOURS[index], lw=0.7, ls=":")
        axes.plot([], [], ls="none", marker="x", ms=7, color="0.2", label="fem")
        axes.plot([], [], color="0.4", lw=0.7, ls=":", label=r"$C^{\mathrm{out}}$ (Eq. 55)")
        axes.set(xlabel=r"Tabor number $\mu$", ylabel=r"$-\delta^{\mathrm{out}}/(\mu z_0)$", ylim=(0.8, 2.3))
        figure.legend(*axes.get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=8)
    return figure


JUMP_OUT = PaperFigure(
    name="finding-jump-out",
    stem="finding_jump_out",
    title="Displacement at jump-out over the Tabor number, k = 0",
    tasks=_tasks,
    tables=_tables,
    draw=_draw,
)
