"""Linear systems of the finite elements: three ways to solve them, from 1e4 to 5e5 unknowns.

"pyamg" solves the whole system by conjugate gradients with the two-level preconditioner whose coarse level is pyamg's;
"direct" factorises the whole system; "condensed" eliminates all but the surface by nested dissection and solves there.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter

from comparisons.bench.linear_systems import METHODS, measure
from comparisons.bench.part import Item, Part
from comparisons.output.style import COLOURS, MARKERS, lettered, styled

__all__ = ["ELEMENTS", "draw", "items", "summary", "table"]

#: Mesh densities, with the seconds that one method takes; from 1e4 to 2e5 unknowns, then 5e5.
_DENSITIES = {0.9: 1.0, 0.45: 3.0, 0.3: 7.0, 0.22: 18.0}
_LARGE = {0.14: 60.0}
_MATERIAL, _CORNERS = (0.4, 0.25), ((0.0, 0.0), (0.8, 0.45))
#: Fewest unknowns in the figure.
_LEAST_SHOWN = 1e4
_LABELS = {"pyamg": "whole, pyamg", "direct": "whole, direct", "condensed": "condensed"}


def items(full: bool) -> list[Item]:
    """Return all methods at every size; with `full` up to 5e5 unknowns and for three materials."""
    densities = {**_DENSITIES, **(_LARGE if full else {})}
    return [
        Item({"method": method, "density": density, "k": k, "nu": nu}, seconds)
        for k, nu in (_MATERIAL, *(_CORNERS if full else ()))
        for density, seconds in densities.items()
        for method in METHODS
    ]


def table(rows: pd.DataFrame) -> pd.DataFrame:
    """Add the whole time, its ratio and that of memory to those of "pyamg", and the disagreement with "direct".

    The disagreement is the relative difference of the displacements under the centre of the load.
    """
    rows = rows.copy()
    if "solve_seconds" not in rows:
        return rows
    rows["seconds"] = rows["setup_seconds"] + rows["solve_seconds"]
    system = ["density", "k", "nu"]

    def of(method: str, name: str) -> Any:
        values = rows[(rows["method"] == method) & (rows["status"] == "ok")].set_index(system)[name]
        return values.reindex(pd.MultiIndex.from_frame(rows[system])).to_numpy(float)

    rows["ratio"] = rows["seconds"] / of("pyamg", "seconds")
    rows["memory_ratio"] = rows["megabytes"] / of("pyamg", "megabytes")
    direct = of("direct", "displacement")
    rows["disagreement"] = np.abs(rows["displacement"] - direct) / np.abs(direct)
    return rows


def draw(table: pd.DataFrame) -> Figure:
    """Draw iterations, time and memory against unknowns, for the material that every run has."""
    k, nu = _MATERIAL
    rows = table[(table["k"] == k) & (table["nu"] == nu) & (table["status"] == "ok")].sort_values("unknowns")
    with styled():
        figure = Figure(figsize=(11.0, 3.7), layout="constrained")
        iterations, seconds, memory = figure.subplots(1, 3)
        for place, (method, label) in enumerate(_LABELS.items()):
            one = rows[rows["method"] == method]
            line: dict[str, Any] = {"color": COLOURS[place], "marker": MARKERS[place], "ms": 5, "label": label}
            seconds.loglog(one["unknowns"], one["seconds"], **line)
            memory.loglog(one["unknowns"], one["megabytes"], **line)
            if method == "pyamg":
                iterations.semilogx(one["unknowns"], one["iterations"], **line)
        iterations.set_ylim(0.0, None)
        for axes, letter, label in (
            (iterations, "a", "iterations to a residual of 1e-10"),
            (seconds, "b", "CPU time: set-up and solution (s)"),
            (memory, "c", "memory beside the matrix, peak (MB)"),
        ):
            lettered(axes, letter)
            axes.set_xlabel("unknowns")
            axes.set_ylabel(label)
            axes.xaxis.set_minor_formatter(NullFormatter())
            axes.set_xlim(0.8 * _LEAST_SHOWN, max(1.3 * rows["unknowns"].max(), 2.0 * _LEAST_SHOWN))
        seconds.legend(loc="best")
        figure.suptitle(
            rf"Linear systems of the finite elements, $k$ = {k:g}, $\nu$ = {nu:g}, edge of a thousandth of its radius",
            fontsize=10,
        )
    return figure


def summary(table: pd.DataFrame) -> list[str]:
    """Return time and memory of the other methods over those of "pyamg", and the growth of its iterations."""
    k, nu = _MATERIAL
    ok = table[(table["status"] == "ok") & (table["k"] == k) & (table["nu"] == nu)].sort_values("unknowns")
    lines = [f"{'unknowns':>18}  {'direct/pyamg':>14}{'condensed/pyamg':>17}{'memory direct/pyamg':>21}"]
    for unknowns, rows in ok.groupby("unknowns"):
        by = rows.set_index("method")

        def ratio(method: str, name: str, by: pd.DataFrame = by) -> str:
            return f"{by[name][method]:.2f}" if method in by.index else "-"

        lines.append(
            f"{unknowns:>18.0f}  {ratio('direct', 'ratio'):>14}{ratio('condensed', 'ratio'):>17}"
            f"{ratio('direct', 'memory_ratio'):>21}"
        )
    iterations = table.loc[(table["method"] == "pyamg") & (table["status"] == "ok")]
    growth = [
        float(one["iterations"].iloc[-1] / one["iterations"].iloc[0])
        for _, one in iterations.sort_values("unknowns").groupby(["k", "nu"])
    ]
    if growth:
        lines.append(
            f"  iterations of pyamg: at most {iterations['iterations'].max():.0f}; "
            f"most / least unknowns: {max(growth):.2f} times as many"
        )
    return lines


ELEMENTS = Part(
    "elements",
    "iterations, CPU time and memory of the linear solvers of the finite elements",
    items,
    measure,
    table,
    draw,
    summary,
)
