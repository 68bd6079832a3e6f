"""Figs. 10 and 14 to 16: the pull-off force over the Tabor number, of the FSCM and of closed forms."""

from __future__ import annotations

from functools import partial
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator

from comparisons.output.errors import relative_error
from comparisons.output.style import COLOURS, MARKERS, MODEL_LINES, model_styles
from comparisons.paper.drawing import LABELS, by_model, dashed, held, label_of, legend_below, level, of_model, panels
from comparisons.paper.paper_figure import Plan, Tables, paper_figure, together
from comparisons.paper.tasks import GRADIENTS, values_of

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


def _log_forces(axes: Axes, low: float, high: float) -> None:
    """A logarithmic axis with plain numbers: 2, not 2 x 10^0."""
    axes.set(yscale="log", ylim=(low, high))
    axes.yaxis.set_major_locator(LogLocator(subs=(1, 1.5, 2, 3, 5, 7)) if high > 3 * low else MaxNLocator(5))
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_formatter("")


def _transition(figure: Figure, table: pd.DataFrame) -> None:
    forces = table[table["status"] == "ok"]
    lattice = panels(figure, 2, 2, [held(n=n) for n in _SHAPES], LABELS["mu"], LABELS["force"], sharex=True)
    thin: Any = {"ls": (0, (2, 1.5)), "lw": 0.7}
    for axes, (n, limits) in zip(lattice, _SHAPES.items(), strict=True):
        fscm, jkr, bradley = of_model(forces[forces["n"] == n], "fscm", "jkr", "bradley")
        for index, (k, line) in enumerate(fscm.groupby("k")):
            axes.plot(line["mu"], line["value"], label=f"fscm, {label_of('k', k)}", **dashed(index))
            axes.plot("mu", "value", data=jkr[jkr["k"] == k], color=COLOURS[index], label="_", **thin)
        axes.plot(bradley["mu"], bradley["value"], color="0.5", ls="--", lw=0.9, label="bradley")
        axes.plot([], [], color=COLOURS[0], **thin, label="jkr, colours as fscm")
        axes.set(xscale="log", xlim=_ENDS)
        _log_forces(axes, *limits)
    legend_below(figure, 4)


@paper_figure(_transition, size=(7.2, 6.0))
def fig10_transition() -> Plan[Tables]:
    """Pull-off force from the Bradley to the JKR limit."""
    gradients = (*GRADIENTS, 1.0)
    table = yield from values_of(
        "pull_off_force",
        [
            *product(("fscm",), _SHAPES, gradients, _TRANSITION),
            *product(("jkr",), _SHAPES, gradients, (_JKR_FROM, _ENDS[1])),
            *product(("bradley",), _SHAPES, (0.0,), _ENDS),
        ],
    )
    return {"": table.sort_values(["model", "n", "k", "mu"], ignore_index=True)}


def _of_models(*limits: str) -> Plan[pd.DataFrame]:
    """Forces of the three models, then those of limiting ones."""
    models = [*product(_SHAPES, ("fscm", "md-original", "md-improved")), *product(_SHAPES, limits)]
    cases = [(model, n, _K, mu) for (n, model), mu in product(models, TABOR_NUMBERS)]
    table = yield from values_of("pull_off_force", cases)
    columns = ["n", "k", "mu", "model", "value", "u_num", "status", "reason"]
    return table[columns].astype({"value": float, "u_num": float})


def by_limit(limit: str) -> Plan[Tables]:
    """Plan the forces over that of a limiting model in the same case, with the uncertainty of the ratio, and kappa."""
    table = yield from _of_models(limit)
    forces = table[table["model"] != limit]
    scale = table[table["model"] == limit].set_index(["n", "mu"])
    by = scale.loc[pd.MultiIndex.from_frame(forces[["n", "mu"]])]
    size, u = by["value"].to_numpy(), by["u_num"].to_numpy()
    ratio = forces["value"] / size
    scaled = forces[["n", "k", "mu", "model"]].assign(
        ratio=ratio, u_ratio=(forces["u_num"] + ratio * u) / size, status=forces["status"], reason=forces["reason"]
    )
    kappa = relative_error(forces.assign(quantity="pull_off_force", nu=np.nan), "fscm")
    return {"": scaled, "kappa": kappa[["quantity", "n", "k", "mu", "model", "kappa", "u_kappa"]]}


