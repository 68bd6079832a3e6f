"""Fig. 13: force-displacement curves of both Maugis-Dugdale models and of the FSCM."""

from __future__ import annotations

import pandas as pd
from matplotlib.figure import Figure

from comparisons.output.style import MODEL_LINES, lettered
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, by_model, legend_below, level, of_model
from comparisons.paper.paper_figure import PaperFigure, Plan, Tables, lines_of
from comparisons.paper.tasks import curve

__all__ = ["FORCE_CURVE_MODELS"]

_SHAPES = (1.0, 1.5, 2.0, 5.0)
_K, _MU = 0.4, 1.0
#: The picture ends to the left where the FSCM's load has faded to this share of the pull-off force.
_FAINT = 0.04


def _plan() -> Plan[Tables]:
    calls = {(n, model): CachedCall.of(curve, model, n, _K, _MU) for n in _SHAPES for model in MODEL_LINES}
    results = yield list(calls.values())
    parts = []
    for (n, model), call in calls.items():
        key, found = {"n": n, "k": _K, "mu": _MU, "model": model}, results[call]
        part = lines_of(key, found, ["displacement", "load", "u_displacement", "u_load"])
        parts.append(part.assign(status=found["status"], reason=found["reason"]))
    return {"": pd.concat(parts, ignore_index=True)}


def _picture(figure: Figure, tables: Tables) -> None:
    panels = figure.subplots(2, 2).flat
    for letter, axes, (n, of_shape) in zip("abcd", panels, tables[""].groupby("n"), strict=True):
        by_model(axes, of_shape, "displacement", "load")
        (exact,) = of_model(of_shape, "fscm")
        depth = -of_shape["load"].min()
        top = 0.35 * depth
        seen = exact[(exact["load"] < top) & (exact["load"].abs() > _FAINT * depth)]["displacement"]
        margin = 0.06 * (seen.max() - seen.min())
        level(axes)
        axes.set(xlim=(seen.min() - margin, seen.max() + margin), ylim=(-1.12 * depth, top))
        axes.set(xlabel=LABELS["displacement"], ylabel=LABELS["load"])
        lettered(axes, letter, rf"$n$ = {n:g}, $k$ = {_K:g}, $\mu$ = {_MU:g}")
    # Eqs. 66-69 hold in contact only; there both curves end.
    legend_below(figure, 3, title="M-D-$n$-$k$ as far as there is contact, $a > 0$", title_fontsize=8)


FORCE_CURVE_MODELS = PaperFigure(
    name="13",
    stem="fig13_force_curve_models",
    title="Force-displacement curves of both Maugis-Dugdale models, which end at first contact, and the FSCM",
    plan=_plan,
    picture=_picture,
    size=(7.2, 5.6),
    follows_path=True,
)
