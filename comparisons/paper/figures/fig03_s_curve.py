"""Fig. 3: the S-shaped force-displacement curve at a large Tabor number, its named points and its hysteresis."""

from __future__ import annotations

from operator import attrgetter

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.models.solver import translated
from comparisons.output.style import COLOURS, MODEL_NAMES, lettered
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, level, of_model
from comparisons.paper.paper_figure import PaperFigure, Plan, Tables, lines_of
from comparisons.paper.tasks import curve, quantity
from fscm import Analysis, NoSuchEvent, NotConverged
from fscm.problem import Problem
from fscm.solution import FLOOR, SAFETY, EventPair

__all__ = ["S_CURVE", "named_points"]

_CASE = (2.0, 0.4, 3.0)
_COORDINATES = ("central_gap", "displacement", "load")
#: The points, and the offsets of their names in (b), in points of the page.
_BESIDE = {"B'": (-3, 6), "A": (4, 5), "B": (-11, -9), "A'": (7, -3), "C": (-3, -12), "D": (-12, 3)}
#: Ranges of the axes: the approach continues to the left of (b) and to the right of (a).
_GAPS, _DISPLACEMENTS, _LOADS = (-0.35, 6.0), (-7.2, 7.6), (-2.05, 0.55)
#: In contact the central gap hardly moves; an inset shows it.
_NEAR_GAPS, _NEAR_DISPLACEMENTS = (-0.024, 0.034), (-7.2, 9.0)


def named_points(n: float, k: float, mu: float) -> dict[str, dict[str, float]]:
    """Return central gap, displacement and load of B', A, B, A', C and D (Fig. 3b), each with its uncertainty.

    A and B are the jump-in and the jump-out, A' and B' where these land under displacement control, C is the
    pull-off and D the zero of the load.

    Raises
    ------
    comparisons.model.NotApplicable
        Below the critical Tabor number, where nothing jumps.
    comparisons.model.ComputationFailed
        If a point was not reached.

    Examples
    --------
    >>> points = named_points(2, 0.4, 1)
    >>> fall = points["A"]["displacement"] - points["A'"]["displacement"]
    >>> abs(fall) < 1e-9, round(points["C"]["load"], 8)
    (True, -1.78848171)
    """
    analysis = Analysis(Problem(n, k, mu))
    with translated(NoSuchEvent, NotConverged):
        pairs = {
            "B'": analysis.landing("jump_out"),
            "A": analysis.event("jump_in"),
            "B": analysis.event("jump_out"),
            "A'": analysis.landing("jump_in"),
            "C": analysis.event("pull_off"),
            "D": analysis.event("zero_load"),
        }
    return {name: _coordinates(pair) for name, pair in pairs.items()}


def _coordinates(pair: EventPair) -> dict[str, float]:
    found = {}
    for name in _COORDINATES:
        of = attrgetter(name)
        value = float(of(pair.value))
        found[name] = value
        found[f"u_{name}"] = float(SAFETY * pair.difference(of) + FLOOR * (1.0 + abs(value)))
    return found


def _plan() -> Plan[Tables]:
    path, jkr = (CachedCall.of(curve, model, *_CASE) for model in ("fscm", "jkr"))
    places, energy = CachedCall.of(named_points, *_CASE), CachedCall.of(quantity, "fscm", "hysteresis_energy", *_CASE)
    results = yield [path, places, energy, jkr]
    # The coordinate along the path, at which displacement and load are uncertain; JKR has none.
    parts = [
        lines_of(
            {"model": model, "central_gap": results[call]["columns"].get("central_gap", np.nan)},
            results[call],
            ["displacement", "u_displacement", "load", "u_load"],
        )
        for model, call in (("fscm", path), ("jkr", jkr))
    ]
    points = pd.DataFrame.from_dict(results[places], orient="index").rename_axis("name")
    return {
        "curves": pd.concat(parts, ignore_index=True),
        "points": points.reset_index(),
        "hysteresis": pd.DataFrame([{"quantity": "hysteresis_energy"} | results[energy]]),
    }


def _picture(figure: Figure, tables: Tables) -> None:
    points = tables["points"].set_index("name")
    path, jkr = of_model(tables["curves"], "fscm", "jkr")
    grid = figure.add_gridspec(2, 2, width_ratios=(1.0, 1.35))
    above = figure.add_subplot(grid[0, 0])
    below = figure.add_subplot(grid[1, 0], sharex=above)
    _against_gap(above, path, points, "displacement", (0.38, 0.5, 0.59, 0.46))
    _against_gap(below, path, points, "load", (0.38, 0.17, 0.59, 0.50))
    above.set(xlim=_GAPS, ylim=_DISPLACEMENTS, ylabel=LABELS["displacement"])
    above.tick_params(labelbottom=False)
    below.set(ylim=_LOADS, ylabel=LABELS["load"], xlabel=r"central gap $H_0/z_0$")
    lettered(above, "a")
    _plane(figure.add_subplot(grid[:, 1]), path, jkr, points, tables["hysteresis"]["value"].item())


