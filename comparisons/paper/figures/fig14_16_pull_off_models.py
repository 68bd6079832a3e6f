"""Figs. 14-16: pull-off force of both Maugis-Dugdale models and of the FSCM over the Tabor number."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from comparisons.output.figures import kappa as kappa_figure
from comparisons.output.style import COLOURS, MARKERS, MODEL_LINES, MODEL_NAMES, lettered
from comparisons.output.tables import relative_error
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, by_model, legend_below, of_model
from comparisons.paper.paper_figure import PaperFigure, Plan, Tables, rows_of
from comparisons.paper.tasks import quantity

__all__ = ["PULL_OFF", "PULL_OFF_BY_RIGID_LIMIT", "PULL_OFF_BY_SOFT_LIMIT", "TABOR_NUMBERS"]

_SHAPES = (1.0, 1.5, 2.0, 5.0)
_K = 0.4
#: Ten a decade, the preferred numbers of the series R10 but for rounding.
TABOR_NUMBERS = tuple(float(f"{mu:.3g}") for mu in np.geomspace(0.01, 10.0, 31))
_MODELS = ("fscm", "md-original", "md-improved")


def _forces(*limits: str) -> Plan[pd.DataFrame]:
    """Forces of the three models, then those of limiting ones."""
    models = [*product(_SHAPES, _MODELS), *product(_SHAPES, limits)]
    table = yield from rows_of(
        (
            {"n": n, "k": _K, "mu": mu, "model": model},
            CachedCall.of(quantity, model, "pull_off_force", n, _K, mu),
        )
        for (n, model), mu in product(models, TABOR_NUMBERS)
    )
    return table.astype({"value": float, "u_num": float})


def _pull_off() -> Plan[Tables]:
    table = yield from _forces("bradley", "jkr")
    return {"": table}


def _by_limit(limit: str) -> Plan[Tables]:
    """Plan the forces over that of a limiting model in the same case, with the uncertainty of the ratio, and kappa."""
    table = yield from _forces(limit)
    forces = table[table["model"] != limit]
    scale = table[table["model"] == limit].set_index(["n", "mu"])
    by = scale.loc[pd.MultiIndex.from_frame(forces[["n", "mu"]])]
    size, u = by["value"].to_numpy(), by["u_num"].to_numpy()
    ratio = forces["value"] / size
    scaled = forces[["n", "k", "mu", "model"]].assign(
        ratio=ratio, u_ratio=(forces["u_num"] + ratio * u) / size, status=forces["status"], reason=forces["reason"]
    )
    kappa = relative_error(forces.assign(quantity="pull_off_force", nu=np.nan), "fscm")
    return {"": scaled, "kappa": kappa[["quantity", "n", "k", "mu", "model", "kappa", "u_kappa"]]}


def _by_rigid_limit() -> Plan[Tables]:
    tables = yield from _by_limit("bradley")
    return {"": tables[""]}


def _draw_forces(figure: Figure, tables: Tables) -> None:
    panels = figure.subplots(2, 2).flat
    for letter, axes, (n, of_shape) in zip("abcd", panels, tables[""].groupby("n"), strict=True):
        for name, line in (("bradley", "-."), ("jkr", ":")):
            (part,) = of_model(of_shape, name)
            axes.plot(part["mu"], part["value"], color="0.55", lw=0.9, ls=line, label=MODEL_NAMES[name])
        own = of_shape[of_shape["model"].isin(_MODELS)]["value"]
        by_model(axes, of_shape, "mu", "value")
        axes.set(xscale="log", yscale="log", xlim=(0.008, 12.0), ylim=_framed(own))
        axes.set(xlabel=LABELS["mu"], ylabel=LABELS["force"])
        _plain_ticks(axes)
        lettered(axes, letter, f"$n$ = {n:g}, $k$ = {_K:g}")
    legend_below(figure, 5)


def _draw_by_rigid(figure: Figure, tables: Tables) -> None:
    panels = figure.subplots(2, 2).flat
    for letter, axes, (n, of_shape) in zip("abcd", panels, tables[""].groupby("n"), strict=True):
        by_model(axes, of_shape, "mu", "ratio")
        axes.axhline(1.0, color="0.55", lw=0.9, ls="-.")
        axes.set(xscale="log", xlim=(0.008, 12.0), xlabel=LABELS["mu"], ylabel=r"$P_c/P_c^{\mathrm{Bradley}}$")
        if of_shape["ratio"].max() > 4.0:
            axes.set_yscale("log")
            _plain_ticks(axes)
        lettered(axes, letter, f"$n$ = {n:g}, $k$ = {_K:g}")
    legend_below(figure, 5)


def _draw_by_soft(figure: Figure, tables: Tables) -> None:
    above, below = np.ravel(figure.subfigures(2, 1, height_ratios=[1.0, 1.15], squeeze=False))
    axes = above.subplots()
    shapes = []
    for index, (n, of_shape) in enumerate(tables[""].groupby("n")):
        marked: Any = {"color": COLOURS[index], "marker": MARKERS[index], "ms": 3.5, "mfc": "white"}
        shapes.append(Line2D([], [], label=f"$n$ = {n:g}", **marked))
        for model, part in zip(MODEL_LINES, of_model(of_shape, *MODEL_LINES), strict=True):
            places = {"markevery": (2 * index, 8)} if model == "md-improved" else {"marker": ""}
            axes.plot(part["mu"], part["ratio"], **MODEL_LINES[model] | marked | places)
    axes.axhline(1.0, color="0.55", lw=0.9, ls=":")
    axes.set(xscale="log", yscale="log", xlim=(0.008, 12.0), xlabel=LABELS["mu"], ylabel=r"$P_c/P_c^{\mathrm{JKR}}$")
    _plain_ticks(axes)
    lettered(axes, "a", f"scaled by the soft limit, $k$ = {_K:g}")
    grey = {name: style | {"color": "0.45"} for name, style in MODEL_LINES.items()}
    models = [Line2D([], [], label=MODEL_NAMES[name], **style) for name, style in grey.items()]
    above.legend(handles=[*shapes, *models], loc="outside right center")
    whole, near = below.subplots(1, 2)
    kappa_figure.panels(whole, near, tables["kappa"])
    lettered(whole, "b", f"relative error, $k$ = {_K:g}")
    lettered(near, "c", "enlarged")
    below.legend(handles=kappa_figure.handles(_SHAPES), loc="outside lower center", ncols=6, columnspacing=1.2)


def _framed(values: pd.Series) -> tuple[float, float]:
    """Limits of a logarithmic axis, a tenth of the range and at least 2 % beyond it."""
    low, high = float(values.min()), float(values.max())
    beyond = max((high / low) ** 0.1, 1.02)
    return low / beyond, high * beyond


def _plain_ticks(axes: Axes) -> None:
    """Write 2, not 2 x 10^0, and only as many as there is room for."""
    low, high = axes.get_ylim()
    steps = (1, 2, 3, 4, 6) if high / low < 12 else (1, 2, 5)
    ticks = [step * 10.0**power for power in range(-3, 4) for step in steps]
    if high / low < 2.5:
        ticks = list(np.arange(0.2, 4.0, 0.1 if high / low < 1.8 else 0.2).round(1))
    axes.set_yticks([tick for tick in ticks if low <= tick <= high])
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.yaxis.set_minor_formatter(lambda value, _: "")
    axes.yaxis.set_tick_params(which="minor", length=0)


PULL_OFF = PaperFigure(
    name="14",
    stem="fig14_pull_off_models",
    title="Pull-off force of the original and improved Maugis-Dugdale models and of the FSCM, k = 0.4",
    plan=_pull_off,
    picture=_draw_forces,
    size=(7.2, 5.6),
)
PULL_OFF_BY_RIGID_LIMIT = PaperFigure(
    name="15",
    stem="fig15_pull_off_by_rigid_limit",
    title="Pull-off force scaled by the rigid (Bradley) limit, k = 0.4",
    plan=_by_rigid_limit,
    picture=_draw_by_rigid,
    size=(7.2, 5.6),
)
PULL_OFF_BY_SOFT_LIMIT = PaperFigure(
    name="16",
    stem="fig16_pull_off_by_soft_limit",
    title="Pull-off force scaled by the soft (JKR) limit, and the relative error kappa of both models, k = 0.4",
    plan=lambda: _by_limit("jkr"),
    picture=_draw_by_soft,
    size=(7.2, 6.6),
)
