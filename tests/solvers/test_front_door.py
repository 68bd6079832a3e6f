"""What both solvers say of a result, and of an argument that is none."""

from math import isclose

import pytest

import fem_reference
import fscm

FSCM = fscm.Problem(n=2, k=0.4, mu=1)
FEM = fem_reference.Problem(
    fem_reference.Homogeneous(50.0, 0.3), fem_reference.PowerPunch(2.0, 1.0), fem_reference.LennardJones(1.0, 1.0)
)


@pytest.mark.parametrize(("solver", "problem"), [(fscm, FSCM), (fem_reference, FEM)], ids=["fscm", "fem"])
def test_a_solution_is_a_number_and_prints_its_bound(solver, problem):
    solution = solver.solve(problem, "pull_off_force", "quick")
    value, bound = map(float, str(solution).split(" +- "))
    assert float(solution) == solution.value
    assert abs(value - solution.value) <= solution.u_num
    assert isclose(bound, solution.u_num, rel_tol=0.5)


@pytest.mark.parametrize(("solver", "problem"), [(fscm, FSCM), (fem_reference, FEM)], ids=["fscm", "fem"])
def test_a_wrong_argument_is_one_sentence(solver, problem):
    with pytest.raises(ValueError, match="is one name"):
        solver.solve_together(problem, "pull_off_force")
    with pytest.raises(ValueError, match="is no Problem"):
        solver.solve((2, 0.4, 1), "pull_off_force")
