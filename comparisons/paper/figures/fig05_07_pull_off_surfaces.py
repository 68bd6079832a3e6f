"""Figs. 5 and 7: deformation of the surface and pressure on it at pull-off."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.models.gibson_limit import gibson_profile
from comparisons.models.solver import translated
from comparisons.output.style import COLOURS, LINES, lettered, styled
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, Tables
from fscm import Analysis, NoSuchEvent, NotConverged, solve
from fscm.problem import Problem
from fscm.solution import FLOOR, SAFETY, State

__all__ = ["OVER_GRADIENTS", "OVER_TABOR_NUMBERS", "surface"]

_TABOR_NUMBERS = (0.1, 0.3, 0.5, 1.0, 2.0, 3.0)
#: k = 1 is the Gibson limit.
_GRADIENTS = (0.0, 0.2, 0.4, 0.6, 1.0)
_CASES_5 = [(2.0, 0.4, mu) for mu in _TABOR_NUMBERS]
_CASES_7 = [(2.0, k, 1.0) for k in _GRADIENTS]

#: Strength of the 9-3 law, 16 sqrt(3) / 27 (Eq. 73).
_STRENGTH = 16.0 * math.sqrt(3.0) / 27.0
#: Radii shown: everywhere, and around the cohesive edge, whose width is a small part of its radius.
_FARTHEST, _STEPS = 6.0, 240
_AROUND_EDGE = np.concatenate([-np.geomspace(0.3, 1e-3, 40), [0.0], np.geomspace(1e-3, 0.3, 40)])


def surface(n: float, k: float, mu: float) -> dict[str, Any]:
    """Return the surface where P is smallest, for radii up to 6.

    Returns
    -------
    dict
        ``displacement``; lists over the ``radius``: ``gap``, ``pressure`` (tension negative), ``deformation`` w (Eq. 4;
        positive where the surface is pressed down), each with ``u_``, the bound on its numerical error.

    Raises
    ------
    comparisons.model.ComputationFailed
        If the pull-off was not found.

    Examples
    --------
    >>> found = surface(2, 0.4, 1)
    >>> round(min(found["pressure"]), 3)          # the strength of the surface law
    -1.026
    """
    problem = Problem(n, k, mu)
    if k == 1.0:
        return _gibson(problem)
    with translated(NoSuchEvent, NotConverged):
        event = Analysis(problem).event("pull_off")
    edge = event.value.scale if event.value.follows_edge else 1.0
    radius = np.unique(np.concatenate([np.linspace(0.0, _FARTHEST, _STEPS + 1), edge * (1.0 + _AROUND_EDGE)]))
    check, value = _sampled(event.check, radius), _sampled(event.value, radius)
    found: dict[str, Any] = {"displacement": float(event.value.displacement), "radius": radius.tolist()}
    for name, values in value.items():
        found[name] = values.tolist()
        error = SAFETY * np.abs(values - check[name]) + FLOOR * (1.0 + np.abs(values))
        found[f"u_{name}"] = error.tolist()
    return found


def _sampled(state: State, radius: np.ndarray) -> dict[str, np.ndarray]:
    def at(values: np.ndarray) -> np.ndarray:
        return state.disc.mesh.evaluate(values, radius / state.scale)

    gap = at(state.gap)
    return {"gap": gap, "pressure": state.disc.problem.law.traction(gap), "deformation": at(state.deformation)}


def _gibson(problem: Problem) -> dict[str, Any]:
    """The surface at k = 1, algebra at every point: its error is that of the displacement."""
    found, pull_off = gibson_profile(problem), solve(problem, "pull_off_displacement")
    shown = found.radius <= _FARTHEST
    shapes = {
        "gap": found.gap[shown],
        "pressure": found.pressure[shown],
        "deformation": problem.compliance * found.pressure[shown],
    }
    columns: dict[str, Any] = {"displacement": pull_off.value, "radius": found.radius[shown].tolist()}
    for name, values in shapes.items():
        # Along the surface gap and pressure are exact functions of each other; only the radius carries an error.
        u = (1.0 + problem.compliance) * pull_off.u_num + FLOOR * (1.0 + np.abs(values))
        columns |= {name: values.tolist(), f"u_{name}": u.tolist()}
    return columns


def _tasks(cases: Iterable[tuple[float, float, float]]) -> Sequence[CachedCall]:
    return [CachedCall.of(surface, *case) for case in sorted(cases, key=lambda case: -case[2])]


def _tables(cases: Iterable[tuple[float, float, float]], results: Results) -> Tables:
    parts = []
    for n, k, mu in cases:
        part = pd.DataFrame({"n": n, "k": k, "mu": mu} | results[CachedCall.of(surface, n, k, mu)])
        parts.append(part.assign(punch=part["radius"] ** n / n - part["displacement"]))
    return {"": pd.concat(parts, ignore_index=True)}


def _draw(tables: Tables, name: str, farthest: float, heights: tuple[float, float]) -> Figure:
    symbol, held = {"mu": (r"$\mu$", "$n$ = 2, $k$ = 0.4"), "k": ("$k$", r"$n$ = 2, $\mu$ = 1")}[name]
    with styled():
        figure = Figure(figsize=(7.2, 3.7), layout="constrained")
        left, right = figure.subplots(1, 2)
        for index, (value, part) in enumerate(tables[""].groupby(name)):
            label = f"{symbol} = {value:g}" + (" (Gibson)" if (name, value) == ("k", 1.0) else "")
            style = {"color": COLOURS[index], "ls": LINES[index], "label": label}
            left.plot(part["radius"], -part["deformation"], **style)
            left.plot(part["radius"], part["punch"], color=COLOURS[index], lw=0.6, ls=(0, (6, 3)))
            right.plot(part["radius"], part["pressure"], **style)
        right.axhline(-_STRENGTH, color="0.4", lw=0.8, ls="--")
        right.annotate(
            r"$-\sigma_{\mathrm{th}}$", (farthest, -_STRENGTH), (-4, 3), textcoords="offset points", ha="right"
        )
        left.set(ylim=heights, ylabel=r"height of the surface $-w/z_0$")
        right.set(ylabel=r"pressure $p z_0/\Delta\gamma$")
        _finish(figure, left, right, farthest, held)
    return figure


def _finish(figure: Figure, left: Axes, right: Axes, farthest: float, held: str) -> None:
    for letter, axes in zip("ab", (left, right), strict=True):
        axes.set(xlim=(0.0, farthest), xlabel=r"radius $r/(Qz_0)^{1/n}$")
        lettered(axes, letter, held)
    handles, labels = left.get_legend_handles_labels()
    (punch,) = left.plot([], [], color="0.4", lw=0.6, ls=(0, (6, 3)))
    figure.legend([*handles, punch], [*labels, r"punch $f-\delta$"], loc="outside lower center", ncols=4)


OVER_TABOR_NUMBERS = PaperFigure(
    name="5",
    stem="fig05_pull_off_over_tabor_numbers",
    title="Surface and pressure at pull-off for n = 2, k = 0.4, over the Tabor number",
    tasks=lambda: _tasks(_CASES_5),
    tables=lambda results: _tables(_CASES_5, results),
    draw=lambda tables: _draw(tables, "mu", 5.0, (-0.2, 6.2)),
    follows_path=True,
)

OVER_GRADIENTS = PaperFigure(
    name="7",
    stem="fig07_pull_off_over_gradients",
    title="Surface and pressure at pull-off for n = 2, mu = 1, over the gradient exponent",
    tasks=lambda: _tasks(_CASES_7),
    tables=lambda results: _tables(_CASES_7, results),
    draw=lambda tables: _draw(tables, "k", 4.0, (-0.1, 2.0)),
    follows_path=True,
)
