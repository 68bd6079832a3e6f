"""Work of adhesion and modulus that a fit by JKR finds in curves of the FSCM; not in the paper.

The curves have no noise: retreat from a largest load until the surfaces part, at a prescribed displacement.
"""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from numpy.typing import NDArray

from comparisons.fitting.equilibria import by_fscm
from comparisons.fitting.fit import fit_record
from comparisons.fitting.machine import Machine
from comparisons.fitting.parameters import free_keys
from comparisons.fitting.record import Record
from comparisons.output.style import COLOURS, LINES
from comparisons.paper.drawing import legend_below, level, panels
from comparisons.paper.paper_figure import Plan, Tables, keyed, paper_figure, rows_of
from comparisons.problem import Problem, Section
from comparisons.runs.tasks import evaluate

_GRADIENTS = (0.0, 0.4)
#: Largest load of a curve, in units of the pull-off force.
_LARGEST_LOADS = (1.0, 10.0)
_TABOR_NUMBERS = tuple(float(f"{mu:.3g}") for mu in np.geomspace(0.1, 100.0, 13))
_POINTS = 400
#: Columns of the table -> keys of the problem.
_KEYS = {"work_of_adhesion": "law.work_of_adhesion", "modulus": "solid.E0"}


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
    x = np.linspace(retreat.contact[0, 0], np.interp(largest_load * force, *_rising(retreat.contact)), _POINTS)[::-1]
    beyond = np.linspace(x[-1], x[-1] - float(np.ptp(x)), _POINTS)[1:]
    loads = [np.interp(x, *retreat.contact), np.interp(beyond, *retreat.far)]
    record = Record("retreat", np.concatenate([x, beyond]), np.concatenate(loads), np.zeros(x.size + beyond.size, bool))
    fitted = fit_record(record, problem, free_keys(problem, [*_KEYS.values()]), "jkr")
    return {column: fitted.parameters[key].value / problem[key] for column, key in _KEYS.items()}


def _rising(path: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Load and displacement from pull-off into compression."""
    lowest = int(np.argmin(path[1]))
    return path[1, lowest:], path[0, lowest:]


def _picture(figure: Figure, table: pd.DataFrame) -> None:
    words = ["work of adhesion", "modulus"]
    lattice = panels(figure, 1, 2, words, r"$\mu$", "fitted by JKR / true", sharex=True)
    for axes, column in zip(lattice, _KEYS, strict=True):
        for (k, load), line in table.groupby(["k", "largest_load"]):
            colour, dashes = COLOURS[_GRADIENTS.index(k)], LINES[_LARGEST_LOADS.index(load)]
            axes.plot(line["mu"], line[column], color=colour, ls=dashes, lw=1.1, label=f"k = {k:g}, load to {load:g} P")
        level(axes, 1.0, color="0.5", lw=0.6)
        axes.set(xscale="log")
    legend_below(figure, 4)


@paper_figure(_picture, size=(7.2, 3.2))
def fit_by_jkr() -> Plan[Tables]:
    """Work of adhesion and modulus that a fit by JKR finds in curves of the FSCM."""
    calls = product(_GRADIENTS, _LARGEST_LOADS, _TABOR_NUMBERS)
    table = yield from rows_of(keyed(fitted_by_jkr, k=k, largest_load=load, mu=mu) for k, load, mu in calls)
    return {"": table}
