r"""Equivalent power law of a solid that is none, and the error that it makes in the pull-off force.

The surface compliance of E0 (z/c0)^k is C(xi) = A xi^(k-1).  ln(xi C) of the solid is fitted by k ln(xi) + ln(A): least
squares, each wave number with its share of the elastic energy at the pull-off force.  The force itself is not fitted.
This is the one rule for the equivalent power law of a solid.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from comparisons.model import ComputationFailed
from comparisons.numerics.kappa import relative_difference, relative_uncertainty
from comparisons.problem_file.description import ProblemFile, Section
from comparisons.problem_file.dimensionless import dimensionless_problem
from comparisons.problem_file.elastic_energy import EnergySpectrum, energy_spectrum
from comparisons.problem_file.evaluation import PhysicalValue, evaluate_problem
from comparisons.problem_file.overview import ModelError, model_errors
from fscm.solids import PowerLaw

__all__ = [
    "LARGEST_DEVIATION",
    "LARGEST_K",
    "EquivalentPowerLaw",
    "equivalent_power_law",
    "least_wrong",
    "power_law_of",
]

#: Largest exponent of the power law: both references take it.
LARGEST_K = 0.9

#: Largest deviation of a compliance for which a law stands for the solid.  Measured for power laws under a sphere: at
#: most 0.33 where the modulus rises with depth, up to a hundredfold; 0.55 to 2 where it falls, but 0.36 for a coating
#: much thinner than the contact.
LARGEST_DEVIATION = 0.5

#: Shares of the energy between which the lengths of the fit are stated.
_MIDDLE = 0.05, 0.95


@dataclass(frozen=True)
class EquivalentPowerLaw:
    """The power law with the least wrong surface compliance, and its pull-off force.

    Attributes
    ----------
    problem : ProblemFile
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
    force : PhysicalValue
        Pull-off force with the power law: of the atlas in its range, and else of the FSCM.
    error, bound : float or None
        Relative error of this force and its bound; None where there is no force.
    closed_forms : tuple of ModelError
        Relative errors of the closed forms with this power law against the force of the solid itself, smallest first;
        none where they do not take the punch or the law.
    """

    problem: ProblemFile
    free_k: float
    deviation: float
    surface_deviation: float
    tabor_number: float
    lengths: tuple[float, float]
    force: PhysicalValue
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


def equivalent_power_law(problem: ProblemFile, force: PhysicalValue) -> EquivalentPowerLaw | None:
    """Compute the equivalent power law of the solid of a problem.

    Parameters
    ----------
    problem : ProblemFile
    force : PhysicalValue
        Its pull-off force by the FSCM.

    Returns
    -------
    EquivalentPowerLaw or None
        None if the solid is a power law, or if there is no force.

    Examples
    --------
    >>> from pathlib import Path
    >>> solid = Section("exponential", {"E_surface": 1e9, "E_depth": 3e9, "length": 1e-8, "nu": 0.3})
    >>> law = Section("lennard-jones-9-3", {"work_of_adhesion": 0.05, "z0": 4e-10})
    >>> pad = ProblemFile(Path("pad.toml"), solid, Section("sphere", {"R": 1e-7}), law)
    >>> found = equivalent_power_law(pad, evaluate_problem(pad, "fscm", "pull_off_force"))
    >>> 0.1 < found.problem.solid["k"] < 0.3, abs(found.error) < 0.02
    (True, True)
    """
    if problem.power_law is not None or force.value is None or force.u_num is None:
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
        tabor_number=dimensionless_problem(similar)[0].mu,
        lengths=(last, first),
        force=found,
        error=error,
        bound=bound,
        closed_forms=model_errors(similar, force),
    )


def least_wrong(spectrum: EnergySpectrum) -> tuple[float, float, float, float]:
    """Fit a power of the wave number to a compliance.

    Returns
    -------
    k, free_k, deviation : float
        As of `EquivalentPowerLaw`.
    compliance : float
        xi C of the power law at the middle of the fit, where the mean of ln(xi) is.

    Examples
    --------
    >>> xi = np.geomspace(1e6, 1e8, 5)
    >>> k, free_k, deviation, _ = least_wrong(EnergySpectrum(xi, 3e-9 * xi**0.25, np.full(5, 0.2), 1e-18))
    >>> round(k, 12), round(free_k, 12), deviation < 1e-14
    (0.25, 0.25, True)
    """
    x, y, shares = np.log(spectrum.wave_numbers), np.log(spectrum.compliances), spectrum.shares
    x = x - shares @ x
    mean = float(shares @ y)
    free_k = float(shares @ (x * y) / (shares @ x**2))
    k = min(max(free_k, 0.0), LARGEST_K)
    deviation = float(np.sqrt(shares @ (mean + k * x - y) ** 2))
    return k, free_k, deviation, math.exp(mean)


def power_law_of(problem: ProblemFile, k: float, compliance: float, spectrum: EnergySpectrum) -> ProblemFile:
    """Return the problem with the power law of a compliance.

    Its Poisson's ratio is that of the surface.  Its c0 is that of the file, or else the length 1/xi of the middle of
    the fit.
    """
    posed, _ = dimensionless_problem(problem)
    nu = float(posed.graded.poisson(np.zeros(1))[0])  # type: ignore[union-attr]
    middle = math.exp(-float(spectrum.shares @ np.log(spectrum.wave_numbers)))
    c0 = problem.solid.get("c0", middle)
    # xi C = 2 b (1 - nu^2)/E0 (xi c0/2)^k Gamma((1-k)/2)/Gamma((1+k)/2)
    b = PowerLaw(E0=1.0, c0=1.0, k=k, nu=nu).response_factor
    gamma = math.gamma((1.0 - k) / 2.0) / math.gamma((1.0 + k) / 2.0)
    E0 = 2.0 * b * (1.0 - nu**2) * (c0 / (2.0 * middle)) ** k * gamma / compliance
    solid = Section("power-law", {"E0": E0, "c0": c0, "k": k, "nu": nu})
    return ProblemFile(problem.path, solid, problem.punch, problem.law)


def _surface_deviation(problem: ProblemFile, spectrum: EnergySpectrum) -> float:
    solid = dimensionless_problem(problem)[0].graded
    E, nu = (float(of_depth(np.zeros(1))[0]) for of_depth in (solid.modulus, solid.poisson))  # type: ignore[union-attr]
    surface = 2.0 * (1.0 - nu**2) / E
    return float(np.sqrt(spectrum.shares @ np.log(spectrum.compliances / surface) ** 2))


def _reference(problem: ProblemFile) -> PhysicalValue:
    """The force of the atlas where it has the problem, and else that of the FSCM."""
    found = evaluate_problem(problem, "atlas", "pull_off_force")
    return found if found.status == "ok" else evaluate_problem(problem, "fscm", "pull_off_force")
