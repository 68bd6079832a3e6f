"""Growth of time and unknowns of `fscm` with the digits, the Tabor number and the gradient exponent."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.bench.fits import growth_exponent, line
from comparisons.bench.part import Item, Numbers, Part, Settings
from comparisons.bench.pull_off import FSCM_ACCURACIES, edge_width, solved
from comparisons.output.style import COLOURS, MARKERS, lettered, styled
from fscm.problem import Problem

__all__ = ["GROWTH", "draw", "items", "measure", "summary", "table"]

TABOR_NUMBERS = (0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0)
GRADIENT_EXPONENTS = (0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)
_CASE = {"model": "fscm", "n": 2.0}
_DEFAULT = 1e-8

#: What varies -> the name of its column, and its label.
_VARIED = {
    "digits": ("accuracy", "requested relative error"),
    "mu": ("mu", r"Tabor number $\mu$ ($k$ = 0)"),
    "k": ("k", r"gradient exponent $k$ ($\mu$ = 1)"),
}
#: Those with which the edge becomes narrower.
_EDGES = ("mu", "k")


def items(full: bool) -> list[Item]:
    """Return the accuracies, the Tabor numbers and the gradient exponents."""
    return [
        *(
            Item({"varied": "digits", **_CASE, "k": 0.4, "mu": 1.0, "accuracy": accuracy}, 2.0)
            for accuracy in FSCM_ACCURACIES
        ),
        *(Item({"varied": "mu", **_CASE, "k": 0.0, "mu": mu, "accuracy": _DEFAULT}, 2.0) for mu in TABOR_NUMBERS),
        *(Item({"varied": "k", **_CASE, "k": k, "mu": 1.0, "accuracy": _DEFAULT}, 3.0) for k in GRADIENT_EXPONENTS),
    ]


def measure(settings: Settings) -> Numbers:
    """Return the pull-off force of a problem with its bound, the unknowns, the CPU time and the width of the edge."""
    problem = Problem(settings["n"], settings["k"], settings["mu"])
    return {**solved(settings), "edge_width": edge_width(problem)}


def table(rows: pd.DataFrame) -> pd.DataFrame:
    """Add the bound relative to the value, and the time relative to the least of the same series."""
    rows = rows.copy()
    if "value" not in rows:
        return rows
    rows["relative_bound"] = rows["u_num"] / rows["value"]
    rows["ratio"] = rows["cpu_seconds"] / rows.groupby("varied")["cpu_seconds"].transform("min")
    return rows


def _decades(rows: pd.DataFrame) -> pd.Series:
    """Decades by which the edge is narrower than its radius."""
    return -np.log10(rows["edge_width"])


def _edge_rows(table: pd.DataFrame) -> pd.DataFrame:
    """Rows of one accuracy and several edge widths, the widest edge first."""
    rows = table[table["varied"].isin(_EDGES) & (table["status"] == "ok")]
    return rows.sort_values("edge_width", ascending=False)


def draw(table: pd.DataFrame) -> Figure:
    """Draw unknowns and CPU time against what varies, unknowns against the edge, and the bounds that are reached."""
    ok = table[table["status"] == "ok"]
    with styled():
        figure = Figure(figsize=(13.0, 6.0), layout="constrained")
        panels = figure.subplots(2, 4)
        for row, (name, text) in enumerate((("unknowns", "unknowns"), ("cpu_seconds", "CPU time (s)"))):
            for column, varied in enumerate(_VARIED):
                _draw_series(panels[row, column], ok[ok["varied"] == varied], varied, name)
                panels[row, column].set_ylim(0.0, 1.08 * ok[name].max())
            panels[row, 0].set_ylabel(text)
        _draw_edge(panels[0, 3], ok)
        _draw_bounds(panels[1, 3], ok[ok["varied"] == "digits"])
        for axes, letter in zip(panels.ravel(), "abcdefgh", strict=True):
            lettered(axes, letter)
        figure.suptitle(
            r"Pull-off force by fscm, $n$ = 2, against the requested error ($k$ = 0.4, $\mu$ = 1), $\mu$ and $k$",
            fontsize=10,
        )
    return figure


def _draw_series(axes: Axes, rows: pd.DataFrame, varied: str, name: str) -> None:
    quantity, label = _VARIED[varied]
    place = list(_VARIED).index(varied)
    rows = rows.sort_values(quantity)
    axes.plot(rows[quantity], rows[name], color=COLOURS[place], marker=MARKERS[place], ms=5)
    if varied != "k":
        axes.set_xscale("log")
    if varied == "digits" and len(rows) > 1:
        axes.invert_xaxis()
    axes.set_xlabel(label)


def _draw_bounds(axes: Axes, rows: pd.DataFrame) -> None:
    """Draw the bound that is reached against the error that is requested."""
    rows = rows.sort_values("accuracy")
    axes.loglog(rows["accuracy"], rows["relative_bound"], color=COLOURS[0], marker=MARKERS[0], ms=5, label="bound")
    axes.loglog(rows["accuracy"], rows["accuracy"], color=COLOURS[7], ls="--", label="requested")
    if len(rows) > 1:
        axes.invert_xaxis()
    axes.set_xlabel(_VARIED["digits"][1])
    axes.set_ylabel("relative bound of the pull-off force")
    axes.legend(loc="best")


def _draw_edge(axes: Axes, table: pd.DataFrame) -> None:
    """Draw unknowns against the width of the edge, with the fitted line of each series."""
    rows = _edge_rows(table)
    for place, name in enumerate(_EDGES, start=1):
        one = rows[rows["varied"] == name]
        axes.semilogx(
            one["edge_width"],
            one["unknowns"],
            ls="",
            color=COLOURS[place],
            marker=MARKERS[place],
            ms=5,
            label=_VARIED[name][1],
        )
    for place, name in enumerate(_EDGES, start=1):
        one = rows[rows["varied"] == name]
        if one["edge_width"].nunique() > 1:
            fitted = line(_decades(one), one["unknowns"])
            ends = one["edge_width"].agg(["min", "max"])
            axes.semilogx(ends, fitted.start - fitted.slope * np.log10(ends), color=COLOURS[place], ls="--")
    axes.invert_xaxis()
    axes.set_xlabel("width of the cohesive edge / its radius")
    axes.set_ylabel("unknowns")
    axes.legend(loc="lower right")


def summary(table: pd.DataFrame) -> list[str]:
    """Return by how much the time grows over each series, and the growth of unknowns with the edge."""
    ok = table[table["status"] == "ok"]
    lines = [f"{'most / least CPU time of fscm:':34}{'ratio':>7}{'unknowns':>14}"]
    for name, (quantity, _) in _VARIED.items():
        rows = ok[ok["varied"] == name].sort_values(quantity, ascending=name != "digits")
        if not rows.empty:
            ends = f"{quantity} {rows[quantity].iloc[0]:g} to {rows[quantity].iloc[-1]:g}"
            unknowns = f"{rows['unknowns'].min():.0f} to {rows['unknowns'].max():.0f}"
            lines.append(f"  {ends:32}{rows['ratio'].max():>7.1f}{unknowns:>14}")
    rows = _edge_rows(table)
    for name in _EDGES:
        one = rows[rows["varied"] == name]
        if one["edge_width"].nunique() > 1:
            fitted = line(_decades(one), one["unknowns"])
            exponent = growth_exponent(1.0 / one["edge_width"], one["unknowns"])
            lines.append(
                f"  with {name}: unknowns = {fitted.start:.0f} + {fitted.slope:.0f} log10(1 / edge width) within "
                f"{100.0 * fitted.residual:.0f} %; width^-{exponent:.2f}"
            )
    return lines


GROWTH = Part(
    "growth",
    "CPU time and unknowns of fscm against digits, Tabor number and gradient exponent",
    items,
    measure,
    table,
    draw,
    summary,
)
