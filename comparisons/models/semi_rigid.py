"""The semi-rigid asymptote of the approach before contact (Eqs. 40-48).

The traction is that of the undeformed gap H0 + r^n / n; it deforms the half-space, but the deformation does
not feed back.  With q = 1/(H0 + 1), b = (1-k)/n and g_j = (1-k) B(j-b, b) = n Gamma(j-b) Gamma(1+b) / (j-1)!,

    delta = -H0 + (16/3) n^(b-1) mu^(2-b) [ g_9 q^(9-b) - g_3 q^(3-b) ]          (Eq. 41),

written so that k = 1 is no exception.  Without the repulsion (g_9) it is Eq. 43, whose fold is Eqs. 46-48.
"""

from __future__ import annotations

import math
from typing import ClassVar

import numpy as np
from scipy.special import beta, gamma

from comparisons.model import FARTHEST_GAP, Curve, Result
from comparisons.models.bradley import rigid_load
from comparisons.models.closed_form import EPS, POINTS, ClosedForm, monomial
from comparisons.problem import Problem


def _reach(n: float, k: float, j: int) -> float:
    """g_j = (1-k) B(j - b, b), b = (1-k)/n, with its limit n at k = 1."""
    b = (1.0 - k) / n
    return n * float(gamma(j - b) * gamma(1.0 + b)) / math.factorial(j - 1)


def attraction_coefficient(n: float, k: float) -> float:
    """Coefficient of mu^(2-b) q^(3-b) in Eq. 43, b = (1-k)/n, dimensionless.

    Examples
    --------
    >>> round(attraction_coefficient(5.0, 1.0), 12)        # 16/3 at k = 1, whatever n
    5.333333333333
    """
    return 16.0 / 3.0 * n ** ((1.0 - k) / n - 1.0) * _reach(n, k, 3)


def _fold(n: float, k: float, mu: float) -> Result:
    """H0 + 1 at the fold of Eq. 43 (Eq. 46)."""
    b = (1.0 - k) / n
    return monomial(((3.0 - b) * attraction_coefficient(n, k), 1.0 / (4.0 - b)), (mu, (2.0 - b) / (4.0 - b)))


def jump_in_coefficient(n: float, k: float) -> float:
    """C_in of Eq. 48, dimensionless; 8/3 at k = 1 whatever n.

    Examples
    --------
    >>> round(jump_in_coefficient(5.0, 1.0), 12)
    2.666666666667
    """
    b = (1.0 - k) / n
    return (4.0 - b) / (3.0 - b) * _fold(n, k, 1.0).value


class SemiRigid(ClosedForm):
    """The semi-rigid theory of jump-in.

    Examples
    --------
    >>> problem = Problem.dimensionless(n=2, k=0.0, mu=1.0)
    >>> value = SemiRigid().evaluate(problem, "jump_in_displacement").value
    >>> bool(np.isclose(value, 1 - 1.4 * (5 * np.pi / np.sqrt(2)) ** (2 / 7), rtol=1e-14))
    True
    """

    name = "semi-rigid"
    citation = (
        "Zhu, Zheng, Huang & Yu, Eqs. 40-48; Greenwood, Philos. Mag. 89 (2009) 945-965; n = 2, k = 0: Wu, J. Adhes. 86 "
        "(2010) 1071-1085; Ciavarella, Greenwood & Barber, J. Mech. Phys. Solids 98 (2017) 236-244"
    )
    domain = "n > (1-k)/3, 0 <= k <= 1; asymptotic for a jump-in at a large central gap"
    undefined: ClassVar[str] = "it describes only the approach up to the jump-in, where deformations are small"

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why not, where the fold is not out of contact."""
        if (reason := super().skip(problem, quantity)) or quantity == "force_curve":
            return reason
        gap = _fold_of(problem).value - 1.0
        if gap > 0.0:
            return None
        return f"Eq. 46 gives the central gap {gap:.3g} at mu = {problem.mu}, but the asymptote needs a positive one"

    def jump_in_gap(self, problem: Problem) -> Result:
        """Central gap at the fold (Eq. 46)."""
        fold = _fold_of(problem)
        return Result(fold.value - 1.0, fold.u_num + EPS)

    def jump_in_displacement(self, problem: Problem) -> Result:
        """Displacement at the fold (Eqs. 47-48)."""
        fold = _fold_of(problem)
        b = (1.0 - problem.k) / problem.n
        factor = (4.0 - b) / (3.0 - b)
        return Result(1.0 - factor * fold.value, factor * fold.u_num + 4.0 * EPS * factor * fold.value + EPS)

    def force_curve(self, problem: Problem) -> Curve:
        """Return Eqs. 41-42 from H0 = 10 (or twice the fold's, if farther) to the jump-in gap, or to H0 = 0.

        Columns ``central_gap``, and Eqs. 43-44 as ``asymptotic_displacement`` and ``asymptotic_load``.
        """
        n, k, mu = float(problem.n), float(problem.k), float(problem.mu)
        nearest = max(_fold(n, k, mu).value, 1.0)
        H0 = np.geomspace(max(FARTHEST_GAP + 1.0, 2.0 * nearest), nearest, POINTS) - 1.0
        b, c = (1.0 - k) / n, 2.0 / n
        q = 1.0 / (H0 + 1.0)
        pull = attraction_coefficient(n, k) * mu ** (2.0 - b) * q ** (3.0 - b)
        push = pull * (_reach(n, k, 9) / _reach(n, k, 3)) * q**6
        load = rigid_load(n, H0)
        far_load = -16.0 / 3.0 * n ** (c - 1.0) * float(beta(3.0 - c, c)) * q ** (3.0 - c)
        return Curve(
            displacement=-H0 + push - pull,
            load=load,
            columns={
                "central_gap": H0,
                "asymptotic_displacement": -H0 - pull,
                "asymptotic_load": far_load,
            },
        )


def _fold_of(problem: Problem) -> Result:
    """H0 + 1 at the fold of a problem."""
    return _fold(float(problem.n), float(problem.k), float(problem.mu))
