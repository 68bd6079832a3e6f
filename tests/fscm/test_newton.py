"""Tests of Newton's method with factors that were made at another state."""

from dataclasses import replace

import numpy as np
import pytest

from fscm import Problem, solve
from fscm._arc_length import parameter_control, parameter_of
from fscm._continuation import equilibrium_path
from fscm._equilibrium import Control, Linearisation, State
from fscm._newton import newton


def state_in_contact(problem: Problem) -> State:
    for point in equilibrium_path(problem, 8, 1e-4):
        if point.state.follows_edge and point.state.load > -1.0:
            return newton(point.state, parameter_control(point.state, parameter_of(point.state)))
    raise AssertionError("the path has no end")


@pytest.mark.parametrize("problem", [Problem(2, 0.4, 1.0), Problem(1, 0.2, 0.5), Problem(30, 0.3, 1.0)])
def test_factors_of_a_state_nearby_give_the_same_state_and_tangent(problem: Problem) -> None:
    state = state_in_contact(problem)
    value = parameter_of(state) + 1e-3
    control = parameter_control(state, value)
    assert state.disc.factor is not None
    kept = newton(state, control)
    rates = kept.rates("log_scale")
    state.disc.factor = None
    fresh = newton(replace(state), control)
    fresh.disc.factor = None
    exact = fresh.rates("log_scale")
    assert np.max(np.abs(kept.gap - fresh.gap) / (1.0 + np.abs(fresh.gap))) < 1e-12
    # Measured worst 2e-13 (n = 1).
    assert rates.load == pytest.approx(exact.load, rel=1e-10, abs=1e-11)
    assert rates.displacement == pytest.approx(exact.displacement, rel=1e-10, abs=1e-11)


@pytest.mark.parametrize("control", ["gap", "load", "displacement", "log_scale"])
def test_factors_of_one_control_serve_another(control: str) -> None:
    state = state_in_contact(Problem(2, 0.4, 1.0))
    system = Linearisation(state)
    row = system.row(Control(0.0, **{control: 1.0}))
    right = np.linspace(-1.0, 1.0, len(row))
    solved = system.factor(Control(0.0, load=1.0, displacement=0.5)).solve(right, row)
    # Far out the terms of a row are larger than its sum by many decades.
    rounding = 1e-13 * (np.abs(system.bordered()[:-1]) @ np.abs(solved))
    assert np.all(np.abs(system.times(solved) - right[:-1]) <= rounding)
    assert row @ solved == pytest.approx(right[-1], rel=1e-9)


def test_at_a_large_tabor_number_newton_ends_at_rounding() -> None:
    """Heights are 5e5 times the range of the forces, so that the last step is above the tolerance: the JKR limit."""
    solution = solve(Problem(2, 0, 5e5), "pull_off_force")
    assert solution.parts["rounding"] < solution.u_num < 1e-7
    assert abs(solution.value - 1.5) <= solution.u_num
