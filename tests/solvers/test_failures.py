"""What both references say of a result, of an argument that is none, and of a failure, with its remedy."""

import ast
import operator
import pickle
from fractions import Fraction
from math import isclose, radians, tan
from pathlib import Path

import numpy as np
import pandas as pd
import pint
import pytest
from matplotlib.figure import Figure
from uncertainties import ufloat

import comparisons
import fem_reference
import fscm
from fscm.errors import RingsForm
from fscm.solution import Parts
from tests.fem_reference.solved_together import sphere_on
from tests.refusals import refused

ureg = pint.UnitRegistry()
both = pytest.mark.parametrize("package", [fscm, fem_reference], ids=lambda package: package.__name__)


def calls(package):
    """Names of modules and the calls in them that make a failure; finite strain has no names of failures."""
    return [
        (path.name, node)
        for path in sorted(Path(package.__file__).parent.rglob("*.py"))
        if path.parent.name != "_large_strain"
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") in ("NotConverged", "RingsForm")
    ]


@both
def test_whatever_does_not_converge_names_its_failure(package):
    named = {
        argument.attr
        for _, call in calls(package)
        for argument in call.args
        if isinstance(argument, ast.Attribute) and getattr(argument.value, "id", "") == "Failure"
    }
    assert [name for name, call in calls(package) if len(call.args) < 2] == []
    assert named == {failure.name for failure in package.Failure}


@pytest.mark.parametrize(
    ("package", "problem"),
    [
        (fscm, fscm.Problem(n=2, k=0.999, mu=1)),
        (fem_reference, sphere_on(fem_reference.Coating(1e-12, 1.0, 1.0, 0, 0.3))),
    ],
)
def test_a_failure_ends_the_message_with_its_remedy(package, problem):
    with pytest.raises(package.NotConverged) as refused:
        package.solve(problem, "pull_off_force", "quick")
    assert refused.value.failure is package.Failure.MESH
    assert str(refused.value) == f"{refused.value.reason}; {package.Failure.MESH.value}"


@pytest.mark.parametrize("kind", [fscm.NotConverged, RingsForm, fem_reference.NotConverged])
def test_a_failure_passes_between_processes(kind):
    failure = fem_reference.Failure.MESH if kind is fem_reference.NotConverged else fscm.Failure.RINGS
    error = pickle.loads(pickle.dumps(kind("no edge", failure)))
    assert (type(error), error.reason, error.failure) == (kind, "no edge", failure)
    assert str(kind("only a reason")) == "only a reason"


FSCM = fscm.Problem(n=2, k=0.4, mu=1)
BEAD = comparisons.Problem.of(
    solid={"kind": "homogeneous", "E": "1.5 MPa", "nu": 0.49},
    punch={"kind": "sphere", "R": "5 um"},
    law={"kind": "lennard-jones-9-3", "work_of_adhesion": "50 mJ/m^2", "z0": "3 nm"},
)
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


def solution_of(solver, value, u_num, unit=""):
    """A solution of a solver with a value and a bound."""
    if solver is fscm:
        return fscm.Solution(value, Parts(mesh=u_num), 9, 3, 0.0, 0.1, unit)
    return fem_reference.Solution(value, u_num, 9, 3, 0.0, 0.1, (4, 5, 6), (value,) * 3, unit=unit)


@pytest.mark.parametrize("solver", [fscm, fem_reference], ids=["fscm", "fem"])
def test_a_solution_is_formatted_and_shown_with_its_unit(solver):
    solution = solution_of(solver, 1.78848171, 2e-8, "z0")
    assert f"{solution:.3f}" == "1.788"
    assert f"{solution}" == str(solution)
    assert repr(solution) == "Solution(1.78848171 +- 2e-08 z0)"
    for operation in (lambda a: a + "x", lambda a: a * None, lambda a: a < "x"):
        with pytest.raises(TypeError):
            operation(solution)


#: Operations and values of two operands; the second is not zero within its bound.
OPERATIONS = [operator.add, operator.sub, operator.mul, operator.truediv]


@pytest.mark.parametrize("solver", [fscm, fem_reference], ids=["fscm", "fem"])
@pytest.mark.parametrize("operation", OPERATIONS, ids=lambda operation: operation.__name__)
@pytest.mark.parametrize(
    ("first", "second"), [((1.5, 0.1), (2.0, 0.3)), ((-3.0, 0.5), (0.7, 0.2)), ((0.0, 0.1), (-1.0, 0.0))]
)
def test_the_bound_of_a_result_holds_and_is_reached(solver, operation, first, second):
    """At every combination of the ends of both operands, by exact fractions."""
    result = operation(solution_of(solver, *first), solution_of(solver, *second))
    assert result.value == operation(first[0], second[0])
    (a, ua), (b, ub) = (map(Fraction, operand) for operand in (first, second))
    ends = [operation(a + s * ua, b + t * ub) for s in (-1, 1) for t in (-1, 1)]
    worst = max(abs(end - Fraction(result.value)) for end in ends)
    assert worst <= Fraction(result.u_num) <= worst * Fraction(101, 100) + Fraction(1e-15)
    # A plain number is exact, on either side.
    for a, b in ((solution_of(solver, *first), second[0]), (first[0], solution_of(solver, *second))):
        assert operation(a, b).value == operation(float(a), float(b))
        assert operation(a, b).u_num <= result.u_num


