"""Problems that several test files need, and the solutions of one with both jumps."""

from functools import cache

from fem_reference import LennardJones, PowerLaw, PowerPunch, Problem, Solution, solve_together
from fem_reference.quantities import TABLE
from fem_reference.solids import Solid
from fem_reference.verification.reference_solutions import surface_constant


def sphere_on(solid: Solid) -> Problem:
    """Return the problem of a sphere with R = w = z0 = 1."""
    return Problem(solid, PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0))


def problem_with(k: float, mu: float, n: float = 2.0, nu: float = 0.3) -> Problem:
    """Return the problem of a Tabor number with Q = c0 = z0 = w = 1 (Eq. 29 of the paper)."""
    E_star = surface_constant(k, nu) / (1 - k) / mu ** ((2 * n + k - 1) / n)
    return Problem(PowerLaw(E_star * (1 - nu**2), 1.0, k, nu), PowerPunch(n, 1.0), LennardJones(1.0, 1.0))


PROBLEM = problem_with(0.3, 1.2)


@cache
def solved() -> dict[str, Solution]:
    """Return every quantity of `PROBLEM`."""
    return solve_together(PROBLEM, ("hysteresis_energy", *TABLE), "quick")
