"""The Maugis-Dugdale models of a power-law punch on a graded half-space (M-D-n-k, Eqs. 63-78).

They differ in the cohesive stress alone: `MaugisDugdaleOriginal` takes the largest tension of the 9-3 law (Eq. 73),
`MaugisDugdaleImproved` the stress eta(n) that gives the rigid pull-off force (Eqs. 76-78), and `MaugisDugdaleJin` that
of Jin, Tang, Guo and Gao (2021), dgamma / z0.  Their strength is the theoretical one without its decimals (1 for
1.026), so that the Maugis number is the Tabor number.  Their Tabor number has no factor b/(1-k) (Eq. 30); the Maugis
number has none either, and the ratio of the two, which alone enters here, is the same.
"""

from __future__ import annotations

from typing import ClassVar

from comparisons.models.closed_form import Limits
from comparisons.models.cohesive_model import CohesiveModel
from comparisons.models.cohesive_stress import eta
from comparisons.problem import Problem

__all__ = ["MaugisDugdaleImproved", "MaugisDugdaleJin", "MaugisDugdaleOriginal"]

MODELS = {
    "md-original": "MaugisDugdaleOriginal",
    "md-improved": "MaugisDugdaleImproved",
    "md-jin": "MaugisDugdaleJin",
}


class MaugisDugdaleOriginal(CohesiveModel):
    """M-D-n-k with the theoretical strength 16 sqrt(3) / 27 as cohesive stress (Eq. 73).

    Examples
    --------
    >>> round(MaugisDugdaleOriginal().evaluate(Problem.dimensionless(n=2, k=0.4, mu=1.0), "pull_off_force").value, 8)
    1.7304517
    """

    name = "md-original"
    citation = "Zhu, Zheng, Huang & Yu, Eqs. 63-73; Jin, Tang, Guo & Gao, J. Mech. Phys. Solids 154 (2021) 104509"
    domain = "n > (1-k)/2, 0 <= k <= 1; cohesive stress 16 sqrt(3)/27"


class MaugisDugdaleImproved(CohesiveModel):
    """M-D-n-k with the cohesive stress eta(n) of the rigid-limit-consistency condition (Eqs. 76-78).

    Examples
    --------
    >>> round(MaugisDugdaleImproved().evaluate(Problem.dimensionless(n=2, k=0.4, mu=1.0), "pull_off_force").value, 8)
    1.78527591
    """

    name = "md-improved"
    citation = "Zhu, Zheng, Huang & Yu, Eqs. 63-78; Zheng & Yu, J. Colloid Interface Sci. 310 (2007) 27-34"
    domain = "n > 2/3, 0 <= k <= 1; cohesive stress eta(n)"
    limits: ClassVar[Limits | None] = {"n": [0.667, None]}

    def cohesive_stress(self, problem: Problem) -> float:
        """sigma_0 = eta(n), in dgamma / z0."""
        return eta(float(problem.n))


class MaugisDugdaleJin(CohesiveModel):
    """M-D-n-k with the cohesive stress 1.

    Examples
    --------
    >>> round(MaugisDugdaleJin().evaluate(Problem.dimensionless(n=2, k=0.4, mu=1.0), "pull_off_force").value, 8)
    1.73229032
    """

    name = "md-jin"
    citation = (
        "Jin, Tang, Guo & Gao, J. Mech. Phys. Solids 154 (2021) 104509; Zhu, Zheng, Huang & Yu, Eqs. 63-72 and Sec. 4.2"
    )
    domain = "n > (1-k)/2, 0 <= k <= 1; cohesive stress 1"

    def cohesive_stress(self, problem: Problem) -> float:
        """sigma_0 = 1, in dgamma / z0."""
        return 1.0
