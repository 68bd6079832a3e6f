"""The condensed path against Newton on every displacement, with facet forms and pyamg."""

from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import numpy as np
import pyamg
import pytest

from fem_reference import NotConverged, solve
from fem_reference._contact import error_parts, mesh_choice, uncondensed
from fem_reference._contact.contact import Contact
from fem_reference._contact.event_equations import EventEquations
from fem_reference._contact.events import PathEvents
from fem_reference._contact.full_system import FullSystem
from fem_reference._contact.resolved import ResolvedEvents
from fem_reference._contact.tracing import traced
from fem_reference._contact.uncondensed import UncondensedEvents
from fem_reference._elastic.assembly import assemble_half_space
from fem_reference._elastic.compliance import compliance_for
from fem_reference._elastic.mesh import MeshSpec
from fem_reference._linear.linear_solver import solve_cg
from fem_reference._linear.preconditioner import ElasticPreconditioner
from fem_reference.laws import LennardJones
from fem_reference.modulus import PowerLawModulus
from fem_reference.problem import Problem
from fem_reference.punch import PowerPunch
from fem_reference.quantities import TABLE
from fem_reference.solids import PowerLaw
from fem_reference.states import event_state

#: Newton tolerance 1e-10 and linear tolerance 1e-4 of the last step: measured 1e-11.
AGREEMENT = 1e-8

#: Largest distance of the whole system from its condensation (measured: 4e-11).
ALGEBRA = 1e-9

SPEC = MeshSpec(0.125, 2.5e-3, 64.0, 1.3, 4)


def _problem(solid):
    return Problem(solid, PowerPunch(2.0, 1.1), LennardJones(1.2, 0.9))


NU = 0.3
SOFT = PowerLawModulus(0.3, 1.3, 0.4)

#: Relative error put into the condensed compliance.
SPOILED = 1e-5


def _soft_contact(spoiled=0.0):
    """A solid with jumps on the small mesh; its compliance is too large by a share."""
    compliance = compliance_for(SOFT, NU, SPEC, 1.0)
    compliance = replace(compliance, matrix=(1.0 + spoiled) * compliance.matrix)
    return Contact(PowerPunch(2.0, 1.1), LennardJones(1.2, 0.9), compliance)


@pytest.fixture(scope="module")
def soft_system():
    half_space = assemble_half_space(SPEC.grid(), PowerLawModulus(1.0, 1.0, SOFT.k), NU, SPEC.order)
    return FullSystem(half_space, PowerPunch(2.0, 1.1), LennardJones(1.2, 0.9))


@pytest.fixture(scope="module")
def soft_path():
    return PathEvents(traced(_soft_contact()))


@pytest.fixture(scope="module")
def spoiled_path():
    return PathEvents(traced(_soft_contact(SPOILED)))


CONDENSED = mesh_choice._traced, error_parts.events_on_meshes
WHOLE = uncondensed.uncondensed_events, uncondensed._preconditioned


def _forget(*kept):
    for cache in kept:
        cache.cache_clear()


@pytest.fixture
def no_kept_whole_system():
    """No event of a whole system that was solved before or after is used again."""
    _forget(*WHOLE)
    yield
    _forget(*WHOLE)


@pytest.fixture
def no_kept_events(no_kept_whole_system):
    """Nothing solved here is used again after the test."""
    yield
    _forget(*CONDENSED)


@pytest.fixture(scope="module")
def solved():
    """A problem and its solution, and what was kept of its condensed system."""
    problem = _problem(PowerLaw(3.0, 1.3, 0.4, NU))
    return problem, solve(problem, "pull_off_force", "quick")


def test_the_value_is_that_of_the_whole_system_and_not_of_the_condensed_path(soft_path, spoiled_path, soft_system):
    """A wrong compliance moves every condensed value; the whole system brings each back and tells how far it was."""
    events = UncondensedEvents(spoiled_path, lambda: soft_system)
    for name, row in TABLE.items():
        right, wrong = row.functional(soft_path), row.functional(spoiled_path)
        whole = events.value(row.functional)
        assert abs(wrong - right) > 10 * ALGEBRA, name
        assert whole.value == pytest.approx(right, abs=ALGEBRA), name
        assert whole.algebra >= 0.99 * abs(wrong - right), name


def test_the_whole_system_agrees_with_a_right_condensation(soft_path, soft_system):
    events = UncondensedEvents(soft_path, lambda: soft_system)
    events.prepare(row.functional for row in TABLE.values())
    for name, row in TABLE.items():
        whole = events.value(row.functional)
        assert whole.value != row.functional(soft_path), name
        assert whole.value == pytest.approx(row.functional(soft_path), abs=ALGEBRA), name
        assert whole.algebra <= ALGEBRA, name
        assert whole.iterations <= 20, name


