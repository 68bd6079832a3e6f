"""Fig. 9: the asymptotes of the jumps beside the FSCM, and their coefficients over the gradient exponent."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.models.semi_rigid import jump_in_coefficient
from comparisons.output.style import COLOURS, LINES, MODEL_LINES, lettered, styled
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.figures.fig08_jumps import TABOR_NUMBERS, jumps, near_critical
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.tasks import quantity

__all__ = ["JUMP_ASYMPTOTES", "asymptotes", "coefficients"]

_N, _K = 2.0, 0.4
_SHAPES = (1.0, 1.5, 2.0, 5.0)
#: Quantity -> the model whose asymptote it has: Eqs. 47 and 54.
_MODELS = {"jump_in_displacement": "semi-rigid", "jump_out_displacement": "jkr"}
_TABOR_NUMBERS = np.linspace(0.05, 5.0, 100)
_GRADIENTS = np.linspace(0.0, 1.0, 101)


def asymptotes(n: float, k: float) -> list[dict[str, Any]]:
    """Return rows of mu and the displacements at the jumps by Eqs. 47 and 54; None where Eq. 46 has no jump.

    Examples
    --------
    >>> round(asymptotes(2, 0.4)[-1]["jump_out_displacement"], 2)
    -7.98
    """
    rows = []
    for mu in map(float, _TABOR_NUMBERS):
        row: dict[str, Any] = {"mu": mu}
        for name, model in _MODELS.items():
            found = quantity(model, name, n, k, mu)
            row |= {name: found["value"], f"u_{name}": found["u_num"]}
        rows.append(row)
    return rows


def coefficients(n: float) -> list[dict[str, float]]:
    """Return rows of k, C_in (Eq. 48) and C_out (Eq. 55), from k = 0 to the Gibson limit.

    Examples
    --------
    >>> last = coefficients(5)[-1]
    >>> round(last["C_in"], 12), round(last["C_out"], 12)
    (2.666666666667, 2.0)
    """
    return [
        {
            "k": float(k),
            "C_in": jump_in_coefficient(n, float(k)),
            "C_out": -quantity("jkr", "jump_out_displacement", n, float(k), 1.0)["value"],
        }
        for k in _GRADIENTS
    ]


def _tasks() -> Sequence[CachedCall]:
    return [
        CachedCall.of(near_critical, _N, _K),
        *(CachedCall.of(jumps, _N, _K, mu) for mu in reversed(TABOR_NUMBERS)),
        CachedCall.of(asymptotes, _N, _K),
        *(CachedCall.of(coefficients, n) for n in _SHAPES),
    ]


def _tables(results: Results) -> Tables:
    # Where the two jumps part, then evenly.
    first = results[CachedCall.of(near_critical, _N, _K)]["jumps"][0]
    computed = [first, *({"mu": mu} | results[CachedCall.of(jumps, _N, _K, mu)] for mu in TABOR_NUMBERS)]
    computed_columns = ["mu", *(f"{u}{name}" for name in _MODELS for u in ("", "u_"))]
    fscm = pd.DataFrame(computed)[computed_columns].sort_values("mu")
    closed = pd.DataFrame(results[CachedCall.of(asymptotes, _N, _K)])
    displacements = pd.concat([fscm.assign(model="fscm"), closed.assign(model="asymptote")], ignore_index=True)
    constants = [pd.DataFrame(results[CachedCall.of(coefficients, n)]).assign(n=n) for n in _SHAPES]
    return {
        "displacements": displacements[["model", *computed_columns]].assign(n=_N, k=_K),
        "coefficients": pd.concat(constants, ignore_index=True)[["n", "k", "C_in", "C_out"]],
    }


def _draw(tables: Tables) -> Figure:
    with styled():
        figure = Figure(figsize=(7.2, 3.5), layout="constrained")
        left, right = figure.subplots(1, 2)
        _displacements(left, tables["displacements"])
        _coefficients(right, tables["coefficients"])
    return figure


def _displacements(axes: Axes, table: pd.DataFrame) -> None:
    fscm, closed = (table[table["model"] == model] for model in ("fscm", "asymptote"))
    for index, (name, label) in enumerate((("jump_in", "in, Eq. 47"), ("jump_out", "out, Eq. 54"))):
        column = f"{name}_displacement"
        axes.plot(closed["mu"], closed[column], color=COLOURS[index], ls=("-", "--")[index], label=f"jump {label}")
        axes.plot(
            fscm["mu"],
            fscm[column],
            **MODEL_LINES["fscm"] | {"color": COLOURS[index]},
            label=f"jump {label.split(',')[0]}, FSCM",
        )
    last, asymptote = fscm.iloc[-1], closed.iloc[-1]
    difference = asymptote["jump_in_displacement"] / last["jump_in_displacement"] - 1.0
    # Below both curves, where no line runs.
    axes.text(
        0.03,
        0.03,
        f"Eq. 47 is {100.0 * difference:.0f} % farther\nthan the FSCM at $\\mu$ = {last['mu']:g}",
        transform=axes.transAxes,
        fontsize=8,
    )
    axes.set(xlim=(0.0, 5.1), xlabel=r"Tabor number $\mu$", ylabel=r"displacement at the jumps $\delta/z_0$")
    lettered(axes, "a", f"$n$ = {_N:g}, $k$ = {_K:g}")
    axes.legend()


def _coefficients(axes: Axes, table: pd.DataFrame) -> None:
    for index, (n, part) in enumerate(table.groupby("n")):
        axes.plot(part["k"], part["C_in"], color=COLOURS[index], ls=LINES[index], label=f"$n$ = {n:g}")
        axes.plot(part["k"], part["C_out"], color=COLOURS[index], ls=LINES[index], lw=0.8)
    for limit, text in ((8.0 / 3.0, "8/3"), (2.0, "2")):
        axes.plot(1.0, limit, ls="none", marker="o", ms=4, color="0.2", clip_on=False)
        axes.annotate(text, (1.0, limit), (6, -3), textcoords="offset points", annotation_clip=False)
    axes.set(xlim=(0.0, 1.0), xlabel="gradient exponent $k$")
    axes.set_ylabel(r"$C^{\mathrm{in}}$ (thick), $C^{\mathrm{out}}$ (thin)")
    lettered(axes, "b")
    # Between the two bundles of curves.
    axes.legend(loc="center", bbox_to_anchor=(0.45, 0.7), ncols=2)


JUMP_ASYMPTOTES = PaperFigure(
    name="9",
    stem="fig09_jump_asymptotes",
    title="Asymptotes of the jumps beside the FSCM, and their coefficients",
    tasks=_tasks,
    tables=_tables,
    draw=_draw,
)
