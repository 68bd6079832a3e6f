"""Fig. 17: surface and pressure at pull-off of both Maugis-Dugdale models and of the FSCM."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.models.maugis_dugdale import MaugisDugdaleImproved, MaugisDugdaleOriginal
from comparisons.output.style import MODEL_LINES, lettered
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, by_model, legend_below, level, of_model
from comparisons.paper.paper_figure import PaperFigure, Plan, Tables, lines_of
from comparisons.paper.tasks import profile, quantity
from comparisons.problem import Problem

__all__ = ["SURFACE_MODELS", "cohesive_surface"]

_N, _K, _MU = 2.0, 0.4, 1.0
_COHESIVE = {model.name: model for model in (MaugisDugdaleOriginal(), MaugisDugdaleImproved())}
_FARTHEST = 3.0


def cohesive_surface(model: str, n: float, k: float, mu: float) -> dict[str, Any]:
    """Return the surface of a Maugis-Dugdale model at pull-off.

    Returns
    -------
    dict
        ``contact_radius`` and ``cohesive_radius`` (a and c), ``displacement``; ``radius``, ``pressure``, ``gap`` as
        lists, in barred variables.

    Raises
    ------
    NotApplicable
        Where the cohesive zone has no width.

    Examples
    --------
    >>> found = cohesive_surface("md-improved", 2, 0.4, 1)
    >>> round(found["contact_radius"], 3), round(found["cohesive_radius"], 3)
    (1.264, 2.054)
    """
    found = _COHESIVE[model].profiles(Problem.dimensionless(n, k, mu))
    return {
        "contact_radius": found.contact_radius,
        "cohesive_radius": found.cohesive_radius,
        "displacement": found.displacement,
        "radius": found.radius.tolist(),
        "pressure": found.pressure.tolist(),
        "gap": found.gap.tolist(),
    }


def _plan() -> Plan[Tables]:
    exact = CachedCall.of(profile, "fscm", _N, _K, _MU)
    displacement = CachedCall.of(quantity, "fscm", "pull_off_displacement", _N, _K, _MU)
    calls = {model: CachedCall.of(cohesive_surface, model, _N, _K, _MU) for model in _COHESIVE}
    results = yield [exact, displacement, *calls.values()]
    # The closed form is good to rounding.
    found = {"fscm": results[exact] | {"displacement": results[displacement]["value"]}}
    found |= {model: {"u_distance": 0.0} | results[call] for model, call in calls.items()}
    names = ("contact_radius", "cohesive_radius")
    radii = [{"model": model} | {name: found[model][name] for name in names} for model in calls]
    parts = [_surface(model, shape) for model, shape in found.items()]
    return {"": pd.concat(parts, ignore_index=True), "radii": pd.DataFrame(radii)}


def _surface(model: str, found: dict[str, Any]) -> pd.DataFrame:
    """Return the profile with the height of the deformed surface, -w = f - delta - H (Eq. 4)."""
    table = lines_of({"model": model}, found, ("radius", "gap", "pressure"))
    punch = table["radius"] ** _N / _N - found["displacement"]
    return table.assign(height=punch - table["gap"], punch=punch, u_distance=found["u_distance"])


def _picture(figure: Figure, tables: Tables) -> None:
    left, right = figure.subplots(1, 2)
    by_model(left, tables[""], "radius", "height")
    by_model(right, tables[""], "radius", "pressure")
    (exact,) = of_model(tables[""], "fscm")
    left.plot(exact["radius"], exact["punch"], color="0.45", ls=":", lw=0.9, label="punch (FSCM)")
    level(right)
    left.set(ylabel=LABELS["height"], ylim=(0.0, 1.75))
    right.set(ylabel=LABELS["pressure"])
    for axes, letter, at in ((left, "a", 0.02), (right, "b", 0.98)):
        axes.set(xlabel=LABELS["radius"], xlim=(0, _FARTHEST))
        lettered(axes, letter, rf"$n$ = {_N:g}, $k$ = {_K:g}, $\mu$ = {_MU:g}")
        for model, a, c in tables["radii"].to_numpy():
            _mark(axes, float(a), "a", at, str(model))
            _mark(axes, float(c), "c", at, str(model))
    legend_below(figure, 4)


def _mark(axes: Axes, radius: float, letter: str, at: float, model: str) -> None:
    """Mark a or c of a model by a thin line in its colour, with its name on the side where no other line is near."""
    style = MODEL_LINES[model]
    axes.axvline(radius, color=style["color"], ls=style["ls"], lw=0.6)
    low, original = at < 0.5, model == "md-original"
    # From the left a and a of the improved and original, c of the original and improved: one slot holds two names.
    left = (letter == "a") != original
    up = 0.07 if original and letter == "a" else 0.0
    axes.annotate(
        rf"${letter}_{{\mathrm{{{'orig' if original else 'impr'}}}}}$",
        (radius, at + (up if low else -up)),
        (-2 if left else 2, 0),
        xycoords=axes.get_xaxis_transform(),
        textcoords="offset points",
        color=style["color"],
        fontsize=8,
        ha="right" if left else "left",
        va="bottom" if low else "top",
    )


SURFACE_MODELS = PaperFigure(
    name="17",
    stem="fig17_surface_models",
    title="Surface and pressure at pull-off of both Maugis-Dugdale models and the FSCM; n = 2, k = 0.4, mu = 1",
    plan=_plan,
    picture=_picture,
    size=(7.2, 3.7),
    follows_path=True,
)
