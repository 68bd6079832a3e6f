"""Figs. 5, 7 and 17: surface and pressure at pull-off, over Tabor numbers, gradient exponents and models."""

from __future__ import annotations

from functools import partial
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH
from comparisons.output.style import COLOURS, MODEL_LINES
from comparisons.paper.drawing import LABELS, by_model, case, legend_below, level, lines_by, of_model, panels
from comparisons.paper.paper_figure import Tables, paper_figure
from comparisons.paper.plan import Plan, cases, result_of, rows_of, table_of, together
from comparisons.paper.tasks import COHESIVE, GRADIENTS, cohesive_surface, profile, quantity, surface

#: Of the surfaces at pull-off.
_TABOR_NUMBERS = (0.1, 0.3, 0.5, 1.0, 2.0, 3.0)
_CASE = {"n": 2.0, "k": 0.4, "mu": 1.0}
_N, _K, _MU = _CASE.values()
#: Radii at which surfaces are subtracted.
_RADII = np.linspace(0.02, 3.0, 150)
_PUNCH: Any = {"lw": 0.6, "ls": (0, (6, 3)), "label": "_"}


def _surfaces(keys: list[dict[str, Any]]) -> Plan[Tables]:
    def with_punch(table: pd.DataFrame) -> pd.DataFrame:
        return table.assign(punch=table["radius"] ** _N / _N - table["displacement"])

    return together({"": rows_of(surface, keys).then(with_punch)})


def _draw(figure: Figure, table: pd.DataFrame, name: str, words: str, farthest: float, top: float) -> None:
    left, right = panels(figure, (words, words), "radius", sharex=True)
    lines_by(left, table, name, "radius", "deformation", -1.0)
    lines_by(left, table, name, "radius", "punch", **_PUNCH)
    lines_by(right, table, name, "radius", "pressure")
    level(right, -THEORETICAL_STRENGTH, ls="--")
    corner = (farthest, -THEORETICAL_STRENGTH)
    right.annotate(r"$-\sigma_{\mathrm{th}}$", corner, (-4, 3), textcoords="offset points", ha="right")
    left.set(xlim=(0.0, farthest), ylim=(-0.2, top), ylabel=LABELS["height"])
    right.set(ylabel=LABELS["pressure"])
    left.plot([], [], color="0.4", **_PUNCH | {"label": r"punch $f-\delta$"})
    legend_below(figure, 4)


_over_tabor_numbers = partial(_draw, name="mu", words=case(n=_N, k=_K), farthest=5.0, top=6.2)
_over_gradients = partial(_draw, name="k", words=case(n=_N, mu=_MU), farthest=4.0, top=2.0)


@paper_figure(_over_tabor_numbers, size=(7.2, 3.7), follows_path=True)
def fig05_pull_off_over_tabor_numbers() -> Plan[Tables]:
    """Surface and pressure at pull-off for n = 2, k = 0.4, over the Tabor number."""
    return _surfaces(cases(n=[_N], k=[_K], mu=_TABOR_NUMBERS))


@paper_figure(_over_gradients, size=(7.2, 3.7), follows_path=True)
def fig07_pull_off_over_gradients() -> Plan[Tables]:
    """Surface and pressure at pull-off for n = 2, mu = 1, over the gradient exponent."""
    return _surfaces(cases(n=[_N], k=(*GRADIENTS, 1.0), mu=[_MU]))


def _shapes(*references: str) -> Plan[dict[str, dict[str, Any]]]:
    """Plan the surface of each reference and Maugis-Dugdale model at pull-off, with its displacement."""
    plans: dict[Any, Plan[Any]] = {model: result_of(profile, model, **_CASE) for model in references}
    plans |= {model: result_of(cohesive_surface, model, **_CASE) for model in COHESIVE}
    plans |= {(model,): result_of(quantity, model, "pull_off_displacement", **_CASE) for model in references}

    def make(results: dict[Any, Any]) -> dict[str, dict[str, Any]]:
        at = {model: {"displacement": results[model,]["value"]} for model in references}
        return {model: {"model": model} | results[model] | at.get(model, {}) for model in (*references, *COHESIVE)}

    return together(plans).then(make)


