"""Fig. 13: force-displacement curves of both Maugis-Dugdale models and of the FSCM."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.output.style import MODEL_LINES, MODEL_NAMES, lettered, styled
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.tasks import curve

__all__ = ["FORCE_CURVE_MODELS"]

_SHAPES = (1.0, 1.5, 2.0, 5.0)
_K, _MU = 0.4, 1.0
#: The picture ends to the left where the FSCM's load has faded to this share of the pull-off force.
_FAINT = 0.04


def _task(model: str, n: float) -> CachedCall:
    return CachedCall.of(curve, model, n, _K, _MU)


def _tasks() -> Sequence[CachedCall]:
    return [_task(model, n) for model in MODEL_LINES for n in _SHAPES]


def _tables(results: Results) -> Tables:
    parts = []
    for n in _SHAPES:
        for model in MODEL_LINES:
            found = results[_task(model, n)]
            shape = {"displacement": [np.nan], "load": [np.nan]} | {
                name: found[name] for name in ("displacement", "load") if name in found
            }
            bounds = {name: found.get(name, np.nan) for name in ("u_displacement", "u_load")}
            part = pd.DataFrame({"n": n, "k": _K, "mu": _MU, "model": model} | shape | bounds)
            parts.append(part.assign(status=found["status"], reason=found["reason"]))
    return {"": pd.concat(parts, ignore_index=True)}


def _draw(tables: Tables) -> Figure:
    with styled():
        figure = Figure(figsize=(7.2, 5.6), layout="constrained")
        for letter, axes, (n, of_shape) in zip(
            "abcd", figure.subplots(2, 2).flat, tables[""].groupby("n"), strict=True
        ):
            for model, style in MODEL_LINES.items():
                part = of_shape[of_shape["model"] == model]
                axes.plot(part["displacement"], part["load"], label=MODEL_NAMES[model], **style)
            exact = of_shape[of_shape["model"] == "fscm"]
            depth = -of_shape["load"].min()
            top = 0.35 * depth
            seen = exact[(exact["load"] < top) & (exact["load"].abs() > _FAINT * depth)]["displacement"]
            margin = 0.06 * (seen.max() - seen.min())
            axes.axhline(0, color="0.4", lw=0.8)
            axes.set(xlim=(seen.min() - margin, seen.max() + margin), ylim=(-1.12 * depth, top))
            axes.set(xlabel=r"displacement $\delta/z_0$", ylabel=r"load $\bar P$")
            lettered(axes, letter, rf"$n$ = {n:g}, $k$ = {_K:g}, $\mu$ = {_MU:g}")
        # Eqs. 66-69 hold in contact only; there both curves end.
        figure.legend(
            *figure.axes[0].get_legend_handles_labels(),
            loc="outside lower center",
            ncols=3,
            title="M-D-$n$-$k$ as far as there is contact, $a > 0$",
            title_fontsize=8,
        )
    return figure


FORCE_CURVE_MODELS = PaperFigure(
    name="13",
    stem="fig13_force_curve_models",
    title="Force-displacement curves of both Maugis-Dugdale models, which end at first contact, and the FSCM",
    tasks=_tasks,
    tables=_tables,
    draw=_draw,
    follows_path=True,
)
