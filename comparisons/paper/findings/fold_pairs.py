"""Finding: the path turns back more than twice, already in the case of Fig. 3."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, LINES, lettered, styled
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.statements.paths import turning_points
from comparisons.paper.tasks import curve

__all__ = ["FOLD_PAIRS"]

_CASES = ((2.0, 0.4, 3.0), (2.0, 0.6, 3.0))
#: Central gaps and displacements of the part with the additional turning points.
_GAPS = (0.0, 2.6)
_DISPLACEMENTS = ((-3.36, -3.22), (-3.36, -3.32))


def _tasks() -> Sequence[CachedCall]:
    return [CachedCall.of(curve, model, *case) for model in ("fscm", "fem") for case in _CASES]


def _tables(results: Results) -> Tables:
    parts = []
    for case in _CASES:
        for model in ("fscm", "fem"):
            path = results[CachedCall.of(curve, model, *case)]
            displacement = np.array(path["displacement"])
            turns = np.zeros(len(displacement), bool)
            turns[turning_points(displacement, path["u_displacement"])] = True
            columns = {"central_gap": path["columns"]["central_gap"], "displacement": displacement}
            bound = {"u_displacement": path["u_displacement"], "turning_point": turns}
            named = dict(zip(("n", "k", "mu"), case, strict=True))
            parts.append(pd.DataFrame({"model": model} | named | columns | bound))
    return {"": pd.concat(parts, ignore_index=True)}


def _draw(tables: Tables) -> Figure:
    with styled():
        figure = Figure(figsize=(7.2, 3.4), layout="constrained")
        panels = figure.subplots(1, 2)
        for letter, axes, case, limits in zip("ab", panels, _CASES, _DISPLACEMENTS, strict=True):
            table = tables[""][(tables[""]["k"] == case[1])]
            exact, fem = (table[table["model"] == model] for model in ("fscm", "fem"))
            axes.plot(exact["central_gap"], exact["displacement"], color=COLOURS[0], ls=LINES[0], label="fscm")
            axes.plot(
                fem["central_gap"], fem["displacement"], ls="none", marker="x", ms=4, color=COLOURS[1], label="fem"
            )
            turns = exact[exact["turning_point"]]
            axes.plot(
                turns["central_gap"],
                turns["displacement"],
                ls="none",
                marker="o",
                mfc="white",
                color=COLOURS[2],
                label="turning points",
            )
            axes.set(xlim=_GAPS, ylim=limits, xlabel=r"central gap $H_0/z_0$", ylabel=r"displacement $\delta/z_0$")
            lettered(axes, letter, r"$n$ = {:g}, $k$ = {:g}, $\mu$ = {:g}".format(*case))
        figure.legend(*panels[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


FOLD_PAIRS = PaperFigure(
    name="finding-fold-pairs",
    stem="finding_fold_pairs",
    title="Additional turning points of the displacement at mu = 3",
    tasks=_tasks,
    tables=_tables,
    draw=_draw,
    follows_path=True,
)
