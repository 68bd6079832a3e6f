"""Formulas for the transition from DMT to JKR of a paraboloid on a homogeneous half-space, n = 2 and k = 0.

Maugis (1992) defines lambda = sigma_0 (9 R / (2 pi dgamma E*^2))^(1/3) (Eq. 2).  With sigma_0 in dgamma / z0 and the
Tabor number mu = (R dgamma^2 / (E*^2 z0^3))^(1/3) (Eq. 1) the ratio has no other parameter:

    lambda / mu = sigma_0 (9 / (2 pi))^(1/3),    1.1570 with the strength 16 sqrt(3) / 27 of the 9-3 law.

*Carpick, Ogletree and Salmeron (1999)* fit the pull-off force of the Maugis-Dugdale model, which with this lambda is
`md-original`, between 2 (DMT) and 3/2 (JKR) by their Eq. 12a,

    -P_c = 7/4 - (1/4) (4.04 lambda^1.4 - 1) / (4.04 lambda^1.4 + 1).

Their transition parameter alpha is 0 in the DMT and 1 in the JKR limit.  Their Eq. 10, lambda = -0.924 ln(1 - 1.02
alpha), gives one from the other.  It has alpha = 1 nowhere: the largest is 1 / 1.02.

*Pietrement and Troyon (2000)* fit the same model by polynomials and powers of alpha.  In Maugis's units (load
pi R dgamma, radius (pi dgamma R^2 / K)^(1/3), displacement radius^2 / R, K = 4 E* / 3)

    delta = a_0^2 [ y^(4/3) - S y^(2 beta / 3) ],    y = (alpha + sqrt(1 + P / F)) / (1 + alpha),

with F the pull-off force, a_0 the contact radius without load, and S and beta functions of alpha.  For alpha = 1 the
coefficients give JKR to their digits: F = 1.5, a_0 = 6^(1/3), S = 2/3 and beta = 1/2.  The coefficients were checked
against these limits and against the model that they fit, over its whole range, but not against the printed page.

*Schwarz (2003)* superposes JKR and DMT.  The part w_1 = x dgamma of the work of adhesion acts at the contact edge
(JKR), the rest w_2 as a load 2 pi R w_2 (DMT).  In tilde variables

    delta = a^2 - sqrt(2 pi x a),    P = (4 / (3 pi)) a^3 - sqrt(8 x a^3 / pi) - 2 (1 - x),

so that -P_c = 2 - x/2.  The contact radius then has the form of Carpick, Ogletree and Salmeron in the load, with
alpha^2 = 3 x / (4 - x), whence -P_c = 6 / (3 + alpha^2) (Eq. 34).  Schwarz leaves x open; alpha is here that of
Carpick, Ogletree and Salmeron at Maugis's lambda.
"""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np

from comparisons.model import Curve, Result
from comparisons.models.closed_form import EPS, FACTOR_ROUNDING, POINTS, ClosedForm, ContactBranch
from comparisons.models.cohesive_stress import THEORETICAL_STRENGTH
from comparisons.models.graded_punch import GradedPunch
from comparisons.models.jkr import JKR
from comparisons.problem import Problem

#: Maugis's lambda over the Tabor number, with the theoretical strength as cohesive stress.
LAMBDA_OVER_MU = THEORETICAL_STRENGTH * (9.0 / (2.0 * math.pi)) ** (1.0 / 3.0)

#: Below this alpha the fit of S turns negative: -2.160 and 2.7531 belong to powers that differ by 0.045 alone.
_SMALLEST_ALPHA = 0.01
#: Maugis's unit of the displacement over (R dgamma^2 / E*^2)^(1/3), the unit of the tilde variables.
_UNIT = (9.0 * math.pi**2 / 16.0) ** (1.0 / 3.0)


def maugis_parameter(mu: float) -> float:
    """Return Maugis's lambda at a Tabor number, n = 2 and k = 0.

    Examples
    --------
    >>> round(maugis_parameter(1.0), 3)
    1.157
    """
    return LAMBDA_OVER_MU * mu


def transition_parameter(mu: float) -> float:
    """Return alpha at a Tabor number (Carpick, Ogletree & Salmeron, Eq. 10).

    Examples
    --------
    >>> round(transition_parameter(1.0), 4), round(transition_parameter(100.0), 4)
    (0.7001, 0.9804)
    """
    return -math.expm1(-maugis_parameter(mu) / 0.924) / 1.02


