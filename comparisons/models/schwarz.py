"""Schwarz's model of the transition (2003): JKR with a part of the work of adhesion, DMT with the rest.

The part w_1 = x dgamma acts at the contact edge (JKR), the rest w_2 as a load 2 pi R w_2 (DMT).  In tilde variables

    delta = a^2 - sqrt(2 pi x a),    P = (4 / (3 pi)) a^3 - sqrt(8 x a^3 / pi) - 2 (1 - x),

so that -P_c = 2 - x/2.  The contact radius then has the form of Carpick, Ogletree and Salmeron in the load, with
alpha^2 = 3 x / (4 - x), whence -P_c = 6 / (3 + alpha^2) (Eq. 34).  Schwarz leaves x open; alpha is here that of
Carpick, Ogletree and Salmeron at Maugis's lambda.
"""

from __future__ import annotations

import math

import numpy as np

from comparisons.model import Curve, Result
from comparisons.models.closed_form import EPS, FACTOR_ROUNDING, POINTS
from comparisons.models.graded_punch import GradedPunch
from comparisons.models.homogeneous_sphere import HomogeneousSphere, transition_parameter
from comparisons.models.jkr import JKR
from comparisons.problem import Problem

__all__ = ["Schwarz", "short_range_share"]

MODELS = {"schwarz": "Schwarz"}


def short_range_share(alpha: float) -> float:
    """Return x = w_1 / dgamma, the part of the work of adhesion that acts at the contact edge.

    Examples
    --------
    >>> short_range_share(0.0), short_range_share(1.0)
    (0.0, 1.0)
    """
    return 4.0 * alpha**2 / (3.0 + alpha**2)


class Schwarz(HomogeneousSphere):
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

    def pull_off_displacement(self, problem: Problem) -> Result:
        """Delta where P is smallest: that of JKR with the part w_1."""
        return _of_part(problem, JKR().pull_off_displacement(problem))

    def jump_out_displacement(self, problem: Problem) -> Result:
        """Smallest delta on the curve: that of JKR with the part w_1."""
        return _of_part(problem, JKR().jump_out_displacement(problem))

    def zero_load_displacement(self, problem: Problem) -> Result:
        """Delta in contact where P = 0."""
        mu = float(problem.mu)
        punch, x = GradedPunch.of(problem), short_range_share(transition_parameter(mu))
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
        return Curve(
            displacement=scale.displacement * (a**2 - punch.adhesion * np.sqrt(x * a)),
            load=scale.load * load,
            columns={"contact_radius": scale.radius * a},
        )


def _of_part(problem: Problem, of_all: Result) -> Result:
    """Return a displacement of JKR with the part w_1: displacements grow with the work of adhesion as w^(2/3)."""
    factor = short_range_share(transition_parameter(float(problem.mu))) ** (2.0 / 3.0)
    value = factor * of_all.value
    return Result(value, factor * of_all.u_num + FACTOR_ROUNDING * abs(value) + EPS * abs(value))
