"""The condensed path against Newton on every displacement, with facet forms and pyamg."""

import numpy as np
import pytest

from fem_reference.contact import Contact
from fem_reference.events import find_event
from fem_reference.modulus import PowerLaw
from fem_reference.punch import PowerPunch
from fem_reference.surface import MeshSpec, compliance_for
from fem_reference.traction import LennardJones
from fem_reference.uncondensed import FullContact

AGREEMENT = 1e-8
"""Newton tolerance 1e-10 and linear tolerance 1e-4 of the last step: measured 1e-11."""

SPEC = MeshSpec(0.125, 2.5e-3, 64.0, 1.3, 4)


@pytest.mark.parametrize(("n", "k"), [(2.0, 0.4), (1.0, 0.0)])
def test_equilibrium_and_pull_off_agree_with_the_condensed_path(n, k):
    modulus, nu = PowerLaw(0.8, 1.3, k), 0.3
    punch, law = PowerPunch(n, 1.1), LennardJones(1.2, 0.9)
    contact = Contact(punch, law, compliance_for(modulus, nu, SPEC, 1.0))
    point = find_event(contact, "pull_off_force").point
    full = FullContact(modulus, nu, punch, law, SPEC)
    # Start from the elastic response to 0.97 of the pressure on the undisturbed gap of the solution.
    gap = np.interp(full.s, contact.compliance.trace.s, contact.gap(point.state.y))
    start = 0.97 * full.under_pressure(law.traction(gap), point.state.size)
    state = full.equilibrium(start, point.state.displacement, point.state.size)
    tail = contact.load(point.state.y) - 2 * np.pi * point.state.size**2 * float(
        contact.compliance.trace.weight * contact.compliance.trace.s @ law.traction(contact.gap(point.state.y))
    )
    scale = abs(point.state.load)
    assert state.load + tail == pytest.approx(point.state.load, abs=AGREEMENT * scale)
    assert state.displacement == pytest.approx(point.state.displacement, abs=AGREEMENT)
    surface = full.half_space.surface
    assert np.abs(state.u[surface] - point.state.y[:-2]).max() <= AGREEMENT * np.abs(state.u).max()
    if n == 2.0:
        found = full.pull_off(state.u, state.displacement, 1.03 * state.size)
        assert found.size == pytest.approx(point.state.size, rel=1e-5)
        assert found.load + tail == pytest.approx(point.state.load, abs=AGREEMENT * scale)
