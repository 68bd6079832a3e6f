"""The base of the formulas for a paraboloid on a homogeneous half-space, n = 2 and k = 0.

Their variables are Maugis's lambda and the transition parameter alpha of Carpick, Ogletree and Salmeron (1999), which
is 0 in the DMT and 1 in the JKR limit.  Their Eq. 10, lambda = -0.924 ln(1 - 1.02 alpha), gives one from the other.  It
has alpha = 1 nowhere: the largest is 1 / 1.02.
"""

from __future__ import annotations

import math
from typing import ClassVar

from comparisons.model import NotApplicable
from comparisons.models.closed_form import IN_CONTACT, ClosedForm, Limits
from comparisons.models.maugis_parameter import maugis_parameter
from comparisons.problem import Problem

__all__ = ["HomogeneousSphere", "transition_parameter"]


def transition_parameter(mu: float) -> float:
    """Return alpha at a Tabor number (Carpick, Ogletree & Salmeron, Eq. 10).

    Examples
    --------
    >>> round(transition_parameter(1.0), 4), round(transition_parameter(100.0), 4)
    (0.7001, 0.9804)
    """
    return -math.expm1(-maugis_parameter(mu) / 0.924) / 1.02


class HomogeneousSphere(ClosedForm):
    """A formula for n = 2 and k = 0 alone.

    Examples
    --------
    >>> from comparisons.models.schwarz import Schwarz
    >>> Schwarz().evaluate(Problem.dimensionless(n=2, k=0.4, mu=1.0), "pull_off_force")
    Traceback (most recent call last):
    comparisons.model.NotApplicable: schwarz is for n = 2 and k = 0, a sphere on a homogeneous solid, not for k = 0.4
    """

    limits: ClassVar[Limits | None] = {"n": [2, 2], "k": [0, 0]}
    undefined: ClassVar[dict[str, str]] = IN_CONTACT

    def check(self, problem: Problem) -> None:
        """Raise `NotApplicable` unless n = 2, k = 0, the punch is r^2 / 2 and the law is 9-3."""
        for name, value, only in (("n", problem.n, 2.0), ("k", problem.k, 0.0)):
            if float(value) != only:
                raise NotApplicable(
                    f"{self.name} is for n = 2 and k = 0, a sphere on a homogeneous solid, not for {name} = {value:g}"
                )
