"""The Stieltjes scheme: its equations, its order, its uncertainty, its exceptions."""

import math

import numpy as np
import pytest

from fscm._surface.kernel import Psi
from fscm.errors import NoSuchEvent, NotConverged
from fscm.problem import Problem
from fscm.solver import solve_together
from fscm.stieltjes import STIELTJES_QUANTITIES, StieltjesScheme, find_event, stieltjes_solution
from tests.marks import heavy
from tests.refusals import refused

COARSE = {"gap_step": 0.25}


@pytest.mark.parametrize(("n", "k", "mu"), [(2.0, 0.4, 1.0), (1.0, 0.2, 0.5), (5.0, 0.6, 0.3)])
def test_a_solution_satisfies_eqs_34_38_and_39_literally(n, k, mu):
    problem = Problem(n, k, mu)
    N, H0 = 12, 1.0
    state = StieltjesScheme(problem, N).solve(H0)
    r = np.linspace(0.0, (50 * n) ** (1 / n), N + 1)
    H = np.concatenate([[H0], state.gap])
    p = problem.law.traction(0.5 * (H[1:] + H[:-1]))
    M = 2 * mu ** ((2 * n + k - 1) / n)
    for i in range(1, N + 1):
        psi = np.append(0.0, Psi(k, r[1:] / r[i], r[1:] / r[i] - 1.0))
        deformation = M * r[i] ** (1 - k) * float(p @ np.diff(psi))
        # The last Newton step is quadratic from 1e-6; measured worst 1e-13.
        assert H[i] - H0 - r[i] ** n / n - deformation == pytest.approx(0.0, abs=1e-10)
    assert state.displacement == pytest.approx(-H0 + M * float(p @ np.diff(r ** (1 - k))), rel=1e-9)
    assert state.load == pytest.approx(float(p @ np.diff(r**2)), rel=1e-9)
    assert np.all(np.abs(state.change) < 1e-6 * np.abs(H).max())


@pytest.mark.parametrize(
    ("problem", "quantity"),
    [
        (Problem(2, 0.0, 0.5), "pull_off_force"),
        (Problem(2, 0.4, 0.5), "pull_off_displacement"),
        (Problem(5, 0.2, 1.0), "jump_in_displacement"),
        (Problem(5, 0.2, 1.0), "jump_out_displacement"),
    ],
)
def test_the_order_is_two_where_the_edge_is_resolved(problem, quantity):
    row = STIELTJES_QUANTITIES[quantity]
    schemes = [StieltjesScheme(problem, segments, **COARSE) for segments in (75, 150, 300)]
    a, b, c = (row.value(find_event(scheme, row.event)) for scheme in schemes)
    # Smooth tractions at midpoints: second order for every k.  Measured 1.93 to 2.04.
    assert 1.85 < math.log2(abs((b - a) / (c - b))) < 2.15


@pytest.fixture(params=[Problem(5, 0.2, 1.0), *heavy(Problem(2, 0.4, 1.0), Problem(2, 0.0, 1.0))], scope="module")
def solved(request):
    """A problem and its solutions."""
    return request.param, solve_together(request.param, STIELTJES_QUANTITIES)


@pytest.mark.parametrize("quantity", list(STIELTJES_QUANTITIES))
def test_the_uncertainty_covers_the_error(solved, quantity):
    problem, solutions = solved
    solution = stieltjes_solution(problem, quantity, 200, **COARSE)
    error = abs(solution.value - solutions[quantity].value)
    assert error <= solution.u_num < 0.1
    assert solution.size == 200


def test_events_that_are_not_on_the_path():
    calm = StieltjesScheme(Problem(2, 0.4, 0.5), 60, **COARSE)
    for name in ("jump_in", "jump_out"):
        refused("jump", find_event, calm, name, error=NoSuchEvent)
    # The pull-off of a cone lies beyond the range of the paper.
    with pytest.raises(NoSuchEvent, match="pull off"):
        find_event(StieltjesScheme(Problem(1, 0.4, 0.1), 100, last_gap=-0.1, **COARSE), "pull_off")


def test_an_edge_narrower_than_the_segments_is_a_failure_not_a_number():
    scheme = StieltjesScheme(Problem(2, 0.4, 3.0), 100, **COARSE)
    refused(r"folds|Newton", find_event, scheme, "pull_off", error=NotConverged)
    refused("Newton's method failed", StieltjesScheme(Problem(2, 0.4, 3.0), 100).solve, -0.05, error=NotConverged)


def test_bad_input():
    problem = Problem(2, 0.4, 0.5)
    for name, value in (
        *(("segments", bad) for bad in (9, 100.0, True)),
        *(("farthest_height", 0.0), ("gap_step", 0.0), ("gap_step", math.nan), ("last_gap", -1.0)),
        *(("last_load", -0.1), ("first_gap", -0.5), ("first_gap", math.inf)),
    ):
        refused(name, StieltjesScheme, problem, **{name: value})
    refused("gradient exponent", StieltjesScheme, Problem(2, 1, 1.0))
    refused("unknown event", find_event, StieltjesScheme(problem, 20), "nonsense")
    refused("unknown quantity", stieltjes_solution, problem, "weight", 20)
