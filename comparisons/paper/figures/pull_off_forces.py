"""Figs. 10 and 14 to 16: the pull-off force over the Tabor number, of the FSCM and of closed forms; findings on it.

They are errors of the Maugis-Dugdale models, a force that falls first, and a domain too small.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator

from comparisons.output.errors import relative_error
from comparisons.output.style import COLOURS, MARKERS, MODEL_LINES
from comparisons.paper.drawing import (
    banded,
    beside_fem,
    by_model,
    case,
    dashed,
    legend_below,
    level,
    lines_by,
    of_model,
    panels,
)
from comparisons.paper.paper_figure import Tables, paper_figure
from comparisons.paper.plan import Plan, cases, rows_of, together
from comparisons.paper.statements.measures import table_of_terms
from comparisons.paper.tasks import COHESIVE, GRADIENTS, SHAPES, quantity

#: Range of the pull-off force of each panel of Fig. 10, by shape index: a panel spans less than two decades.
_SHAPES = {1.0: (2.0, 80.0), 1.5: (1.5, 7.0), 2.0: (1.45, 2.05), 5.0: (0.25, 2.2)}
_TRANSITION = (0.01, 0.03, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0)
#: The closed forms are power laws of mu: two points are the line.  JKR is drawn where it is near the curves.
_ENDS, _JKR_FROM = (_TRANSITION[0], _TRANSITION[-1]), 0.3
_K = 0.4
#: Face of the markers of a model; None: the colour of its line.
_FACES = {"md-original": "white", "md-improved": None}
#: Ten a decade, the preferred numbers of the series R10 but for rounding.
TABOR_NUMBERS = tuple(float(f"{mu:.3g}") for mu in np.geomspace(0.01, 10.0, 31))

#: Reference, n and mu of the errors.
_FORCES = [
    *(("fscm", n, mu) for n in SHAPES for mu in (1.0, 1.5, 2.0, 3.0, 5.0, 7.0, 10.0)),
    *(("fem", n, mu) for n, mu in ((1.0, 2.0), (1.5, 2.0), (5.0, 2.0), (5.0, 3.0))),
]
#: n and mu at `_K`, and the reference.
_DOMAIN = [(n, 0.01, model) for n in (1.0, 1.5) for model in ("fscm", "fem")]
_DOMAIN += [(2.0, 0.668, "fscm"), (5.0, 0.246, "fscm")]
_FALLING_N = 1.5
_FORCE, _PLACE = "pull_off_force", "pull_off_displacement"
_FALLING = [
    *(("fscm", _FORCE, k, mu) for k in GRADIENTS for mu in (0.01, 0.03, 0.05, 0.1, 0.15, 0.2, 0.3, 0.5, 0.7, 1.0)),
    *(("fem", _FORCE, k, mu) for k, mu in ((0.0, 0.01), (0.0, 0.3), (0.4, 0.01), (0.4, 0.05))),
    *(("fscm", _PLACE, 0.4, mu) for mu in (0.01, 0.02, 0.03, 0.05, 0.07, 0.1, 0.15, 0.2, 0.3)),
    *(("fem", _PLACE, 0.4, mu) for mu in (0.01, 0.1)),
]


def _log_forces(axes: Axes, low: float, high: float) -> None:
    """A logarithmic axis with plain numbers: 2, not 2 x 10^0."""
    axes.set(yscale="log", ylim=(low, high))
    axes.yaxis.set_major_locator(LogLocator(subs=(1, 1.5, 2, 3, 5, 7)) if high > 3 * low else MaxNLocator(5))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_formatter("")


def _transition(figure: Figure, table: pd.DataFrame) -> None:
    forces = table[table["status"] == "ok"]
    lattice = panels(figure, [case(n=n) for n in _SHAPES], "mu", "force", rows=2, sharex=True)
    thin: Any = {"ls": (0, (2, 1.5)), "lw": 0.7}
    for axes, (n, limits) in zip(lattice, _SHAPES.items(), strict=True):
        fscm, jkr, bradley = of_model(forces[forces["n"] == n], "fscm", "jkr", "bradley")
        lines_by(axes, fscm, "k", "mu", "value", label="fscm, ")
        lines_by(axes, jkr, "k", "mu", "value", **{"label": "_", **thin})
        axes.plot(bradley["mu"], bradley["value"], color="0.5", ls="--", lw=0.9, label="bradley")
        axes.plot([], [], color=COLOURS[0], **thin, label="jkr, colours as fscm")
        axes.set(xscale="log", xlim=_ENDS)
        _log_forces(axes, *limits)
    legend_below(figure, 4)


@paper_figure(_transition, size=(7.2, 6.0))
def fig10_transition() -> Plan[Tables]:
    """Pull-off force from the Bradley to the JKR limit."""
    gradients = (*GRADIENTS, 1.0)
    keys = [
        *cases(model=["fscm"], n=_SHAPES, k=gradients, mu=_TRANSITION),
        *cases(model=["jkr"], n=_SHAPES, k=gradients, mu=(_JKR_FROM, _ENDS[1])),
        *cases(model=["bradley"], n=_SHAPES, k=[0.0], mu=_ENDS),
    ]
    forces = rows_of(quantity, keys, quantity=_FORCE)
    return together({"": forces.then(lambda table: table.sort_values(["model", "n", "k", "mu"], ignore_index=True))})


def _of_models(*limits: str) -> Plan[pd.DataFrame]:
    """Forces of the three models, then those of limiting ones."""
    keys = [cases(n=_SHAPES, k=[_K], model=models, mu=TABOR_NUMBERS) for models in (MODEL_LINES, limits)]
    columns = ["n", "k", "mu", "model", "value", "u_num", "status", "reason"]
    forces = rows_of(quantity, [*keys[0], *keys[1]], quantity=_FORCE)
    return forces.then(lambda table: table[columns].astype({"value": float, "u_num": float}))


def by_limit(limit: str) -> Plan[Tables]:
    """Plan the forces over that of a limiting model in the same case, with the uncertainty of the ratio, and kappa."""
    return _of_models(limit).then(partial(_scaled, limit=limit))


def _scaled(table: pd.DataFrame, limit: str) -> Tables:
    forces = table[table["model"] != limit]
    scale = table[table["model"] == limit].set_index(["n", "mu"])
    by = scale.loc[pd.MultiIndex.from_frame(forces[["n", "mu"]])]
    size, u = by["value"].to_numpy(), by["u_num"].to_numpy()
    ratio = forces["value"] / size
    scaled = forces[["n", "k", "mu", "model"]].assign(
        ratio=ratio, u_ratio=(forces["u_num"] + ratio * u) / size, status=forces["status"], reason=forces["reason"]
    )
    kappa = relative_error(forces.assign(quantity=_FORCE, nu=np.nan), "fscm")
    return {"": scaled, "kappa": kappa[["quantity", "n", "k", "mu", "model", "kappa", "u_kappa"]]}


def _panels_of_models(figure: Figure, table: pd.DataFrame, y: str, label: str, limit: str = "") -> None:
    lattice = panels(figure, [case(n=n, k=_K) for n in _SHAPES], "mu", label, rows=2, sharex=True)
    for axes, (_, of_shape) in zip(lattice, table.groupby("n"), strict=True):
        # A ratio to a limiting model has the limit 1.
        if y == "ratio":
            level(axes, 1.0, color="0.55", lw=0.9, ls="-.", label=limit)
        for name, dashes in (("bradley", "-."), ("jkr", ":")) if y == "value" else ():
            (line,) = of_model(of_shape, name)
            axes.plot(line["mu"], line[y], color="0.55", lw=0.9, ls=dashes, label=name)
        by_model(axes, of_shape, "mu", y)
        forces_of_models = of_shape.loc[of_shape["model"].isin(MODEL_LINES), y]
        axes.set(xscale="log", xlim=(0.008, 12.0))
        # A tenth of the range and at least 2 % beyond it.
        beyond = max((forces_of_models.max() / forces_of_models.min()) ** 0.1, 1.02)
        _log_forces(axes, forces_of_models.min() / beyond, forces_of_models.max() * beyond)
    legend_below(figure, 5)


_forces = partial(_panels_of_models, y="value", label="force")
_by_rigid = partial(_panels_of_models, y="ratio", limit="bradley", label=r"$P_c/P_c^{\mathrm{Bradley}}$")


@paper_figure(_forces, size=(7.2, 5.6))
def fig14_pull_off_models() -> Plan[Tables]:
    """Pull-off force of the original and improved Maugis-Dugdale models and of the FSCM, k = 0.4."""
    return together({"": _of_models("bradley", "jkr")})


@paper_figure(_by_rigid, size=(7.2, 5.6))
def fig15_pull_off_by_rigid_limit() -> Plan[Tables]:
    """Pull-off force scaled by the rigid (Bradley) limit, k = 0.4."""
    return by_limit("bradley").then(lambda tables: {"": tables[""]})


def _by_soft(figure: Figure, table: pd.DataFrame, kappa: pd.DataFrame) -> None:
    words = (f"scaled by the soft limit, {case(k=_K)}", "relative error", "enlarged")
    scaled, complete, enlarged = panels(figure, words, "mu", r"$P_c/P_c^{\mathrm{JKR}}$")
    for index, (n, of_shape) in enumerate(table.groupby("n")):
        by_model(scaled, of_shape, "mu", "ratio", color=COLOURS[index], label="_")
        for model, rows in zip(_FACES, of_model(kappa[kappa["n"] == n].sort_values("mu"), *_FACES), strict=True):
            face, ls = _FACES[model] or COLOURS[index], MODEL_LINES[model]["ls"]
            style = {"color": COLOURS[index], "marker": MARKERS[index], "mfc": face, "ms": 3.5, "ls": ls}
            banded(complete, rows["mu"], rows["kappa"], rows["u_kappa"], label=f"$n$ = {n:g}, {model}", **style)
            banded(enlarged, rows["mu"], rows["kappa"], rows["u_kappa"], label="_", **style)
    level(scaled, 1.0, ls=":", label="jkr")
    _log_forces(scaled, table["ratio"].min() / 1.2, table["ratio"].max() * 1.2)
    for axes in (scaled, complete, enlarged):
        axes.set(xscale="log")
    for axes in (complete, enlarged):
        level(axes)
    complete.set_ylabel(r"relative error of the pull-off force $\kappa$ (%)")
    enlarged.set_ylim(-9, 9)
    scaled.plot([], [], label="fscm, colours as $n$", **MODEL_LINES["fscm"])
    figure.legend(loc="outside lower center", ncols=5)


@paper_figure(_by_soft, size=(9.6, 3.8))
def fig16_pull_off_by_soft_limit() -> Plan[Tables]:
    """Pull-off force scaled by the soft (JKR) limit, and the relative error kappa of both models, k = 0.4."""
    return by_limit("jkr")


def _cohesive_errors(figure: Figure, table: pd.DataFrame) -> None:
    left, right = panels(figure, (case(k=_K), case(n=5, k=_K)), "mu")
    for axes, shapes in ((left, SHAPES), (right, (5.0,))):
        for (model, n), line in table[table["n"].isin(shapes)].groupby(["model", "n"]):
            index, label = SHAPES.index(n), f"{model.removeprefix('md-')}, {case(n=n)}"
            style = {"color": COLOURS[index], "marker": MARKERS[index], "ls": MODEL_LINES[model]["ls"], "ms": 3}
            beside_fem(axes, line, "mu", "error", 100.0, label=label, **style)
    level(left, 2.0, ls=":")
    left.set(xscale="log", yscale="log", ylabel="relative error of the pull-off force (%)", ylim=(0.05, 30.0))
    right.set(xlim=(1.4, 4.0), ylim=(0.0, 4.5))
    legend_below(figure, 5, fontsize=7)


@paper_figure(_cohesive_errors, size=(7.2, 3.6))
def finding_cohesive_errors() -> Plan[Tables]:
    """Errors of both Maugis-Dugdale pull-off forces from mu = 1 on, k = 0.4."""
    rows = [
        {"reference": reference, "model": model, "n": n, "k": _K, "mu": mu}
        for reference, n, mu in _FORCES
        for model in COHESIVE
    ]
    return together({"": table_of_terms(rows, error="relative_error pull_off_force {model}")})


def _falls_first(figure: Figure, table: pd.DataFrame) -> None:
    left, right = panels(figure, (case(n=_FALLING_N), case(n=_FALLING_N, k=0.4)), "mu", "force")
    for axes, name in ((left, _FORCE), (right, _PLACE)):
        for k, line in table[table["quantity"] == name].groupby("k"):
            style: Any = {"label": f"{case(k=k)}, crosses: fem", **dashed(GRADIENTS.index(k))}
            beside_fem(axes, line, "mu", "value", column="model", **style)
        axes.set(xscale="log")
    left.set(ylim=(2.1, 2.3))
    right.set(ylabel=r"displacement at pull-off $\delta_c/z_0$")
    legend_below(figure, 5)


@paper_figure(_falls_first)
def finding_falls_first() -> Plan[Tables]:
    """Pull-off force and its displacement at n = 1.5, which fall before they rise."""
    names = ("model", "quantity", "n", "k", "mu")
    keys = [dict(zip(names, (model, name, _FALLING_N, k, mu), strict=True)) for model, name, k, mu in _FALLING]
    return together({"": rows_of(quantity, keys)})


def _domain(figure: Figure, table: pd.DataFrame) -> None:
    axes = figure.subplots()
    labels = [f"{case(n=n)}\n{case(mu=mu)}" for n, mu in table[["n", "mu"]].to_numpy()]
    style: Any = {"ls": "none", "marker": "o", "mfc": "none", "label": "against fscm, crosses: fem"}
    beside_fem(axes, table.assign(case=labels), "case", "lacking", 100.0, **style)
    axes.axhline(0.1, color=COLOURS[1], lw=1.0, ls="--", label="0.1 %")
    axes.set(yscale="log", ylim=(1e-3, 10.0), ylabel="pull-off force that the scheme lacks (%)")
    axes.legend()


@paper_figure(_domain, size=(5.0, 3.4))
def finding_domain() -> Plan[Tables]:
    """Pull-off force that the scheme with f(r_max) = 50 lacks, k = 0.4."""
    rows = [{"reference": model, "n": n, "k": _K, "mu": mu} for n, mu, model in _DOMAIN]
    return together({"": table_of_terms(rows, force=_FORCE, scheme="stieltjes_force", lacking="scheme_lack")})
