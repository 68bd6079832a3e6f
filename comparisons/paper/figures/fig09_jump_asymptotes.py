"""Fig. 9: the asymptotes of the jumps beside the FSCM, and their coefficients over the gradient exponent."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from comparisons.models.semi_rigid import jump_in_coefficient
from comparisons.output.style import COLOURS, MODEL_LINES, lettered
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, dashed, of_model
from comparisons.paper.figures.fig08_jumps import TABOR_NUMBERS, jumps, near_critical
from comparisons.paper.paper_figure import PaperFigure, Plan, Tables
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


def _plan() -> Plan[Tables]:
    onset, closed_forms = CachedCall.of(near_critical, _N, _K), CachedCall.of(asymptotes, _N, _K)
    beyond = {mu: CachedCall.of(jumps, _N, _K, mu) for mu in reversed(TABOR_NUMBERS)}
    of_shapes = {n: CachedCall.of(coefficients, n) for n in _SHAPES}
    results = yield [onset, *beyond.values(), closed_forms, *of_shapes.values()]
    # Where the two jumps part, then evenly.
    computed = [results[onset]["jumps"][0], *({"mu": mu} | results[call] for mu, call in beyond.items())]
    columns = ["mu", *(f"{u}{name}" for name in _MODELS for u in ("", "u_"))]
    fscm = pd.DataFrame(computed)[columns].sort_values("mu").assign(model="fscm")
    closed = pd.DataFrame(results[closed_forms]).assign(model="asymptote")
    displacements = pd.concat([fscm, closed], ignore_index=True)[["model", *columns]]
    constants = pd.concat([pd.DataFrame(results[call]).assign(n=n) for n, call in of_shapes.items()], ignore_index=True)
    return {
        "displacements": displacements.assign(n=_N, k=_K),
        "coefficients": constants[["n", "k", "C_in", "C_out"]],
    }


def _picture(figure: Figure, tables: Tables) -> None:
    left, right = figure.subplots(1, 2)
    _displacements(left, tables["displacements"])
    _coefficients(right, tables["coefficients"])


def _displacements(axes: Axes, table: pd.DataFrame) -> None:
    fscm, closed = of_model(table, "fscm", "asymptote")
    broad = MODEL_LINES["fscm"]
    for index, (name, equation) in enumerate((("in", "Eq. 47"), ("out", "Eq. 54"))):
        column, colour = f"jump_{name}_displacement", COLOURS[index]
        axes.plot(closed["mu"], closed[column], color=colour, ls=("-", "--")[index], label=f"jump {name}, {equation}")
        axes.plot(fscm["mu"], fscm[column], **broad | {"color": colour}, label=f"jump {name}, FSCM")
    last, asymptote = fscm.iloc[-1], closed.iloc[-1]
    difference = asymptote["jump_in_displacement"] / last["jump_in_displacement"] - 1.0
    text = f"Eq. 47 is {100.0 * difference:.0f} % farther\nthan the FSCM at $\\mu$ = {last['mu']:g}"
    # Below both curves, where no line runs.
    axes.text(0.03, 0.03, text, transform=axes.transAxes, fontsize=8)
    axes.set(xlim=(0.0, 5.1), xlabel=LABELS["mu"], ylabel=r"displacement at the jumps $\delta/z_0$")
    lettered(axes, "a", f"$n$ = {_N:g}, $k$ = {_K:g}")
    axes.legend()


def _coefficients(axes: Axes, table: pd.DataFrame) -> None:
    for index, (n, part) in enumerate(table.groupby("n")):
        axes.plot(part["k"], part["C_in"], label=f"$n$ = {n:g}", **dashed(index))
        axes.plot(part["k"], part["C_out"], lw=0.8, **dashed(index))
    for limit, text in ((8.0 / 3.0, "8/3"), (2.0, "2")):
        axes.plot(1.0, limit, ls="none", marker="o", ms=4, color="0.2", clip_on=False)
        axes.annotate(text, (1.0, limit), (6, -3), textcoords="offset points", annotation_clip=False)
    axes.set(xlim=(0.0, 1.0), xlabel=LABELS["k"], ylabel=r"$C^{\mathrm{in}}$ (thick), $C^{\mathrm{out}}$ (thin)")
    lettered(axes, "b")
    # Between the two bundles of curves.
    axes.legend(loc="center", bbox_to_anchor=(0.45, 0.7), ncols=2)


JUMP_ASYMPTOTES = PaperFigure(
    name="9",
    stem="fig09_jump_asymptotes",
    title="Asymptotes of the jumps beside the FSCM, and their coefficients",
    plan=_plan,
    picture=_picture,
    size=(7.2, 3.5),
)
