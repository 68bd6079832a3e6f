"""The DMT model: Hertz's contact pressed by the rigid pull-off force (DMT-n-k, Eq. 75).

It is the limit Lambda -> 0 of the Maugis-Dugdale equations.  There the cohesive radius outgrows all else,
c = (n / sigma_0)^(1/n) by Griffith's relation over the undeformed profile, so that Eqs. 66-67 become

    delta = 1/2 B(n/2, (1+k)/2) a^n,    P = Hertz(a) - n^(2/n) sigma_0^(1 - 2/n).

The cohesive stress is eta(n) (Eq. 77), for which the pull-off force is Bradley's (Eq. 74) and sits at a = 0.
"""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from comparisons.model import Curve
from comparisons.models.closed_form import FACTOR_ROUNDING, ClosedForm, Estimate, monomial
from comparisons.models.cohesive_stress import eta
from comparisons.models.graded_punch import GradedPunch
from comparisons.problem import Problem

__all__ = ["DMT", "dmt_pull_off"]

MODELS = {"dmt": "DMT"}

_POINTS = 401


def dmt_pull_off(n: float, cohesive_stress: float) -> Estimate:
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
    applies_to: ClassVar[dict[str, list[Any]]] = {
        "quantities": ["pull_off_force", "pull_off_displacement", "zero_load_displacement", "force_curve"],
        "n": [0.667, None],
    }
    undefined: ClassVar[dict[str, str]] = dict.fromkeys(
        (
            "jump_in_displacement",
            "jump_in_gap",
            "jump_out_displacement",
            "jump_out_gap",
            "hysteresis_energy",
            "critical_tabor_number",
        ),
        "its displacement grows with the contact radius throughout, so it has no folds",
    )

    def cohesive_stress(self, problem: Problem) -> float:
        """sigma_0 = eta(n), in dgamma / z0."""
        return eta(float(problem.n))

    def pull_off_force(self, problem: Problem) -> Estimate:
        """Rigid pull-off force (Eq. 75)."""
        return dmt_pull_off(float(problem.n), self.cohesive_stress(problem))

    def pull_off_displacement(self, problem: Problem) -> Estimate:
        """Zero: the pull-off sits at the point of first contact."""
        self.cohesive_stress(problem)
        GradedPunch.of(problem)
        return Estimate(0.0, 0.0)

    def zero_load_displacement(self, problem: Problem) -> Estimate:
        """Delta where Hertz's load balances the adhesion."""
        punch = GradedPunch.of(problem)
        n, k = punch.n, punch.k
        adhesion = self.pull_off_force(problem)
        power = n / (n + k + 1.0)
        estimate = monomial((punch.flattening, 1.0), (adhesion.value / _hertz(punch, problem.mu), power))
        inherited = power * (adhesion.u_num / adhesion.value + FACTOR_ROUNDING)
        return Estimate(estimate.value, estimate.u_num + inherited * estimate.value)

    def curve(self, problem: Problem) -> Curve:
        """Return the contact branch from a = 0 to a load as compressive as the pull-off is tensile.

        Column ``contact_radius``.
        """
        self.check(problem)
        punch = GradedPunch.of(problem)
        n, k = punch.n, punch.k
        adhesion = self.pull_off_force(problem).value
        hertz = _hertz(punch, problem.mu)
        end = (2.0 * adhesion / hertz) ** (1.0 / (n + k + 1.0))
        a = end * np.linspace(0.0, 1.0, _POINTS)
        return Curve(
            displacement=punch.flattening * a**n,
            load=hertz * a ** (n + k + 1.0) - adhesion,
            columns={"contact_radius": a},
        )


def _hertz(punch: GradedPunch, mu: float) -> float:
    """Barred Hertz load over a_bar^(n+k+1)."""
    return punch.hertz_load * mu ** -((2.0 * punch.n + punch.k - 1.0) / punch.n)
