"""Equivalent power law of a solid that is none, and the error that it makes in the pull-off force."""

from __future__ import annotations

from typing import Any

import numpy as np

from comparisons.description.choice import LIMITS, by_size, simplest_within, size_of
from comparisons.description.forces import change_of, force_content, reference_force
from comparisons.description.overview import model_errors
from comparisons.model import ComputationFailed
from comparisons.problem import Problem
from comparisons.problem.equivalent_solid import (
    LARGEST_DEVIATION,
    EnergySpectrum,
    energy_spectrum,
    least_wrong,
    power_law_of,
)
from comparisons.runs.rows import Row

#: Shares of the energy between which the lengths of the fit are stated.
_MIDDLE = 0.95, 0.05


def equivalent_power_law(problem: Problem, force: Row) -> dict[str, Any] | None:
    """Return the power law with the least wrong surface compliance, as JSON has it; errors are fractions.

    Parameters
    ----------
    problem : Problem
    force : Row
        Its pull-off force by the FSCM.

    Returns
    -------
    dict or None
        None if the solid is a power law, if there is no force, or for two bodies, surface tension or friction.
        `free_k` is the exponent of the fit without limits; the deviations of the compliance are relative root mean
        squares, of this law and of the modulus of the surface; nine tenths of the elastic energy are between both
        `lengths`; `pull_off_force` has the error of this law, and `closed_forms` those of the closed forms with this
        law, against the force of the solid itself, with what the size of that of the law and of their own make together
        as ``at_most``; `closed_form_within` has the simplest one for which this is within.

    Examples
    --------
    >>> from comparisons.problem import Section
    >>> solid = Section("exponential", {"E_surface": 1e9, "E_depth": 3e9, "length": 1e-8, "nu": 0.3})
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 4e-10})
    >>> pad = Problem(solid, Section("sphere", {"R": 1e-7}), law)
    >>> equivalent = equivalent_power_law(pad, reference_force(pad))
    >>> 0.1 < equivalent["k"] < 0.3, abs(equivalent["pull_off_force"]["error"]) < 0.02
    (True, True)
    """
    if problem.is_of_the_paper("solid") or force.value is None or problem.punch_solid or problem.surface:
        return None
    try:
        spectrum = energy_spectrum(problem)
    except ComputationFailed:
        return None
    _, free_k, deviation, _ = least_wrong(spectrum)
    similar = power_law_of(problem, spectrum)
    of_law = reference_force(similar)
    error, bound = change_of(of_law, force) or (None, None)
    closed_forms = model_errors(similar, force)
    if error is not None and bound is not None:
        own = {row["model"]: size_of(row) for row in model_errors(similar, of_law)}
        closed_forms = [row | {"at_most": by_size(own[row["model"]], abs(error) + bound)} for row in closed_forms]
    is_near = deviation <= LARGEST_DEVIATION and error is not None
    within = {f"{100 * limit:g} %": simplest_within(closed_forms, limit) if is_near else None for limit in LIMITS}
    return {
        **similar.solid.values,
        "free_k": free_k,
        "compliance_deviation": deviation,
        "surface_compliance_deviation": _surface_deviation(problem, spectrum),
        "tabor_number": similar.posed.mu,
        "lengths": [spectrum.length(share) for share in _MIDDLE],
        "pull_off_force": force_content(of_law) | {"error": error, "error_u_num": bound},
        "closed_forms": closed_forms,
        "closed_form_within": within,
    }


def _surface_deviation(problem: Problem, spectrum: EnergySpectrum) -> float:
    solid = problem.posed.graded
    of_depth = solid.modulus, solid.poisson  # type: ignore[union-attr]  # it is not a power law
    E, nu = (float(values(np.zeros(1))[0]) for values in of_depth)
    surface = 2.0 * (1.0 - nu**2) / E
    return float(np.sqrt(spectrum.shares @ np.log(spectrum.compliances / surface) ** 2))
