"""Findings on the full model: a domain too small, additional folds, the onset of hysteresis, forces that fall first."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, crosses, dashed, held, legend_below, level, line_a_value, of_model, panels
from comparisons.paper.paper_figure import Plan, Tables, paper_figure, rows_of
from comparisons.paper.solver_tasks import near_critical
from comparisons.paper.statements.measures import named, table_of
from comparisons.paper.statements.path_measures import turning_points
from comparisons.paper.tasks import curve, quantity

__all__: list[str] = []

_GRADIENTS = (0.0, 0.2, 0.4, 0.6)

#: n and mu at k = 0.4, and the reference.
_DOMAIN = [(n, 0.01, model) for n in (1.0, 1.5) for model in ("fscm", "fem")]
_DOMAIN += [(2.0, 0.668, "fscm"), (5.0, 0.246, "fscm")]

#: Cases of the folds, and the displacements of the part with the additional turning points.
_FOLDS = {(2.0, 0.4, 3.0): (-3.36, -3.22), (2.0, 0.6, 3.0): (-3.36, -3.32)}

_ONSET_N, _ONSET_MU = 2.0, 0.74

_FALLING_N = 1.5
_FORCE, _PLACE = "pull_off_force", "pull_off_displacement"
_FALLING = [
    *(("fscm", _FORCE, k, mu) for k in _GRADIENTS for mu in (0.01, 0.03, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 0.7, 1.0)),
    *(("fem", _FORCE, k, mu) for k, mu in ((0.0, 0.01), (0.0, 0.3), (0.4, 0.01), (0.4, 0.05))),
    *(("fscm", _PLACE, 0.4, mu) for mu in (0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.3)),
    *(("fem", _PLACE, 0.4, mu) for mu in (0.01, 0.1)),
]


def _draw_domain(figure: Figure, tables: Tables) -> None:
    axes = figure.subplots()
    exact, fem = of_model(tables[""], "fscm", "fem", column="reference")
    at = range(len(exact))
    axes.bar(at, 100.0 * exact["lacking"], 0.5, color=COLOURS[0], alpha=0.6, label="against fscm")
    crosses(axes, range(len(fem)), 100.0 * fem["lacking"], label="against fem")
    axes.axhline(0.1, color=COLOURS[1], lw=1.0, ls="--", label="0.1 %")
    axes.set(yscale="log", ylim=(1e-3, 10.0), ylabel="pull-off force that the scheme lacks (%)")
    axes.set_xticks(at, [f"{held(n=n)}\n{held(mu=mu)}" for n, mu in exact[["n", "mu"]].to_numpy()])
    axes.legend()


@paper_figure(_draw_domain, size=(5.0, 3.4))
def finding_domain() -> Plan[Tables]:
    """Pull-off force that the scheme with f(r_max) = 50 lacks, k = 0.4."""
    terms = {"force": _FORCE, "scheme": "stieltjes_force", "lacking": "scheme_lack"}
    table = yield from table_of([(model, {}, named(n, 0.4, mu)) for n, mu, model in _DOMAIN], **terms)
    return {"": table}


def _draw_fold_pairs(figure: Figure, tables: Tables) -> None:
    words = [held(n=n, k=k, mu=mu) for n, k, mu in _FOLDS]
    lattice = panels(figure, 1, 2, words, LABELS["central_gap"], LABELS["displacement"])
    for axes, ((_, k, _), limits) in zip(lattice, _FOLDS.items(), strict=True):
        exact, fem = of_model(tables[""][tables[""]["k"] == k], "fscm", "fem")
        turns = exact[exact["turning_point"]]
        axes.plot(exact["central_gap"], exact["displacement"], color=COLOURS[0], label="fscm")
        crosses(axes, fem["central_gap"], fem["displacement"], ms=4, color=COLOURS[1], label="fem")
        open_circle = {"marker": "o", "mfc": "white", "color": COLOURS[2]}
        crosses(axes, turns["central_gap"], turns["displacement"], ms=6, label="turning points", **open_circle)
        axes.set(xlim=(0.0, 2.6), ylim=limits)
    legend_below(figure, 3)


@paper_figure(_draw_fold_pairs, follows_path=True)
def finding_fold_pairs() -> Plan[Tables]:
    """Additional turning points of the displacement at mu = 3."""
    results = yield {(case, model): CachedCall.of(curve, model, *case) for case in _FOLDS for model in ("fscm", "fem")}
    parts = []
    for ((n, k, mu), model), path in results.items():
        columns = {name: path[name] for name in ("displacement", "u_displacement")}
        key = {"model": model, "n": n, "k": k, "mu": mu, "central_gap": path["columns"]["central_gap"]}
        table = pd.DataFrame(key | columns)
        turns = turning_points(np.array(path["displacement"]), path["u_displacement"])
        parts.append(table.assign(turning_point=table.index.isin(turns)))
    return {"": pd.concat(parts, ignore_index=True)}


def _draw_onset(figure: Figure, tables: Tables) -> None:
    critical = tables[""]
    axes = figure.subplots()
    axes.plot(critical["k"], critical["mu"], color=COLOURS[0], marker="o", ms=4, label="critical Tabor number")
    low, high = critical["mu"].min(), critical["mu"].max()
    axes.axhspan(low, high, color=COLOURS[1], alpha=0.15, lw=0, label="the gradient exponent decides")
    for mu in (0.5, 1.0):
        level(axes, mu, ls=":")
        axes.annotate(f"Fig. 6: μ = {mu:g}", (0.6, mu), (0, 3), textcoords="offset points", ha="right", fontsize=8)
    (fem,) = of_model(tables["energies"], "fem")
    for status, face, label in (("ok", COLOURS[2], "jumps"), ("not-applicable", "white", "no jump")):
        squares = fem[fem["status"] == status]
        square = {"marker": "s", "ms": 7, "color": COLOURS[2], "mfc": face}
        crosses(axes, squares["k"], squares["mu"], label=f"{label} (both references)", **square)
    axes.set(xlabel=LABELS["k"], ylabel=LABELS["mu"], ylim=(0.2, 1.1), xlim=(-0.03, 0.63))
    axes.legend(loc="lower left", fontsize=8)


@paper_figure(_draw_onset, size=(5.0, 3.6))
def finding_onset() -> Plan[Tables]:
    """Onset of hysteresis over the gradient exponent at n = 2."""
    calls: dict[Any, CachedCall] = {k: CachedCall.of(near_critical, _ONSET_N, k) for k in _GRADIENTS}
    for model in ("fscm", "fem"):
        for k in (0.0, 0.4):
            calls[model, k] = CachedCall.of(quantity, model, "hysteresis_energy", _ONSET_N, k, _ONSET_MU)
    results = yield calls
    critical = [{"n": _ONSET_N, "k": k} | {name: results[k][name] for name in ("mu", "u_mu")} for k in _GRADIENTS]
    energies = [
        {"model": model, "n": _ONSET_N, "k": k, "mu": _ONSET_MU} | results[model, k]
        for model in ("fscm", "fem")
        for k in (0.0, 0.4)
    ]
    return {"": pd.DataFrame(critical), "energies": pd.DataFrame(energies)}


def _draw_falls_first(figure: Figure, tables: Tables) -> None:
    left, right = panels(figure, 1, 2, (held(n=_FALLING_N), held(n=_FALLING_N, k=0.4)), LABELS["mu"])
    for axes, name in ((left, _FORCE), (right, _PLACE)):
        exact, fem = of_model(tables[""][tables[""]["quantity"] == name], "fscm", "fem")
        style = dashed(_GRADIENTS.index(0.4)) if name == _PLACE else {}
        line_a_value(axes, exact, "k", "mu", "value", label="fscm, ", **style)
        crosses(axes, fem["mu"], fem["value"], ms=6, zorder=3, label="fem")
        axes.set(xscale="log")
    left.set(ylabel=LABELS["force"], ylim=(2.1, 2.3))
    right.set(ylabel=r"displacement at pull-off $\delta_c/z_0$")
    legend_below(figure, 5)


@paper_figure(_draw_falls_first)
def finding_falls_first() -> Plan[Tables]:
    """Pull-off force and its displacement at n = 1.5, which fall before they rise."""
    table = yield from rows_of(
        (
            {"model": model, "quantity": name, "n": _FALLING_N, "k": k, "mu": mu},
            CachedCall.of(quantity, model, name, _FALLING_N, k, mu),
        )
        for model, name, k, mu in _FALLING
    )
    return {"": table}
