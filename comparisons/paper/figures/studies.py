"""Studies beyond the paper: errors against a true sphere and finite strain, and what a fit by JKR finds.

*Finite strain*: errors of JKR, improved M-D and the FSCM of a paraboloid against a ball on a neo-Hookean solid.  The
reference is the pull-off force of the linear solid and the exact sphere, by the FSCM, times what finite strain and the
potential of the ball change, from the table of `comparisons.description.strain_errors`.

*What JKR neglects*: the same errors of JKR one by one in its limit mu -> infinity, and how they cancel.

*Fit*: work of adhesion and modulus that a fit by JKR finds in curves of the FSCM.  The curves have no noise: retreat
from a largest load until the surfaces part, at a prescribed displacement.
"""

from __future__ import annotations

import math
from itertools import product
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from comparisons.description.strain_errors import Change, area_limit, ball_on, body_change, strain_change
from comparisons.fitting.equilibria import by_fscm
from comparisons.fitting.fit import fit_record
from comparisons.fitting.machine import Machine
from comparisons.fitting.parameters import free_keys
from comparisons.fitting.record import Record
from comparisons.numerics.bounds import relative_difference, relative_uncertainty
from comparisons.output.style import COLOURS, LINES
from comparisons.paper.drawing import banded, case, dashed, legend_below, level, of_model, panels
from comparisons.paper.paper_figure import Tables, paper_figure
from comparisons.paper.plan import Plan, cases, rows_of, together
from comparisons.paper.tasks import quantity
from comparisons.problem import Problem, Section
from comparisons.runs.tasks import evaluate

#: Models of a paraboloid on a linear solid.
MODELS = ("fscm", "md-improved", "jkr")
_SOFTNESS = tuple(float(f"{softness:.3g}") for softness in np.geomspace(1e-5, 0.1, 17))
_TABOR_NUMBERS = (0.3, 1.0, 3.0, 10.0)
_POISSON_RATIOS = (0.3, 0.5)

_GRADIENTS = (0.0, 0.4)
#: Largest load of a curve, in units of the pull-off force.
_LARGEST_LOADS = (1.0, 10.0)
_FITTED_TABOR_NUMBERS = tuple(float(f"{mu:.3g}") for mu in np.geomspace(0.1, 100.0, 13))
_POINTS = 400
#: Columns of the table -> keys of the problem.
_KEYS = {"work_of_adhesion": "law.work_of_adhesion", "modulus": "solid.E0"}


def force_of_a_ball(elasto_adhesion_number: float, mu: float) -> dict[str, float | None]:
    """Return the pull-off force of a ball on a linear solid, ``linear`` and ``u_linear`` in pi w R; None without one.

    Parameters
    ----------
    elasto_adhesion_number : float
        w/(E* R).
    mu : float
        Tabor number.
    """
    row = evaluate("fscm", "pull_off_force", ball_on(elasto_adhesion_number, mu, 0.3))
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
        where = force.elasto_adhesion_number, force.mu, nu
        strain, body = (change(*where) or Change(math.nan, math.nan) for change in (strain_change, body_change))
        factor = (1.0 + strain.value) * (1.0 + body.value)
        finite = force.linear * factor
        relative = strain.uncertainty / (1.0 + strain.value) + body.uncertainty / (1.0 + body.value)
        u_finite = force.u_linear * factor + finite * relative
        for model in models[models["mu"] == force.mu].itertuples():
            kappa = relative_difference(model.value, finite)
            u_kappa = relative_uncertainty(model.value, model.u_num, finite, u_finite)
            key = {"elasto_adhesion_number": force.elasto_adhesion_number, "mu": force.mu, "nu": nu}
            rows.append({**key, "model": model.model, "finite": finite, "kappa": kappa, "u_kappa": u_kappa})
    return pd.DataFrame(rows)


def _finite_strain(figure: Figure, table: pd.DataFrame, cancel: pd.DataFrame) -> None:
    places = cases(nu=_POISSON_RATIOS, mu=_TABOR_NUMBERS)
    words = [case(**place) for place in places]
    lattice = panels(figure, words, r"$w/(E^*R)$", "error of the force (%)", rows=2, sharex=True, sharey=True)
    for axes, place in zip(lattice, places, strict=True):
        of_place, meeting = (of[(of["nu"] == place["nu"]) & (of["mu"] == place["mu"])] for of in (table, cancel))
        for index, (model, rows) in enumerate(zip(MODELS, of_model(of_place, *MODELS), strict=True)):
            x = rows["elasto_adhesion_number"]
            banded(axes, x, rows["kappa"], rows["u_kappa"], lw=1.1, label=model, **dashed(index))
        axes.plot(meeting["elasto_adhesion_number"], 0.0 * meeting["mu"], "o", ms=4, color=COLOURS[0], mfc="none")
        level(axes, color="0.5", lw=0.6)
        axes.set(xscale="log", ylim=(-15.0, 15.0))
    legend_below(figure, 3)


@paper_figure(_finite_strain, size=(7.2, 4.4))
def finite_strain() -> Plan[Tables]:
    """Errors of JKR, improved M-D and the FSCM against a true sphere and finite strain."""
    balls = cases(elasto_adhesion_number=_SOFTNESS, mu=_TABOR_NUMBERS)
    ball: dict[str, Any] = {"quantity": "pull_off_force", "n": 2.0, "k": 0.0}
    models = rows_of(quantity, cases(model=MODELS, mu=_TABOR_NUMBERS), "value", "u_num", **ball)
    errors = together({"forces": rows_of(force_of_a_ball, balls), "models": models}).then(lambda of: _errors(**of))
    return errors.then(lambda table: {"": table, "cancel": meeting_points(table)})


