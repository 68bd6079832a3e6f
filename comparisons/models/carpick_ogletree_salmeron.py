"""The transition formula of Carpick, Ogletree and Salmeron for the pull-off force (1999).

Their Eq. 12a fits the pull-off force of the Maugis-Dugdale model over Maugis's lambda,

    -P_c = 7/4 - (1/4) (4.04 lambda^1.4 - 1) / (4.04 lambda^1.4 + 1),

between 2 (DMT) and 3/2 (JKR).  With lambda = 1.157 mu the fitted model is `md-original`.
"""

from __future__ import annotations

from typing import ClassVar

from comparisons.model import Result
from comparisons.models.closed_form import FACTOR_ROUNDING, IN_CONTACT
from comparisons.models.homogeneous_sphere import HomogeneousSphere
from comparisons.models.maugis_parameter import maugis_parameter
from comparisons.problem import Problem

__all__ = ["CarpickOgletreeSalmeron"]

MODELS = {"carpick-ogletree-salmeron": "CarpickOgletreeSalmeron"}


class CarpickOgletreeSalmeron(HomogeneousSphere):
    """The pull-off force over Maugis's lambda by Eq. 12a.

    Examples
    --------
    >>> round(CarpickOgletreeSalmeron().evaluate(Problem.dimensionless(n=2, k=0, mu=1.0), "pull_off_force").value, 6)
    1.583961
    """

    name = "carpick-ogletree-salmeron"
    citation = "Carpick, Ogletree & Salmeron, J. Colloid Interface Sci. 211 (1999) 395-400, Eq. 12a"
    domain = "n = 2, k = 0; fit to Maugis-Dugdale with lambda = 1.157 mu"
    undefined: ClassVar[dict[str, str]] = IN_CONTACT | dict.fromkeys(
        ("pull_off_displacement", "jump_out_displacement", "zero_load_displacement", "force_curve"),
        "its equations relate load and contact radius, without the displacement",
    )

    def pull_off_force(self, problem: Problem) -> Result:
        """-min P (Eq. 12a)."""
        power = 4.04 * maugis_parameter(float(problem.mu)) ** 1.4
        # 7/4 - (x - 1) / (4 (x + 1)), without a difference.
        value = 1.5 + 0.5 / (1.0 + power)
        return Result(value, FACTOR_ROUNDING * value)
