"""Figs. 14-16: pull-off force of both Maugis-Dugdale models and of the FSCM over the Tabor number."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from comparisons.output.figures import kappa as kappa_figure
from comparisons.output.style import COLOURS, MARKERS, MODEL_LINES, MODEL_NAMES, lettered, styled
from comparisons.output.tables import relative_error
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.tasks import quantity

__all__ = ["PULL_OFF", "PULL_OFF_BY_RIGID_LIMIT", "PULL_OFF_BY_SOFT_LIMIT", "TABOR_NUMBERS"]

_SHAPES = (1.0, 1.5, 2.0, 5.0)
_K = 0.4
#: Ten a decade, the preferred numbers of the series R10 but for rounding.
TABOR_NUMBERS = tuple(float(f"{mu:.3g}") for mu in np.geomspace(0.01, 10.0, 31))
_MODELS = ("fscm", "md-original", "md-improved")
_MU = r"Tabor number $\mu$"


def _task(model: str, n: float, mu: float) -> CachedCall:
    return CachedCall.of(quantity, model, "pull_off_force", n, _K, mu)


def _tasks() -> Sequence[CachedCall]:
    # The largest Tabor numbers take longest.
    return [_task(model, n, mu) for mu in reversed(TABOR_NUMBERS) for n in _SHAPES for model in _MODELS]


def _limits(name: str) -> Callable[[], Sequence[CachedCall]]:
    return lambda: [*_tasks(), *(_task(name, n, mu) for n in _SHAPES for mu in TABOR_NUMBERS)]


def _forces(results: Results, models: Sequence[str] = _MODELS) -> pd.DataFrame:
    rows = [
        {"n": n, "k": _K, "mu": mu, "model": model} | results[_task(model, n, mu)]
        for n in _SHAPES
        for model in models
        for mu in TABOR_NUMBERS
    ]
    return pd.DataFrame(rows).astype({"value": float, "u_num": float})


def _pull_off_tables(results: Results) -> Tables:
    forces = _forces(results)
    bounds = _forces(results, ("bradley", "jkr"))
    return {"": pd.concat([forces, bounds], ignore_index=True)}


def _scaled(results: Results, limit: str) -> pd.DataFrame:
    """Return the forces over that of a limiting model in the same case, with the uncertainty of the ratio."""
    forces = _forces(results)
    scale = _forces(results, (limit,)).set_index(["n", "mu"])
    by = scale.loc[pd.MultiIndex.from_frame(forces[["n", "mu"]])]
    size, u = by["value"].to_numpy(), by["u_num"].to_numpy()
    ratio = forces["value"] / size
    return forces[["n", "k", "mu", "model"]].assign(
        ratio=ratio, u_ratio=(forces["u_num"] + ratio * u) / size, status=forces["status"], reason=forces["reason"]
    )


def _kappa(results: Results) -> pd.DataFrame:
    forces = _forces(results).assign(quantity="pull_off_force", nu=np.nan)
    table = relative_error(forces, "fscm")
    return table[["quantity", "n", "k", "mu", "model", "kappa", "u_kappa"]]


def _draw_forces(tables: Tables) -> Figure:
    with styled():
        figure = Figure(figsize=(7.2, 5.6), layout="constrained")
        for letter, axes, (n, of_shape) in zip(
            "abcd", figure.subplots(2, 2).flat, tables[""].groupby("n"), strict=True
        ):
            for name, line in (("bradley", "-."), ("jkr", ":")):
                part = of_shape[of_shape["model"] == name]
                axes.plot(part["mu"], part["value"], color="0.55", lw=0.9, ls=line, label=MODEL_NAMES[name])
            own = of_shape[of_shape["model"].isin(_MODELS)]["value"]
            _lines(axes, of_shape, "value")
            axes.set(xscale="log", yscale="log", xlim=(0.008, 12.0), ylim=_framed(own))
            axes.set(xlabel=_MU, ylabel=r"pull-off force $-\bar P_c$")
            _plain_ticks(axes)
            lettered(axes, letter, f"$n$ = {n:g}, $k$ = {_K:g}")
        _legend(figure)
    return figure


def _draw_by_rigid(tables: Tables) -> Figure:
    with styled():
        figure = Figure(figsize=(7.2, 5.6), layout="constrained")
        for letter, axes, (n, of_shape) in zip(
            "abcd", figure.subplots(2, 2).flat, tables[""].groupby("n"), strict=True
        ):
            _lines(axes, of_shape, "ratio")
            axes.axhline(1.0, color="0.55", lw=0.9, ls="-.")
            axes.set(xscale="log", xlim=(0.008, 12.0), xlabel=_MU, ylabel=r"$P_c/P_c^{\mathrm{Bradley}}$")
            if of_shape["ratio"].max() > 4.0:
                axes.set_yscale("log")
                _plain_ticks(axes)
            lettered(axes, letter, f"$n$ = {n:g}, $k$ = {_K:g}")
        _legend(figure)
    return figure


def _draw_by_soft(tables: Tables) -> Figure:
    with styled():
        figure = Figure(figsize=(7.2, 6.6), layout="constrained")
        above, below = np.ravel(figure.subfigures(2, 1, height_ratios=[1.0, 1.15], squeeze=False))
        axes = above.subplots()
        for index, (_, of_shape) in enumerate(tables[""].groupby("n")):
            for model, style in MODEL_LINES.items():
                part = of_shape[of_shape["model"] == model]
                coloured = style | {"color": COLOURS[index], "marker": MARKERS[index], "ms": 3.5, "mfc": "white"}
                coloured |= {"markevery": (2 * index, 8)} if model == "md-improved" else {"marker": ""}
                axes.plot(part["mu"], part["ratio"], **coloured)
        axes.axhline(1.0, color="0.55", lw=0.9, ls=":")
        axes.set(xscale="log", yscale="log", xlim=(0.008, 12.0), xlabel=_MU, ylabel=r"$P_c/P_c^{\mathrm{JKR}}$")
        _plain_ticks(axes)
        lettered(axes, "a", f"scaled by the soft limit, $k$ = {_K:g}")
        above.legend(handles=_handles(), loc="outside right center")
        whole, near = below.subplots(1, 2)
        kappa_figure.panels(whole, near, tables["kappa"])
        lettered(whole, "b", f"relative error, $k$ = {_K:g}")
        lettered(near, "c", "enlarged")
        below.legend(handles=kappa_figure.handles(_SHAPES), loc="outside lower center", ncols=6, columnspacing=1.2)
    return figure


def _handles() -> list[Line2D]:
    """Return the entries of the legend of Fig. 16(a): colour and marker of each n, line of each model."""
    colours = list(zip(_SHAPES, COLOURS, MARKERS, strict=False))
    shapes = [Line2D([], [], color=c, marker=m, ms=3.5, mfc="white", label=f"$n$ = {n:g}") for n, c, m in colours]
    drawn = {name: style | {"color": "0.45"} for name, style in MODEL_LINES.items()}
    models = [Line2D([], [], label=MODEL_NAMES[name], **style) for name, style in drawn.items()]
    return [*shapes, *models]


def _framed(values: pd.Series) -> tuple[float, float]:
    """Limits of a logarithmic axis, a tenth of the range and at least 2 % beyond it."""
    low, high = float(values.min()), float(values.max())
    beyond = max((high / low) ** 0.1, 1.02)
    return low / beyond, high * beyond


def _lines(axes: Axes, of_shape: pd.DataFrame, column: str) -> None:
    for model, style in MODEL_LINES.items():
        part = of_shape[of_shape["model"] == model]
        axes.plot(part["mu"], part[column], label=MODEL_NAMES[model], **style)


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


def _legend(figure: Figure) -> None:
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=5)


def _soft_tables(results: Results) -> Tables:
    return {"": _scaled(results, "jkr"), "kappa": _kappa(results)}


PULL_OFF = PaperFigure(
    name="14",
    stem="fig14_pull_off_models",
    title="Pull-off force of the original and improved Maugis-Dugdale models and of the FSCM, k = 0.4",
    tasks=lambda: list(dict.fromkeys([*_limits("bradley")(), *_limits("jkr")()])),
    tables=_pull_off_tables,
    draw=_draw_forces,
)
PULL_OFF_BY_RIGID_LIMIT = PaperFigure(
    name="15",
    stem="fig15_pull_off_by_rigid_limit",
    title="Pull-off force scaled by the rigid (Bradley) limit, k = 0.4",
    tasks=_limits("bradley"),
    tables=lambda results: {"": _scaled(results, "bradley")},
    draw=_draw_by_rigid,
)
PULL_OFF_BY_SOFT_LIMIT = PaperFigure(
    name="16",
    stem="fig16_pull_off_by_soft_limit",
    title="Pull-off force scaled by the soft (JKR) limit, and the relative error kappa of both models, k = 0.4",
    tasks=_limits("jkr"),
    tables=_soft_tables,
    draw=_draw_by_soft,
)
