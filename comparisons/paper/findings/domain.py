"""Finding: the attraction beyond f = 50 z0 is several percent of the pull-off force of a cone."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, styled
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.statements.sources import number, tasks_of
from comparisons.paper.values.scheme_ingredients import scheme_force

__all__ = ["DOMAIN"]

_CASES = ((1.0, 0.4, 0.01), (1.5, 0.4, 0.01), (2.0, 0.4, 0.668), (5.0, 0.4, 0.246))
_FEM = _CASES[:2]
_FORCE = "pull_off_force"
_LIMIT = 0.1


def _references(case: tuple[float, float, float]) -> tuple[str, ...]:
    return ("fscm", "fem") if case in _FEM else ("fscm",)


def _tasks() -> Sequence[CachedCall]:
    calls = [CachedCall.of(scheme_force, *case) for case in _CASES]
    return [*calls, *(call for case in _CASES for model in _references(case) for call in tasks_of(model, _FORCE, case))]


def _tables(results: Results) -> Tables:
    rows = []
    for case in _CASES:
        scheme = results[CachedCall.of(scheme_force, *case)]
        for model in _references(case):
            exact = number(results, model, _FORCE, case)
            rows.append(
                {"reference": model}
                | dict(zip(("n", "k", "mu"), case, strict=True))
                | {"force": exact.value, "u_force": exact.u, "scheme": scheme["force"], "u_scheme": scheme["u_num"]}
                | {
                    "lacking": abs(1.0 - scheme["force"] / exact.value),
                    "u_lacking": (scheme["u_num"] + exact.u) / exact.value,
                }
            )
    return {"": pd.DataFrame(rows)}


def _draw(tables: Tables) -> Figure:
    table = tables[""]
    with styled():
        figure = Figure(figsize=(5.0, 3.4), layout="constrained")
        axes = figure.subplots()
        exact, fem = (table[table["reference"] == model] for model in ("fscm", "fem"))
        places = {n: place for place, n in enumerate(exact["n"])}
        axes.bar(
            list(places.values()), 100.0 * exact["lacking"], 0.5, color=COLOURS[0], alpha=0.6, label="against fscm"
        )
        axes.plot(
            fem["n"].map(places), 100.0 * fem["lacking"], ls="none", marker="x", ms=8, color="0.2", label="against fem"
        )
        axes.axhline(_LIMIT, color=COLOURS[1], lw=1.0, ls="--", label="0.1 %")
        axes.set(yscale="log", ylim=(1e-3, 10.0), ylabel="pull-off force that the scheme lacks (%)")
        axes.set_xticks(
            list(places.values()),
            [f"$n$ = {n:g}\n$\\mu$ = {mu:g}" for n, mu in zip(exact["n"], exact["mu"], strict=True)],
        )
        axes.legend()
    return figure


DOMAIN = PaperFigure(
    name="finding-domain",
    stem="finding_domain",
    title="Pull-off force that the scheme with f(r_max) = 50 lacks, k = 0.4",
    tasks=_tasks,
    tables=_tables,
    draw=_draw,
)