def _against_gap(
    axes: Axes, path: pd.DataFrame, points: pd.DataFrame, name: str, place: tuple[float, float, float, float]
) -> None:
    inset = axes.inset_axes(place)
    for shown in (axes, inset):
        shown.plot(path["central_gap"], path[name], color=COLOURS[0])
        level(shown)
    near = (points["central_gap"] > _NEAR_GAPS[0]) & (points["central_gap"] < _NEAR_GAPS[1])
    # The names are on the convex side of the curve.
    in_inset = (3, 4) if name == "displacement" else (6, -7)
    for shown, some, beside in ((axes, points[~near], (3, 4)), (inset, points[near], in_inset)):
        shown.plot(some["central_gap"], some[name], ls="none", marker="o", ms=3.5, color=COLOURS[2])
        for label, point in some.iterrows():
            where = point["central_gap"], point[name]
            shown.annotate(str(label), where, beside, textcoords="offset points", fontsize=8)
    inset.set(xlim=_NEAR_GAPS, ylim=_NEAR_DISPLACEMENTS if name == "displacement" else _LOADS)
    inset.tick_params(labelsize=7, pad=2)


def _plane(axes: Axes, path: pd.DataFrame, jkr: pd.DataFrame, points: pd.DataFrame, energy: float) -> None:
    axes.fill(*_loop(path, points), color=COLOURS[6], alpha=0.35, lw=0)
    axes.plot(path["displacement"], path["load"], color=COLOURS[0], label=MODEL_NAMES["fscm"])
    axes.plot(jkr["displacement"], jkr["load"], color=COLOURS[2], ls="--", label=MODEL_NAMES["jkr"])
    level(axes)
    places = _places(points)
    for start, end in (("A", "A'"), ("B", "B'")):
        arrow = {"arrowstyle": "-|>", "color": COLOURS[1], "lw": 1.2, "ls": ":"}
        axes.annotate("", places[end], places[start], arrowprops=arrow)
    axes.plot(points["displacement"], points["load"], ls="none", marker="o", ms=4, color=COLOURS[2])
    for name, offset in _BESIDE.items():
        axes.annotate(name, places[name], offset, textcoords="offset points")
    axes.annotate(
        f"hysteresis loss\n$\\oint\\,\\bar P\\,d\\delta/z_0$ = {energy:.4f}",
        (0.5 * (places["A"][0] + places["B"][0]), -0.75),
        (-0.9, -0.62),
        arrowprops={"arrowstyle": "-", "color": "0.4", "lw": 0.7},
    )
    axes.set(xlim=_DISPLACEMENTS, ylim=_LOADS, xlabel=LABELS["displacement"], ylabel=LABELS["load"])
    lettered(axes, "b", r"$n$ = {:g}, $k$ = {:g}, $\mu$ = {:g}".format(*_CASE))
    axes.legend(loc="lower right")


def _places(points: pd.DataFrame) -> dict[str, tuple[float, float]]:
    """Displacement and load of each point, by name."""
    return dict(zip(points.index, zip(points["displacement"], points["load"], strict=True), strict=True))


def _loop(path: pd.DataFrame, points: pd.DataFrame) -> tuple[np.ndarray, np.ndarray]:
    """Outline B'-A-A'-B-B' of the energy that a cycle of displacement control loses."""
    displacement, load = path["displacement"].to_numpy(), path["load"].to_numpy()
    falling = np.diff(displacement) < 0.0
    top, bottom = int(np.argmax(falling)), int(np.flatnonzero(falling)[-1]) + 1
    places = _places(points)
    far = slice(int(np.searchsorted(displacement[:top], places["B'"][0])), top + 1)
    near = slice(bottom, bottom + int(np.searchsorted(displacement[bottom:], places["A'"][0])))
    outline = np.vstack(
        [
            places["B'"],
            np.column_stack([displacement[far], load[far]]),
            places["A'"],
            np.column_stack([displacement[near], load[near]])[::-1],
        ]
    )
    return outline[:, 0], outline[:, 1]


S_CURVE = PaperFigure(
    name="3",
    stem="fig03_s_curve",
    title="The S-shaped curve at n = 2, k = 0.4, mu = 3",
    plan=_plan,
    picture=_picture,
    size=(7.2, 4.8),
    follows_path=True,
)
