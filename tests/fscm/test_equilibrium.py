"""The exact tangent, sensitivities and controls of the discrete equilibrium."""

import itertools
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from fscm import Coating, LennardJones, Mie, NotConverged, PowerPunch, Problem, solve
from fscm._path.arc_length import parameter_control, parameter_of
from fscm._path.continuation import equilibrium_path
from fscm._surface import adaptivity
from fscm._surface.linearisation import rates_by
from fscm._surface.newton import _least_clearance, newton
from fscm._surface.state import Control, State
from tests.marks import heavy

# The deformation is the unknown under the last punch.
PROBLEMS = [Problem(2, 0.4, 1.0), Problem(1, 0, 0.3), Problem(12, 0.7, 1.5)]


def _state(problem: Problem, in_contact: bool, end_height: float = 1e6) -> State:
    for point in equilibrium_path(problem, 8, 1e-4, end_height=end_height):
        state = point.state
        if state.anchor.in_contact == in_contact and (state.central_gap < 1.0):
            return state
    raise AssertionError


@pytest.fixture(params=itertools.product(PROBLEMS, (False, True)), scope="module", ids=str)
def state(request: pytest.FixtureRequest) -> State:
    """The mesh ends where the tail counts."""
    problem, touching = request.param
    return _state(problem, touching, end_height=3.0)


def test_rates_are_the_derivatives_of_solved_states(state: State) -> None:
    """Central differences of fully solved neighbours, in the continuation parameter."""
    h = 1e-4
    rates = rates_by(state, state.anchor.parameter)
    x = parameter_of(state)
    plus, minus = (newton(state, parameter_control(state, x + s * h)) for s in (1, -1))
    for name in ("displacement", "load", "central_gap"):
        difference = (getattr(plus, name) - getattr(minus, name)) / (2 * h)
        assert getattr(rates, name) == pytest.approx(difference, rel=2e-5, abs=2e-6)
    change = plus.unknowns - minus.unknowns
    np.testing.assert_allclose(rates.unknowns, change / (2 * h), rtol=1e-4, atol=1e-4)


def test_newton_converges_quadratically(state: State, monkeypatch: pytest.MonkeyPatch) -> None:
    """With new factors in every iteration."""
    monkeypatch.setattr("fscm._surface.newton._CHORD", 0.0)
    state.disc.factor = None
    moved = replace(state, unknowns=state.unknowns * (1 + 1e-3), displacement=state.displacement + 1e-3)
    solved = newton(moved, parameter_control(state, parameter_of(state)))
    assert solved.iterations <= 5
    assert solved.load == pytest.approx(state.load, rel=1e-9)


def test_controls_agree(state: State) -> None:
    """The same state is found again under central-gap, displacement and load control."""
    guess = replace(
        state, unknowns=state.unknowns * (1 + 1e-4), scale=state.scale * (1 + 1e-4 * state.anchor.in_contact)
    )
    for control, value in (("gap", state.central_gap), ("displacement", state.displacement), ("load", state.load)):
        solved = newton(guess, Control(value, **{control: 1.0}))
        assert solved.load == pytest.approx(state.load, rel=1e-8)
        assert solved.displacement == pytest.approx(state.displacement, rel=1e-8)


@pytest.mark.parametrize(
    "control",
    [Control(-1.2, gap=1.0), Control(-30.0, load=1.0)],
    ids=["below the singular gap", "beyond pull-off"],
)
def test_no_number_where_there_is_no_equilibrium(control: Control) -> None:
    with pytest.raises(NotConverged):
        newton(_state(Problem(2, 0.4, 3.0), True), control)


@pytest.mark.parametrize(("n", "k", "mu"), [(300.0, 0.2, 2.0), *heavy((8.445, 0.824, 18.4))])
def test_a_nucleus_many_decades_smaller_than_its_mesh_does_not_overflow(n: float, k: float, mu: float) -> None:
    """Its mesh is made with the load of the known state; at the scale of the nucleus that mesh ends at no height."""
    solution = solve(Problem(n, k, mu), "jump_in_displacement")
    assert 0.0 < solution.u_num < 1e-8 * abs(solution.value)


@pytest.mark.parametrize("problem", [Problem(2, 0.4, 1.0), Problem(30, 0.3, 1.0)])
def test_factors_of_a_state_nearby_give_the_same_state_and_tangent(problem: Problem) -> None:
    start = _state(problem, True)
    start = newton(start, parameter_control(start, parameter_of(start)))
    control = parameter_control(start, parameter_of(start) + 1e-3)
    assert start.disc.factor is not None
    by_old_factors = newton(start, control)
    rates = rates_by(by_old_factors, "log_scale")
    start.disc.factor = None
    fresh = newton(replace(start), control)
    fresh.disc.factor = None
    exact = rates_by(fresh, "log_scale")
    assert np.max(np.abs(by_old_factors.gap - fresh.gap) / (1.0 + np.abs(fresh.gap))) < 1e-12
    # Measured worst 2e-13 (n = 1).
    assert rates.load == pytest.approx(exact.load, rel=1e-10, abs=1e-11)
    assert rates.displacement == pytest.approx(exact.displacement, rel=1e-10, abs=1e-11)


@pytest.mark.heavy
def test_at_a_large_tabor_number_newton_ends_at_rounding() -> None:
    """Heights are 5e5 times the range of the forces, so that the last step is above the tolerance: the JKR limit."""
    solution = solve(Problem(2, 0, 5e5), "pull_off_force")
    assert solution.parts["rounding"] < solution.u_num < 1e-7
    assert abs(solution.value - 1.5) <= solution.u_num


def test_iterates_stay_where_the_repulsion_is_strong_and_go_as_far() -> None:
    """A repulsion that hardly exceeds the attraction has not begun where the 9-3 law is 7e5 times its strength."""
    assert _least_clearance(LennardJones()) == 0.25
    law = Mie(m=2.352, n=1.2016)
    clearance = _least_clearance(law)
    strength = -float(law.traction(np.array(law.peak_gap)))
    assert float(law.traction(np.array(0.25 - 1.0))) < 100.0 * strength
    assert float(law.traction(np.array(clearance - 1.0))) > 1e5 * strength


@pytest.mark.heavy
def test_a_law_with_a_soft_repulsion_has_a_zero_load() -> None:
    """Refused because Newton's method was driven into the singular gap."""
    coating = Coating(
        73780.54203558447, 1154.3143529930994, 89.18567516488058, 0.0, 0.3008163741869798, 0.45922860411101324
    )
    problem = Problem(coating, PowerPunch(n=2.0, Q=29779.364927597602), Mie(m=2.3519028939091093, n=1.2015510827386442))
    assert solve(problem, "zero_load_displacement").value == pytest.approx(1.0039246136470368, rel=1e-9)


def test_the_tip_of_a_cone_is_resolved_in_three_rounds(monkeypatch: pytest.MonkeyPatch) -> None:
    """By halves, one in each round, it would take six; each has another response and other steps of Newton's."""
    state = _state(Problem(1, 0.6, 2.0), in_contact=True, end_height=1e3)
    control, solved = parameter_control(state, parameter_of(state)), []

    def counted(*arguments: Any) -> State:
        solved.append(newton(*arguments))
        return solved[-1]

    monkeypatch.setattr(adaptivity, "newton", counted)
    innermost = state.disc.mesh.lengths[0]
    found = adaptivity.adapted(state, control, 1e-7)
    assert np.max(adaptivity.indicator(found)) <= 1e-7
    assert found.disc.mesh.lengths[0] <= 0.5**6 * innermost
    assert len(solved) <= 3
