"""Fig. 17: surface and pressure at pull-off of both Maugis-Dugdale models and of the FSCM."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.models.maugis_dugdale import MaugisDugdaleImproved, MaugisDugdaleOriginal
from comparisons.output.style import MODEL_LINES, MODEL_NAMES, lettered, styled
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.tasks import profile, quantity
from comparisons.runs.cases import Case

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
    found = _COHESIVE[model].profiles(Case(n, k, mu).problem())
    return {
        "contact_radius": found.contact_radius,
        "cohesive_radius": found.cohesive_radius,
        "displacement": found.displacement,
        "radius": found.radius.tolist(),
        "pressure": found.pressure.tolist(),
        "gap": found.gap.tolist(),
    }


_FSCM = CachedCall.of(profile, "fscm", _N, _K, _MU)
_FSCM_DISPLACEMENT = CachedCall.of(quantity, "fscm", "pull_off_displacement", _N, _K, _MU)
_MD = {model: CachedCall.of(cohesive_surface, model, _N, _K, _MU) for model in _COHESIVE}


def _tasks() -> Sequence[CachedCall]:
    return [_FSCM, _FSCM_DISPLACEMENT, *_MD.values()]


def _tables(results: Results) -> Tables:
    shape = results[_FSCM]
    displacement = results[_FSCM_DISPLACEMENT]
    parts = [_surface("fscm", shape, displacement["value"], shape["u_distance"])]
    radii = []
    for model, call in _MD.items():
        found = results[call]
        # The closed form is good to rounding.
        parts.append(_surface(model, found, found["displacement"], 0.0))
        radii.append({"model": model, "contact_radius": found["contact_radius"]})
        radii[-1]["cohesive_radius"] = found["cohesive_radius"]
    return {"": pd.concat(parts, ignore_index=True), "radii": pd.DataFrame(radii)}


def _surface(model: str, found: dict[str, Any], displacement: float, u: float) -> pd.DataFrame:
    """Return the profile with the height of the deformed surface, -w = f - delta - H (Eq. 4)."""
    table = pd.DataFrame({name: found[name] for name in ("radius", "gap", "pressure")}).astype(float)
    table.insert(0, "model", model)
    table["height"] = table["radius"] ** _N / _N - displacement - table["gap"]
    table["punch"] = table["radius"] ** _N / _N - displacement
    return table.assign(u_distance=u)


def _draw(tables: Tables) -> Figure:
    with styled():
        figure = Figure(figsize=(7.2, 3.7), layout="constrained")
        left, right = figure.subplots(1, 2)
        for model, style in MODEL_LINES.items():
            part = tables[""][tables[""]["model"] == model]
            left.plot(part["radius"], part["height"], label=MODEL_NAMES[model], **style)
            right.plot(part["radius"], part["pressure"], **style)
        exact = tables[""][tables[""]["model"] == "fscm"]
        left.plot(exact["radius"], exact["punch"], color="0.45", ls=":", lw=0.9, label="punch (FSCM)")
        right.axhline(0, color="0.4", lw=0.8)
        for axes in (left, right):
            axes.set(xlabel=r"radius $r/(Qz_0)^{1/n}$", xlim=(0, _FARTHEST))
        left.set(ylabel=r"height of the surface $-w/z_0$", ylim=(0.0, 1.75))
        right.set(ylabel=r"pressure $p z_0/\Delta\gamma$")
        for letter, axes in (("a", left), ("b", right)):
            lettered(axes, letter, rf"$n$ = {_N:g}, $k$ = {_K:g}, $\mu$ = {_MU:g}")
        for axes, at in ((left, 0.02), (right, 0.98)):
            for model, a, c in tables["radii"].to_numpy():
                _mark(axes, float(a), "a", at, str(model))
                _mark(axes, float(c), "c", at, str(model))
        figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=4)
    return figure


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
    tasks=_tasks,
    tables=_tables,
    draw=_draw,
    follows_path=True,
)
