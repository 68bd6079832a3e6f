"""The hysteresis energy from the asymptotes of the two jumps.

Sec. 3.3 of Zhu, Zheng, Huang and Yu names this use of the asymptotes.  At a large Tabor number the cycle follows the
semi-rigid branch (Eqs. 43-44) up to its fold delta_in (Eq. 46), jumps to the JKR branch (Eqs. 50-51), follows it back
to its fold delta_out (Eq. 53), and jumps to the semi-rigid branch again.  With U, dU = P d delta, the energy of a
branch, zero far away and at a = 0, the jumps lose

    W = [U_s(delta_in) - U_J(delta_in)] + [U_J(delta_out) - U_s(delta_out)].

On the semi-rigid branch, with q = 1/(H0 + 1), b = (1-k)/n and c = 2/n,

    delta = 1 - 1/q - A q^(3-b),    P = -B q^(3-c),    U_s = -B [ q^(2-c)/(2-c) - (3-b) A q^(6-b-c)/(6-b-c) ],

and only differences of U_s enter: for n <= 1 that to infinity is infinite.
"""

from __future__ import annotations

import math
from typing import ClassVar

import scipy
from scipy.special import beta

from comparisons.model import Result
from comparisons.models.closed_form import EPS, FACTOR_ROUNDING, ClosedForm
from comparisons.models.graded_punch import GradedPunch
from comparisons.models.jkr import JKR
from comparisons.models.semi_rigid import SemiRigid, attraction_coefficient
from comparisons.problem import Problem


class JumpAsymptotes(ClosedForm):
    """The cycle between the semi-rigid branch and the JKR branch.

    Examples
    --------
    >>> round(JumpAsymptotes().evaluate(Problem.dimensionless(n=2, k=0.0, mu=5.0), "hysteresis_energy").value, 6)
    4.462498
    """

    name = "jump-asymptotes"
    citation = (
        "Zhu, Zheng, Huang & Yu, Eqs. 43-55 and Sec. 3.3; n = 2, k = 0: Ciavarella, Greenwood & Barber, J. Mech. Phys. "
        "Solids 98 (2017) 236-244; the energy of the cycle: docs/theory.md"
    )
    domain = "n > 2/3, 0 <= k <= 1; where the asymptote of the jump-in lies above that of the jump-out"
    undefined: ClassVar[str] = "its branches are those of semi-rigid and jkr, which have their own values"

    jump_in_displacement = staticmethod(SemiRigid().jump_in_displacement)
    jump_in_gap = staticmethod(SemiRigid().jump_in_gap)
    jump_out_displacement = staticmethod(JKR().jump_out_displacement)

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why not, where the asymptote of the jump-in is not above that of the jump-out."""
        if (reason := super().skip(problem, quantity)) or quantity == "jump_out_displacement":
            return reason
        if (reason := SemiRigid().skip(problem, "jump_in_gap")) or quantity != "hysteresis_energy":
            return reason
        jump_in, jump_out = self.jump_in_displacement(problem).value, self.jump_out_displacement(problem).value
        if jump_in > jump_out:
            return None
        return (
            f"at mu = {problem.mu:g} the asymptote of the jump-in, {jump_in:.4g}, is not above that of the "
            f"jump-out, {jump_out:.4g}: there is no cycle between them"
        )

    def hysteresis_energy(self, problem: Problem) -> Result:
        """Energy that the two jumps lose."""
        n, k = float(problem.n), float(problem.k)
        jump_in, jump_out = self.jump_in_displacement(problem).value, self.jump_out_displacement(problem).value
        approach, approach_scale = _far_energy(problem, jump_out)
        contact, contact_scale = _contact_energy(GradedPunch(n, k), jump_in / problem.mu)
        scale = GradedPunch(n, k).scales(problem.mu)
        unit = scale.load * scale.displacement
        # The ends are folds or roots to rounding; their errors count by the load there, which the scales contain.
        rounding = 4.0 * FACTOR_ROUNDING * (approach_scale + unit * contact_scale)
        return Result(approach - unit * contact, rounding)


def _far_energy(problem: Problem, jump_out: float) -> tuple[float, float]:
    """U_s(delta_in) - U_s(delta_out) in barred units, and the magnitude of its terms."""
    n, mu = float(problem.n), float(problem.mu)
    b, c = (1.0 - problem.k) / n, 2.0 / n
    A = attraction_coefficient(n, float(problem.k)) * mu ** (2.0 - b)
    B = 16.0 / 3.0 * n ** (c - 1.0) * float(beta(3.0 - c, c))
    fold = ((3.0 - b) * A) ** (-1.0 / (4.0 - b))

    def distance(log_q: float) -> float:
        q = math.exp(log_q)
        return 1.0 - 1.0 / q - A * q ** (3.0 - b) - jump_out

    # At q = 1/(1 - delta_out) the displacement is below delta_out; it rises up to the fold.
    low, high = -math.log(1.0 - jump_out) - 1.0, math.log(fold)
    q = math.exp(scipy.optimize.brentq(distance, low, high, xtol=4.0 * EPS, rtol=4.0 * EPS))
    energy, scale = _sum([(1.0, 2.0 - c), (-(3.0 - b) * A, 6.0 - b - c)], q, fold)
    return -B * energy, B * scale


def _contact_energy(punch: GradedPunch, jump_in: float) -> tuple[float, float]:
    """U_J(delta_in) - U_J(delta_out) in tilde units, and the magnitude of its terms."""
    n, k, s = punch.n, punch.k, punch.s
    D, K = punch.flattening, punch.adhesion
    pull = punch.stiffness * K / (1.0 + k)
    fold = (s * K / (n * D)) ** (1.0 / (n - s)) if s > 0.0 else 0.0

    def distance(a: float) -> float:
        return D * a**n - K * a**s - jump_in

    upper = 2.0 * max(fold, 1.0)
    while distance(upper) < 0.0:
        upper *= 2.0
    a = float(scipy.optimize.brentq(distance, fold, upper, xtol=4.0 * EPS, rtol=4.0 * EPS))
    heavy, light = n + k + 1.0, s + k + 1.0
    hertz = [(punch.hertz_load * n * D, heavy + n), (-punch.hertz_load * s * K, heavy + s)]
    return _sum([*hertz, (-pull * n * D, light + n), (pull * s * K, light + s)], fold, a)


def _sum(terms: list[tuple[float, float]], low: float, high: float) -> tuple[float, float]:
    """Integral from low to high of the sum of factor x^(power - 1), and the sum of the magnitudes."""
    integrals = [factor * _power_integral(low, high, power) for factor, power in terms]
    return sum(integrals), sum(map(abs, integrals))


def _power_integral(low: float, high: float, power: float) -> float:
    """Integral of x^(power - 1) from low to high, its logarithm for power = 0."""
    if low == 0.0:
        return high**power / power
    ratio = math.log(high / low)
    return low**power * (math.expm1(power * ratio) / power if power != 0.0 else ratio)