def neglected_by_jkr(elasto_adhesion_number: float) -> dict[str, float]:
    """Return errors of JKR in the limit mu -> infinity on an incompressible solid, and the uncertainty of the last two.

    ``geometry`` is that of the paraboloid, ``derjaguin`` of the projected area, ``strain`` of small strains, and
    ``total`` of all.

    Parameters
    ----------
    elasto_adhesion_number : float
        w/(E* R).
    """
    ball = ball_on(elasto_adhesion_number, 1.0, 0.5)
    projected = evaluate("jkr-sphere-projected", "pull_off_force", ball).value
    strain = strain_change(elasto_adhesion_number, math.inf, 0.5)
    if projected is None or strain is None:
        return {}
    area = 1.0 + area_limit(elasto_adhesion_number)
    errors = {
        "geometry": 1.5 * math.pi / projected,
        "derjaguin": 1.0 / area,
        "strain": 1.0 / (1.0 + strain.value),
        "total": 1.5 * math.pi / projected / area / (1.0 + strain.value),
    }
    return {name: factor - 1.0 for name, factor in errors.items()} | {
        "u_strain": strain.uncertainty,
        "u_total": strain.uncertainty,
    }


#: Column of the errors that JKR neglects -> legend.
_CAUSES = {
    "geometry": "paraboloid",
    "derjaguin": "projected area",
    "strain": r"small strains, $\nu$ = 0.5",
    "total": "together",
}


def _neglected(figure: Figure, table: pd.DataFrame) -> None:
    axes = figure.subplots()
    axes.set(title=r"JKR, $\mu \to \infty$", xlabel=r"$w/(E^*R)$", ylabel="error of the force (%)")
    x = table["elasto_adhesion_number"]
    for index, (cause, label) in enumerate(_CAUSES.items()):
        style = dashed(index + 1) if cause != "total" else {"color": COLOURS[0], "ls": "-", "lw": 1.8}
        banded(axes, x, table[cause], table.get(f"u_{cause}", 0.0 * x), label=label, **style)
    level(axes, color="0.5", lw=0.6)
    axes.set(xscale="log", ylim=(-9.0, 9.0))
    legend_below(figure, 2)


@paper_figure(_neglected, size=(4.6, 3.8))
def what_jkr_neglects() -> Plan[Tables]:
    """What JKR neglects on a soft incompressible solid, and how it cancels."""
    balls = cases(elasto_adhesion_number=_SOFTNESS)
    return together({"": rows_of(neglected_by_jkr, balls, *_CAUSES, "u_strain", "u_total")})


def sphere_of_tabor_number(k: float, mu: float) -> Problem:
    """Return a sphere of 1 um on a solid whose modulus gives a Tabor number.

    Examples
    --------
    >>> round(sphere_of_tabor_number(0.4, 3.0).posed.mu, 12)
    3.0
    """

    def problem(log_modulus: float) -> Problem:
        solid = Section("power-law", {"E0": math.exp(log_modulus), "c0": 1e-9, "k": k, "nu": 0.3})
        law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 0.4e-9})
        return Problem(solid, Section("sphere", {"R": 1e-6}), law)

    # The Tabor number is a power of the modulus.
    low, high = (math.log(problem(log_modulus).posed.mu) for log_modulus in (18.0, 20.0))
    return problem(18.0 + 2.0 * (math.log(mu) - low) / (high - low))


def fitted_by_jkr(k: float, largest_load: float, mu: float) -> dict[str, float]:
    """Return the fitted over the true values.

    Parameters
    ----------
    k : float
    largest_load : float
        In units of the pull-off force.
    mu : float
        Tabor number.
    """
    problem = sphere_of_tabor_number(k, mu)
    force = float(evaluate("fscm", "pull_off_force", problem))
    retreat = Machine.of(by_fscm(problem, largest_load * force, True), math.inf)
    # From pull-off into compression load and displacement rise.
    displacement, load = retreat.contact[:, int(np.argmin(retreat.contact[1])) :]
    x = np.linspace(retreat.contact[0, 0], np.interp(largest_load * force, load, displacement), _POINTS)[::-1]
    beyond = np.linspace(x[-1], x[-1] - float(np.ptp(x)), _POINTS)[1:]
    loads = [np.interp(x, *retreat.contact), np.interp(beyond, *retreat.far)]
    record = Record("retreat", np.concatenate([x, beyond]), np.concatenate(loads), np.zeros(x.size + beyond.size, bool))
    fitted = fit_record(record, problem, free_keys(problem, [*_KEYS.values()]), "jkr")
    return {column: fitted.parameters[key].value / problem[key] for column, key in _KEYS.items()}


def _fit(figure: Figure, table: pd.DataFrame) -> None:
    lattice = panels(figure, ["work of adhesion", "modulus"], r"$\mu$", "fitted by JKR / true", sharex=True)
    for axes, column in zip(lattice, _KEYS, strict=True):
        for (k, load), line in table.groupby(["k", "largest_load"]):
            colour, dashes = COLOURS[_GRADIENTS.index(k)], LINES[_LARGEST_LOADS.index(load)]
            axes.plot(line["mu"], line[column], color=colour, ls=dashes, lw=1.1, label=f"k = {k:g}, load to {load:g} P")
        level(axes, 1.0, color="0.5", lw=0.6)
        axes.set(xscale="log")
    legend_below(figure, 4)


@paper_figure(_fit, size=(7.2, 3.2))
def fit_by_jkr() -> Plan[Tables]:
    """Work of adhesion and modulus that a fit by JKR finds in curves of the FSCM."""
    keys = cases(k=_GRADIENTS, largest_load=_LARGEST_LOADS, mu=_FITTED_TABOR_NUMBERS)
    return together({"": rows_of(fitted_by_jkr, keys)})
