"""Values with their numerical uncertainty, from two meshes.

The value comes from the second mesh, of higher order and smaller tolerance.  The uncertainty is the difference of the
two with a safety factor, plus a floor for what the two meshes share (rounding, tail).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from fscm._equilibrium import State

__all__ = ["FLOOR", "SAFETY", "EventPair", "Solution", "State", "solution_of"]

# The difference of the two results estimates the error of the coarser; the factor covers accidental
# agreement.
SAFETY = 3.0
# Rounding and quadrature, which the two meshes share: measured worst 1.3e-13 of the pull-off force (n = 3.4,
# k = 0, mu = 0.04) against meshes of order 18 over 45 random problems.
FLOOR = 2e-13


@dataclass(frozen=True)
class Solution:
    """A number with its numerical uncertainty.

    Attributes
    ----------
    value, u_num : float
        Dimensionless, in the scales of `fscm.problem`.
    size : int
        Unknowns of the finest mesh.
    iterations : int
        Newton iterations on the two meshes.
    residual : float
        Largest residual relative to 1 + |H| before the last Newton step.
    seconds : float

    Examples
    --------
    >>> from fscm import Problem, solve
    >>> solution = solve(Problem(n=2, k=0, mu=1.0), "pull_off_force")
    >>> solution.u_num < 1e-10, solution.residual < 1e-12
    (True, True)
    """

    value: float
    u_num: float
    size: int
    iterations: int
    residual: float
    seconds: float


@dataclass(frozen=True)
class EventPair:
    """A state on the check mesh and on the value mesh."""

    check: State
    value: State

    def difference(self, *functionals: Callable[[State], float]) -> float:
        """Largest difference between the two meshes."""
        return max(abs(f(self.value) - f(self.check)) for f in functionals)


def solution_of(value: float, difference: float, pairs: list[EventPair], shared: float = 0.0) -> Solution:
    """Solution with the uncertainty of a difference between two meshes, and of what both share."""
    tail = max(pair.value.tail_uncertainty for pair in pairs)
    return Solution(
        float(value),
        float(SAFETY * difference + FLOOR * (1.0 + abs(value)) + tail + shared),
        max(len(pair.value.gap) for pair in pairs) + 2,
        sum(pair.check.iterations + pair.value.iterations for pair in pairs),
        max(pair.value.residual for pair in pairs),
        0.0,
    )
