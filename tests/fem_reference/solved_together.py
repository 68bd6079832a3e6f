"""Solutions that several test files need: one problem with both jumps, and a pull-off on one mesh alone."""

from functools import cache

from fem_reference import LennardJones, PowerLaw, PowerPunch, Problem, Solution, solve_together
from fem_reference._contact.mesh_choice import chosen
from fem_reference._contact.newton import State
from fem_reference.quantities import TABLE
from fem_reference.solids import Solid
from fem_reference.verification.reference_solutions import surface_constant

#: Error of a pull-off on the coarsest mesh alone, relative: measured worst 9.1e-6 (the displacement of a homogeneous
#: solid with Poisson's ratio of layers), and 3e-6 of a force.
COARSEST = 2e-5


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


def pull_off_on_the_coarsest_mesh(problem: Problem) -> State:
    """Return the state at pull-off on the coarsest mesh of the quick choice: no bound, in a fifth of the time."""
    choice, spec, size = chosen(problem, ("pull_off",), "quick")
    return choice.traced(spec, size).at("pull_off").state
