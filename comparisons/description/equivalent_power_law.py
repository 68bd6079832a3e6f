"""Equivalent power law of a solid that is none, and the error that it makes in the pull-off force."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from comparisons.description.overview import ModelError, model_errors
from comparisons.model import ComputationFailed
from comparisons.numerics.kappa import relative_difference, relative_uncertainty
from comparisons.problem.elastic_energy import EnergySpectrum, energy_spectrum
from comparisons.problem.equivalent_solid import LARGEST_DEVIATION, least_wrong, power_law_of
from comparisons.problem.problem import Problem
from comparisons.runs.rows import Row
from comparisons.runs.tasks import evaluate

__all__ = [
    "EquivalentPowerLaw",
    "equivalent_power_law",
]

#: Shares of the energy between which the lengths of the fit are stated.
_MIDDLE = 0.05, 0.95


@dataclass(frozen=True)
class EquivalentPowerLaw:
    """The power law with the least wrong surface compliance, and its pull-off force.

    Attributes
    ----------
    problem : Problem
        That of the file with this power law as its solid.
    free_k : float
        The exponent of the fit without limits; k is the nearest one from 0 to `LARGEST_K`.
    deviation : float
        Root mean square of the relative difference of the compliances.
    surface_deviation : float
        The same for a homogeneous solid with the modulus of the surface.
    tabor_number : float
        With this power law.
    lengths : tuple of float
        From the shortest to the longest 1/xi of the fit, in m: nine tenths of the elastic energy are between.
    force : Row
        Pull-off force with the power law: of the atlas in its range, and else of the FSCM.
    error, bound : float or None
        Relative error of this force and its bound; None where there is no force.
    closed_forms : tuple of ModelError
        Relative errors of the closed forms with this power law against the force of the solid itself, smallest first;
        none where they do not take the punch or the law.
    """

    problem: Problem
    free_k: float
    deviation: float
    surface_deviation: float
    tabor_number: float
    lengths: tuple[float, float]
    force: Row
    error: float | None
    bound: float | None
    closed_forms: tuple[ModelError, ...]

    @property
    def is_close(self) -> bool:
        """Whether the power law stands for the solid."""
        return self.deviation <= LARGEST_DEVIATION

    @property
    def is_surface_close(self) -> bool:
        """Whether the modulus of the surface stands for the solid."""
        return self.surface_deviation <= LARGEST_DEVIATION


def equivalent_power_law(problem: Problem, force: Row) -> EquivalentPowerLaw | None:
    """Compute the equivalent power law of the solid of a problem.

    Parameters
    ----------
    problem : Problem
    force : Row
        Its pull-off force by the FSCM.

    Returns
    -------
    EquivalentPowerLaw or None
        None if the solid is a power law, or if there is no force.

    Examples
    --------
    >>> from comparisons.problem import Section
    >>> solid = Section("exponential", {"E_surface": 1e9, "E_depth": 3e9, "length": 1e-8, "nu": 0.3})
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 4e-10})
    >>> pad = Problem(solid, Section("sphere", {"R": 1e-7}), law)
    >>> found = equivalent_power_law(pad, evaluate("fscm", "pull_off_force", pad))
    >>> 0.1 < found.problem.solid["k"] < 0.3, abs(found.error) < 0.02
    (True, True)
    """
    if problem.has_power_law or force.value is None or force.u_num is None:
        return None
    try:
        spectrum = energy_spectrum(problem)
    except ComputationFailed:
        return None
    k, free_k, deviation, compliance = least_wrong(spectrum)
    first, last = (spectrum.length(share) for share in _MIDDLE)
    similar = power_law_of(problem, k, compliance, spectrum)
    found = _reference(similar)
    error = bound = None
    if found.value is not None and found.u_num is not None:
        error = relative_difference(found.value, force.value)
        bound = relative_uncertainty(found.value, found.u_num, force.value, force.u_num)
    return EquivalentPowerLaw(
        problem=similar,
        free_k=free_k,
        deviation=deviation,
        surface_deviation=_surface_deviation(problem, spectrum),
        tabor_number=similar.posed.mu,
        lengths=(last, first),
        force=found,
        error=error,
        bound=bound,
        closed_forms=model_errors(similar, force),
    )


def _surface_deviation(problem: Problem, spectrum: EnergySpectrum) -> float:
    solid = problem.posed.graded
    E, nu = (float(of_depth(np.zeros(1))[0]) for of_depth in (solid.modulus, solid.poisson))  # type: ignore[union-attr]
    surface = 2.0 * (1.0 - nu**2) / E
    return float(np.sqrt(spectrum.shares @ np.log(spectrum.compliances / surface) ** 2))


def _reference(problem: Problem) -> Row:
    """The force of the atlas where it has the problem, and else that of the FSCM."""
    found = evaluate("atlas", "pull_off_force", problem)
    return found if found.status == "ok" else evaluate("fscm", "pull_off_force", problem)
