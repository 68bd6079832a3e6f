"""The Maugis-Dugdale model as Jin, Tang, Guo and Gao published it (2021): the cohesive stress is dgamma / z0.

Their strength is the theoretical one without its decimals (1 for 1.026), so that the Maugis number is the Tabor number.
Their Tabor number has no factor b/(1-k) (Eq. 30); the Maugis number has none either, and the ratio of the two, which
alone enters here, is the same.
"""

from __future__ import annotations

from comparisons.models.cohesive_model import CohesiveModel
from comparisons.problem import Problem

__all__ = ["MaugisDugdaleJin"]

MODELS = {"md-jin": "MaugisDugdaleJin"}


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
