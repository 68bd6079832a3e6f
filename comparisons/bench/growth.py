"""Growth of time and unknowns of `fscm` with the digits, the Tabor number and the gradient exponent."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.bench.drawing import Panel, lines
from comparisons.bench.part import Numbers, Part, Settings
from comparisons.bench.pull_off import FSCM_ACCURACIES, edge_width, solved
from fscm.problem import Problem

__all__ = ["GROWTH"]

#: What varies -> the name of its column, its values, and the label of its axis.
_VARIED = {
    "digits": ("accuracy", FSCM_ACCURACIES, r"requested error ($k$ = 0.4, $\mu$ = 1)"),
    "mu": ("mu", (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0), r"Tabor number $\mu$ ($k$ = 0)"),
    "k": ("k", (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9), r"gradient exponent $k$ ($\mu$ = 1)"),
}
#: Those with which the edge becomes narrower.
_EDGES = ("mu", "k")


def plan(full: bool) -> list[Settings]:
    """Return the accuracies, the Tabor numbers and the gradient exponents."""
    return [
        {"varied": varied, "model": "fscm", "n": 2.0, "k": 0.4 if varied == "digits" else 0.0, "mu": 1.0}
        | {"accuracy": 1e-8, name: value}
        for varied, (name, values, _) in _VARIED.items()
        for value in values
    ]


def measure(settings: Settings) -> Numbers:
    """Return the pull-off force of a problem with its bound, the unknowns, the CPU time and the width of the edge."""
    problem = Problem(n=settings["n"], k=settings["k"], mu=settings["mu"])
    return {**solved(settings), "edge_width": edge_width(problem)}


def ratios(rows: pd.DataFrame) -> pd.DataFrame:
    """Add the bound relative to the value, and the time relative to the least of the same series."""
    least = rows.groupby("varied")["cpu_seconds"].transform("min")
    return rows.assign(relative_bound=rows["u_num"] / rows["value"], ratio=rows["cpu_seconds"] / least)


def draw(rows: pd.DataFrame) -> Figure:
    """Draw unknowns and CPU time against what varies, unknowns against the edge, and the bounds that are reached."""
    names = {"unknowns": "unknowns", "cpu_seconds": "CPU time (s)"}
    series = {varied: rows[rows["varied"] == varied] for varied in _VARIED}
    panels = [
        Panel(series[varied], name, y, "varied", (label, text), "" if varied == "k" else "x")
        for y, text in names.items()
        for varied, (name, _, label) in _VARIED.items()
    ]
    labels = "width of the cohesive edge / its radius", "unknowns"
    panels.insert(3, Panel(rows[rows["varied"].isin(_EDGES)], "edge_width", "unknowns", "varied", labels, "x"))
    labels = "requested error", "relative bound of the pull-off force"
    panels.append(Panel(series["digits"], "accuracy", "relative_bound", "varied", labels, "xy"))
    return lines(panels, "Pull-off force by fscm, $n$ = 2, against the requested error, $\\mu$ and $k$", 4)


def summary(rows: pd.DataFrame) -> list[str]:
    """Return by how much the time grows over each series, and the growth of unknowns with the edge."""
    table = rows.groupby("varied", sort=False).agg(
        ratio=("ratio", "max"), least_unknowns=("unknowns", "min"), most_unknowns=("unknowns", "max")
    )
    text = ["most / least CPU time of fscm, and unknowns:", *table.to_string(float_format="%.1f").splitlines()]
    for varied in _EDGES:
        series = rows[rows["varied"] == varied]
        if series["edge_width"].nunique() > 1:
            decades = -np.log10(series["edge_width"].astype(float))
            slope, start = np.polyfit(decades, series["unknowns"].astype(float), 1)
            distance = (np.abs(start + slope * decades - series["unknowns"]) / series["unknowns"]).max()
            text.append(
                f"  with {varied}: unknowns = {start:.0f} + {slope:.0f} log10(1 / edge width) "
                f"within {100.0 * distance:.0f} %"
            )
    return text


GROWTH = Part("growth", "CPU time and unknowns of fscm over digits, mu and k", plan, measure, ratios, draw, summary)
