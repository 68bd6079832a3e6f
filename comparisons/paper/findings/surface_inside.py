"""Finding: inside the contact the surface of the original Maugis-Dugdale model is nearer on average."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, MODEL_LINES, MODEL_NAMES, styled
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.figures.fig17_surface_models import cohesive_surface
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.statements.sources import number, tasks_of
from comparisons.paper.tasks import profile

__all__ = ["SURFACE_INSIDE"]

_CASE = (2.0, 0.4, 1.0)
_MODELS = ("md-original", "md-improved")
_RADII = np.linspace(0.02, 3.0, 150)


def _tasks() -> Sequence[CachedCall]:
    exact = [CachedCall.of(profile, model, *_CASE) for model in ("fscm", "fem")]
    places = [call for model in ("fscm", "fem") for call in tasks_of(model, "pull_off_displacement", _CASE)]
    return [*exact, *places, *(CachedCall.of(cohesive_surface, model, *_CASE) for model in _MODELS)]


def _tables(results: Results) -> Tables:
    parts, radii = [], []
    for model in ("fscm", "fem", *_MODELS):
        if model in _MODELS:
            found = results[CachedCall.of(cohesive_surface, model, *_CASE)]
            displacement = found["displacement"]
            radii.append({"model": model} | {name: found[name] for name in ("contact_radius", "cohesive_radius")})
        else:
            found = results[CachedCall.of(profile, model, *_CASE)]
            displacement = number(results, model, "pull_off_displacement", _CASE).value
        # H + delta is the height of the surface below the punch's tip, w + f (Eq. 4).
        height = np.interp(_RADII, found["radius"], found["gap"]) + displacement
        parts.append(pd.DataFrame({"model": model, "radius": _RADII, "gap_and_displacement": height}))
    return {"": pd.concat(parts, ignore_index=True), "radii": pd.DataFrame(radii)}


def _draw(tables: Tables) -> Figure:
    table = tables[""].pivot(index="radius", columns="model", values="gap_and_displacement")
    with styled():
        figure = Figure(figsize=(5.4, 3.6), layout="constrained")
        axes = figure.subplots()
        for model in _MODELS:
            style = MODEL_LINES[model]
            axes.plot(table.index, table[model] - table["fscm"], label=MODEL_NAMES[model], **style)
        axes.plot(table.index, table["fem"] - table["fscm"], color=COLOURS[0], lw=0.9, ls=":", label="fem")
        axes.axhline(0.0, color="0.4", lw=0.8)
        inner = tables["radii"]["contact_radius"].min()
        axes.axvspan(0.0, inner, color="0.5", alpha=0.12, lw=0)
        axes.annotate(
            "contact of both models", (0.5 * inner, 0.93), xycoords=("data", "axes fraction"), ha="center", fontsize=8
        )
        axes.set(xlim=(0.0, 3.0), xlabel=r"radius $r/(Qz_0)^{1/n}$")
        axes.set_ylabel(r"difference of the surfaces from fscm, in $z_0$")
        axes.legend(loc="upper right", fontsize=8)
    return figure


SURFACE_INSIDE = PaperFigure(
    name="finding-surface-inside",
    stem="finding_surface_inside",
    title="Difference of the surfaces of both Maugis-Dugdale models from the FSCM; n = 2, k = 0.4, mu = 1",
    tasks=_tasks,
    tables=_tables,
    draw=_draw,
    follows_path=True,
)