def _panels_of_models(figure: Figure, table: pd.DataFrame, y: str, label: str) -> None:
    words = [held(n=n, k=_K) for n in _SHAPES]
    lattice = panels(figure, 2, 2, words, LABELS["mu"], label, sharex=True)
    for axes, (_, of_shape) in zip(lattice, table.groupby("n"), strict=True):
        _limits(axes, of_shape, y)
        by_model(axes, of_shape, "mu", y)
        forces_of_models = of_shape.loc[of_shape["model"].isin(MODEL_LINES), y]
        axes.set(xscale="log", xlim=(0.008, 12.0))
        # A tenth of the range and at least 2 % beyond it.
        beyond = max((forces_of_models.max() / forces_of_models.min()) ** 0.1, 1.02)
        _log_forces(axes, forces_of_models.min() / beyond, forces_of_models.max() * beyond)
    legend_below(figure, 5)


def _limits(axes: Axes, table: pd.DataFrame, y: str) -> None:
    """Draw the limiting models; a ratio to one of them has the limit 1."""
    if y == "ratio":
        level(axes, 1.0, color="0.55", lw=0.9, ls="-.")
        return
    for name, dashes in (("bradley", "-."), ("jkr", ":")):
        (line,) = of_model(table, name)
        axes.plot(line["mu"], line[y], color="0.55", lw=0.9, ls=dashes, label=name)


@paper_figure(partial(_panels_of_models, y="value", label=LABELS["force"]), size=(7.2, 5.6))
def fig14_pull_off_models() -> Plan[Tables]:
    """Pull-off force of the original and improved Maugis-Dugdale models and of the FSCM, k = 0.4."""
    return together({"": _of_models("bradley", "jkr")})


@paper_figure(partial(_panels_of_models, y="ratio", label=r"$P_c/P_c^{\mathrm{Bradley}}$"), size=(7.2, 5.6))
def fig15_pull_off_by_rigid_limit() -> Plan[Tables]:
    """Pull-off force scaled by the rigid (Bradley) limit, k = 0.4."""
    tables = yield from by_limit("bradley")
    return {"": tables[""]}


def _kappa_panels(complete: Axes, enlarged: Axes, kappa: pd.DataFrame) -> None:
    """Draw kappa (of one quantity and gradient exponent) into two axes: all of it, and near zero."""
    for index, (n, of_shape) in enumerate(kappa.sort_values("mu").groupby("n")):
        for model, face in _FACES.items():
            points = of_shape[of_shape["model"] == model]
            colour, line = COLOURS[index], model_styles([model])[model].line
            style: dict[str, Any] = {"color": colour, "marker": MARKERS[index], "mfc": face or colour, "ms": 3.5}
            error, u = 100 * points["kappa"], 100 * points["u_kappa"]
            for axes, label in ((complete, f"$n$ = {n:g}, {model}"), (enlarged, "_")):
                axes.plot(points["mu"], error, ls=line, label=label, **style)
                axes.fill_between(points["mu"], error - u, error + u, color=colour, alpha=0.2)
    for axes in (complete, enlarged):
        axes.set(xscale="log", xlabel=r"Tabor number $\mu$")
        axes.axhline(0, color="0.4", lw=0.8)
    complete.set_ylabel(r"relative error of the pull-off force $\kappa$ (%)")
    enlarged.set_ylim(-9, 9)


def _by_soft(figure: Figure, table: pd.DataFrame, kappa: pd.DataFrame) -> None:
    words = (f"scaled by the soft limit, {held(k=_K)}", "relative error", "enlarged")
    scaled, complete, enlarged = panels(figure, 1, 3, words, LABELS["mu"], r"$P_c/P_c^{\mathrm{JKR}}$")
    for index, (_, of_shape) in enumerate(table.groupby("n")):
        for model, line in zip(MODEL_LINES, of_model(of_shape, *MODEL_LINES), strict=True):
            scaled.plot(line["mu"], line["ratio"], **MODEL_LINES[model] | {"color": COLOURS[index]})
    level(scaled, 1.0, ls=":")
    scaled.set(xscale="log")
    _log_forces(scaled, table["ratio"].min() / 1.2, table["ratio"].max() * 1.2)
    _kappa_panels(complete, enlarged, kappa)
    scaled.plot([], [], label="fscm, colours as $n$", **MODEL_LINES["fscm"])
    figure.legend(loc="outside lower center", ncols=5)


@paper_figure(_by_soft, size=(9.6, 3.8))
def fig16_pull_off_by_soft_limit() -> Plan[Tables]:
    """Pull-off force scaled by the soft (JKR) limit, and the relative error kappa of both models, k = 0.4."""
    return by_limit("jkr")
