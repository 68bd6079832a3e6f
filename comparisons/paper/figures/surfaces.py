"""Figs. 5, 7 and 17: surface and pressure at pull-off, over Tabor numbers, gradient exponents and models."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH
from comparisons.output.style import MODEL_LINES
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, by_model, held, legend_below, level, line_a_value, of_model, panels
from comparisons.paper.paper_figure import Plan, Tables, lines_of, paper_figure
from comparisons.paper.solver_tasks import surface
from comparisons.paper.tasks import COHESIVE, cohesive_surface, profile, quantity

__all__ = ["fig05_pull_off_over_tabor_numbers", "fig07_pull_off_over_gradients", "fig17_surface_models"]

_TABOR_NUMBERS = (0.1, 0.3, 0.5, 1.0, 2.0, 3.0)
#: k = 1 is the Gibson limit.
_GRADIENTS = (0.0, 0.2, 0.4, 0.6, 1.0)
_N, _K, _MU = 2.0, 0.4, 1.0
_PUNCH: Any = {"lw": 0.6, "ls": (0, (6, 3)), "label": "_"}
#: How a and c of each model are written: the side of the text that is at the line, and a height without other texts.
_MARKS = {
    ("md-original", "contact_radius"): (r"$a_\mathrm{orig}$", "left", 0.09),
    ("md-original", "cohesive_radius"): (r"$c_\mathrm{orig}$", "right", 0.02),
    ("md-improved", "contact_radius"): (r"$a_\mathrm{impr}$", "right", 0.02),
    ("md-improved", "cohesive_radius"): (r"$c_\mathrm{impr}$", "left", 0.02),
}


def _surfaces(cases: Iterable[tuple[float, float, float]]) -> Plan[Tables]:
    results = yield {case: CachedCall.of(surface, *case) for case in cases}
    parts = []
    for (n, k, mu), shape in sorted(results.items()):
        profile_rows = pd.DataFrame({"n": n, "k": k, "mu": mu} | shape)
        parts.append(profile_rows.assign(punch=profile_rows["radius"] ** n / n - profile_rows["displacement"]))
    return {"": pd.concat(parts, ignore_index=True)}


def _draw(figure: Figure, table: pd.DataFrame, name: str, words: str, farthest: float, top: float) -> None:
    left, right = panels(figure, 1, 2, (words, words), LABELS["radius"], sharex=True)
    line_a_value(left, table, name, "radius", "deformation", -1.0)
    line_a_value(left, table, name, "radius", "punch", **_PUNCH)
    line_a_value(right, table, name, "radius", "pressure")
    level(right, -THEORETICAL_STRENGTH, ls="--")
    corner = (farthest, -THEORETICAL_STRENGTH)
    right.annotate(r"$-\sigma_{\mathrm{th}}$", corner, (-4, 3), textcoords="offset points", ha="right")
    left.set(xlim=(0.0, farthest), ylim=(-0.2, top), ylabel=LABELS["height"])
    right.set(ylabel=LABELS["pressure"])
    left.plot([], [], color="0.4", **_PUNCH | {"label": r"punch $f-\delta$"})
    legend_below(figure, 4)


def _over_tabor_numbers(figure: Figure, tables: Tables) -> None:
    _draw(figure, tables[""], "mu", held(n=_N, k=_K), 5.0, 6.2)


@paper_figure(_over_tabor_numbers, size=(7.2, 3.7), follows_path=True)
def fig05_pull_off_over_tabor_numbers() -> Plan[Tables]:
    """Surface and pressure at pull-off for n = 2, k = 0.4, over the Tabor number."""
    return (yield from _surfaces((_N, _K, mu) for mu in _TABOR_NUMBERS))


def _over_gradients(figure: Figure, tables: Tables) -> None:
    _draw(figure, tables[""], "k", held(n=_N, mu=_MU), 4.0, 2.0)


@paper_figure(_over_gradients, size=(7.2, 3.7), follows_path=True)
def fig07_pull_off_over_gradients() -> Plan[Tables]:
    """Surface and pressure at pull-off for n = 2, mu = 1, over the gradient exponent."""
    return (yield from _surfaces((_N, k, _MU) for k in _GRADIENTS))


def _over_models(figure: Figure, tables: Tables) -> None:
    words = held(n=_N, k=_K, mu=_MU)
    left, right = panels(figure, 1, 2, (words, words), LABELS["radius"], sharex=True)
    by_model(left, tables[""], "radius", "height")
    by_model(right, tables[""], "radius", "pressure")
    (exact,) = of_model(tables[""], "fscm")
    left.plot(exact["radius"], exact["punch"], color="0.45", ls=":", lw=0.9, label="punch (FSCM)")
    level(right)
    left.set(xlim=(0.0, 3.0), ylim=(0.0, 1.75), ylabel=LABELS["height"])
    right.set(ylabel=LABELS["pressure"])
    radii = tables["radii"].set_index("model")
    for (model, name), (text, side, height) in _MARKS.items():
        style = MODEL_LINES[model]
        for axes, at in ((left, height), (right, 0.93 - height)):
            axes.axvline(radii.loc[model, name], color=style["color"], ls=style["ls"], lw=0.6)
            style_of_text: Any = {"color": style["color"], "fontsize": 8, "ha": side, "clip_on": True}
            axes.text(radii.loc[model, name], at, f" {text} ", transform=axes.get_xaxis_transform(), **style_of_text)
    legend_below(figure, 4)


@paper_figure(_over_models, size=(7.2, 3.7), follows_path=True)
def fig17_surface_models() -> Plan[Tables]:
    """Surface and pressure at pull-off of both Maugis-Dugdale models and the FSCM; n = 2, k = 0.4, mu = 1."""
    case = (_N, _K, _MU)
    calls = {"fscm": CachedCall.of(profile, "fscm", *case)}
    calls |= {model: CachedCall.of(cohesive_surface, model, *case) for model in COHESIVE}
    results = yield calls | {"": CachedCall.of(quantity, "fscm", "pull_off_displacement", *case)}
    parts = []
    for model in calls:
        # The closed form is good to rounding.
        shape = {"displacement": results[""]["value"], "u_distance": 0.0} | results[model]
        table = lines_of({"model": model}, shape, ("radius", "gap", "pressure"))
        punch = table["radius"] ** _N / _N - shape["displacement"]
        # The height of the deformed surface, -w = f - delta - H (Eq. 4).
        parts.append(table.assign(height=punch - table["gap"], punch=punch, u_distance=shape["u_distance"]))
    radii = [{"model": model} | {name: results[model][name] for _, name in list(_MARKS)[:2]} for model in COHESIVE]
    return {"": pd.concat(parts, ignore_index=True), "radii": pd.DataFrame(radii)}