def _radii(shapes: dict[str, dict[str, Any]]) -> pd.DataFrame:
    return pd.DataFrame([shapes[model] for model in COHESIVE])[["model", "contact_radius", "cohesive_radius"]]


def _over_models(figure: Figure, table: pd.DataFrame, radii: pd.DataFrame) -> None:
    left, right = panels(figure, (case(**_CASE),) * 2, "radius", sharex=True)
    by_model(left, table, "radius", "height")
    by_model(right, table, "radius", "pressure")
    (exact,) = of_model(table, "fscm")
    left.plot(exact["radius"], exact["punch"], color="0.45", ls=":", lw=0.9, label="punch (fscm)")
    level(right)
    left.set(xlim=(0.0, 3.0), ylim=(0.0, 1.75), ylabel=LABELS["height"])
    right.set(ylabel=LABELS["pressure"])
    for model, *edges in radii.itertuples(index=False):
        for axes, edge in product((left, right), edges):
            axes.axvline(edge, color=MODEL_LINES[model]["color"], ls=MODEL_LINES[model]["ls"], lw=0.6)
    legend_below(figure, 4, title="vertical: contact radius $a$ and cohesive radius $c$", title_fontsize=8)


@paper_figure(_over_models, size=(7.2, 3.7), follows_path=True)
def fig17_surface_models() -> Plan[Tables]:
    """Surface and pressure at pull-off of both Maugis-Dugdale models and the FSCM; n = 2, k = 0.4, mu = 1."""
    return _shapes("fscm").then(_beside_the_punch)


def _beside_the_punch(shapes: dict[str, dict[str, Any]]) -> Tables:
    names = ("model", "radius", "gap", "pressure", "displacement")
    # The closed form is good to rounding.
    table = table_of(
        {name: shape[name] for name in names} | {"u_distance": shape.get("u_distance", 0.0)}
        for shape in shapes.values()
    )
    punch = table["radius"] ** _N / _N - table["displacement"]
    # The height of the deformed surface, -w = f - delta - H (Eq. 4).
    heights = {"height": punch - table["gap"], "punch": punch, "u_distance": table.pop("u_distance")}
    return {"": table.drop(columns="displacement").assign(**heights), "radii": _radii(shapes)}


def _inside(figure: Figure, table: pd.DataFrame, radii: pd.DataFrame) -> None:
    heights = table.pivot(index="radius", columns="model", values="gap_and_displacement")
    axes = figure.subplots()
    for model in COHESIVE:
        axes.plot(heights.index, heights[model] - heights["fscm"], label=model, **MODEL_LINES[model])
    axes.plot(heights.index, heights["fem"] - heights["fscm"], color=COLOURS[0], lw=0.9, ls=":", label="fem")
    level(axes)
    inner = radii["contact_radius"].min()
    axes.axvspan(0.0, inner, color="0.5", alpha=0.12, lw=0)
    position = (0.5 * inner, 0.93)
    axes.annotate("contact of both models", position, xycoords=("data", "axes fraction"), ha="center", fontsize=8)
    axes.set(xlim=(0.0, 3.0), xlabel=LABELS["radius"], ylabel=r"difference of the surfaces from fscm, in $z_0$")
    axes.legend(loc="upper right", fontsize=8)


@paper_figure(_inside, size=(5.4, 3.6), follows_path=True)
def finding_surface_inside() -> Plan[Tables]:
    """Difference of the surfaces of both Maugis-Dugdale models from the FSCM; n = 2, k = 0.4, mu = 1."""
    return _shapes("fscm", "fem").then(_at_common_radii)


def _at_common_radii(shapes: dict[str, dict[str, Any]]) -> Tables:
    rows = []
    for model, shape in shapes.items():
        # H + delta is the height of the surface below the punch's tip, w + f (Eq. 4).
        height = np.interp(_RADII, shape["radius"], shape["gap"]) + shape["displacement"]
        rows.append({"model": model, "radius": _RADII.tolist(), "gap_and_displacement": height.tolist()})
    return {"": table_of(rows), "radii": _radii(shapes)}