def short_range_share(alpha: float) -> float:
    """Return Schwarz's x = w_1 / dgamma, the part of the work of adhesion that acts at the contact edge.

    Examples
    --------
    >>> short_range_share(0.0), short_range_share(1.0)
    (0.0, 1.0)
    """
    return 4.0 * alpha**2 / (3.0 + alpha**2)


class _HomogeneousSphere(ClosedForm):
    """A formula for n = 2 and k = 0 alone."""

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why not, unless n = 2 and k = 0."""
        if reason := super().skip(problem, quantity):
            return reason
        for name, value, only in (("n", problem.n, 2.0), ("k", problem.k, 0.0)):
            if float(value) != only:
                return (
                    f"{self.name} is for n = 2 and k = 0, a sphere on a homogeneous solid, not for {name} = {value:g}"
                )
        return None


class CarpickOgletreeSalmeron(_HomogeneousSphere):
    """The pull-off force over Maugis's lambda by Eq. 12a.

    Examples
    --------
    >>> round(CarpickOgletreeSalmeron().evaluate(Problem.dimensionless(n=2, k=0, mu=1.0), "pull_off_force").value, 6)
    1.583961
    """

    name = "carpick-ogletree-salmeron"
    citation = "Carpick, Ogletree & Salmeron, J. Colloid Interface Sci. 211 (1999) 395-400, Eq. 12a"
    domain = "n = 2, k = 0; fit to Maugis-Dugdale with lambda = 1.157 mu"
    undefined: ClassVar[str] = "its equations relate load and contact radius, without the displacement"

    def pull_off_force(self, problem: Problem) -> Result:
        """-min P (Eq. 12a)."""
        power = 4.04 * maugis_parameter(float(problem.mu)) ** 1.4
        # 7/4 - (x - 1) / (4 (x + 1)), without a difference.
        value = 1.5 + 0.5 / (1.0 + power)
        return Result(value, FACTOR_ROUNDING * value)


class PietrementTroyon(_HomogeneousSphere):
    """Load and displacement above the pull-off.

    Examples
    --------
    >>> round(PietrementTroyon().evaluate(Problem.dimensionless(n=2, k=0, mu=1.0), "pull_off_force").value, 6)
    1.593884
    """

    name = "pietrement-troyon"
    citation = (
        "Pietrement & Troyon, J. Colloid Interface Sci. 226 (2000) 166-171; "
        "alpha: Carpick, Ogletree & Salmeron, J. Colloid Interface Sci. 211 (1999) 395-400, Eq. 10"
    )
    domain = (
        "n = 2, k = 0; displacements for alpha >= 0.01 (mu >= 0.0082); fit to Maugis-Dugdale with lambda = 1.157 mu"
    )
    undefined: ClassVar[str] = "its equations hold in contact and above the pull-off only"

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why not, where the fit of the displacement has no meaning."""
        if (reason := super().skip(problem, quantity)) or quantity == "pull_off_force":
            return reason
        alpha = transition_parameter(float(problem.mu))
        if alpha >= _SMALLEST_ALPHA:
            return None
        return (
            f"the displacement of {self.name} needs alpha >= {_SMALLEST_ALPHA}, below which its fit turns "
            f"negative, but alpha = {alpha:.3g} at mu = {problem.mu:g}"
        )

    def pull_off_force(self, problem: Problem) -> Result:
        """-min P."""
        value = _pull_off(transition_parameter(float(problem.mu)))
        return Result(value, FACTOR_ROUNDING * 2.0)

    def pull_off_displacement(self, problem: Problem) -> Result:
        """Delta where P is smallest."""
        return self._displacement(problem, 0.0)

    def zero_load_displacement(self, problem: Problem) -> Result:
        """Delta in contact where P = 0."""
        return self._displacement(problem, 1.0)

    def force_curve(self, problem: Problem) -> Curve:
        """Return the branch from the pull-off to a load as compressive as the pull-off is tensile."""
        root = math.sqrt(2.0) * np.linspace(0.0, 1.0, POINTS)
        grown, lift, unit = self._terms(problem, root)
        force = _pull_off(transition_parameter(float(problem.mu)))
        return Curve(displacement=unit * (grown - lift), load=force * (root**2 - 1.0))

    def _displacement(self, problem: Problem, root: float) -> Result:
        grown, lift, unit = self._terms(problem, root)
        # S is a difference of terms up to 3.
        return Result(float(unit * (grown - lift)), float(unit * FACTOR_ROUNDING * (grown + 6.0)))

    def _terms(self, problem: Problem, root: Any) -> tuple[Any, Any, float]:
        """Return y^(4/3), S y^(2 beta / 3) and the unit of delta at `root` = sqrt(1 + P / F)."""
        alpha = transition_parameter(float(problem.mu))
        y = (alpha + root) / (1.0 + alpha)
        square, S, beta = _coefficients(alpha)
        return y ** (4.0 / 3.0), S * y ** (2.0 * beta / 3.0), float(problem.mu) * _UNIT * square


