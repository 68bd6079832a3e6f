"""Errors of JKR, improved M-D and the FSCM of a paraboloid against a ball on a neo-Hookean solid; not in the paper.

The reference is the pull-off force of the linear solid and the exact sphere, by the FSCM, times what finite strain
changes, from the table of `comparisons.description.strain_errors`.
"""

from __future__ import annotations

import math
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.description.strain_errors import Change, ball_on, strain_change
from comparisons.numerics.bounds import relative_difference, relative_uncertainty
from comparisons.output.style import COLOURS, LINES
from comparisons.paper.cache import CachedCall
from comparisons.paper.drawing import legend_below, level, panels
from comparisons.paper.paper_figure import Plan, Tables, keyed, paper_figure, rows_of, together
from comparisons.paper.tasks import quantity
from comparisons.runs.tasks import evaluate

#: Models of a paraboloid on a linear solid.
MODELS = ("fscm", "md-improved", "jkr")
_SOFTNESS = tuple(float(f"{softness:.3g}") for softness in np.geomspace(1e-5, 0.1, 17))
_TABOR_NUMBERS = (0.3, 1.0, 3.0, 10.0)
_POISSON_RATIOS = (0.3, 0.5)


def force_of_a_ball(softness: float, mu: float) -> dict[str, float | None]:
    """Return the pull-off force of a ball on a linear solid, ``linear`` and ``u_linear`` in pi w R; None without one.

    Parameters
    ----------
    softness : float
        w/(E* R).
    mu : float
        Tabor number.
    """
    row = evaluate("fscm", "pull_off_force", ball_on(softness, mu, 0.3))
    if row.value is None or row.u_num is None:
        return {"linear": None, "u_linear": None}
    return {"linear": row.value / math.pi, "u_linear": row.u_num / math.pi}


def meeting_points(errors: pd.DataFrame) -> pd.DataFrame:
    """Return w/(E* R) at which the FSCM of a paraboloid has no error, and those at both ends of its bound.

    What geometry changes grows as (w/(E* R))^(2/3), and strain as its root, so that kappa over the cube root of
    w/(E* R) is nearly a straight line in that root.
    """
    rows = []
    for (nu, mu), line in errors[errors["model"] == "fscm"].groupby(["nu", "mu"]):
        root = np.cbrt(line["elasto_adhesion_number"].to_numpy())
        roots = []
        for sign in (0.0, 1.0, -1.0):
            scaled = (line["kappa"] + sign * line["u_kappa"]).to_numpy() / root
            turns = np.flatnonzero((scaled[:-1] < 0.0) & (scaled[1:] >= 0.0))
            i = turns[0] if turns.size else 0
            share = -scaled[i] / (scaled[i + 1] - scaled[i])
            roots.append((root[i] + share * (root[i + 1] - root[i])) ** 3 if turns.size else np.nan)
        rows.append((nu, mu, *roots))
    return pd.DataFrame(rows, columns=["nu", "mu", "elasto_adhesion_number", "lowest", "highest"])


def _errors(forces: pd.DataFrame, models: pd.DataFrame) -> pd.DataFrame:
    """Errors of the models at each force of the linear ball, for each of Poisson's ratios."""
    rows: list[dict[str, Any]] = []
    for nu, force in product(_POISSON_RATIOS, forces.dropna().itertuples()):
        change = strain_change(force.elasto_adhesion_number, force.mu, nu) or Change(math.nan, math.nan)
        finite = force.linear * (1.0 + change.value)
        u_finite = force.u_linear * (1.0 + change.value) + force.linear * change.bound
        for model in models[models["mu"] == force.mu].itertuples():
            kappa = relative_difference(model.value, finite)
            u_kappa = relative_uncertainty(model.value, model.u_num, finite, u_finite)
            key = {"elasto_adhesion_number": force.elasto_adhesion_number, "mu": force.mu, "nu": nu}
            rows.append({**key, "model": model.model, "finite": finite, "kappa": kappa, "u_kappa": u_kappa})
    return pd.DataFrame(rows)


def _picture(figure: Figure, table: pd.DataFrame, cancel: pd.DataFrame) -> None:
    places = list(product(_POISSON_RATIOS, _TABOR_NUMBERS))
    words = [rf"$\nu$ = {nu:g}, $\mu$ = {mu:g}" for nu, mu in places]
    lattice = panels(figure, 2, 4, words, r"$w/(E^*R)$", "error of the force (%)", sharex=True, sharey=True)
    for axes, (nu, mu) in zip(lattice, places, strict=True):
        for model, line, colour in zip(MODELS, LINES, COLOURS, strict=False):
            rows = table[(table["nu"] == nu) & (table["mu"] == mu) & (table["model"] == model)]
            percent, u, x = 100.0 * rows["kappa"], 100.0 * rows["u_kappa"], rows["elasto_adhesion_number"]
            axes.plot(x, percent, color=colour, ls=line, lw=1.1, label=model)
            axes.fill_between(x, percent - u, percent + u, color=colour, alpha=0.2, lw=0.0)
        meeting = cancel[(cancel["nu"] == nu) & (cancel["mu"] == mu)]["elasto_adhesion_number"]
        axes.plot(meeting, 0.0 * meeting, "o", ms=4, color=COLOURS[0], mfc="none")
        level(axes, color="0.5", lw=0.6)
        axes.set(xscale="log", ylim=(-15.0, 15.0))
    legend_below(figure, 3)


@paper_figure(_picture, size=(7.2, 4.4))
def finite_strain() -> Plan[Tables]:
    """Errors of JKR, improved M-D and the FSCM against a true sphere and finite strain."""
    calls = [
        ({"model": model, "mu": mu}, CachedCall.of(quantity, model, "pull_off_force", 2.0, 0.0, mu))
        for model, mu in product(MODELS, _TABOR_NUMBERS)
    ]
    places = product(_SOFTNESS, _TABOR_NUMBERS)
    forces = rows_of(keyed(force_of_a_ball, elasto_adhesion_number=softness, mu=mu) for softness, mu in places)
    plans = {"forces": forces, "models": rows_of(calls, "value", "u_num")}
    tables = yield from together(plans)
    errors = _errors(tables["forces"], tables["models"])
    return {"": errors, "cancel": meeting_points(errors)}
