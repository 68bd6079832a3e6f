r"""Power law that stands for a solid that is none.

The surface compliance of E0 (z/c0)^k is C(xi) = A xi^(k-1).  ln(xi C) of the solid is fitted by k ln(xi) + ln(A): least
squares, each wave number with its share of the elastic energy at the pull-off force.  The force itself is not fitted.
This is the one rule for the equivalent power law of a solid.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache

import numpy as np

from comparisons.model import NotApplicable
from comparisons.problem.elastic_energy import EnergySpectrum, energy_spectrum
from comparisons.problem.problem import Problem, Section
from fscm.solids import PowerLaw

#: Largest exponent of the power law: both references take it.
LARGEST_K = 0.9

#: Largest deviation of a compliance for which a law stands for the solid.  Measured for power laws under a sphere: at
#: most 0.33 where the modulus rises with depth, up to a hundredfold; 0.55 to 2 where it falls, but 0.36 for a coating
#: much thinner than the contact.
LARGEST_DEVIATION = 0.5


@lru_cache(maxsize=64)
def equivalent_solids(problem: Problem) -> tuple[Problem, Problem]:
    """Return a problem with the power law that stands for its solid, and with that of every second wave number.

    What a model gives for both differs by more than the first has an error: the fit converges with the second power of
    the distance of the wave numbers or faster (measured: a twentieth of the difference on two coatings).

    Raises
    ------
    NotApplicable
        If no power law stands for the solid.
    comparisons.model.ComputationFailed
        If the FSCM does not converge.
    """
    spectrum = energy_spectrum(problem)
    k, _, deviation, compliance = least_wrong(spectrum)
    if deviation > LARGEST_DEVIATION:
        raise NotApplicable(
            f"no power law stands for the {problem.solid.kind} solid: the nearest misses its compliance by "
            f"{100 * deviation:.0f} %, more than {100 * LARGEST_DEVIATION:.0f} %"
        )
    shares = spectrum.shares[::2] / float(np.sum(spectrum.shares[::2]))
    coarse = EnergySpectrum(spectrum.wave_numbers[::2], spectrum.compliances[::2], shares, spectrum.energy)
    coarse_k, _, _, coarse_compliance = least_wrong(coarse)
    return (
        power_law_of(problem, k, compliance, spectrum),
        power_law_of(problem, coarse_k, coarse_compliance, coarse),
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


def power_law_of(problem: Problem, k: float, compliance: float, spectrum: EnergySpectrum) -> Problem:
    """Return the problem with the power law of a compliance.

    Its Poisson's ratio is that of the surface.  Its c0 is that of the file, or else the length 1/xi of the middle of
    the fit.
    """
    nu = float(problem.posed.graded.poisson(np.zeros(1))[0])  # type: ignore[union-attr]
    middle = math.exp(-float(spectrum.shares @ np.log(spectrum.wave_numbers)))
    c0 = problem.solid.get("c0", middle)
    # xi C = 2 b (1 - nu^2)/E0 (xi c0/2)^k Gamma((1-k)/2)/Gamma((1+k)/2)
    b = PowerLaw(E0=1.0, c0=1.0, k=k, nu=nu).response_factor
    gamma = math.gamma((1.0 - k) / 2.0) / math.gamma((1.0 + k) / 2.0)
    E0 = 2.0 * b * (1.0 - nu**2) * (c0 / (2.0 * middle)) ** k * gamma / compliance
    solid = Section("power-law", {"E0": E0, "c0": c0, "k": k, "nu": nu})
    return replace(problem, solid=solid)
