"""The condensed path against Newton on every displacement, with facet forms and pyamg."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fem_reference import NotConverged, solve
from fem_reference._contact import uncondensed
from fem_reference._contact.carried import CarriedEvents
from fem_reference._contact.contact import Contact
from fem_reference._contact.event_equations import EventEquations
from fem_reference._contact.event_kinds import Anchor
from fem_reference._contact.events import PathEvents
from fem_reference._contact.full_system import FullSystem
from fem_reference._contact.path import traced
from fem_reference._contact.uncondensed import UncondensedEvents, UncondensedValue
from fem_reference._elastic.assembly import assemble_half_space
from fem_reference._elastic.compliance import compliance_for
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._linear.linear_solver import solve_cg
from fem_reference.interaction import Derjaguin
from fem_reference.laws import LennardJones
from fem_reference.problem import Problem
from fem_reference.punch import PowerPunch
from fem_reference.quantities import TABLE
from fem_reference.solid import PowerLaw
from fem_reference.states import event_state

#: Largest distance of the whole system from its condensation (measured: 4e-11).
ALGEBRA = 1e-9

#: What the first order leaves of an error of 1e-6: measured 2e-7 to 1e-4 of it.
SECOND_ORDER = 1e-3

SPEC = MeshSpec(0.125, 2.5e-3, 64.0, 1.3, 4)


def _problem(solid):
    return Problem(solid, PowerPunch(2.0, 1.1), LennardJones(1.2, 0.9))


NU = 0.3
SOFT = PowerLaw(0.3, 1.3, 0.4, NU)

#: Relative error put into the condensed compliance.
SPOILED = 1e-5


def _soft_contact(spoiled=0.0, spec=SPEC):
    """A solid with jumps on the small mesh; its compliance is too large by a share."""
    compliance = compliance_for(SOFT, spec, 1.0)
    compliance = replace(compliance, matrix=(1.0 + spoiled) * compliance.matrix)
    return Contact(Derjaguin(PowerPunch(2.0, 1.1), LennardJones(1.2, 0.9)), compliance)


@pytest.fixture(scope="module")
def soft_system():
    half_space = assemble_half_space(SPEC.grid(), PowerLaw(1.0, 1.0, SOFT.k, NU), SPEC.order)
    return FullSystem(half_space, Derjaguin(PowerPunch(2.0, 1.1), LennardJones(1.2, 0.9)))


@pytest.fixture(scope="module")
def soft_path():
    return PathEvents(traced(_soft_contact()))


@pytest.fixture(scope="module")
def lower():
    """Elements of a lower degree, with whose states the whole system begins."""
    return _soft_contact(spec=replace(SPEC, order=SPEC.order - 1))


@pytest.fixture(scope="module")
def spoiled_path():
    return PathEvents(traced(_soft_contact(SPOILED)))


@pytest.fixture(scope="module")
def solved():
    """A problem and its solution, and what was kept of its condensed system."""
    problem = _problem(PowerLaw(3.0, 1.3, 0.4, NU))
    return problem, solve(problem, "pull_off_force", "quick")


def test_the_value_is_that_of_the_whole_system_and_not_of_the_condensed_path(
    soft_path, spoiled_path, lower, soft_system
):
    """A wrong compliance moves every condensed value; the whole system brings each back and tells how far it was."""
    events = UncondensedEvents(spoiled_path, lower, lambda: soft_system)
    for name, row in TABLE.items():
        right, wrong = row.value(soft_path.at), row.value(spoiled_path.at)
        solution = events.value(row)
        assert abs(wrong - right) > 10 * ALGEBRA, name
        assert solution.value == pytest.approx(right, abs=ALGEBRA), name
        assert solution.rounding >= 0.99 * abs(wrong - right), name


def test_what_conjugate_gradients_leave_is_known(soft_path, soft_system, monkeypatch):
    """With a coarse tolerance the estimate alone, without the distance from the condensed value, is the error."""
    monkeypatch.setattr(uncondensed, "LINEAR_TOLERANCE", 1e-5)
    monkeypatch.setattr(uncondensed, "NEWTON_TOLERANCE", 1e-2)
    monkeypatch.setattr(uncondensed, "ROUNDING_STEP", 1e-2)
    monkeypatch.setattr(uncondensed, "RESIDUAL_TOLERANCE", 1e-2)
    events = UncondensedEvents(soft_path, _soft_contact(), lambda: soft_system)
    for name, row in TABLE.items():
        solution, right = events.value(row), row.value(soft_path.at)
        estimate = solution.rounding - abs(solution.value - right)
        assert estimate == pytest.approx(abs(solution.value - right), rel=SECOND_ORDER), name


@pytest.mark.parametrize("tolerance", ["ROUNDING_STEP", "RESIDUAL_TOLERANCE"])
def test_a_missed_tolerance_is_no_number(soft_path, lower, soft_system, monkeypatch, tolerance):
    monkeypatch.setattr(uncondensed, tolerance, 1e-25)
    events = UncondensedEvents(soft_path, lower, lambda: soft_system)
    with pytest.raises(NotConverged, match=r"Newton step|nonlinear system"):
        events.value(TABLE["pull_off_force"])


def test_an_equilibrium_that_is_left_after_one_step_is_refused_for_its_residual(lower, soft_system, monkeypatch):
    """Measured: 2e-5 of the traction.  A tolerance that is a hundred times as large would take it."""
    path = PathEvents(traced(_soft_contact(0.01 * SPOILED)))
    monkeypatch.setattr(uncondensed, "NEWTON_TOLERANCE", 1e-4)
    events = UncondensedEvents(path, lower, lambda: soft_system)
    with pytest.raises(NotConverged, match="residual"):
        events.value(TABLE["pull_off_force"])


def test_the_end_of_a_jump_moves_with_its_beginning(soft_path):
    fold, landed = soft_path.jump_in, soft_path.landing
    beginning, end = (
        EventEquations(name, point, _soft_contact()) for name, point in (("jump_in", fold), ("landing", landed))
    )
    equations = {"jump_in": beginning, "landing": end}
    shifted = {name: equation.copy() for name, equation in equations.items()}
    displacement = 1e-6 * np.exp(-np.arange(beginning.y.size - 2.0))
    shifted["jump_in"].shift(displacement, np.zeros_like(displacement), shifted, equations)
    shifted["landing"].shift(np.zeros(end.y.size - 2), None, shifted, equations)
    moved = shifted["jump_in"].y[-2] - beginning.y[-2]
    assert abs(moved) > 1e-8
    assert shifted["landing"].y[-2] - end.y[-2] == pytest.approx(moved, rel=1e-3)


def test_the_end_of_a_further_jump_is_kept_on_any_mesh(soft_path):
    """It begins at an edge for which the mesh is not fine, and is not looked for at its displacement."""
    end = replace(soft_path.landing, pinned=True)
    events = CarriedEvents(
        SimpleNamespace(anchor=lambda event: Anchor(end, end.displacement_rate)), _soft_contact(1e-3)
    )
    landing = events.at("landing_2")
    assert landing.pinned
    assert landing.parameter == end.parameter
    assert landing.state.displacement != end.state.displacement
    equation = EventEquations("landing_2", end, _soft_contact())
    shifted = {"landing_2": equation.copy()}
    shifted["landing_2"].shift(np.zeros(end.state.y.size - 2), None, shifted, {"landing_2": equation})
    assert not equation.is_fold
    assert np.array_equal(shifted["landing_2"].y, equation.y)


def test_an_event_is_taken_beside_where_it_is(soft_path):
    """By the error of its radius, which is a part of the bound."""
    uncertain = SimpleNamespace(anchor=lambda event: replace(soft_path.anchor(event), radius_error=1e-3))
    there, beside = (CarriedEvents(uncertain, _soft_contact(), beside=share).at("pull_off") for share in (0.0, -1.0))
    assert beside.parameter == pytest.approx((1.0 - 1e-3) * there.parameter, rel=1e-12)
    # An equilibrium of its own, with a larger load than the least one.
    assert beside.state.load > there.state.load
    assert beside.state.displacement < there.state.displacement


def test_every_event_takes_iterations_and_none_is_refused(soft_path, lower, soft_system, monkeypatch):
    """The start is another discretisation: an event whose displacement pyamg did not make is no number."""
    events = UncondensedEvents(soft_path, lower, lambda: soft_system)
    events.prepare(TABLE.values())
    assert {"pull_off", "jump_in", "jump_out", "landing"} <= set(events._points)
    assert min(point.state.iterations for point in events._points.values()) > 5

    def idle(half_space, load, *_, **options):
        result = solve_cg(half_space, load, *_, **options)
        return replace(result, iterations=np.zeros_like(result.iterations))

    monkeypatch.setattr(uncondensed, "solve_cg", idle)
    again = UncondensedEvents(soft_path, lower, lambda: soft_system)
    with pytest.raises(NotConverged, match="no iteration"):
        again.value(TABLE["pull_off_force"])


def test_a_stationary_quantity_needs_no_rate_of_the_whole_system(soft_path, lower, soft_system, monkeypatch):
    """Its event stays where the condensed path has it, until another quantity asks for the place."""
    columns = []

    def counted(half_space, load, *_, **options):
        columns.append(load.shape[1])
        return solve_cg(half_space, load, *_, **options)

    monkeypatch.setattr(uncondensed, "solve_cg", counted)
    events = UncondensedEvents(soft_path, lower, lambda: soft_system)
    force = events.value(TABLE["pull_off_force"])
    assert set(columns) == {1}
    events.at("pull_off")
    assert set(columns) == {1, 2}
    assert events.value(TABLE["pull_off_force"]).value == pytest.approx(force.value, abs=1e-3 * ALGEBRA)


def test_the_whole_system_ends_where_its_condensation_does_from_any_start(soft_path, lower, soft_system):
    """A lower degree, other elements and the event itself as starts: one equilibrium, to rounding."""
    other = _soft_contact(spec=replace(SPEC, density=1.1))
    for start in (_soft_contact(), lower, other):
        events = UncondensedEvents(soft_path, start, lambda: soft_system)
        events.prepare(TABLE.values())
        for name, row in TABLE.items():
            value = events.value(row)
            assert value.value == pytest.approx(row.value(soft_path.at), abs=ALGEBRA), name
            assert value.iterations > 0, name


def test_a_coarse_displacement_is_repaired_in_the_steps_that_follow(soft_path, lower, soft_system, monkeypatch):
    """What the first displacement leaves of its load is a part of the load of the next one."""
    calls = []

    def rough_at_first(half_space, load, preconditioner, tolerance, **options):
        calls.append(1e-2 if not calls else tolerance)
        return solve_cg(half_space, load, preconditioner, calls[-1], **options)

    monkeypatch.setattr(uncondensed, "solve_cg", rough_at_first)
    row = TABLE["pull_off_force"]
    value = UncondensedEvents(soft_path, lower, lambda: soft_system).value(row)
    assert value.value == pytest.approx(row.value(soft_path.at), abs=ALGEBRA)
    assert value.rounding <= ALGEBRA
    assert len(calls) > 1


def test_a_move_along_the_path_keeps_the_equilibrium(soft_path):
    """Its tangent alone leaves the equilibrium where the traction is steep; rounding of a rate then moves the load."""
    equation = EventEquations("pull_off", soft_path.pull_off, _soft_contact())
    y, rate, contact, move = equation.y, equation.rate, equation.contact, 0.01 * equation.parameter
    equation._move(move)
    along_the_tangent = np.abs(contact.residual(y + move * rate)).max()
    assert along_the_tangent > 1e-4
    assert np.abs(contact.residual(equation.y)).max() <= 0.05 * along_the_tangent
    assert equation.y[-1] == pytest.approx(equation.parameter, rel=1e-12)


def test_a_solution_holds_the_value_of_the_whole_system(solved, monkeypatch):
    """Another displacement of the mesh is another value, and its distance from the condensed one is in the bound."""
    problem, right = solved
    other = right.with_whole_system(UncondensedValue(right.value + 1.0, 0.5, 7, 1e-3))
    assert (other.value, other.iterations, other.residual) == (right.value + 1.0, 7, 1e-3)
    assert other.parts["rounding"] == right.parts["rounding"] + 0.5
    assert right.parts["rounding"] <= ALGEBRA
    assert right.iterations > 5
    assert 0.0 < right.residual <= uncondensed.RESIDUAL_TOLERANCE
    assert right.u_num == pytest.approx(sum(right.parts.values()))
    _, point = event_state(problem, "pull_off", "quick")
    # The mesh of the state extends farther.
    ends = right.parts["rounding"] + right.parts["interior and exterior"]
    assert -point.state.load == pytest.approx(right.value, abs=ends)
    uncondensed.uncondensed_events.cache_clear()

    def softer(*arguments, **options):
        result = solve_cg(*arguments, **options)
        return replace(result, solution=(1.0 + SPOILED) * result.solution)

    monkeypatch.setattr(uncondensed, "solve_cg", softer)
    monkeypatch.setattr(uncondensed, "RESIDUAL_TOLERANCE", 1.0)
    wrong = solve(problem, "pull_off_force", "quick")
    uncondensed.uncondensed_events.cache_clear()
    moved = abs(wrong.value - right.value)
    assert wrong.values == right.values
    assert moved > 100 * ALGEBRA
    assert wrong.parts["rounding"] >= 0.9 * moved


def test_facet_forms_on_elements_thinner_than_rounding_resolves():
    """At an edge of a millionth of its radius the reference coordinates are good to 1e-10 of an element."""
    grid = replace(SPEC, edge_width=1e-6, density=1.4).grid()
    half_space = assemble_half_space(grid, PowerLaw(1.0, 1.0, 0.4, NU), 4)
    system = FullSystem(half_space, Derjaguin(PowerPunch(2.0, 1.1), LennardJones(1.2, 0.9)), preconditioner=object())
    assert system.facets.dx.sum() == pytest.approx(SPEC.extent, rel=1e-12)
    assert system.s.min() > 0.0
    nodes = grid.r[:-1, None]
    assert np.all((np.sort(system.s, axis=0)[np.argsort(system.s[:, 0])] > nodes).all())
