"""Fig. 10: the pull-off force from the rigid (Bradley) to the JKR limit, over the Tabor number."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.interpolate import CubicSpline

from comparisons.output.style import COLOURS, LINES, MODEL_NAMES, lettered, styled
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.tasks import quantity

__all__ = ["TRANSITION"]

_SHAPES = (1.0, 1.5, 2.0, 5.0)
#: k = 1 is the Gibson limit.
_GRADIENTS = (0.0, 0.2, 0.4, 0.6, 1.0)
_TABOR_NUMBERS = (0.01, 0.03, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0)
#: The closed forms are power laws of mu: two points are the line.
_ENDS = (_TABOR_NUMBERS[0], _TABOR_NUMBERS[-1])
#: A line of the FSCM is drawn through this many points of a spline: chords between the computed ones would show
#: corners.  At k = 0.4 it passes the denser values of Fig. 14 within 6e-4 for every n, less than its own width.
_SMOOTH = 121
#: JKR is drawn where its line is near the curves, i.e. from here on.
_JKR_FROM = 0.3
_JKR_STYLE: Any = {"ls": (0, (2, 1.5)), "lw": 0.7}
#: Range of the pull-off force of each panel, and its ticks: a panel spans less than two decades.
_RANGES = {1.0: (2.0, 80.0), 1.5: (1.5, 7.0), 2.0: (1.45, 2.05), 5.0: (0.25, 2.2)}
_TICKS = {
    1.0: (2, 5, 10, 20, 50),
    1.5: (1.5, 2, 3, 4, 5, 6, 7),
    2.0: (1.5, 1.6, 1.7, 1.8, 1.9, 2),
    5.0: (0.3, 0.5, 0.7, 1, 1.5, 2),
}


def _cases() -> list[tuple[str, float, float, float]]:
    fscm = [("fscm", n, k, mu) for n in _SHAPES for k in _GRADIENTS for mu in reversed(_TABOR_NUMBERS)]
    jkr = [("jkr", n, k, mu) for n in _SHAPES for k in _GRADIENTS for mu in (_JKR_FROM, _ENDS[1])]
    return [*fscm, *jkr, *(("bradley", n, 0.0, mu) for n in _SHAPES for mu in _ENDS)]


def _task(case: tuple[str, float, float, float]) -> CachedCall:
    return CachedCall.of(quantity, case[0], "pull_off_force", *case[1:])


def _tasks() -> Sequence[CachedCall]:
    return [_task(case) for case in sorted(_cases(), key=lambda case: (case[1], -case[3]))]


def _tables(results: Results) -> Tables:
    rows = [
        {"model": model, "n": n, "k": k, "mu": mu} | results[_task((model, n, k, mu))] for model, n, k, mu in _cases()
    ]
    return {"": pd.DataFrame(rows).sort_values(["model", "n", "k", "mu"], ignore_index=True)}


def _draw(tables: Tables) -> Figure:
    forces = tables[""][tables[""]["status"] == "ok"]
    with styled():
        figure = Figure(figsize=(7.2, 6.0), layout="constrained")
        panels = figure.subplots(2, 2, sharex=True).ravel()
        for letter, n, axes in zip("abcd", _SHAPES, panels, strict=True):
            _panel(axes, forces[forces["n"] == n])
            lettered(axes, letter, f"$n$ = {n:g}")
            axes.set_ylim(*_RANGES[n])
            axes.set_yticks(_TICKS[n], [f"{tick:g}" for tick in _TICKS[n]])
            axes.set_yticks([], minor=True)
        for axes in panels[2:]:
            axes.set_xlabel(r"Tabor number $\mu$")
        for axes in panels[::2]:
            axes.set_ylabel(r"pull-off force $-\bar P_c$")
        handles, labels = panels[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=4)
    return figure


def _panel(axes: Axes, forces: pd.DataFrame) -> None:
    for index, k in enumerate(_GRADIENTS):
        fscm, jkr = (forces[(forces["model"] == model) & (forces["k"] == k)] for model in ("fscm", "jkr"))
        label = f"FSCM, $k$ = {k:g}" + (" (Gibson)" if k == 1.0 else "")
        axes.plot(*_smooth(fscm), color=COLOURS[index], ls=LINES[index], label=label)
        axes.plot(jkr["mu"], jkr["value"], color=COLOURS[index], **_JKR_STYLE)
    bradley = forces[forces["model"] == "bradley"]
    axes.plot(bradley["mu"], bradley["value"], color="0.5", ls="--", lw=0.9, label=MODEL_NAMES["bradley"])
    axes.plot([], [], color=COLOURS[0], **_JKR_STYLE, label=f"{MODEL_NAMES['jkr']}, colours as FSCM")
    axes.set(xscale="log", yscale="log", xlim=_ENDS)


def _smooth(forces: pd.DataFrame) -> tuple[np.ndarray, np.ndarray]:
    """Tabor numbers and forces on the spline of log force over log mu."""
    log_mu = np.log(forces["mu"].to_numpy(float))
    at = np.linspace(log_mu[0], log_mu[-1], _SMOOTH)
    return np.exp(at), np.exp(CubicSpline(log_mu, np.log(forces["value"].to_numpy(float)))(at))


TRANSITION = PaperFigure(
    name="10",
    stem="fig10_transition",
    title="Pull-off force from the Bradley to the JKR limit",
    tasks=_tasks,
    tables=_tables,
    draw=_draw,
)