def _pull_off(alpha: float) -> float:
    """F of Pietrement and Troyon in pi R dgamma."""
    return 0.267 * alpha**2 - 0.767 * alpha + 2.0


def _coefficients(alpha: float) -> tuple[float, float, float]:
    """Return a_0^2, S and beta of Pietrement and Troyon."""
    radius = -0.451 * alpha**4 + 1.417 * alpha**3 - 1.365 * alpha**2 + 0.950 * alpha + 1.264
    S = -2.160 * alpha**0.019 + 2.7531 * alpha**0.064 + 0.073 * alpha**1.919
    beta = 0.516 * alpha**4 - 0.683 * alpha**3 + 0.235 * alpha**2 + 0.429 * alpha
    return radius**2, S, beta


class Schwarz(_HomogeneousSphere, ContactBranch):
    """JKR and DMT superposed, with the transition parameter of Carpick, Ogletree and Salmeron.

    Examples
    --------
    >>> round(Schwarz().evaluate(Problem.dimensionless(n=2, k=0, mu=1.0), "pull_off_force").value, 6)
    1.719118
    """

    name = "schwarz"
    citation = (
        "Schwarz, J. Colloid Interface Sci. 261 (2003) 99-106, Eqs. 23-36; "
        "alpha: Carpick, Ogletree & Salmeron, J. Colloid Interface Sci. 211 (1999) 395-400, Eq. 10"
    )
    domain = "n = 2, k = 0; alpha of Carpick, Ogletree and Salmeron with lambda = 1.157 mu"

    def pull_off_force(self, problem: Problem) -> Result:
        """-min P (Eq. 34)."""
        value = 6.0 / (3.0 + transition_parameter(float(problem.mu)) ** 2)
        return Result(value, FACTOR_ROUNDING * value)

    def displacement_at(self, problem: Problem, event: str) -> Result:
        """Delta at an event; of pull-off and jump-out that of JKR with the part w_1."""
        mu = float(problem.mu)
        punch, x = GradedPunch.of(problem), short_range_share(transition_parameter(mu))
        if event != "zero_load":
            # Displacements of JKR grow with the work of adhesion as w^(2/3).
            of_all, factor = JKR().displacement_at(problem, event), x ** (2.0 / 3.0)
            value = factor * of_all.value
            return Result(value, factor * of_all.u_num + FACTOR_ROUNDING * abs(value) + EPS * abs(value))
        pull = punch.stiffness * punch.adhesion * math.sqrt(x)
        root = math.sqrt(pull**2 + 8.0 * punch.hertz_load * (1.0 - x))
        a = ((pull + root) / (2.0 * punch.hertz_load)) ** (2.0 / 3.0)
        flat, lift = a**2, punch.adhesion * math.sqrt(x * a)
        return Result(mu * (flat - lift), mu * FACTOR_ROUNDING * (flat + lift))

    def force_curve(self, problem: Problem) -> Curve:
        """Return the contact branch from a = 0 to where JKR of the whole work of adhesion ends.

        Column ``contact_radius``.
        """
        punch, x = GradedPunch.of(problem), short_range_share(transition_parameter(float(problem.mu)))
        scale = punch.scales(problem.mu)
        end = float(JKR().curve(problem).columns["contact_radius"][-1]) / scale.radius
        a = end * np.linspace(0.0, 1.0, POINTS) ** 2
        load = punch.hertz_load * a**3 - punch.stiffness * punch.adhesion * np.sqrt(x * a**3) - 2.0 * (1.0 - x)
        return scale.curve(a**2 - punch.adhesion * np.sqrt(x * a), load, contact_radius=a)
