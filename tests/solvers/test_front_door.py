"""What both solvers say of a result, and of an argument that is none."""

from fractions import Fraction
from math import isclose

import numpy as np
import pandas as pd
import pytest
from matplotlib.figure import Figure

import comparisons
import fem_reference
import fscm
from tests.refusals import refused

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
    refused("is one name", solver.solve_together, problem, "pull_off_force")
    refused("is no Problem", solver.solve, (2, 0.4, 1), "pull_off_force")


@pytest.mark.parametrize(("solver", "problem"), [(fscm, FSCM), (fem_reference, FEM)], ids=["fscm", "fem"])
def test_paths_and_surfaces_are_tables_and_pictures(solver, problem):
    path, surface = solver.trace(problem, "quick"), solver.profile(problem, "pull_off", "quick")
    frame = path.to_frame()
    assert {"displacement", "load", "central_gap", "edge_radius"} <= {*frame}
    assert len(frame) == len(path.load)
    axes = Figure().add_subplot()
    (line,) = path.plot(axes).lines
    assert line.get_ydata().min() == path.load.min()
    assert surface.to_frame()["gap"].equals(pd.Series(surface.gap, name="gap"))
    (line,) = surface.plot(Figure().add_subplot()).lines
    assert line.get_ydata().min() == surface.pressure.min()
    assert 1e-3 <= abs(line.get_ydata()[-1]) / np.abs(surface.pressure).max() < 2e-2


def test_an_uncertain_number_propagates_the_bound():
    solution = fscm.solve(FSCM, "pull_off_force", "quick")
    doubled = 2.0 * solution.as_ufloat()
    assert (doubled.nominal_value, doubled.std_dev) == (2.0 * solution.value, 2.0 * solution.u_num)


@pytest.mark.parametrize("number", ["50", np.ma.masked, np.array([1.0, 2.0]), None, True, 1j], ids=repr)
def test_what_is_no_real_number_is_named(number):
    refused("modulus E", fem_reference.Homogeneous, number, 0.3)
    refused("Tabor number", fscm.Problem, 2, 0.4, number)


def test_a_fraction_is_a_real_number():
    assert fscm.Problem(Fraction(2), Fraction(2, 5), 1) == FSCM
    assert fem_reference.Homogeneous(Fraction(50), 0.3) == FEM.solid


def test_a_row_is_a_number_with_its_unit():
    problem = comparisons.Problem.dimensionless(n=2, k=0.4, mu=1)
    assert float(comparisons.evaluate("jkr", "pull_off_force", problem)) == 1.7
    assert "1.7" in str(comparisons.evaluate("jkr", "pull_off_force", problem))
    refused("jkr has no jump_in_gap", float, comparisons.evaluate("jkr", "jump_in_gap", problem))
    refused("is no Problem", comparisons.evaluate, "jkr", "pull_off_force", (2, 0.4, 1))
