"""Figs. 5 and 7: deformation of the surface and pressure on it at pull-off."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH
from comparisons.models.gibson_limit import gibson_profile
from comparisons.models.solver import translated
from comparisons.output.style import COLOURS, lettered
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, dashed, gradient, legend_below, level
from comparisons.paper.paper_figure import PaperFigure, Plan, Tables
from fscm import Analysis, NoSuchEvent, NotConverged, solve
from fscm.problem import Problem
from fscm.solution import FLOOR, SAFETY, State

__all__ = ["OVER_GRADIENTS", "OVER_TABOR_NUMBERS", "surface"]

_TABOR_NUMBERS = (0.1, 0.3, 0.5, 1.0, 2.0, 3.0)
#: k = 1 is the Gibson limit.
_GRADIENTS = (0.0, 0.2, 0.4, 0.6, 1.0)
#: Radii shown: everywhere, and around the cohesive edge, whose width is a small part of its radius.
_FARTHEST, _STEPS = 6.0, 240
_AROUND_EDGE = np.concatenate([-np.geomspace(0.3, 1e-3, 40), [0.0], np.geomspace(1e-3, 0.3, 40)])
_PUNCH: Any = {"lw": 0.6, "ls": (0, (6, 3))}


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
    pressure = found.pressure[shown]
    shapes = {"gap": found.gap[shown], "pressure": pressure, "deformation": problem.compliance * pressure}
    columns: dict[str, Any] = {"displacement": pull_off.value, "radius": found.radius[shown].tolist()}
    for name, values in shapes.items():
        # Along the surface gap and pressure are exact functions of each other; only the radius carries an error.
        u = (1.0 + problem.compliance) * pull_off.u_num + FLOOR * (1.0 + np.abs(values))
        columns |= {name: values.tolist(), f"u_{name}": u.tolist()}
    return columns


def _plan(cases: Iterable[tuple[float, float, float]]) -> Plan[Tables]:
    calls = {case: CachedCall.of(surface, *case) for case in sorted(cases, key=lambda case: -case[2])}
    results = yield list(calls.values())
    parts = []
    for (n, k, mu), call in sorted(calls.items()):
        part = pd.DataFrame({"n": n, "k": k, "mu": mu} | results[call])
        parts.append(part.assign(punch=part["radius"] ** n / n - part["displacement"]))
    return {"": pd.concat(parts, ignore_index=True)}


def _draw(figure: Figure, table: pd.DataFrame, name: str, farthest: float, heights: tuple[float, float]) -> None:
    held = {"mu": "$n$ = 2, $k$ = 0.4", "k": r"$n$ = 2, $\mu$ = 1"}[name]
    left, right = figure.subplots(1, 2)
    for index, (value, part) in enumerate(table.groupby(name)):
        style = {"label": gradient(value) if name == "k" else rf"$\mu$ = {value:g}"} | dashed(index)
        left.plot(part["radius"], -part["deformation"], **style)
        left.plot(part["radius"], part["punch"], color=COLOURS[index], **_PUNCH)
        right.plot(part["radius"], part["pressure"], **style)
    level(right, -THEORETICAL_STRENGTH, ls="--")
    place = (farthest, -THEORETICAL_STRENGTH)
    right.annotate(r"$-\sigma_{\mathrm{th}}$", place, (-4, 3), textcoords="offset points", ha="right")
    left.set(ylim=heights, ylabel=LABELS["height"])
    right.set(ylabel=LABELS["pressure"])
    for letter, axes in zip("ab", (left, right), strict=True):
        axes.set(xlim=(0.0, farthest), xlabel=LABELS["radius"])
        lettered(axes, letter, held)
    left.plot([], [], color="0.4", label=r"punch $f-\delta$", **_PUNCH)
    legend_below(figure, 4)


OVER_TABOR_NUMBERS = PaperFigure(
    name="5",
    stem="fig05_pull_off_over_tabor_numbers",
    title="Surface and pressure at pull-off for n = 2, k = 0.4, over the Tabor number",
    plan=lambda: _plan((2.0, 0.4, mu) for mu in _TABOR_NUMBERS),
    picture=lambda figure, tables: _draw(figure, tables[""], "mu", 5.0, (-0.2, 6.2)),
    size=(7.2, 3.7),
    follows_path=True,
)

OVER_GRADIENTS = PaperFigure(
    name="7",
    stem="fig07_pull_off_over_gradients",
    title="Surface and pressure at pull-off for n = 2, mu = 1, over the gradient exponent",
    plan=lambda: _plan((2.0, k, 1.0) for k in _GRADIENTS),
    picture=lambda figure, tables: _draw(figure, tables[""], "k", 4.0, (-0.1, 2.0)),
    size=(7.2, 3.7),
    follows_path=True,
)