def test_solutions_of_both_solvers_combine_and_compare():
    a, b = solution_of(fscm, 2.0, 0.01), solution_of(fem_reference, 1.9, 0.02)
    assert (a - b).u_num == pytest.approx(0.03)
    assert (b / a).value == 0.95
    assert (a > b, b <= a, a < 1.0, a <= 2.0, max(a, b) is a) == (True, True, False, True, True)
    assert (float(-a), float(abs(-a)), (-a).u_num) == (-2.0, 2.0, 0.01)
    with pytest.raises(ZeroDivisionError):
        1.0 / solution_of(fscm, 0.01, 0.02)


def test_a_solution_states_its_unit():
    physical = FSCM.in_units(c0=1e-6, nu=0.3, Q=1e-6, work_of_adhesion=0.05, z0=3e-10)
    for problem, units in ((FSCM, ("pi Q^(2/n) dgamma z0^(2/n-1)", "z0")), (physical, ("N in SI", "m in SI"))):
        solutions = fscm.solve_together(problem, ["pull_off_force", "pull_off_displacement"], "quick")
        assert tuple(solution.unit for solution in solutions.values()) == units
    assert fem_reference.solve(FEM, "pull_off_force", "quick").unit == "N in SI"


@pytest.mark.parametrize("solver", [fscm, fem_reference], ids=["fscm", "fem"])
def test_spheres_and_cones_are_power_laws(solver):
    assert solver.Sphere(3.0) == solver.PowerPunch(2.0, 3.0)
    assert pytest.approx(2.0) == solver.Sphere(3.0, R_solid=6.0).Q
    assert solver.Cone(radians(70.0)).height(np.array(1.0)) == pytest.approx(1.0 / tan(radians(70.0)))
    refused("radius R", solver.Sphere, -1.0)
    refused("R_solid", solver.Sphere, 1.0, 0.0)
    for angle in (0.0, 70.0, None):
        refused("half_angle", solver.Cone, angle)


@pytest.mark.parametrize("solver", [fscm, fem_reference], ids=["fscm", "fem"])
@pytest.mark.parametrize(
    "value", ["2 um", ureg.Quantity(2.0, "um"), ufloat(2e-6, 1e-7)], ids=["text", "pint", "ufloat"]
)
def test_a_value_with_a_unit_is_led_to_where_it_is_taken(solver, value):
    refused("comparisons.Problem.of", solver.Sphere, value)


@pytest.mark.parametrize(("solver", "problem"), [(fscm, FSCM), (fem_reference, FEM)], ids=["fscm", "fem"])
def test_a_wrong_argument_is_one_sentence(solver, problem):
    refused("is one name", solver.solve_together, problem, "pull_off_force")
    refused("a builtins.tuple is no Problem", solver.solve, (2, 0.4, 1), "pull_off_force")


@pytest.mark.parametrize("solver", [fscm, fem_reference], ids=["fscm", "fem"])
@pytest.mark.parametrize(
    ("name", "quantity"), [("solve", ["pull_off_force"]), ("solve_together", [["pull_off_force"]]), ("trace", [])]
)
def test_the_problem_of_another_package_is_led_to_where_it_is_taken(solver, name, quantity):
    """Without the whole of it, which may have the rows of a table."""
    words = f"^a comparisons.Problem is no Problem of {solver.__name__}: give it to comparisons.evaluate"
    for problem in (BEAD, comparisons.Problem.dimensionless(2, 0.4, 1)):
        refused(words, getattr(solver, name), problem, *quantity)
    assert isinstance(BEAD.build(solver), solver.Problem)


def test_the_problem_of_three_numbers_is_posed_for_the_fscm():
    assert comparisons.Problem.dimensionless(2, 0.4, 1).posed == FSCM


@pytest.mark.parametrize(("solver", "problem"), [(fscm, FSCM), (fem_reference, FEM)], ids=["fscm", "fem"])
def test_paths_and_surfaces_are_tables_and_pictures(solver, problem):
    path, surface = solver.trace(problem, "quick"), solver.profile(problem, "pull_off", "quick")
    frame = path.to_frame()
    assert {"displacement", "load", "central_gap", "edge_radius"} <= {*frame}
    assert len(frame) == len(path.load)
    axes = Figure().add_subplot()
    (line,) = path.plot(axes).lines
    assert line.get_ydata().min() == path.load.min()
    units = ("z0", "pi Q^(2/n) dgamma z0^(2/n-1)") if solver is fscm else ("m in SI", "N in SI")
    assert (axes.get_xlabel(), axes.get_ylabel()) == (f"displacement [{units[0]}]", f"load [{units[1]}]")
    assert len(repr(path)) < 120
    assert len(repr(surface)) < 120
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
