"""Findings on the closed forms: end of the small chi, errors of three models of the pull-off and of the jump-in."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, MARKERS, MODEL_LINES, MODEL_NAMES
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, crosses, dashed, held, legend_below, level, of_model, panels
from comparisons.paper.figures.fig11_gradient_effect import insensitive_regions, largest_chi
from comparisons.paper.paper_figure import Plan, Tables, paper_figure
from comparisons.paper.statements.measures import named, table_of
from comparisons.paper.tasks import COHESIVE, cohesive_surface, profile, quantity
from comparisons.paper.values.printed_values import LAST_K

__all__ = ["near_the_end"]

_CHI_SHAPES = np.linspace(6.213, 6.223, 11)
_LAST = (1.0, 0.9995, LAST_K)
_PRINTED, _LIMIT = 6.219, 10.0

#: Of all errors here.
_K = 0.4
_SHAPES = (1.0, 1.5, 2.0, 5.0)
_FORCES = [
    *(("fscm", n, mu) for n in _SHAPES for mu in (1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0)),
    *(("fem", n, mu) for n, mu in ((1.0, 2.0), (1.5, 2.0), (5.0, 2.0), (5.0, 3.0))),
]
_JUMPS = [
    *(("fscm", n, mu) for n in _SHAPES for mu in (1.25, 1.5, 2.0, 3.0, 5.0)),
    *(("fem", n, 3.0) for n in _SHAPES),
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


def _draw_chi_range(figure: Figure, tables: Tables) -> None:
    axes = figure.subplots()
    for index, (last_k, end) in enumerate(tables["ends"].to_numpy()):
        line = tables[""][tables[""]["last_k"] == last_k]
        label = rf"$k \leq$ {last_k:g}: 10 % at $n$ = {end:.4f}"
        axes.plot(line["n"], 100.0 * line["chi_max"], label=label, marker="o", ms=3, **dashed(index))
    level(axes, _LIMIT, ls="--")
    axes.axvline(_PRINTED, color="0.4", lw=0.8, ls=":", label=f"printed: {_PRINTED}")
    axes.set(xlabel=LABELS["n"], ylabel=r"largest deviation $\chi_{\max}$ (%)")
    axes.legend()


@paper_figure(_draw_chi_range, size=(5.0, 3.4))
def finding_chi_range() -> Plan[Tables]:
    """End of the second range of small chi, for three largest gradient exponents."""
    functions = (near_the_end, insensitive_regions)
    results = yield {(of, last_k): CachedCall.of(of, last_k) for last_k in _LAST for of in functions}
    parts = [pd.DataFrame({"last_k": at, "n": _CHI_SHAPES, "chi_max": results[near_the_end, at]}) for at in _LAST]
    ends = [{"last_k": last_k, "n_to": results[insensitive_regions, last_k][3]} for last_k in _LAST]
    return {"": pd.concat(parts, ignore_index=True), "ends": pd.DataFrame(ends)}


def _draw_cohesive_errors(figure: Figure, tables: Tables) -> None:
    left, right = panels(figure, 1, 2, (held(k=_K), held(n=5, k=_K)), LABELS["mu"])
    for axes, shapes in ((left, _SHAPES), (right, (5.0,))):
        for (model, n), line in tables[""].groupby(["model", "n"]):
            if n in shapes:
                exact, fem = of_model(line, "fscm", "fem", column="reference")
                index, label = _SHAPES.index(n), f"{model.removeprefix('md-')}, {held(n=n)}"
                style = {"color": COLOURS[index], "marker": MARKERS[index], "ls": MODEL_LINES[model]["ls"]}
                axes.plot(exact["mu"], 100.0 * exact["error"], label=label, ms=3, **style)
                crosses(axes, fem["mu"], 100.0 * fem["error"])
    crosses(left, [], [], label="against fem")
    level(left, 2.0, ls=":")
    left.set(xscale="log", yscale="log", ylabel="relative error of the pull-off force (%)", ylim=(0.05, 30.0))
    right.set(xlim=(1.4, 4.0), ylim=(0.0, 4.5))
    legend_below(figure, 5, fontsize=7)


@paper_figure(_draw_cohesive_errors, size=(7.2, 3.6))
def finding_cohesive_errors() -> Plan[Tables]:
    """Errors of both Maugis-Dugdale pull-off forces from mu = 1 on, k = 0.4."""
    places = [(reference, {"model": model}, named(n, _K, mu)) for reference, n, mu in _FORCES for model in COHESIVE]
    table = yield from table_of(places, error="relative_error pull_off_force {model}")
    return {"": table}


def _draw_semi_rigid(figure: Figure, tables: Tables) -> None:
    lattice = panels(figure, 1, 2, (held(k=_K),) * 2, LABELS["mu"])
    for axes, column, scale in zip(lattice, ("deformation", "error"), (1.0, 100.0), strict=True):
        for index, (n, line) in enumerate(tables[""].groupby("n")):
            exact, fem = of_model(line, "fscm", "fem", column="reference")
            style: Any = {"marker": MARKERS[index], "ms": 3.5, "label": f"fscm, {held(n=n)}"}
            axes.plot(exact["mu"], scale * exact[column], **dashed(index), **style)
            crosses(axes, fem["mu"], scale * fem[column])
        axes.set(ylim=(0.0, None))
    crosses(lattice[0], [], [], label="fem")
    lattice[0].set_ylabel(r"deformation over gap at jump-in, $|w(0)|/H_0$")
    lattice[1].set_ylabel("error of the asymptote of jump-in (%)")
    legend_below(figure, 5)


@paper_figure(_draw_semi_rigid)
def finding_semi_rigid() -> Plan[Tables]:
    """Deformation at jump-in, and the error of the asymptote that neglects it."""
    places: Any = [(reference, {}, named(n, _K, mu)) for reference, n, mu in _JUMPS]
    error = "relative_error jump_in_displacement semi-rigid"
    table = yield from table_of(places, deformation="jump_in_deformation", error=error)
    return {"": table}


def _draw_surface_inside(figure: Figure, tables: Tables) -> None:
    table = tables[""].pivot(index="radius", columns="model", values="gap_and_displacement")
    axes = figure.subplots()
    for model in COHESIVE:
        axes.plot(table.index, table[model] - table["fscm"], label=MODEL_NAMES[model], **MODEL_LINES[model])
    axes.plot(table.index, table["fem"] - table["fscm"], color=COLOURS[0], lw=0.9, ls=":", label="fem")
    level(axes)
    inner = tables["radii"]["contact_radius"].min()
    axes.axvspan(0.0, inner, color="0.5", alpha=0.12, lw=0)
    position = (0.5 * inner, 0.93)
    axes.annotate("contact of both models", position, xycoords=("data", "axes fraction"), ha="center", fontsize=8)
    axes.set(xlim=(0.0, 3.0), xlabel=LABELS["radius"], ylabel=r"difference of the surfaces from fscm, in $z_0$")
    axes.legend(loc="upper right", fontsize=8)


@paper_figure(_draw_surface_inside, size=(5.4, 3.6), follows_path=True)
def finding_surface_inside() -> Plan[Tables]:
    """Difference of the surfaces of both Maugis-Dugdale models from the FSCM; n = 2, k = 0.4, mu = 1."""
    references = ("fscm", "fem")
    calls = {model: CachedCall.of(profile, model, *_CASE) for model in references}
    calls |= {model: CachedCall.of(cohesive_surface, model, *_CASE) for model in COHESIVE}
    places = {("at", of): CachedCall.of(quantity, of, "pull_off_displacement", *_CASE) for of in references}
    results = yield {**calls, **places}
    parts = []
    for model in calls:
        shape = results[model]
        displacement = results["at", model]["value"] if model in references else shape["displacement"]
        # H + delta is the height of the surface below the punch's tip, w + f (Eq. 4).
        height = np.interp(_RADII, shape["radius"], shape["gap"]) + displacement
        parts.append(pd.DataFrame({"model": model, "radius": _RADII, "gap_and_displacement": height}))
    names = ("contact_radius", "cohesive_radius")
    radii = [{"model": model} | {name: results[model][name] for name in names} for model in COHESIVE]
    return {"": pd.concat(parts, ignore_index=True), "radii": pd.DataFrame(radii)}
