"""The rigid limit of the 9-3 law on a power-law punch (Bradley-n, Eqs. 42 and 56).

With q = 1 / (H0 + 1), b = 2/n and B_j = B(j - b, b),

    P = (16/3) n^(b - 1) [ B_9 q^(9-b) - B_3 q^(3-b) ],    delta = -H0.

dP/dq = 0 at q^6 = (3-b) B_3 / ((9-b) B_9) = 168 B(4 - b, 6) = prod_{j=4..9} (j - 1) / (j - b), whence Eq. 56.
"""

from __future__ import annotations

import math
from typing import ClassVar

import numpy as np
import scipy
from numpy.typing import NDArray

from comparisons.model import FARTHEST_GAP, Curve, Result
from comparisons.models.closed_form import EPS, FACTOR_ROUNDING, POINTS, STIFF, ClosedForm, monomial
from comparisons.problem import Problem

#: The curve ends this factor of H0 + 1 inside the zero-load gap, where the load has turned compressive.
_INSIDE = 0.97


def rigid_load(n: float, central_gap: NDArray[np.float64]) -> NDArray[np.float64]:
    """P of a rigid power-law punch at central gap H0 (Eq. 42), shape of `central_gap`.

    Examples
    --------
    >>> float(rigid_load(2.0, np.array(0.0)))
    -2.0
    """
    b = 2.0 / n
    q = 1.0 / (np.asarray(central_gap, float) + 1.0)
    factor = 16.0 / 3.0 * n ** (b - 1.0)
    return factor * q ** (3.0 - b) * (scipy.special.beta(9.0 - b, b) * q**6 - scipy.special.beta(3.0 - b, b))


def _gap_base(n: float) -> float:
    """q^6 at pull-off, 168 B(4 - 2/n, 6) as a rational product."""
    return math.prod((j - 1.0) / (j - 2.0 / n) for j in range(4, 10))


def rigid_pull_off(n: float) -> Result:
    """-min P of a rigid power-law punch (Eq. 56).

    Examples
    --------
    >>> [round(rigid_pull_off(n).value, 3) for n in (1, 1.5, 2, 5)]
    [2.88, 2.166, 2.0, 1.669]
    """
    b = 2.0 / n
    return monomial(
        (32.0 / (9.0 * n - 2.0), 1.0),
        (n, b),
        (float(scipy.special.beta(3.0 - b, b)), 1.0),
        (_gap_base(n), (3.0 - b) / 6.0),
    )


class Bradley(ClosedForm):
    """Bradley-n: nothing deforms.

    Examples
    --------
    >>> Bradley().evaluate(Problem.dimensionless(n=2, k=0.4, mu=1.0), "pull_off_force").value
    2.0
    """

    name = "bradley"
    citation = "Zhu, Zheng, Huang & Yu, Eqs. 42 and 56; Zheng & Yu, J. Colloid Interface Sci. 310 (2007) 27-34"
    domain = "n > 2/3, any k; exact as mu -> 0"
    validity = STIFF
    undefined: ClassVar[str] = "a rigid pair under displacement control has no folds, at which energy is lost"

    def pull_off_force(self, problem: Problem) -> Result:
        """-min P (Eq. 56)."""
        return rigid_pull_off(float(problem.n))

    def pull_off_displacement(self, problem: Problem) -> Result:
        """Delta = 1 - 1/q at the smallest P."""
        return _shifted(monomial((_gap_base(float(problem.n)), -1.0 / 6.0)))

    def zero_load_displacement(self, problem: Problem) -> Result:
        """Delta where attraction and repulsion balance."""
        return _shifted(_zero_load_gap(float(problem.n)))

    def force_curve(self, problem: Problem) -> Curve:
        """Return Eq. 42 from H0 = 10 to a compressive load; column ``central_gap``."""
        n = float(problem.n)
        nearest = _INSIDE * _zero_load_gap(n).value
        central_gap = np.geomspace(FARTHEST_GAP + 1.0, nearest, POINTS) - 1.0
        return Curve(displacement=-central_gap, load=rigid_load(n, central_gap), columns={"central_gap": central_gap})


def _zero_load_gap(n: float) -> Result:
    """H0 + 1 where P = 0: the sixth root of B_9 / B_3."""
    b = 2.0 / n
    return monomial((float(scipy.special.beta(9.0 - b, b) / scipy.special.beta(3.0 - b, b)), 1.0 / 6.0))


def _shifted(gap_plus_one: Result) -> Result:
    """1 - (H0 + 1), with the rounding of the subtraction."""
    return Result(1.0 - gap_plus_one.value, gap_plus_one.u_num + FACTOR_ROUNDING * gap_plus_one.value + EPS)
