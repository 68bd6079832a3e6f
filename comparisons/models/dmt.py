"""The DMT model: Hertz's contact pressed by the rigid pull-off force (DMT-n-k, Eq. 75).

It is the limit Lambda -> 0 of the Maugis-Dugdale equations.  There the cohesive radius outgrows all else,
c = (n / sigma_0)^(1/n) by Griffith's relation over the undeformed profile, so that Eqs. 66-67 become

    delta = 1/2 B(n/2, (1+k)/2) a^n,    P = Hertz(a) - n^(2/n) sigma_0^(1 - 2/n).

The pull-off sits at a = 0.  With the cohesive stress eta(n) (Eq. 77), of `DMT`, its force is Bradley's (Eq. 74).  With
the theoretical strength 16 sqrt(3) / 27 (Eq. 73), of `DMTStrength`, it is the limit of the original Maugis-Dugdale
model and for n other than 2 not Bradley's.  For n = 2 the strength has no influence: both are the model of Derjaguin,
Muller and Toporov.
"""

from __future__ import annotations

from typing import ClassVar

import numpy as np

from comparisons.model import Curve, Result
from comparisons.models.closed_form import FACTOR_ROUNDING, POINTS, STIFF, ClosedForm, monomial
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH, eta
from comparisons.models.graded_punch import GradedPunch
from comparisons.problem import Problem


def dmt_pull_off(n: float, cohesive_stress: float) -> Result:
    """Pull-off force n^(2/n) sigma_0^(1 - 2/n) (Eq. 75), sigma_0 in dgamma / z0.

    Examples
    --------
    >>> dmt_pull_off(2.0, 1.0).value
    2.0
    """
    return monomial((n, 2.0 / n), (cohesive_stress, 1.0 - 2.0 / n))


class DMT(ClosedForm):
    """DMT-n-k with the cohesive stress eta(n).

    Examples
    --------
    >>> round(DMT().evaluate(Problem.dimensionless(n=5, k=0.4, mu=0.1), "pull_off_force").value, 3)
    1.669
    """

    name = "dmt"
    citation = (
        "Zhu, Zheng, Huang & Yu, Eqs. 75-77; Derjaguin, Muller & Toporov, J. Colloid Interface Sci. 53 (1975) 314-326"
    )
    domain = "n > 2/3, 0 <= k <= 1; cohesive stress eta(n); exact pull-off as mu -> 0"
    validity = STIFF
    undefined: ClassVar[str] = "its displacement grows with the contact radius throughout, so it has no folds"

    def cohesive_stress(self, problem: Problem) -> float:
        """sigma_0 = eta(n), in dgamma / z0."""
        return eta(float(problem.n))

    def pull_off_force(self, problem: Problem) -> Result:
        """Rigid pull-off force (Eq. 75)."""
        return dmt_pull_off(float(problem.n), self.cohesive_stress(problem))

    def pull_off_displacement(self, problem: Problem) -> Result:
        """Zero: the pull-off sits at the point of first contact."""
        return Result(0.0, 0.0)

    def zero_load_displacement(self, problem: Problem) -> Result:
        """Delta where Hertz's load balances the adhesion."""
        punch = GradedPunch.of(problem)
        n, k = punch.n, punch.k
        adhesion = self.pull_off_force(problem)
        power = n / (n + k + 1.0)
        estimate = monomial((punch.flattening, 1.0), (adhesion.value / _hertz(punch, problem.mu), power))
        inherited = power * (adhesion.u_num / adhesion.value + FACTOR_ROUNDING)
        return Result(estimate.value, estimate.u_num + inherited * estimate.value)

    def force_curve(self, problem: Problem) -> Curve:
        """Return the contact branch from a = 0 to a load as compressive as the pull-off is tensile.

        Column ``contact_radius``.
        """
        return self.curve_to(problem, self.pull_off_force(problem).value)

    def curve_to(self, problem: Problem, load: float) -> Curve:
        """Return the same to a load, in pi Q^(2/n) dgamma z0^(2/n-1)."""
        punch = GradedPunch.of(problem)
        n, k = punch.n, punch.k
        adhesion = self.pull_off_force(problem).value
        hertz = _hertz(punch, problem.mu)
        end = ((load + adhesion) / hertz) ** (1.0 / (n + k + 1.0))
        a = end * np.linspace(0.0, 1.0, POINTS)
        return Curve(
            displacement=punch.flattening * a**n,
            load=hertz * a ** (n + k + 1.0) - adhesion,
            columns={"contact_radius": a},
        )


class DMTStrength(DMT):
    """DMT-n-k with the cohesive stress 16 sqrt(3) / 27.

    Examples
    --------
    >>> round(DMTStrength().evaluate(Problem.dimensionless(n=1, k=0.4, mu=0.1), "pull_off_force").value, 4)
    0.9743
    """

    name = "dmt-strength"
    citation = "Zhu, Zheng, Huang & Yu, Eqs. 73 and 75; Jin, Tang, Guo & Gao, J. Mech. Phys. Solids 154 (2021) 104509"
    domain = "n > 2/3, 0 <= k <= 1; cohesive stress 16 sqrt(3)/27"
    validity = STIFF

    def cohesive_stress(self, problem: Problem) -> float:
        """sigma_0 = 16 sqrt(3) / 27, in dgamma / z0."""
        return THEORETICAL_STRENGTH


def _hertz(punch: GradedPunch, mu: float) -> float:
    """Barred Hertz load over a_bar^(n+k+1)."""
    return punch.hertz_load * mu ** -((2.0 * punch.n + punch.k - 1.0) / punch.n)
