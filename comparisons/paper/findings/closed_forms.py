"""Findings on the closed forms: end of the small chi, errors of three models of the pull-off and of the jump-in."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, LINES, MARKERS, MODEL_LINES, MODEL_NAMES, lettered
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, crosses, dashed, legend_below, level, of_model
from comparisons.paper.figures.fig11_gradient_effect import insensitive_regions, largest_chi
from comparisons.paper.figures.fig17_surface_models import cohesive_surface
from comparisons.paper.paper_figure import PaperFigure, Plan, Tables
from comparisons.paper.statements.numbers import case_keys, number, numbers, relative_error, tasks_of
from comparisons.paper.tasks import profile
from comparisons.paper.values.causes import LAST_K

__all__ = ["CHI_RANGE", "COHESIVE_ERRORS", "SEMI_RIGID", "SURFACE_INSIDE"]

_CHI_SHAPES = np.linspace(6.213, 6.223, 11)
_LAST = (1.0, 0.9995, LAST_K)
_PRINTED, _LIMIT = 6.219, 10.0

#: Of all errors here.
_K = 0.4
_SHAPES = (1.0, 1.5, 2.0, 5.0)
_MODELS = {"md-original": "--", "md-improved": "-"}
_FORCES = [
    *(("fscm", (n, _K, mu)) for n in _SHAPES for mu in (1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0)),
    *(("fem", (n, _K, mu)) for n, mu in ((1.0, 2.0), (1.5, 2.0), (5.0, 2.0), (5.0, 3.0))),
]
_JUMPS = [
    *(("fscm", (n, _K, mu)) for n in _SHAPES for mu in (1.25, 1.5, 2.0, 3.0, 5.0)),
    *(("fem", (n, _K, 3.0)) for n in _SHAPES),
]
_CASE = (2.0, _K, 1.0)
_RADII = np.linspace(0.02, 3.0, 150)


def near_the_end(up_to: float) -> list[float]:
    """Return the largest chi over k, up to a last k, at the shapes of the figure.

    Examples
    --------
    >>> bool(near_the_end(1.0)[0] < 0.1 < near_the_end(1.0)[-1])
    True
    """
    return [largest_chi(float(n), up_to)[0] for n in _CHI_SHAPES]


def _chi_range() -> Plan[Tables]:
    functions = (near_the_end, insensitive_regions)
    calls = {last: [CachedCall.of(function, last) for function in functions] for last in _LAST}
    results = yield [call for of_last in calls.values() for call in of_last]
    parts = [
        pd.DataFrame({"last_k": last, "n": _CHI_SHAPES, "chi_max": results[near]}) for last, (near, _) in calls.items()
    ]
    ends = [{"last_k": last, "n_to": results[regions][3]} for last, (_, regions) in calls.items()]
    return {"": pd.concat(parts, ignore_index=True), "ends": pd.DataFrame(ends)}


def _draw_chi_range(figure: Figure, tables: Tables) -> None:
    axes = figure.subplots()
    for index, (last, end) in enumerate(tables["ends"].to_numpy()):
        part = tables[""][tables[""]["last_k"] == last]
        label = rf"$k \leq$ {last:g}: 10 % at $n$ = {end:.4f}"
        axes.plot(part["n"], 100.0 * part["chi_max"], label=label, marker="o", ms=3, **dashed(index))
    level(axes, _LIMIT, ls="--")
    axes.axvline(_PRINTED, color="0.4", lw=0.8, ls=":", label=f"printed: {_PRINTED}")
    axes.set(xlabel=LABELS["n"], ylabel=r"largest deviation $\chi_{\max}$ (%)")
    axes.legend()


CHI_RANGE = PaperFigure(
    name="finding-chi-range",
    stem="finding_chi_range",
    title="End of the second range of small chi, for three largest gradient exponents",
    plan=_chi_range,
    picture=_draw_chi_range,
    size=(5.0, 3.4),
)


def _cohesive_errors() -> Plan[Tables]:
    places = [(model, case) for reference, case in _FORCES for model in (reference, *_MODELS)]
    force = yield from numbers("pull_off_force", places)
    rows = []
    for reference, case in _FORCES:
        for model in _MODELS:
            error = relative_error(model, force[model, case], reference, force[reference, case])
            row: dict[str, Any] = {"reference": reference, "model": model} | case_keys(case)
            rows.append(row | {"error": error.value, "u_error": error.u})
    return {"": pd.DataFrame(rows)}


def _draw_cohesive_errors(figure: Figure, tables: Tables) -> None:
    left, right = figure.subplots(1, 2)
    for axes, shapes in ((left, _SHAPES), (right, (5.0,))):
        for n in shapes:
            index = _SHAPES.index(n)
            of_shape = tables[""][tables[""]["n"] == n]
            for part, (model, line) in zip(of_model(of_shape, *_MODELS), _MODELS.items(), strict=True):
                exact, fem = of_model(part, "fscm", "fem", column="reference")
                style = {"color": COLOURS[index], "marker": MARKERS[index], "ms": 3, "ls": line}
                label = f"{model.removeprefix('md-')}, $n$ = {n:g}"
                axes.plot(exact["mu"], 100.0 * exact["error"], label=label, **style)
                crosses(axes, fem["mu"], 100.0 * fem["error"])
        axes.set(xlabel=LABELS["mu"])
    left.axhline(2.0, color="0.5", lw=0.8, ls=":")
    left.set(xscale="log", yscale="log")
    left.set(ylabel="relative error of the pull-off force (%)", ylim=(0.05, 30.0))
    right.set(xlim=(1.4, 4.0), ylim=(0.0, 4.5))
    crosses(left, [], [], label="against fem")
    lettered(left, "a", f"$k$ = {_K:g}")
    lettered(right, "b", f"$n$ = 5, $k$ = {_K:g}")
    legend_below(figure, 5, fontsize=7)


COHESIVE_ERRORS = PaperFigure(
    name="finding-cohesive-errors",
    stem="finding_cohesive_errors",
    title="Errors of both Maugis-Dugdale pull-off forces from mu = 1 on, k = 0.4",
    plan=_cohesive_errors,
    picture=_draw_cohesive_errors,
    size=(7.2, 3.6),
)


def _semi_rigid() -> Plan[Tables]:
    share, place = "jump_in_deformation", "jump_in_displacement"
    calls = [
        call for model, case in _JUMPS for call in (*tasks_of(model, share, case), *tasks_of("semi-rigid", place, case))
    ]
    results = yield calls
    rows = []
    for model, case in _JUMPS:
        deformation = number(results, model, share, case)
        exact, closed = (number(results, one, place, case) for one in (model, "semi-rigid"))
        error = relative_error("semi-rigid", closed, model, exact)
        found = {"deformation": deformation.value, "u_deformation": deformation.u}
        rows.append({"reference": model} | case_keys(case) | found | {"error": error.value, "u_error": error.u})
    return {"": pd.DataFrame(rows)}


def _draw_semi_rigid(figure: Figure, tables: Tables) -> None:
    left, right = figure.subplots(1, 2)
    for axes, column, scale in ((left, "deformation", 1.0), (right, "error", 100.0)):
        for index, n in enumerate(_SHAPES):
            exact, fem = of_model(tables[""][tables[""]["n"] == n], "fscm", "fem", column="reference")
            style = {"ls": LINES[index], "color": COLOURS[index], "marker": MARKERS[index], "ms": 3.5}
            axes.plot(exact["mu"], scale * exact[column], label=f"fscm, $n$ = {n:g}", **style)
            crosses(axes, fem["mu"], scale * fem[column])
        crosses(axes, [], [], label="fem")
        axes.set(xlabel=LABELS["mu"], ylim=(0.0, None))
    left.set_ylabel(r"deformation over gap at jump-in, $|w(0)|/H_0$")
    right.set_ylabel("error of the asymptote of jump-in (%)")
    lettered(left, "a", f"$k$ = {_K:g}")
    lettered(right, "b", f"$k$ = {_K:g}")
    legend_below(figure, 5)


SEMI_RIGID = PaperFigure(
    name="finding-semi-rigid",
    stem="finding_semi_rigid",
    title="Deformation at jump-in, and the error of the asymptote that neglects it",
    plan=_semi_rigid,
    picture=_draw_semi_rigid,
)


def _surface_inside() -> Plan[Tables]:
    exact = {model: CachedCall.of(profile, model, *_CASE) for model in ("fscm", "fem")}
    closed = {model: CachedCall.of(cohesive_surface, model, *_CASE) for model in _MODELS}
    places = [call for model in exact for call in tasks_of(model, "pull_off_displacement", _CASE)]
    results = yield [*exact.values(), *places, *closed.values()]
    parts = []
    for model, call in (exact | closed).items():
        found = results[call]
        displacement = (
            number(results, model, "pull_off_displacement", _CASE).value if model in exact else found["displacement"]
        )
        # H + delta is the height of the surface below the punch's tip, w + f (Eq. 4).
        height = np.interp(_RADII, found["radius"], found["gap"]) + displacement
        parts.append(pd.DataFrame({"model": model, "radius": _RADII, "gap_and_displacement": height}))
    names = ("contact_radius", "cohesive_radius")
    radii = [{"model": model} | {name: results[call][name] for name in names} for model, call in closed.items()]
    return {"": pd.concat(parts, ignore_index=True), "radii": pd.DataFrame(radii)}


def _draw_surface_inside(figure: Figure, tables: Tables) -> None:
    table = tables[""].pivot(index="radius", columns="model", values="gap_and_displacement")
    axes = figure.subplots()
    for model in _MODELS:
        axes.plot(table.index, table[model] - table["fscm"], label=MODEL_NAMES[model], **MODEL_LINES[model])
    axes.plot(table.index, table["fem"] - table["fscm"], color=COLOURS[0], lw=0.9, ls=":", label="fem")
    level(axes)
    inner = tables["radii"]["contact_radius"].min()
    axes.axvspan(0.0, inner, color="0.5", alpha=0.12, lw=0)
    place = (0.5 * inner, 0.93)
    axes.annotate("contact of both models", place, xycoords=("data", "axes fraction"), ha="center", fontsize=8)
    axes.set(xlim=(0.0, 3.0), xlabel=LABELS["radius"], ylabel=r"difference of the surfaces from fscm, in $z_0$")
    axes.legend(loc="upper right", fontsize=8)


SURFACE_INSIDE = PaperFigure(
    name="finding-surface-inside",
    stem="finding_surface_inside",
    title="Difference of the surfaces of both Maugis-Dugdale models from the FSCM; n = 2, k = 0.4, mu = 1",
    plan=_surface_inside,
    picture=_draw_surface_inside,
    size=(5.4, 3.6),
    follows_path=True,
)
