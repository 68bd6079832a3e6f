"""The double-Hertz model of a power-law punch on a graded half-space.

The largest traction of the cohesive zone, at the contact edge, is the theoretical strength of the 9-3 law (Eq. 73).
For n = 2 this is the model of Jin, Guo and Gao, for n = 2 and k = 0 that of Greenwood and Johnson.  For other n the
cohesive traction stays the difference of the Hertz pressures of a paraboloid.  That of the Hertz pressures of r^n would
be infinite on the axis for n <= 1 - k, and largest inside the zone, away from the contact edge, for a large n.
"""

from __future__ import annotations

from comparisons.models.cohesive_model import CohesiveModel
from comparisons.problem import Problem

__all__ = ["DoubleHertz"]

MODELS = {"double-hertz-n-k": "DoubleHertz"}


class DoubleHertz(CohesiveModel):
    """Double-Hertz-n-k with the theoretical strength 16 sqrt(3) / 27 as largest traction.

    Examples
    --------
    >>> round(DoubleHertz().evaluate(Problem.dimensionless(n=2, k=0.4, mu=1.0), "pull_off_force").value, 8)
    1.75097087
    """

    name = "double-hertz-n-k"
    citation = (
        "Greenwood & Johnson, J. Phys. D 31 (1998) 3279-3290; Jin, Guo & Gao, J. Mech. Phys. Solids 61 (2013) "
        "2473-2492; other n: equations of this repository (docs/theory.md)"
    )
    domain = "n > (1-k)/2, 0 <= k <= 1; largest traction 16 sqrt(3)/27"

    def decay(self, problem: Problem) -> float:
        """Of the difference of two Hertz pressures: (1+k)/2."""
        return 0.5 * (1.0 + float(problem.k))