def test_what_conjugate_gradients_leave_is_known(soft_path, soft_system, monkeypatch):
    """With a coarse tolerance the estimate alone, without the distance from the condensed value, covers the error."""
    monkeypatch.setattr(uncondensed, "LINEAR_TOLERANCE", 1e-5)
    monkeypatch.setattr(uncondensed, "NEWTON_TOLERANCE", 1e-2)
    monkeypatch.setattr(uncondensed, "ROUNDING_STEP", 1e-2)
    monkeypatch.setattr(uncondensed, "RESIDUAL_TOLERANCE", 1e-2)
    events = UncondensedEvents(soft_path, lambda: soft_system)
    for name, row in TABLE.items():
        whole, right = events.value(row.functional), row.functional(soft_path)
        estimate = whole.algebra - abs(whole.value - right)
        assert abs(whole.value - right) <= estimate, name


@pytest.mark.parametrize("tolerance", ["ROUNDING_STEP", "RESIDUAL_TOLERANCE"])
def test_a_missed_tolerance_is_no_number(soft_path, soft_system, monkeypatch, tolerance):
    monkeypatch.setattr(uncondensed, tolerance, 1e-25)
    events = UncondensedEvents(soft_path, lambda: soft_system)
    with pytest.raises(NotConverged, match=r"conjugate gradients|Newton steps|nonlinear system"):
        events.value(TABLE["pull_off_force"].functional)


def test_an_equilibrium_that_is_left_after_one_step_is_refused_for_its_residual(soft_system, monkeypatch):
    """Measured: 2e-5 of the traction.  A tolerance that is a hundred times as large would take it."""
    path = PathEvents(traced(_soft_contact(0.01 * SPOILED)))
    monkeypatch.setattr(uncondensed, "NEWTON_TOLERANCE", 1e-4)
    events = UncondensedEvents(path, lambda: soft_system)
    with pytest.raises(NotConverged, match="residual"):
        events.value(TABLE["pull_off_force"].functional)


def test_an_iteration_that_ends_early_is_no_solution(soft_path, soft_system, monkeypatch):
    """One that leaves 3.4e-8 is not taken for rounding."""
    monkeypatch.setattr(uncondensed, "solve_cg", partial(solve_cg, iterations=5))
    events = UncondensedEvents(soft_path, lambda: soft_system)
    with pytest.raises(NotConverged, match=r"conjugate gradients reached a residual of 3\.4e-08 in 5 iterations"):
        events.value(TABLE["pull_off_force"].functional)


