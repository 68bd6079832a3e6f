"""The formulas of Pietrement and Troyon for load and displacement in the transition (2000).

They fit the Maugis-Dugdale model by polynomials and powers of the transition parameter alpha.  In Maugis's units (load
pi R dgamma, radius (pi dgamma R^2 / K)^(1/3), displacement radius^2 / R, K = 4 E* / 3)

    delta = a_0^2 [ y^(4/3) - S y^(2 beta / 3) ],    y = (alpha + sqrt(1 + P / F)) / (1 + alpha),

with F the pull-off force, a_0 the contact radius without load, and S and beta functions of alpha.  alpha is that of
Carpick, Ogletree and Salmeron at Maugis's lambda.  For alpha = 1 the coefficients give JKR to their digits: F = 1.5,
a_0 = 6^(1/3), S = 2/3 and beta = 1/2.  The coefficients were checked against these limits and against the model that
they fit, over its whole range, but not against the printed page.
"""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np

from comparisons.model import Curve, NotApplicable, Result
from comparisons.models.closed_form import FACTOR_ROUNDING, IN_CONTACT, POINTS, Limits
from comparisons.models.homogeneous_sphere import HomogeneousSphere, transition_parameter
from comparisons.problem import Problem

__all__ = ["PietrementTroyon"]

MODELS = {"pietrement-troyon": "PietrementTroyon"}

# Below this alpha the fit of S turns negative: -2.160 and 2.7531 belong to powers that differ by 0.045 alone.
_SMALLEST_ALPHA = 0.01
# Maugis's unit of the displacement over (R dgamma^2 / E*^2)^(1/3), the unit of the tilde variables.
_UNIT = (9.0 * math.pi**2 / 16.0) ** (1.0 / 3.0)


class PietrementTroyon(HomogeneousSphere):
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
    narrower: ClassVar[dict[str, Limits]] = {
        quantity: {"mu": [0.0083, None]}
        for quantity in ("pull_off_displacement", "zero_load_displacement", "force_curve")
    }
    undefined: ClassVar[dict[str, str]] = IN_CONTACT | {
        "jump_out_displacement": "its equations hold above the pull-off, and the fold lies below"
    }

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
        if alpha < _SMALLEST_ALPHA:
            raise NotApplicable(
                f"the displacement of {self.name} needs alpha >= {_SMALLEST_ALPHA}, below which its fit turns "
                f"negative, but alpha = {alpha:.3g} at mu = {problem.mu:g}"
            )
        y = (alpha + root) / (1.0 + alpha)
        square, S, beta = _coefficients(alpha)
        return y ** (4.0 / 3.0), S * y ** (2.0 * beta / 3.0), float(problem.mu) * _UNIT * square


def _pull_off(alpha: float) -> float:
    """F in pi R dgamma."""
    return 0.267 * alpha**2 - 0.767 * alpha + 2.0


def _coefficients(alpha: float) -> tuple[float, float, float]:
    """Return a_0^2, S and beta."""
    radius = -0.451 * alpha**4 + 1.417 * alpha**3 - 1.365 * alpha**2 + 0.950 * alpha + 1.264
    S = -2.160 * alpha**0.019 + 2.7531 * alpha**0.064 + 0.073 * alpha**1.919
    beta = 0.516 * alpha**4 - 0.683 * alpha**3 + 0.235 * alpha**2 + 0.429 * alpha
    return radius**2, S, beta
