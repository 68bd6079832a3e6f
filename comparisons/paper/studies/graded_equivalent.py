"""Equivalent power laws of the solids of the study, by the rule of `comparisons.problem.equivalent_solid`.

The rule weighs the compliance of the solid by the elastic energy at the pull-off force; the jumps and the energy of the
table are those of the same power law.
"""

from __future__ import annotations

from comparisons.paper.studies.graded_routes import SCALES, Json, case_of, of_power_law
from comparisons.problem import Problem, Section
from comparisons.problem.elastic_energy import energy_spectrum
from comparisons.problem.equivalent_solid import least_wrong, power_law_of

__all__ = ["equivalent_of", "of_equivalent"]

# Digits of k and mu, as a reader can repeat them.
_DIGITS = 6


def equivalent_of(kind: str, parameter: float) -> tuple[float, float]:
    """Return k and mu of the equivalent power law of a solid at its pull-off force, rounded.

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
    problem = Problem(case_of(kind, parameter).section, punch, law)
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