def test_a_shift_by_nothing_is_none(soft_path):
    """Also where the condition of the event is not met exactly, as after a last step along the path."""
    point = soft_path.samples[len(soft_path.samples) // 2]
    equations = {"pull_off": EventEquations("pull_off", point)}
    shifted = {"pull_off": equations["pull_off"].copy()}
    nothing = np.zeros(point.branch.contact.unknowns)
    shifted["pull_off"].shift(nothing, nothing, shifted, equations)
    assert abs(point.load_rate) > 0.0
    assert np.array_equal(shifted["pull_off"].y, equations["pull_off"].y)


def test_the_end_of_a_jump_moves_with_its_beginning(soft_path):
    beginning, end = EventEquations("jump_in", soft_path.jump_in), EventEquations("landing", soft_path.landing)
    equations = {"jump_in": beginning, "landing": end}
    shifted = {name: equation.copy() for name, equation in equations.items()}
    some = 1e-6 * np.exp(-np.arange(beginning.y.size - 2.0))
    shifted["jump_in"].shift(some, np.zeros_like(some), shifted, equations)
    shifted["landing"].shift(np.zeros(end.y.size - 2), None, shifted, equations)
    moved = shifted["jump_in"].y[-2] - beginning.y[-2]
    assert abs(moved) > 1e-8
    assert shifted["landing"].y[-2] - end.y[-2] == pytest.approx(moved, rel=1e-3)


def test_the_end_of_a_further_jump_is_kept_on_any_mesh(soft_path):
    """It begins at an edge for which the mesh is not fine, and is not looked for at its displacement."""
    end = replace(soft_path.landing, held=True)
    events = ResolvedEvents(SimpleNamespace(anchor=lambda event: (end, end.displacement_rate)), _soft_contact(1e-3))
    found = events.at("landing_2")
    assert found.held
    assert found.parameter == end.parameter
    assert found.state.displacement != end.state.displacement
    equation = EventEquations("landing_2", end)
    shifted = {"landing_2": equation.copy()}
    shifted["landing_2"].shift(np.zeros(end.state.y.size - 2), None, shifted, {"landing_2": equation})
    assert not equation.is_fold
    assert np.array_equal(shifted["landing_2"].y, equation.y)


def test_steps_that_rounding_keeps_from_falling_end_the_iteration(soft_path, soft_system, monkeypatch):
    calls = []

    def counted(*args, **kwargs):
        calls.append(1)
        return solve_cg(*args, **kwargs)

    monkeypatch.setattr(uncondensed, "solve_cg", counted)
    monkeypatch.setattr(uncondensed, "NEWTON_TOLERANCE", 1e-30)
    UncondensedEvents(soft_path, lambda: soft_system).value(TABLE["pull_off_force"].functional)
    assert 2 <= len(calls) < uncondensed.NEWTON_STEPS


def test_another_stiffness_is_not_an_equilibrium_nearby(soft_path):
    """A mesh of a solid twice as stiff: Newton's method does not come back with a number of the soft one."""
    half_space = assemble_half_space(SPEC.grid(), PowerLawModulus(2.0, 1.0, SOFT.k), NU, SPEC.order)
    system = FullSystem(half_space, PowerPunch(2.0, 1.1), LennardJones(1.2, 0.9))
    events = UncondensedEvents(soft_path, lambda: system)
    try:
        whole = events.value(TABLE["pull_off_force"].functional)
    except NotConverged:
        return
    stiff = replace(_soft_contact(), compliance=compliance_for(replace(SOFT, E0=2 * SOFT.E0), NU, SPEC, 1.0))
    assert whole.value == pytest.approx(TABLE["pull_off_force"].functional(PathEvents(traced(stiff))), rel=1e-6)


def _nothing_solved(self, b, **options):
    return np.full_like(b, np.nan)


def _not_preconditioned(self, b):
    return np.array(b)


def test_without_pyamg_there_is_no_value(monkeypatch, soft_path, soft_system):
    monkeypatch.setattr(pyamg.multilevel.MultilevelSolver, "solve", _nothing_solved)
    events = UncondensedEvents(soft_path, lambda: soft_system)
    with pytest.raises(NotConverged, match="conjugate gradients reached a residual"):
        events.value(TABLE["pull_off_force"].functional)


@pytest.mark.heavy
@pytest.mark.usefixtures("no_kept_whole_system")
def test_without_its_preconditioner_there_is_no_solution(solved, monkeypatch):
    """The condensed system alone, which is solved already, is no solution."""
    monkeypatch.setattr(ElasticPreconditioner, "__call__", _not_preconditioned)
    with pytest.raises(NotConverged, match="conjugate gradients reached a residual"):
        solve(solved[0], "pull_off_force", "quick")


def test_a_solution_holds_the_value_of_the_whole_system(solved):
    problem, right = solved
    assert right.value != right.values[-1]
    assert right.parts["algebra"] <= ALGEBRA
    assert right.iterations <= 5
    assert 0.0 < right.residual <= uncondensed.RESIDUAL_TOLERANCE
    assert right.u_num == pytest.approx(sum(right.parts.values()))
    _, point = event_state(problem, "pull_off", "quick")
    assert -point.state.load == pytest.approx(right.value, abs=right.parts["algebra"])


@pytest.mark.heavy
@pytest.mark.usefixtures("no_kept_events")
def test_a_solution_by_a_wrong_condensation_holds_the_value_of_the_whole_system(solved, monkeypatch):
    """The whole solution; on one mesh it is the first test of the whole system."""
    problem, right = solved
    _forget(*CONDENSED, *WHOLE)

    def spoiled(*arguments):
        compliance = compliance_for(*arguments)
        return replace(compliance, matrix=(1.0 + SPOILED) * compliance.matrix)

    monkeypatch.setattr(mesh_choice, "compliance_for", spoiled)
    found = solve(problem, "pull_off_force", "quick")
    moved = abs(found.values[-1] - right.values[-1])
    assert moved > 100 * AGREEMENT
    assert found.value == pytest.approx(right.value, abs=AGREEMENT)
    assert found.parts["algebra"] == pytest.approx(moved, rel=1e-2)
    assert found.u_num >= moved


def test_facet_forms_on_elements_thinner_than_rounding_resolves():
    """At an edge of a millionth of its radius the reference coordinates are good to 1e-10 of an element."""
    grid = replace(SPEC, edge_width=1e-6, density=1.4).grid()
    half_space = assemble_half_space(grid, PowerLawModulus(1.0, 1.0, 0.4), NU, 4)
    system = FullSystem(half_space, PowerPunch(2.0, 1.1), LennardJones(1.2, 0.9), preconditioner=object())
    assert system.facets.dx.sum() == pytest.approx(SPEC.extent, rel=1e-12)
    assert system.s.min() > 0.0
    nodes = grid.r[:-1, None]
    assert np.all((np.sort(system.s, axis=0)[np.argsort(system.s[:, 0])] > nodes).all())
