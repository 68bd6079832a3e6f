"""Findings on the full model: a domain too small, additional folds, the onset of hysteresis, forces that fall first."""

from __future__ import annotations

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, LINES, lettered
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import LABELS, crosses, dashed, legend_below, of_model
from comparisons.paper.figures.fig08_jumps import near_critical
from comparisons.paper.paper_figure import PaperFigure, Plan, Tables, rows_of
from comparisons.paper.statements.numbers import case_keys, lacking, number, tasks_of
from comparisons.paper.statements.paths import turning_points
from comparisons.paper.tasks import curve, quantity
from comparisons.paper.values.scheme_ingredients import scheme_force

__all__ = ["DOMAIN", "FOLD_PAIRS", "ONSET", "PULL_OFF_FALLS_FIRST"]

_GRADIENTS = (0.0, 0.2, 0.4, 0.6)

_DOMAIN_CASES = ((1.0, 0.4, 0.01), (1.5, 0.4, 0.01), (2.0, 0.4, 0.668), (5.0, 0.4, 0.246))
_DOMAIN = [("fscm", case) for case in _DOMAIN_CASES] + [("fem", case) for case in _DOMAIN_CASES[:2]]

#: Cases of the folds, and the displacements of the part with the additional turning points.
_FOLDS = {(2.0, 0.4, 3.0): (-3.36, -3.22), (2.0, 0.6, 3.0): (-3.36, -3.32)}
_GAPS = (0.0, 2.6)

_ONSET_N, _ONSET_MU = 2.0, 0.74
#: Tabor numbers of Fig. 6.
_SHOWN = (0.5, 1.0)

_FALLING_N = 1.5
_FORCE, _PLACE = "pull_off_force", "pull_off_displacement"
_FALLING = [
    *(("fscm", _FORCE, k, mu) for k in _GRADIENTS for mu in (0.01, 0.03, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 0.7, 1.0)),
    *(("fem", _FORCE, k, mu) for k, mu in ((0.0, 0.01), (0.0, 0.3), (0.4, 0.01), (0.4, 0.05))),
    *(("fscm", _PLACE, 0.4, mu) for mu in (0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.3)),
    *(("fem", _PLACE, 0.4, mu) for mu in (0.01, 0.1)),
]


def _domain() -> Plan[Tables]:
    schemes = {case: CachedCall.of(scheme_force, *case) for case in _DOMAIN_CASES}
    results = yield [*schemes.values(), *(call for model, case in _DOMAIN for call in tasks_of(model, _FORCE, case))]
    rows = []
    for model, case in sorted(_DOMAIN, key=lambda one: _DOMAIN_CASES.index(one[1])):
        scheme, exact = results[schemes[case]], number(results, model, _FORCE, case)
        share = lacking(scheme, exact)
        rows.append(
            {"reference": model}
            | case_keys(case)
            | {"force": exact.value, "u_force": exact.u, "scheme": scheme["force"], "u_scheme": scheme["u_num"]}
            | {"lacking": share.value, "u_lacking": share.u}
        )
    return {"": pd.DataFrame(rows)}


def _draw_domain(figure: Figure, tables: Tables) -> None:
    axes = figure.subplots()
    exact, fem = of_model(tables[""], "fscm", "fem", column="reference")
    places = {n: place for place, n in enumerate(exact["n"])}
    at = list(places.values())
    axes.bar(at, 100.0 * exact["lacking"], 0.5, color=COLOURS[0], alpha=0.6, label="against fscm")
    crosses(axes, fem["n"].map(places), 100.0 * fem["lacking"], label="against fem")
    axes.axhline(0.1, color=COLOURS[1], lw=1.0, ls="--", label="0.1 %")
    axes.set(yscale="log", ylim=(1e-3, 10.0), ylabel="pull-off force that the scheme lacks (%)")
    axes.set_xticks(at, [f"$n$ = {n:g}\n$\\mu$ = {mu:g}" for n, mu in exact[["n", "mu"]].to_numpy()])
    axes.legend()


DOMAIN = PaperFigure(
    name="finding-domain",
    stem="finding_domain",
    title="Pull-off force that the scheme with f(r_max) = 50 lacks, k = 0.4",
    plan=_domain,
    picture=_draw_domain,
    size=(5.0, 3.4),
)


def _fold_pairs() -> Plan[Tables]:
    calls = {(case, model): CachedCall.of(curve, model, *case) for case in _FOLDS for model in ("fscm", "fem")}
    results = yield list(calls.values())
    parts = []
    for (case, model), call in calls.items():
        path = results[call]
        table = pd.DataFrame(
            {"model": model}
            | case_keys(case)
            | {"central_gap": path["columns"]["central_gap"]}
            | {name: path[name] for name in ("displacement", "u_displacement")}
        )
        turns = turning_points(np.array(path["displacement"]), path["u_displacement"])
        parts.append(table.assign(turning_point=table.index.isin(turns)))
    return {"": pd.concat(parts, ignore_index=True)}


