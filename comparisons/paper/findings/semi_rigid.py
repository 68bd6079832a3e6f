"""Finding: at jump-in the deformation is as large as the gap, and the asymptote keeps an error of several percent."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, LINES, MARKERS, lettered, styled
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.statements.closeness import relative_error
from comparisons.paper.statements.sources import number, tasks_of

__all__ = ["SEMI_RIGID"]

_K = 0.4
_SHAPES = (1.0, 1.5, 2.0, 5.0)
_TABOR_NUMBERS = (1.25, 1.5, 2.0, 3.0, 5.0)
_FEM_MU = 3.0
_SHARE, _PLACE = "jump_in_deformation", "jump_in_displacement"


def _cases() -> list[tuple[str, tuple[float, float, float]]]:
    fscm = [("fscm", (n, _K, mu)) for n in _SHAPES for mu in _TABOR_NUMBERS]
    return [*fscm, *(("fem", (n, _K, _FEM_MU)) for n in _SHAPES)]


def _tasks() -> Sequence[CachedCall]:
    calls = [
        call
        for model, case in _cases()
        for call in (*tasks_of(model, _SHARE, case), *tasks_of("semi-rigid", _PLACE, case))
    ]
    return list(dict.fromkeys(calls))


def _tables(results: Results) -> Tables:
    rows = []
    for model, case in _cases():
        share = number(results, model, _SHARE, case)
        exact, closed = (number(results, one, _PLACE, case) for one in (model, "semi-rigid"))
        error = relative_error("semi-rigid", closed, model, exact)
        rows.append(
            {"reference": model}
            | dict(zip(("n", "k", "mu"), case, strict=True))
            | {"deformation": share.value, "u_deformation": share.u, "error": error.value, "u_error": error.u}
        )
    return {"": pd.DataFrame(rows)}


def _draw(tables: Tables) -> Figure:
    table = tables[""]
    with styled():
        figure = Figure(figsize=(7.2, 3.4), layout="constrained")
        left, right = figure.subplots(1, 2)
        for axes, column, scale in ((left, "deformation", 1.0), (right, "error", 100.0)):
            for index, n in enumerate(_SHAPES):
                exact, fem = (table[(table["n"] == n) & (table["reference"] == m)] for m in ("fscm", "fem"))
                style = {"color": COLOURS[index], "ls": LINES[index], "marker": MARKERS[index], "ms": 3.5}
                axes.plot(exact["mu"], scale * exact[column], label=f"fscm, $n$ = {n:g}", **style)
                axes.plot(fem["mu"], scale * fem[column], ls="none", marker="x", ms=8, color="0.2")
            axes.plot([], [], ls="none", marker="x", ms=8, color="0.2", label="fem")
            axes.set(xlabel=r"Tabor number $\mu$", ylim=(0.0, None))
        left.set_ylabel(r"deformation over gap at jump-in, $|w(0)|/H_0$")
        right.set_ylabel("error of the asymptote of jump-in (%)")
        lettered(left, "a", f"$k$ = {_K:g}")
        lettered(right, "b", f"$k$ = {_K:g}")
        figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=5)
    return figure


SEMI_RIGID = PaperFigure(
    name="finding-semi-rigid",
    stem="finding_semi_rigid",
    title="Deformation at jump-in, and the error of the asymptote that neglects it",
    tasks=_tasks,
    tables=_tables,
    draw=_draw,
)
