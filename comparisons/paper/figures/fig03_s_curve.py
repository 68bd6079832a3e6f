"""Fig. 3: the S-shaped force-displacement curve at a large Tabor number, its named points and its hysteresis."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, MODEL_NAMES, lettered
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, held, level, of_model
from comparisons.paper.paper_figure import Plan, Tables, lines_of, paper_figure
from comparisons.paper.solver_tasks import named_points
from comparisons.paper.tasks import curve, quantity

__all__ = ["fig03_s_curve", "loop"]

_CASE = (2.0, 0.4, 3.0)
#: The points, and the offsets of their names in (b), in points of the page.
_BESIDE = {"B'": (-3, 6), "A": (4, 5), "B": (-11, -9), "A'": (7, -3), "C": (-3, -12), "D": (-12, 3)}
#: Ranges of the axes: the approach continues to the left of (b) and to the right of (a).
_RANGES = {"displacement": (-7.2, 7.6), "load": (-2.05, 0.55)}
#: In contact the central gap hardly moves; the scale is linear in the middle of (a) and logarithmic beyond.
_LINEAR_GAP = 0.05


def _picture(figure: Figure, tables: Tables) -> None:
    points = tables["points"].set_index("name")
    path, jkr = of_model(tables["curves"], "fscm", "jkr")
    grid = figure.add_gridspec(2, 2, width_ratios=(1.0, 1.35))
    above = figure.add_subplot(grid[0, 0])
    below = figure.add_subplot(grid[1, 0], sharex=above)
    lettered(above, "a")
    above.tick_params(labelbottom=False)
    for axes, name in ((above, "displacement"), (below, "load")):
        _marked(axes, path, points, "central_gap", name)
        axes.set_xscale("symlog", linthresh=_LINEAR_GAP)
        axes.set(xlim=(-0.04, 7.0), ylabel=LABELS[name])
    below.set_xlabel(LABELS["central_gap"])
    below.set_xticks([0.0, 0.1, 1.0, 5.0], ["0", "0.1", "1", "5"])
    right = figure.add_subplot(grid[:, 1])
    lettered(right, "b", held(n=_CASE[0], k=_CASE[1], mu=_CASE[2]))
    right.fill(*loop(path, points), color=COLOURS[6], alpha=0.35, lw=0)
    _marked(right, path, points, "displacement", "load")
    right.plot(jkr["displacement"], jkr["load"], color=COLOURS[2], ls="--", label=MODEL_NAMES["jkr"])
    for start, end in (("A", "A'"), ("B", "B'")):
        head, tail = (points.loc[name, ["displacement", "load"]] for name in (end, start))
        right.annotate("", head, tail, arrowprops={"arrowstyle": "-|>", "color": COLOURS[1], "lw": 1.2, "ls": ":"})
    energy = tables["hysteresis"]["value"].item()
    right.annotate(f"hysteresis loss\n$\\oint\\,\\bar P\\,d\\delta/z_0$ = {energy:.4f}", (-1.9, -0.62))
    right.set(xlim=_RANGES["displacement"], xlabel=LABELS["displacement"], ylabel=LABELS["load"])
    right.legend(loc="lower right")


def _marked(axes: Axes, path: pd.DataFrame, points: pd.DataFrame, x: str, y: str) -> None:
    """Draw the path and its named points."""
    level(axes)
    axes.plot(path[x], path[y], color=COLOURS[0], label=MODEL_NAMES["fscm"])
    axes.plot(points[x], points[y], ls="none", marker="o", ms=4, color=COLOURS[2])
    for name, point in points.iterrows():
        offset = _BESIDE[str(name)] if x == "displacement" else (5, 3) if y == "displacement" else (6, -5)
        axes.annotate(str(name), (point[x], point[y]), offset, textcoords="offset points", fontsize=8)
    axes.set_ylim(_RANGES[y])


def loop(path: pd.DataFrame, points: pd.DataFrame) -> tuple[np.ndarray, np.ndarray]:
    """Outline B'-A-A'-B-B' of the energy that a cycle of displacement control loses."""
    gap, displacement = path["central_gap"], path["displacement"]
    approach = path[(gap >= points.loc["A", "central_gap"]) & (displacement >= points.loc["B'", "displacement"])]
    contact = path[(gap <= points.loc["B", "central_gap"]) & (displacement <= points.loc["A'", "displacement"])]
    sides = [points.loc[["B'"]], approach, points.loc[["A", "A'"]], contact[::-1], points.loc[["B"]]]
    outline = pd.concat(sides)[["displacement", "load"]].to_numpy(float)
    return outline[:, 0], outline[:, 1]


@paper_figure(_picture, size=(7.2, 4.8), follows_path=True)
def fig03_s_curve() -> Plan[Tables]:
    """The S-shaped curve at n = 2, k = 0.4, mu = 3."""
    results = yield {
        "fscm": CachedCall.of(curve, "fscm", *_CASE),
        "points": CachedCall.of(named_points, *_CASE),
        "energy": CachedCall.of(quantity, "fscm", "hysteresis_energy", *_CASE),
        "jkr": CachedCall.of(curve, "jkr", *_CASE),
    }
    # The coordinate along the path, at which displacement and load are uncertain; JKR has none.
    parts = [
        lines_of(
            {"model": model, "central_gap": results[model]["columns"].get("central_gap", np.nan)},
            results[model],
            ["displacement", "u_displacement", "load", "u_load"],
        )
        for model in ("fscm", "jkr")
    ]
    return {
        "curves": pd.concat(parts, ignore_index=True),
        "points": pd.DataFrame.from_dict(results["points"], orient="index").rename_axis("name").reset_index(),
        "hysteresis": pd.DataFrame([{"quantity": "hysteresis_energy"} | results["energy"]]),
    }
