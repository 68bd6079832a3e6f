"""The DMT model with the theoretical strength (DMT-n-k, Eq. 75 with the cohesive stress of Eq. 73).

It is the limit Lambda -> 0 of the original Maugis-Dugdale model, so that it needs no other equation than that limit:

    P = Hertz(a) - n^(2/n) sigma_th^(1 - 2/n),    sigma_th = 16 sqrt(3) / 27.

For n = 2 the strength has no influence, and the model is that of Derjaguin, Muller and Toporov.  For other n its
pull-off force is not that of the rigid punch with the 9-3 law; the consistency condition (Eq. 74) corrects this.
"""

from __future__ import annotations

from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH
from comparisons.models.dmt import DMT
from comparisons.problem import Problem

__all__ = ["DMTStrength"]

MODELS = {"dmt-strength": "DMTStrength"}


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

    def cohesive_stress(self, problem: Problem) -> float:
        """sigma_0 = 16 sqrt(3) / 27, in dgamma / z0."""
        return THEORETICAL_STRENGTH
