"""Finding: errors of the Maugis-Dugdale pull-off forces at Tabor numbers from 1 on."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, MARKERS, lettered, styled
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.statements.closeness import relative_error
from comparisons.paper.statements.sources import number, tasks_of

__all__ = ["COHESIVE_ERRORS"]

_K = 0.4
_SHAPES = (1.0, 1.5, 2.0, 5.0)
_TABOR_NUMBERS = (1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0)
_MODELS = {"md-original": "--", "md-improved": "-"}
_FEM = ((1.0, 2.0), (1.5, 2.0), (5.0, 2.0), (5.0, 3.0))
_FORCE = "pull_off_force"


def _cases() -> list[tuple[str, tuple[float, float, float]]]:
    fscm = [("fscm", (n, _K, mu)) for n in _SHAPES for mu in _TABOR_NUMBERS]
    return [*fscm, *(("fem", (n, _K, mu)) for n, mu in _FEM)]


def _tasks() -> Sequence[CachedCall]:
    calls = [
        call
        for reference, case in _cases()
        for model in (reference, *_MODELS)
        for call in tasks_of(model, _FORCE, case)
    ]
    return list(dict.fromkeys(calls))


def _tables(results: Results) -> Tables:
    rows = []
    for reference, case in _cases():
        exact = number(results, reference, _FORCE, case)
        for model in _MODELS:
            error = relative_error(model, number(results, model, _FORCE, case), reference, exact)
            named = dict(zip(("n", "k", "mu"), case, strict=True))
            rows.append({"reference": reference, "model": model} | named | {"error": error.value, "u_error": error.u})
    return {"": pd.DataFrame(rows)}


def _draw(tables: Tables) -> Figure:
    table = tables[""]
    with styled():
        figure = Figure(figsize=(7.2, 3.6), layout="constrained")
        left, right = figure.subplots(1, 2)
        for axes, shapes in ((left, _SHAPES), (right, (5.0,))):
            for n in shapes:
                index = _SHAPES.index(n)
                for model, line in _MODELS.items():
                    of_model = table[(table["n"] == n) & (table["model"] == model)]
                    exact, fem = (of_model[of_model["reference"] == name] for name in ("fscm", "fem"))
                    label = f"{model.removeprefix('md-')}, $n$ = {n:g}"
                    style = {"color": COLOURS[index], "marker": MARKERS[index], "ms": 3}
                    axes.plot(exact["mu"], 100.0 * exact["error"], ls=line, label=label, **style)
                    axes.plot(fem["mu"], 100.0 * fem["error"], ls="none", marker="x", ms=8, color="0.2")
            axes.set(xlabel=r"Tabor number $\mu$")
        left.axhline(2.0, color="0.5", lw=0.8, ls=":")
        left.set(xscale="log", yscale="log")
        left.set(ylabel="relative error of the pull-off force (%)", ylim=(0.05, 30.0))
        right.set(xlim=(1.4, 4.0), ylim=(0.0, 4.5))
        left.plot([], [], ls="none", marker="x", ms=8, color="0.2", label="against fem")
        lettered(left, "a", f"$k$ = {_K:g}")
        lettered(right, "b", f"$n$ = 5, $k$ = {_K:g}")
        figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=5, fontsize=7)
    return figure


COHESIVE_ERRORS = PaperFigure(
    name="finding-cohesive-errors",
    stem="finding_cohesive_errors",
    title="Errors of both Maugis-Dugdale pull-off forces from mu = 1 on, k = 0.4",
    tasks=_tasks,
    tables=_tables,
    draw=_draw,
)
