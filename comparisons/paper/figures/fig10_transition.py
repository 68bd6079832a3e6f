"""Fig. 10: the pull-off force from the rigid (Bradley) to the JKR limit, over the Tabor number."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.interpolate import CubicSpline

from comparisons.output.style import COLOURS, MODEL_NAMES, lettered
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, dashed, gradient, legend_below, of_model
from comparisons.paper.paper_figure import PaperFigure, Plan, Tables, rows_of
from comparisons.paper.tasks import quantity

__all__ = ["TRANSITION"]

#: Range of the pull-off force of each panel, and its ticks, by shape index: a panel spans less than two decades.
_SHAPES: dict[float, tuple[tuple[float, float], tuple[float, ...]]] = {
    1.0: ((2.0, 80.0), (2, 5, 10, 20, 50)),
    1.5: ((1.5, 7.0), (1.5, 2, 3, 4, 5, 6, 7)),
    2.0: ((1.45, 2.05), (1.5, 1.6, 1.7, 1.8, 1.9, 2)),
    5.0: ((0.25, 2.2), (0.3, 0.5, 0.7, 1, 1.5, 2)),
}
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


def _plan() -> Plan[Tables]:
    cases = [("fscm", n, k, mu) for mu in reversed(_TABOR_NUMBERS) for n in _SHAPES for k in _GRADIENTS]
    cases += [("jkr", n, k, mu) for n in _SHAPES for k in _GRADIENTS for mu in (_JKR_FROM, _ENDS[1])]
    cases += [("bradley", n, 0.0, mu) for n in _SHAPES for mu in _ENDS]
    table = yield from rows_of(
        ({"model": model, "n": n, "k": k, "mu": mu}, CachedCall.of(quantity, model, "pull_off_force", n, k, mu))
        for model, n, k, mu in cases
    )
    return {"": table.sort_values(["model", "n", "k", "mu"], ignore_index=True)}


def _picture(figure: Figure, tables: Tables) -> None:
    forces = tables[""][tables[""]["status"] == "ok"]
    panels = figure.subplots(2, 2, sharex=True).ravel()
    for letter, axes, (n, (limits, ticks)) in zip("abcd", panels, _SHAPES.items(), strict=True):
        _panel(axes, forces[forces["n"] == n])
        lettered(axes, letter, f"$n$ = {n:g}")
        axes.set_ylim(limits)
        axes.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.set_yticks([], minor=True)
    for axes in panels[2:]:
        axes.set_xlabel(LABELS["mu"])
    for axes in panels[::2]:
        axes.set_ylabel(LABELS["force"])
    legend_below(figure, 4)


def _panel(axes: Axes, forces: pd.DataFrame) -> None:
    fscm, jkr, bradley = of_model(forces, "fscm", "jkr", "bradley")
    for index, (k, part) in enumerate(fscm.groupby("k")):
        limit = jkr[jkr["k"] == k]
        axes.plot(*_smooth(part), label=f"FSCM, {gradient(k)}", **dashed(index))
        axes.plot(limit["mu"], limit["value"], color=COLOURS[index], **_JKR_STYLE)
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
    plan=_plan,
    picture=_picture,
    size=(7.2, 6.0),
)
