"""Events of a sphere on solids that are no power law, by both references; dimensionless.

Loads, displacements and energies are in the units of Eqs. 25 and 31, which do not contain the solid.  Depths are in the
transverse length L = (Q z0)^(1/n).  Each solid stands beside three that are simpler: the homogeneous solid of its
surface, the solid that it is at great depth, and its equivalent power law at the pull-off force.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import fem_reference
import fscm
from comparisons.models.solver import translated
from comparisons.problem import Problem as AnyProblem
from comparisons.problem import Section
from comparisons.problem.elastic_energy import energy_spectrum
from comparisons.problem.equivalent_solid import least_wrong, power_law_of
from comparisons.problem.kinds import kind_of
from fscm import LennardJones, NoSuchEvent, NotConverged, PowerLaw, PowerPunch, Problem, solve_together

__all__ = [
    "EVENTS",
    "QUANTITIES",
    "GradedCase",
    "by_elements",
    "by_fscm",
    "case_of",
    "equivalent_of",
    "number_of",
    "of_equivalent",
    "of_power_law",
]

Json = dict[str, Any]

_N, NU = 2.0, 0.3

#: The offset power law: exponent, and Tabor number (Eq. 29) of the limit z_s = 0.
OFFSET = (0.4, 2.0)
#: Tabor numbers with the modulus of the surface, and moduli at depth over that of the surface.
EXPONENTIAL = (2.0, 4.0)
COATING = (0.8, 0.25)

#: Of every problem; no scale is 1, so that a wrong power of one shows.
SCALES = {"c0": 3.0, "Q": 2.0, "work_of_adhesion": 0.7, "z0": 0.25}

_PUNCH, _LAW = PowerPunch(_N, SCALES["Q"]), LennardJones(SCALES["work_of_adhesion"], SCALES["z0"])

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
    """A solid for both references, and the simpler solids beside it.

    Attributes
    ----------
    mu : float
        Tabor number with the modulus of the surface.
    depth : tuple of float
        k and mu of the solid at great depth.
    section : Section
        The solid as in a problem file.
    """

    mu: float
    depth: tuple[float, float]
    section: Section


def _scaled(k: float, mu: float) -> tuple[PowerLaw, Any]:
    """The power law of a Tabor number in the scales of all, and the units."""
    physical = Problem(_N, k, mu).in_units(nu=NU, **SCALES)
    return physical.solid, physical.units  # type: ignore[return-value]


def case_of(kind: str, parameter: float, k: float = OFFSET[0], mu: float = OFFSET[1]) -> GradedCase:
    """Return a solid of the study.

    Parameters
    ----------
    kind : {"offset power law", "exponential", "coating"}
    parameter : float
        z_s, length of the decay or thickness of a sharp coating, in L.
    k, mu : float
        Exponent and Tabor number of the limit z_s = 0 of an offset power law.

    Examples
    --------
    >>> round(case_of("exponential", 1.0).depth[1], 6)
    0.793701
    """
    if kind == "offset power law":
        graded, units = _scaled(k, mu)
        z_s = parameter * units["radius"]
        E = graded.E0 * (z_s / graded.c0) ** k
        mu_surface = Problem(PowerLaw(E, SCALES["c0"], 0.0, NU), _PUNCH, _LAW).mu
        offset = {"E0": graded.E0, "c0": graded.c0, "k": k, "z_s": z_s, "nu": NU}
        return GradedCase(mu_surface, (k, mu), Section("offset-power-law", offset))
    mu, ratio = EXPONENTIAL if kind == "exponential" else COATING
    surface, units = _scaled(0.0, mu)
    E, length = surface.E0, parameter * units["radius"]
    if kind == "exponential":
        solid = {"E_surface": E, "E_depth": ratio * E, "length": length, "nu": NU}
    else:
        solid = {"E_coating": E, "E_substrate": ratio * E, "thickness": length, "transition": 0.0, "nu": NU}
    return GradedCase(mu, (0.0, mu / ratio ** (2.0 / 3.0)), Section(kind, solid))


def by_fscm(kind: str, parameter: float, k: float = OFFSET[0], mu: float = OFFSET[1]) -> Json:
    """Return all quantities of a solid by the FSCM.

    Parameters
    ----------
    kind, parameter, k, mu
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
    section = case_of(kind, parameter, k, mu).section
    problem = Problem(kind_of("solid", section.kind).build(fscm, section), _PUNCH, _LAW)
    return _solved(problem.dimensionless)


def of_power_law(k: float, mu: float) -> Json:
    """Return all quantities of a power-law solid by the FSCM, as `by_fscm`.

    Examples
    --------
    >>> round(of_power_law(0.0, 1.0)["pull_off_force"][0], 8)
    1.67066478
    """
    return _solved(Problem(_N, k, mu))


def _solved(problem: Problem) -> Json:
    with translated(NoSuchEvent, NotConverged):
        events = solve_together(problem, QUANTITIES)
    return {
        name: str(event) if isinstance(event, NoSuchEvent) else [event.value, event.u_num]
        for name, event in events.items()
    }


def by_elements(event: str, kind: str, parameter: float, k: float = OFFSET[0], mu: float = OFFSET[1]) -> Json:
    """Return the quantities of an event by the finite elements, as `by_fscm`.

    Parameters
    ----------
    event : {"pull-off", "jump-out", "landing"}
        Which family of meshes, see `EVENTS`.
    kind, parameter, k, mu
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
    case, scales = case_of(kind, parameter, k, mu), _scaled(0.0, 1.0)[1]
    problem = fem_reference.Problem(
        kind_of("solid", case.section.kind).build(fem_reference, case.section),
        fem_reference.PowerPunch(n=_N, Q=SCALES["Q"]),
        fem_reference.LennardJones(work_of_adhesion=SCALES["work_of_adhesion"], z0=SCALES["z0"]),
    )
    with translated(fem_reference.NoSuchEvent, fem_reference.NotConverged):
        events = fem_reference.solve_together(problem, EVENTS[event], "quick")
    return {
        name: str(solution)
        if isinstance(solution, fem_reference.NoSuchEvent)
        else [number / scales[_UNITS.get(name, "displacement")] for number in (solution.value, solution.u_num)]
        for name, solution in events.items()
    }


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
    punch = Section("sphere", {"R": SCALES["Q"]})
    law = Section("lennard-jones-9-3", {name: SCALES[name] for name in ("work_of_adhesion", "z0")})
    problem = AnyProblem(case_of(kind, parameter).section, punch, law)
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
