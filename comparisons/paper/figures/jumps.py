"""Figs. 8 and 9: displacement and central gap at the two jumps over the Tabor number, and their asymptotes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.models.semi_rigid import jump_in_coefficient
from comparisons.output.style import COLOURS, MODEL_LINES
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, dashed, held, legend_below, line_a_value, of_model, panels
from comparisons.paper.paper_figure import Plan, Tables, paper_figure
from comparisons.paper.solver_tasks import jumps, near_critical
from comparisons.paper.tasks import quantity

__all__ = ["TABOR_NUMBERS", "asymptotes", "coefficients"]

_N, _K = 2.0, 0.4
_SHAPES = (1.0, 1.5, 2.0, 5.0)
_GRADIENTS = (0.0, 0.2, 0.4, 0.6)
#: Above the critical Tabor numbers, which are between 0.69 and 0.79.
TABOR_NUMBERS = (0.85, 0.9, 1.0, 1.1, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0)
#: Quantity -> the model whose asymptote it has: Eqs. 47 and 54.
_ASYMPTOTES = {"jump_in_displacement": "semi-rigid", "jump_out_displacement": "jkr"}
#: Places of the insets and what they show; where the branches are named at `_NAMED_AT`, in points of the page.
_INSETS = {"displacement": (0.13, 0.08, 0.38, 0.4), "gap": (0.52, 0.16, 0.45, 0.33)}
_INSET_RANGES = {"displacement": (-1.7, -1.1), "gap": (0.0, 0.6)}
_NAMED_AT = 3.5
_OFFSETS = {"displacement": ((12, 10), (32, 2)), "gap": ((-28, 10), (-75, 6))}


def _branches(figure: Figure, tables: Tables) -> None:
    table, lattice = tables[""], panels(figure, 1, 2, (held(n=_N),) * 2, LABELS["mu"])
    for axes, (kind, position) in zip(lattice, _INSETS.items(), strict=True):
        # Where the branches begin, enlarged.
        inset = axes.inset_axes(position)
        names = [f"jump_{name}_{kind}" for name in ("in", "out")]
        for index, (k, mu) in enumerate(zip(_GRADIENTS, tables["critical"]["mu"], strict=True)):
            # Both branches begin in one point, at the critical Tabor number, between their first points.
            rows_of_k = table[table["k"] == k]
            meeting = rows_of_k[names].iloc[0].mean()
            for panel in (axes, inset):
                for name, label in zip(names, (rf"{held(k=k)}, $\mu_c$ = {mu:.5f}", "_"), strict=True):
                    panel.plot([mu, *rows_of_k["mu"]], [meeting, *rows_of_k[name]], label=label, **dashed(index))
                panel.plot(mu, meeting, marker="o", ms=4, color=COLOURS[index], mfc="white")
        inset.set(xlim=(0.65, 0.95), ylim=_INSET_RANGES[kind])
        inset.tick_params(labelsize=7, pad=2)
        for name, text, offset in zip(names, ("jump in", "jump out"), _OFFSETS[kind], strict=True):
            at = (_NAMED_AT, float(table.loc[table["mu"] == _NAMED_AT, name].mean()))
            axes.annotate(text, at, offset, textcoords="offset points", ha="center")
        axes.set_xlim(0.5, 5.0)
    lattice[0].set_ylabel(r"displacement at the jumps $\delta/z_0$")
    lattice[1].set_ylabel(r"central gap at the jumps $H_0/z_0$")
    legend_below(figure, 4)


@paper_figure(_branches, size=(7.2, 3.8))
def fig08_jumps() -> Plan[Tables]:
    """Displacement and central gap at the jumps for n = 2, over the Tabor number."""
    calls: dict[Any, CachedCall] = {k: CachedCall.of(near_critical, _N, k) for k in _GRADIENTS}
    calls |= {(k, mu): CachedCall.of(jumps, _N, k, mu) for mu in TABOR_NUMBERS for k in _GRADIENTS}
    results = yield calls
    critical = pd.DataFrame([{"n": _N, "k": k} | results[k] for k in _GRADIENTS])
    rows = [{"n": _N, "k": k} | row for k in _GRADIENTS for row in results[k]["jumps"]]
    rows += [{"n": _N, "k": k, "mu": mu} | results[k, mu] for k in _GRADIENTS for mu in TABOR_NUMBERS]
    table = pd.DataFrame(rows).sort_values(["k", "mu"], ignore_index=True)
    return {"": table, "critical": critical.drop(columns="jumps")}


def asymptotes(n: float, k: float) -> list[dict[str, Any]]:
    """Return rows of mu and the displacements at the jumps by Eqs. 47 and 54; None where Eq. 46 has no jump.

    Examples
    --------
    >>> round(asymptotes(2, 0.4)[-1]["jump_out_displacement"], 2)
    -7.98
    """
    rows = []
    for mu in np.linspace(0.05, 5.0, 100).tolist():
        row: dict[str, Any] = {"mu": mu}
        for name, model in _ASYMPTOTES.items():
            closed = quantity(model, name, n, k, mu)
            row |= {name: closed["value"], f"u_{name}": closed["u_num"]}
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
            "k": k,
            "C_in": jump_in_coefficient(n, k),
            "C_out": -quantity("jkr", "jump_out_displacement", n, k, 1.0)["value"],
        }
        for k in np.linspace(0.0, 1.0, 101).tolist()
    ]


def _beside_asymptotes(figure: Figure, tables: Tables) -> None:
    left, right = panels(figure, 1, 2, (held(n=_N, k=_K), ""))
    fscm, closed = of_model(tables["displacements"], "fscm", "asymptote")
    for index, (column, words) in enumerate(zip(_ASYMPTOTES, ("jump in, Eq. 47", "jump out, Eq. 54"), strict=True)):
        left.plot(closed["mu"], closed[column], label=words, color=COLOURS[index], ls=("-", "--")[index])
        broad = MODEL_LINES["fscm"] | {"color": COLOURS[index]}
        left.plot(fscm["mu"], fscm[column], label=words.partition(",")[0] + ", FSCM", **broad)
    excess = closed["jump_in_displacement"].iloc[-1] / fscm["jump_in_displacement"].iloc[-1] - 1.0
    words = f"Eq. 47 is {100.0 * excess:.0f} % farther\nthan the FSCM at $\\mu$ = {fscm['mu'].iloc[-1]:g}"
    # Below both curves, where no line runs.
    left.text(0.03, 0.03, words, transform=left.transAxes, fontsize=8)
    left.set(xlim=(0.0, 5.1), xlabel=LABELS["mu"], ylabel=r"displacement at the jumps $\delta/z_0$")
    left.legend()
    line_a_value(right, tables["coefficients"], "n", "k", "C_in")
    line_a_value(right, tables["coefficients"], "n", "k", "C_out", lw=0.8, label="_")
    for limit, text in ((8.0 / 3.0, "8/3"), (2.0, "2")):
        right.plot(1.0, limit, ls="none", marker="o", ms=4, color="0.2", clip_on=False)
        right.annotate(text, (1.0, limit), (6, -3), textcoords="offset points", annotation_clip=False)
    right.set(xlim=(0.0, 1.0), xlabel=LABELS["k"], ylabel=r"$C^{\mathrm{in}}$ (thick), $C^{\mathrm{out}}$ (thin)")
    # Between the two bundles of curves.
    right.legend(loc="center", bbox_to_anchor=(0.45, 0.7), ncols=2)


@paper_figure(_beside_asymptotes, size=(7.2, 3.5))
def fig09_jump_asymptotes() -> Plan[Tables]:
    """Asymptotes of the jumps beside the FSCM, and their coefficients."""
    calls: dict[Any, CachedCall] = {mu: CachedCall.of(jumps, _N, _K, mu) for mu in TABOR_NUMBERS}
    calls |= {"onset": CachedCall.of(near_critical, _N, _K), "asymptotes": CachedCall.of(asymptotes, _N, _K)}
    calls |= {("C", n): CachedCall.of(coefficients, n) for n in _SHAPES}
    results = yield calls
    # Where the two jumps part, then evenly.
    computed = [results["onset"]["jumps"][0], *({"mu": mu} | results[mu] for mu in TABOR_NUMBERS)]
    columns = ["mu", *(f"{u}{name}" for name in _ASYMPTOTES for u in ("", "u_"))]
    fscm = pd.DataFrame(computed)[columns].assign(model="fscm")
    closed = pd.DataFrame(results["asymptotes"]).assign(model="asymptote")
    constants = pd.concat([pd.DataFrame(results["C", n]).assign(n=n) for n in _SHAPES], ignore_index=True)
    displacements = pd.concat([fscm, closed], ignore_index=True)[["model", *columns]]
    return {
        "displacements": displacements.assign(n=_N, k=_K),
        "coefficients": constants[["n", "k", "C_in", "C_out"]],
    }
