"""The JKR model of a power-law punch on a graded half-space (JKR-n-k, Eqs. 50-57).

In the tilde variables of `graded_punch`, with D = flattening, K = adhesion, s = (1 - k)/2,

    delta = D a^n - K a^s,    P = stiffness (1+k)^-1 [ n (n+k+1)^-1 D a^(n+k+1) - K a^(s+k+1) ].

Each event is one value of theta in n D a^(n-s) = theta K: theta = s at jump-out (d delta = 0, Eq. 53),
s + k + 1 at pull-off (dP = 0) and n + k + 1 at zero load; then delta = K a^s (theta / n - 1).
"""

from __future__ import annotations

import numpy as np

from comparisons.model import Curve, Result
from comparisons.models.closed_form import EPS, POINTS, SOFT, ContactBranch, monomial
from comparisons.models.graded_punch import GradedPunch
from comparisons.problem import Problem


class JKR(ContactBranch):
    """JKR-n-k: infinitely short-ranged adhesion, Griffith's balance at the contact edge.

    Examples
    --------
    >>> round(JKR().evaluate(Problem.dimensionless(n=2, k=0.0, mu=1.0), "pull_off_force").value, 14)
    1.5
    """

    name = "jkr"
    citation = "Zhu, Zheng, Huang & Yu, Eqs. 50-57; Jin, Tang, Guo & Gao, J. Mech. Phys. Solids 154 (2021) 104509"
    domain = "n > (1-k)/2, 0 <= k <= 1; exact as mu -> infinity"
    validity = SOFT

    def pull_off_force(self, problem: Problem) -> Result:
        """-min P (Eq. 57)."""
        punch = GradedPunch.of(problem)
        n, k, s = punch.n, punch.k, punch.s
        return monomial(
            (punch.stiffness * (n - s) / ((1.0 + k) * (n + k + 1.0)), 1.0),
            *_radius_power(punch, s + k + 1.0, s + k + 1.0),
            (punch.adhesion, 1.0),
            (problem.mu, 2.0 / n - 1.0),
        )

    def displacement_at(self, problem: Problem, event: str) -> Result:
        """Delta at an event; that of the jump-out is Eqs. 54-55."""
        punch = GradedPunch.of(problem)
        n, k, s = punch.n, punch.k, punch.s
        theta = {"pull_off": s + k + 1.0, "jump_out": s, "zero_load": n + k + 1.0}[event]
        magnitude = monomial(*_radius_power(punch, theta, s), (punch.adhesion, 1.0), (problem.mu, 1.0))
        factor = (theta - n) / n
        rounding = EPS * (theta + n) / n * magnitude.value
        return Result(factor * magnitude.value, abs(factor) * magnitude.u_num + rounding)

    def force_curve(self, problem: Problem) -> Curve:
        """Return Eqs. 50-51 from a = 0 to where the load is as compressive as the pull-off is tensile.

        Column ``contact_radius``.
        """
        return self.curve_to(problem, self.pull_off_force(problem).value)

    def curve_to(self, problem: Problem, load: float) -> Curve:
        """Return the same to a load, in pi Q^(2/n) dgamma z0^(2/n-1)."""
        punch = GradedPunch.of(problem)
        n, k, s = punch.n, punch.k, punch.s
        pull_off = monomial(*_radius_power(punch, s + k + 1.0, 1.0)).value
        shares = load / self.pull_off_force(problem).value
        # P(a) / P(a_c) depends on a / a_c alone: x^(n+k+1) theta_c - x^(s+k+1) (n+k+1) over its value at 1.
        parts = np.linspace(0.0, 1.0, POINTS)
        end = 1.0
        while (s + k + 1.0) * end ** (n + k + 1.0) - (n + k + 1.0) * end ** (s + k + 1.0) < (n - s) * shares:
            end *= 1.02
        a = pull_off * end * parts**2
        scale = punch.scales(problem.mu)
        displacement = punch.flattening * a**n - punch.adhesion * a**s
        hertz = punch.hertz_load * a ** (n + k + 1.0)
        return scale.curve(
            displacement, hertz - punch.stiffness * punch.adhesion / (1.0 + k) * a ** (s + k + 1.0), contact_radius=a
        )


def _radius_power(punch: GradedPunch, theta: float, power: float) -> tuple[tuple[float, float], ...]:
    """Return the factors of a^power at the event `theta`."""
    exponent = power / (punch.n - punch.s)
    return ((theta * punch.adhesion, exponent), (punch.n * punch.flattening, -exponent))
