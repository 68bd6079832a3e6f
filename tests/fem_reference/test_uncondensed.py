"""The condensed path against Newton on every displacement, with facet forms and pyamg."""

from dataclasses import replace

import numpy as np
import pytest

from fem_reference import CustomModulus, CustomSolid, NoSuchEvent, solve_together, solve_uncondensed
from fem_reference._contact.contact import Contact
from fem_reference._contact.events import PathEvents
from fem_reference._contact.full_system import FullSystem
from fem_reference._contact.tracing import traced
from fem_reference._contact.uncondensed import last_newton_steps
from fem_reference._elastic.assembly import assemble_half_space
from fem_reference._elastic.compliance import compliance_for
from fem_reference._elastic.mesh import MeshSpec
from fem_reference.laws import LennardJones
from fem_reference.modulus import PowerLawModulus
from fem_reference.problem import Problem
from fem_reference.punch import PowerPunch
from fem_reference.solid import Solid
from fem_reference.states import event_state
from fem_reference.verification.reference_solutions import surface_constant
from fem_reference.verification.uncondensed import FullContact

AGREEMENT = 1e-8
"""Newton tolerance 1e-10 and linear tolerance 1e-4 of the last step: measured 1e-11."""

SPEC = MeshSpec(0.125, 2.5e-3, 64.0, 1.3, 4)


def _beyond(contact, state):
    """The load beyond the mesh, which the uncondensed model leaves out."""
    trace = contact.compliance.trace
    pressure = contact.law.traction(contact.gap(state.y))
    return contact.load(state.y) - 2 * np.pi * state.size**2 * float(trace.weight * trace.s @ pressure)


def _start(full, contact, state):
    """The elastic response to 0.97 of the pressure of a condensed solution."""
    gap = np.interp(full.s, contact.compliance.trace.s, contact.gap(state.y))
    return 0.97 * full.under_pressure(full.law.traction(gap), full.factor(state.size))


@pytest.mark.parametrize(("n", "k"), [(2.0, 0.4), (1.0, 0.0)])
def test_equilibrium_and_pull_off_agree_with_the_condensed_path(n, k):
    modulus, nu = PowerLawModulus(0.8, 1.3, k), 0.3
    punch, law = PowerPunch(n, 1.1), LennardJones(1.2, 0.9)
    contact = Contact(punch, law, compliance_for(modulus, nu, SPEC, 1.0))
    point = PathEvents(traced(contact)).pull_off
    full = FullContact(modulus, nu, punch, law, SPEC)
    state = full.equilibrium(_start(full, contact, point.state), point.state.displacement, point.state.size)
    tail = _beyond(contact, point.state)
    scale = abs(point.state.load)
    assert state.load + tail == pytest.approx(point.state.load, abs=AGREEMENT * scale)
    assert state.displacement == pytest.approx(point.state.displacement, abs=AGREEMENT)
    surface = full.half_space.surface
    assert np.abs(state.u[surface] - point.state.y[:-2]).max() <= AGREEMENT * np.abs(state.u).max()
    if n == 2.0:
        found = full.pull_off(state.u, state.displacement, 1.03 * state.size)
        assert found.size == pytest.approx(point.state.size, rel=1e-5)
        assert found.load + tail == pytest.approx(point.state.load, abs=AGREEMENT * scale)


@pytest.mark.heavy
def test_the_pull_off_of_the_default_mesh_without_condensation():
    """Tabor number 1 at k = 0.4: 5e4 unknowns, every Newton step by pyamg (measured 1e-13 apart)."""
    nu, k = 0.3, 0.4
    solid = Solid(surface_constant(k, nu) / (1 - k) * (1 - nu**2), 1.0, k, nu)
    punch, law = PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0)
    spec, point = event_state(Problem(solid, punch, law), "pull_off")
    contact = point.branch.contact
    full = FullContact(solid.modulus, nu, punch, law, spec)
    start = _start(full, contact, point.state)
    found = full.pull_off(start, point.state.displacement, 1.03 * point.state.size)
    assert found.load + _beyond(contact, point.state) == pytest.approx(point.state.load, rel=AGREEMENT)
    assert -point.state.load / np.pi == pytest.approx(1.78848171, abs=5e-9)


def _problem(solid):
    return Problem(solid, PowerPunch(2.0, 1.1), LennardJones(1.2, 0.9))


@pytest.mark.parametrize("event", ["jump_in", "pull_off"])
def test_the_last_newton_steps_do_not_depend_on_the_condensed_displacement(event):
    """Before contact under the control of the central gap, and in contact under that of the edge."""
    modulus, nu = PowerLawModulus(0.3, 1.3, 0.4), 0.3
    punch, law = PowerPunch(2.0, 1.1), LennardJones(1.2, 0.9)
    contact = Contact(punch, law, compliance_for(modulus, nu, SPEC, 1.0))
    point = PathEvents(traced(contact)).at(event)
    half_space = assemble_half_space(SPEC.grid(), PowerLawModulus(1.0, 1.0, 0.4), nu, SPEC.order)
    start = point.state.y.copy()
    start[:-1] *= 1.0 + 1e-5
    found = last_newton_steps(FullSystem(half_space, punch, law), replace(point, state=replace(point.state, y=start)))
    assert found.state.iterations > 1
    assert found.state.load == pytest.approx(point.state.load, rel=AGREEMENT)
    assert np.abs(found.state.y - point.state.y).max() <= AGREEMENT


@pytest.mark.parametrize(
    "names",
    [
        ("pull_off_force", "pull_off_displacement"),
        pytest.param(("hysteresis_energy", "jump_in_gap"), marks=pytest.mark.heavy),  # four states of the whole mesh
    ],
)
def test_uncondensed_values_with_their_difference_in_the_bound(names):
    problem = _problem(Solid(0.3, 1.3, 0.4, 0.3))
    condensed, whole = solve_together(problem, names, "quick"), solve_uncondensed(problem, names, "quick")
    for name in names:
        difference = abs(whole[name].value - condensed[name].value)
        assert 0.0 < difference <= AGREEMENT
        assert whole[name].u_num == pytest.approx(condensed[name].u_num + difference, rel=1e-12)


def test_uncondensed_values_of_a_solid_of_one_size():
    """The edge moves over a fixed mesh; a quantity that does not exist stays an exception."""
    solid = CustomSolid(CustomModulus(lambda z: 20.0 + 0.0 * z, 0.0, 0.0, surface_depth=1.0), 0.3)
    names = ("pull_off_force", "jump_in_gap")
    found = solve_uncondensed(_problem(solid), names, "quick")
    force = found["pull_off_force"]
    assert force.value == pytest.approx(force.values[-1], rel=AGREEMENT)
    assert isinstance(found["jump_in_gap"], NoSuchEvent)
