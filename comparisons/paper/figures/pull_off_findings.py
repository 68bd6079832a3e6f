"""Findings on the pull-off force: errors of the Maugis-Dugdale models, a force that falls first, a domain too small."""

from __future__ import annotations

from typing import Any

import pandas as pd
from matplotlib.figure import Figure

from comparisons.output.style import COLOURS, MARKERS, MODEL_LINES
from comparisons.paper.drawing import LABELS, beside_fem, dashed, held, legend_below, level, panels
from comparisons.paper.paper_figure import Plan, Tables, keyed, paper_figure, rows_of, together
from comparisons.paper.statements.measures import named, table_of_terms
from comparisons.paper.tasks import COHESIVE, GRADIENTS, SHAPES, quantity

_K = 0.4
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


def _draw_cohesive_errors(figure: Figure, table: pd.DataFrame) -> None:
    left, right = panels(figure, 1, 2, (held(k=_K), held(n=5, k=_K)), LABELS["mu"])
    for axes, shapes in ((left, SHAPES), (right, (5.0,))):
        for (model, n), line in table.groupby(["model", "n"]):
            if n in shapes:
                index, label = SHAPES.index(n), f"{model.removeprefix('md-')}, {held(n=n)}"
                style = {"color": COLOURS[index], "marker": MARKERS[index], "ls": MODEL_LINES[model]["ls"], "ms": 3}
                beside_fem(axes, line, "mu", "error", 100.0, label=label, **style)
    level(left, 2.0, ls=":")
    left.set(xscale="log", yscale="log", ylabel="relative error of the pull-off force (%)", ylim=(0.05, 30.0))
    right.set(xlim=(1.4, 4.0), ylim=(0.0, 4.5))
    legend_below(figure, 5, fontsize=7)


@paper_figure(_draw_cohesive_errors, size=(7.2, 3.6))
def finding_cohesive_errors() -> Plan[Tables]:
    """Errors of both Maugis-Dugdale pull-off forces from mu = 1 on, k = 0.4."""
    places = [(reference, {"model": model}, named(n, _K, mu)) for reference, n, mu in _FORCES for model in COHESIVE]
    return together({"": table_of_terms(places, error="relative_error pull_off_force {model}")})


def _draw_falls_first(figure: Figure, table: pd.DataFrame) -> None:
    left, right = panels(figure, 1, 2, (held(n=_FALLING_N), held(n=_FALLING_N, k=0.4)), LABELS["mu"])
    for axes, name in ((left, _FORCE), (right, _PLACE)):
        for k, line in table[table["quantity"] == name].groupby("k"):
            style: Any = {"label": f"{held(k=k)}, crosses: fem", **dashed(GRADIENTS.index(k))}
            beside_fem(axes, line, "mu", "value", column="model", **style)
        axes.set(xscale="log")
    left.set(ylabel=LABELS["force"], ylim=(2.1, 2.3))
    right.set(ylabel=r"displacement at pull-off $\delta_c/z_0$")
    legend_below(figure, 5)


@paper_figure(_draw_falls_first)
def finding_falls_first() -> Plan[Tables]:
    """Pull-off force and its displacement at n = 1.5, which fall before they rise."""
    calls = (keyed(quantity, model=model, quantity=name, n=_FALLING_N, k=k, mu=mu) for model, name, k, mu in _FALLING)
    return together({"": rows_of(calls)})


def _draw_domain(figure: Figure, table: pd.DataFrame) -> None:
    axes = figure.subplots()
    cases = [f"{held(n=n)}\n{held(mu=mu)}" for n, mu in table[["n", "mu"]].to_numpy()]
    style: Any = {"ls": "none", "marker": "o", "mfc": "none", "label": "against fscm, crosses: fem"}
    beside_fem(axes, table.assign(case=cases), "case", "lacking", 100.0, **style)
    axes.axhline(0.1, color=COLOURS[1], lw=1.0, ls="--", label="0.1 %")
    axes.set(yscale="log", ylim=(1e-3, 10.0), ylabel="pull-off force that the scheme lacks (%)")
    axes.legend()


@paper_figure(_draw_domain, size=(5.0, 3.4))
def finding_domain() -> Plan[Tables]:
    """Pull-off force that the scheme with f(r_max) = 50 lacks, k = 0.4."""
    terms = {"force": _FORCE, "scheme": "stieltjes_force", "lacking": "scheme_lack"}
    return together({"": table_of_terms([(model, {}, named(n, _K, mu)) for n, mu, model in _DOMAIN], **terms)})