def _draw_fold_pairs(figure: Figure, tables: Tables) -> None:
    for letter, axes, (case, limits) in zip("ab", figure.subplots(1, 2), _FOLDS.items(), strict=True):
        exact, fem = of_model(tables[""][tables[""]["k"] == case[1]], "fscm", "fem")
        turns = exact[exact["turning_point"]]
        for part, style in (
            (exact, {"color": COLOURS[0], "ls": LINES[0], "label": "fscm"}),
            (fem, {"ls": "none", "marker": "x", "ms": 4, "color": COLOURS[1], "label": "fem"}),
            (turns, {"ls": "none", "marker": "o", "mfc": "white", "color": COLOURS[2], "label": "turning points"}),
        ):
            axes.plot(part["central_gap"], part["displacement"], **style)
        axes.set(xlim=_GAPS, ylim=limits, xlabel=r"central gap $H_0/z_0$", ylabel=LABELS["displacement"])
        lettered(axes, letter, r"$n$ = {:g}, $k$ = {:g}, $\mu$ = {:g}".format(*case))
    legend_below(figure, 3)


FOLD_PAIRS = PaperFigure(
    name="finding-fold-pairs",
    stem="finding_fold_pairs",
    title="Additional turning points of the displacement at mu = 3",
    plan=_fold_pairs,
    picture=_draw_fold_pairs,
    follows_path=True,
)


def _onset() -> Plan[Tables]:
    onsets = {k: CachedCall.of(near_critical, _ONSET_N, k) for k in _GRADIENTS}
    energies = [
        (
            {"model": model, "n": _ONSET_N, "k": k, "mu": _ONSET_MU},
            CachedCall.of(quantity, model, "hysteresis_energy", _ONSET_N, k, _ONSET_MU),
        )
        for model in ("fscm", "fem")
        for k in (0.0, 0.4)
    ]
    results = yield [*onsets.values(), *(call for _, call in energies)]
    rows = [
        {"n": _ONSET_N, "k": k} | {name: results[call][name] for name in ("mu", "u_mu")} for k, call in onsets.items()
    ]
    return {"": pd.DataFrame(rows), "energies": pd.DataFrame([key | results[call] for key, call in energies])}


def _draw_onset(figure: Figure, tables: Tables) -> None:
    critical = tables[""]
    axes = figure.subplots()
    axes.plot(critical["k"], critical["mu"], color=COLOURS[0], marker="o", ms=4, label="critical Tabor number")
    low, high = critical["mu"].min(), critical["mu"].max()
    axes.axhspan(low, high, color=COLOURS[1], alpha=0.15, lw=0, label="the gradient exponent decides")
    for mu in _SHOWN:
        axes.axhline(mu, color="0.5", lw=0.8, ls=":")
        axes.annotate(f"Fig. 6: μ = {mu:g}", (0.6, mu), (0, 3), textcoords="offset points", ha="right", fontsize=8)
    (fem,) = of_model(tables["energies"], "fem")
    for status, face, label in (
        ("ok", COLOURS[2], "jumps (both references)"),
        ("not-applicable", "white", "no jump (both references)"),
    ):
        part = fem[fem["status"] == status]
        axes.plot(part["k"], part["mu"], ls="none", marker="s", ms=7, color=COLOURS[2], mfc=face, label=label)
    axes.set(xlabel=LABELS["k"], ylabel=LABELS["mu"], ylim=(0.2, 1.1), xlim=(-0.03, 0.63))
    axes.legend(loc="lower left", fontsize=8)


ONSET = PaperFigure(
    name="finding-onset",
    stem="finding_onset",
    title="Onset of hysteresis over the gradient exponent at n = 2",
    plan=_onset,
    picture=_draw_onset,
    size=(5.0, 3.6),
)


def _falls_first() -> Plan[Tables]:
    table = yield from rows_of(
        (
            {"model": model, "quantity": name, "n": _FALLING_N, "k": k, "mu": mu},
            CachedCall.of(quantity, model, name, _FALLING_N, k, mu),
        )
        for model, name, k, mu in _FALLING
    )
    return {"": table}


def _draw_falls_first(figure: Figure, tables: Tables) -> None:
    left, right = figure.subplots(1, 2)
    for axes, name in ((left, _FORCE), (right, _PLACE)):
        exact, fem = of_model(tables[""][tables[""]["quantity"] == name], "fscm", "fem")
        for k, part in exact.groupby("k"):
            axes.plot(part["mu"], part["value"], label=f"fscm, $k$ = {k:g}", **dashed(_GRADIENTS.index(k)))
        crosses(axes, fem["mu"], fem["value"], ms=6, zorder=3, label="fem")
        axes.set(xscale="log", xlabel=LABELS["mu"])
    left.set(ylabel=LABELS["force"], ylim=(2.1, 2.3))
    right.set(ylabel=r"displacement at pull-off $\delta_c/z_0$")
    lettered(left, "a", f"$n$ = {_FALLING_N:g}")
    lettered(right, "b", f"$n$ = {_FALLING_N:g}, $k$ = 0.4")
    legend_below(figure, 5)


PULL_OFF_FALLS_FIRST = PaperFigure(
    name="finding-falls-first",
    stem="finding_falls_first",
    title="Pull-off force and its displacement at n = 1.5, which fall before they rise",
    plan=_falls_first,
    picture=_draw_falls_first,
)
