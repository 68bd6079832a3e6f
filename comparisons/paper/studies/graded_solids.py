"""Pull-off, jumps and hysteresis on solids that are no power law, by both references; not in the paper.

A sphere (n = 2, Poisson's ratio 0.3) on three kinds of solids, each over the depth that belongs to it:

* offset power law E0 ((z + z_s)/c0)^k, k = 0.4 and Tabor number 2 at z_s = 0,
* exponential, four times as stiff at depth as at the surface (Tabor number 2 with the modulus of the surface),
* sharp coating on a substrate of a quarter of its modulus (Tabor number 0.8 with the modulus of the coating).

Loads, displacements and energies are in the units of Eqs. 25 and 31, which do not contain the solid.  Depths are in the
transverse length L = (Q z0)^(1/n).  Beside each value stand those of three simpler solids and their errors against the
FSCM: the homogeneous solid of the surface, the solid at great depth, and the equivalent power law at the pull-off.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import product
from typing import Any, NamedTuple

import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

import fem_reference
import fscm
from comparisons.models.solver import translated
from comparisons.numerics.bounds import relative_difference
from comparisons.output.style import COLOURS
from comparisons.paper.drawing import panels
from comparisons.paper.paper_figure import Plan, Tables, paper_figure, result_of, together
from comparisons.problem import Problem, Section
from comparisons.problem.elastic_energy import energy_spectrum
from comparisons.problem.equivalent_solid import least_wrong, power_law_of

__all__ = ["SERIES", "by_elements", "by_fscm", "case_of", "equivalent_of", "number_of", "of_power_law"]

Json = dict[str, Any]

#: Depths of each kind in L, the finite elements have the pull-off of all; and those at which they have the jumps, too.
SERIES: dict[str, tuple[tuple[float, ...], tuple[float, ...]]] = {
    "offset power law": ((0.01, 0.1, 1.0, 10.0), (0.1, 10.0)),
    "exponential": ((0.1, 0.5, 2.0, 10.0), (0.5, 2.0)),
    "coating": ((0.1, 0.3, 1.0, 3.0), (0.3, 1.0)),
}
_DEPTHS = (r"offset $z_s\,/\,L$", r"length of the decay $/\,L$", r"thickness $/\,L$")
_ROWS = (
    (r"$-P_c\,/\,\pi Q\Delta\gamma$", ("pull_off_force",)),
    (r"$\delta\,/\,z_0$ at the jumps", ("jump_out_displacement", "jump_in_displacement")),
    (r"$W\,/\,\pi Q\Delta\gamma z_0$", ("hysteresis_energy",)),
)
#: Label, line and colour of each simpler solid, by its column.
_STYLES = {
    "surface": ("homogeneous, modulus of the surface", "--", COLOURS[1]),
    "depth": ("solid of great depth", ":", COLOURS[2]),
    "power_law": ("equivalent power law", "-.", COLOURS[3]),
}

_N, _NU = 2.0, 0.3

#: The offset power law: exponent, and Tabor number (Eq. 29) of the limit z_s = 0.
OFFSET = (0.4, 2.0)
#: Tabor numbers with the modulus of the surface, and moduli at depth over that of the surface.
EXPONENTIAL = (2.0, 4.0)
COATING = (0.8, 0.25)

#: Of every problem; no scale is 1, so that a wrong power of one shows.
SCALES = {"c0": 3.0, "Q": 2.0, "work_of_adhesion": 0.7, "z0": 0.25}

_PUNCH = Section("sphere", {"R": SCALES["Q"]})
_LAW = Section("lennard-jones-9-3", {name: SCALES[name] for name in ("work_of_adhesion", "z0")})

#: Quantities of the table.
QUANTITIES = (
    "pull_off_force",
    "pull_off_displacement",
    "jump_in_displacement",
    "jump_out_displacement",
    "hysteresis_energy",
)
#: Quantities that share a family of meshes; the hysteresis energy is the sum of the losses of both jumps.
EVENTS = {
    "pull-off": ("pull_off_force", "pull_off_displacement"),
    "jump-out": ("jump_out_displacement", "jump_in_displacement", "jump_out_energy"),
    "landing": ("jump_in_energy",),
}
_UNITS = {"pull_off_force": "load", "jump_in_energy": "energy", "jump_out_energy": "energy"}
# Digits of k and mu of an equivalent power law, as a reader can repeat them.
_DIGITS = 6


class GradedCase(NamedTuple):
    """A solid under the sphere, and the simpler solids beside it.

    Attributes
    ----------
    problem : Problem
        As of a problem file.
    mu : float
        Tabor number with the modulus of the surface.
    depth : tuple of float
        k and mu of the solid at great depth.
    """

    problem: Problem
    mu: float
    depth: tuple[float, float]


def case_of(kind: str, parameter: float) -> GradedCase:
    """Return a solid of the study.

    Parameters
    ----------
    kind : {"offset power law", "exponential", "coating"}
    parameter : float
        z_s, length of the decay or thickness of a sharp coating, in L.

    Examples
    --------
    >>> round(case_of("exponential", 1.0).depth[1], 6)
    0.793701
    """
    mu, ratio = EXPONENTIAL if kind == "exponential" else COATING
    power_law = OFFSET if kind == "offset power law" else (0.0, mu)
    graded = fscm.Problem(_N, *power_law).in_units(nu=_NU, **SCALES)
    E, length = graded.solid.E0, parameter * graded.units["radius"]  # type: ignore[union-attr]
    if kind == "offset power law":
        offset = {"E0": E, "c0": SCALES["c0"], "k": OFFSET[0], "z_s": length, "nu": _NU}
        problem = Problem(Section("offset-power-law", offset), _PUNCH, _LAW)
        return GradedCase(problem, problem.posed.mu, OFFSET)
    if kind == "exponential":
        solid = {"E_surface": E, "E_depth": ratio * E, "length": length, "nu": _NU}
    else:
        solid = {"E_coating": E, "E_substrate": ratio * E, "thickness": length, "transition": 0.0, "nu": _NU}
    return GradedCase(Problem(Section(kind, solid), _PUNCH, _LAW), mu, (0.0, mu / ratio ** (2.0 / 3.0)))


def by_fscm(kind: str, parameter: float) -> Json:
    """Return all quantities of a solid by the FSCM.

    Parameters
    ----------
    kind, parameter
        As for `case_of`.

    Returns
    -------
    dict
        By quantity ``[value, u_num]``, or the reason why there is no such event.

    Raises
    ------
    ComputationFailed
        If an iteration misses its tolerance.

    Examples
    --------
    >>> value, u_num = by_fscm("coating", 1.0)["pull_off_force"]
    >>> round(value, 6), u_num < 1e-7
    (1.42152, True)
    """
    return _events(fscm, case_of(kind, parameter).problem.posed, QUANTITIES)


def of_power_law(k: float, mu: float) -> Json:
    """Return all quantities of a power-law solid by the FSCM, as `by_fscm`.

    Examples
    --------
    >>> round(of_power_law(0.0, 1.0)["pull_off_force"][0], 8)
    1.67066478
    """
    return _events(fscm, fscm.Problem(_N, k, mu), QUANTITIES)


def _events(solver: Any, problem: Any, names: Sequence[str], *accuracy: str) -> Json:
    """By quantity value and bound in the units of the solver, or the reason why there is no such event."""
    with translated(solver):
        events = solver.solve_together(problem, names, *accuracy)
    return {
        name: str(event) if isinstance(event, solver.NoSuchEvent) else [event.value, event.u_num]
        for name, event in events.items()
    }


def by_elements(event: str, kind: str, parameter: float) -> Json:
    """Return the quantities of an event by the finite elements, as `by_fscm`.

    Parameters
    ----------
    event : {"pull-off", "jump-out", "landing"}
        Which family of meshes, see `EVENTS`.
    kind, parameter
        As for `case_of`.

    Raises
    ------
    ComputationFailed
        If an iteration misses its tolerance.

    Examples
    --------
    >>> by_elements("jump-out", "offset power law", 100.0)["jump_out_displacement"]
    'the displacement rises all along the path: this solid is too stiff for jumps'
    """
    problem = case_of(kind, parameter).problem
    events = _events(fem_reference, problem.build(fem_reference), EVENTS[event], "quick")
    for name, result in events.items():
        if not isinstance(result, str):
            events[name] = [number / problem.units[_UNITS.get(name, "displacement")] for number in result]
    return events


def equivalent_of(kind: str, parameter: float) -> tuple[float, float]:
    """Return k and mu of the equivalent power law of a solid at its pull-off force, rounded.

    The rule of `fscm-bench describe` weighs the compliance of the solid by the elastic energy at the pull-off force.

    Parameters
    ----------
    kind, parameter
        As for `case_of`.

    Examples
    --------
    A thin offset hardly changes the power law.

    >>> k, mu = equivalent_of("offset power law", 1e-4)
    >>> round(k, 3), round(mu, 3)
    (0.398, 1.997)
    """
    problem = case_of(kind, parameter).problem
    spectrum = energy_spectrum(problem)
    k, _, _, surface = least_wrong(spectrum)
    posed = power_law_of(problem, k, surface, spectrum)
    return round(posed.k, _DIGITS), round(posed.mu, _DIGITS)


def of_equivalent(kind: str, parameter: float) -> Json:
    """Return all quantities of the equivalent power law of a solid as `by_fscm`, and its ``k`` and ``mu``.

    Raises
    ------
    ComputationFailed
        If an iteration misses its tolerance.
    """
    k, mu = equivalent_of(kind, parameter)
    return {"k": k, "mu": mu, **of_power_law(k, mu)}


def number_of(results: Json, name: str) -> tuple[float, float]:
    """Return value and bound of a quantity, NaN without the event; the elements have the energy in two parts.

    Examples
    --------
    >>> number_of({"jump_in_energy": [1.0, 0.1], "jump_out_energy": [2.0, 0.1]}, "hysteresis_energy")
    (3.0, 0.2)
    >>> number_of({"jump_in_displacement": "no jump"}, "jump_in_displacement")
    (nan, nan)
    """
    is_sum = name == "hysteresis_energy" and name not in results
    pieces = [results.get(piece, "") for piece in (("jump_in_energy", "jump_out_energy") if is_sum else (name,))]
    if any(isinstance(piece, str) for piece in pieces):
        return math.nan, math.nan
    return sum(float(value) for value, _ in pieces), sum(float(u) for _, u in pieces)


def _picture(figure: Figure, table: pd.DataFrame) -> None:
    lattice = panels(figure, 3, 3, (*SERIES, *[""] * 6), sharex="col", sharey="row")
    fscm: Any = {"color": COLOURS[0], "ms": 4, "lw": 1.1}
    fem: Any = {"color": COLOURS[5], "ms": 8, "mfc": "none", "ls": "none"}
    for axes, ((_, names), kind) in zip(lattice, product(_ROWS, SERIES), strict=True):
        for name, marker in zip(names, "o^", strict=False):
            rows = table[(table["solid"] == kind) & (table["quantity"] == name)]
            for column, (_, line, colour) in _STYLES.items():
                axes.plot(rows["parameter"], rows[column], color=colour, ls=line, lw=1.1)
            axes.plot(rows["parameter"], rows["fscm"], marker=marker, **fscm)
            axes.plot(rows["parameter"], rows["fem"], marker=marker, **fem)
        axes.set_xscale("log")
    for axes, depth in zip(lattice[6:], _DEPTHS, strict=True):
        axes.set(xlabel=depth, yscale="log")
    for axes, (label, _) in zip(lattice[::3], _ROWS, strict=True):
        axes.set_ylabel(label)
    # The softest surfaces jump far below.
    lattice[3].set(ylim=(-5.2, -1.0))
    lattice[6].set(ylim=(3e-4, 5.0))
    figure.suptitle(r"sphere, $\nu=0.3$, $L=(Qz_0)^{1/2}$", fontsize=9)
    handles = [
        Line2D([], [], marker="o", label="FSCM (jump-in: triangles)", **fscm),
        Line2D([], [], marker="o", label="finite elements", **fem),
        *(Line2D([], [], color=colour, ls=line, label=label) for label, line, colour in _STYLES.values()),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncol=3)


@paper_figure(_picture, size=(7.2, 7.0))
def graded_solids() -> Plan[Tables]:
    """Solids that are no power law: pull-off, jumps and hysteresis, and what simpler solids get wrong."""
    solids = [(kind, parameter) for kind, (parameters, _) in SERIES.items() for parameter in parameters]
    results = yield from together({solid: _of_solid(*solid) for solid in solids})
    rows = [_row(solid, results[solid], name) for solid, name in product(solids, QUANTITIES)]
    return {"": pd.DataFrame(rows)}


def _of_solid(kind: str, parameter: float) -> Plan[dict[str, Json]]:
    """Plan the results of both references and for the simpler solids."""
    case = case_of(kind, parameter)
    events = EVENTS if parameter in SERIES[kind][1] else ("pull-off",)
    plans = {event: result_of(by_elements, event, kind, parameter) for event in events}
    plans |= {"fscm": result_of(by_fscm, kind, parameter), "power_law": result_of(of_equivalent, kind, parameter)}
    simpler = {"surface": (0.0, case.mu), "depth": case.depth}
    plans |= {column: result_of(of_power_law, *power_law) for column, power_law in simpler.items()}
    results = yield from together(plans)
    solved = {column: {"k": k, "mu": mu} | results[column] for column, (k, mu) in simpler.items()}
    elements = {name: value for event in events for name, value in results[event].items()}
    return results | solved | {"fem": elements}


def _row(solid: tuple[str, float], results: dict[str, Json], name: str) -> dict[str, Any]:
    row: dict[str, Any] = {"solid": solid[0], "parameter": solid[1], "quantity": name}
    for reference in ("fscm", "fem"):
        row[reference], row[f"u_{reference}"] = number_of(results[reference], name)
    for column in _STYLES:
        solved = results[column]
        row |= {f"{column}_k": solved["k"], f"{column}_mu": solved["mu"]}
        row[column], row[f"u_{column}"] = number_of(solved, name)
        row[f"{column}_error"] = relative_difference(row[column], row["fscm"])
    reason = results["fscm"][name]
    return row | {"reason": reason if isinstance(reason, str) else ""}
