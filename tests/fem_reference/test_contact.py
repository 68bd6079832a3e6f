"""Contact equilibrium: exact tangent, controls, energy, and events."""

import numpy as np
import pytest

from fem_reference._contact.contact import Contact
from fem_reference._contact.controls import CentralGap, EdgeGap, EdgeRadius, GapRise, Size
from fem_reference._contact.events import PathEvents
from fem_reference._contact.newton import newton
from fem_reference._contact.path import traced
from fem_reference._elastic.compliance import compliance_for
from fem_reference._elastic.mesh import MeshSpec
from fem_reference.errors import NotConverged
from fem_reference.interaction import Derjaguin
from fem_reference.laws import LennardJones
from fem_reference.punch import PowerPunch
from fem_reference.quantities import quantity_named
from fem_reference.solid import PowerLaw
from tests.refusals import refused

SPEC = MeshSpec(0.125, 2.5e-3, 256.0, 0.9, 6, 0.05)


def _contact(E0=1.0, k=0.0, nu=0.0, law=None, punch=None):
    compliance = compliance_for(PowerLaw(E0, 1.0, k, nu), SPEC, 1.0)
    return Contact(Derjaguin(punch or PowerPunch(2.0, 1.0), law or LennardJones(1.0, 1.0)), compliance)


@pytest.fixture(scope="module")
def points():
    """Unit Tabor ratio: E* = Q = w = z0 = 1."""
    return traced(_contact())


@pytest.mark.parametrize("n", [1.0, 2.0, 5.0])
def test_tangent_and_load_gradient_by_central_differences(n):
    contact = _contact(0.5, 0.4, 0.25, punch=PowerPunch(n, 1.0))
    rng = np.random.default_rng(2)
    y = np.append(0.05 * rng.normal(size=contact.unknowns) * (np.arange(contact.unknowns) < 20), [-0.4, 1.3])
    v = np.append(1e-2 * rng.normal(size=contact.unknowns) * (np.arange(contact.unknowns) < 20), [0.3, 0.2])
    h = 1e-5
    numeric = (contact.residual(y + h * v) - contact.residual(y - h * v)) / (2 * h)
    assert np.abs(numeric - contact.tangent(y) @ v).max() <= 1e-6 * np.abs(numeric).max()
    slope = (contact.load(y + h * v) - contact.load(y - h * v)) / (2 * h)
    assert slope == pytest.approx(contact.load_gradient(y) @ v, rel=1e-6)


@pytest.mark.parametrize(
    "control",
    [Size(1.2), CentralGap(0.2), EdgeGap(0.2), EdgeGap(), GapRise(0.05)],
    ids=lambda c: type(c).__name__,
)
def test_control_gradients(control):
    contact = _contact()
    rng = np.random.default_rng(3)
    y = np.append(0.1 * rng.normal(size=contact.unknowns), [-0.4, 1.3])
    v = rng.normal(size=y.size)
    h = 1e-6
    numeric = (control.value(contact, y + h * v) - control.value(contact, y - h * v)) / (2 * h)
    assert numeric == pytest.approx(control.gradient(contact, y) @ v, rel=1e-6)


def test_every_control_finds_the_same_state(points):
    point = points[-4]
    contact, y = point.branch.contact, point.state.y
    size = Size(point.state.size)
    start = y.copy()
    start[:-2] *= 1.001
    for control in (CentralGap(point.state.central_gap), EdgeRadius(point.state.size)):
        state = newton(contact, start, size, control)
        assert np.abs(state.y - y).max() <= 1e-8, type(control).__name__


def test_rates_are_derivatives_along_the_path_and_the_load_is_that_of_the_energy(points):
    for point in (points[5], points[-5]):
        h = 1e-4 * point.parameter
        ahead, behind = (point.branch.solve(point.parameter + d, point.predict(point.parameter + d)) for d in (h, -h))
        load, delta = (getattr(ahead.state, name) - getattr(behind.state, name) for name in ("load", "displacement"))
        assert point.state.load_rate == pytest.approx(load / (2 * h), rel=1e-6)
        assert point.state.displacement_rate == pytest.approx(delta / (2 * h), rel=1e-6)
        contact = point.branch.contact
        energy = contact.energy(ahead.state.y) - contact.energy(behind.state.y)
        assert energy / delta == pytest.approx(point.state.load, rel=2e-5)


def test_unknown_names_are_refused(points):
    """An unknown name does not stand for the jump out of contact."""
    refused(r"event 'nonsense' is unknown; choose one of pull_off, jump_in", PathEvents(points).at, "nonsense")
    refused(r"quantity 'nonsense' is unknown; choose one of pull_off_force", quantity_named, "nonsense")


def test_newton_refuses_a_hopeless_start():
    contact = _contact(E0=1e-6)
    y = np.append(np.zeros(contact.unknowns), [50.0, 1.0])
    refused("Newton stopped at a residual", newton, contact, y, Size(1.0), CentralGap(-50.0), error=NotConverged)


class _Exponential(LennardJones):
    """A law whose traction is beyond what numbers hold in deep overlap."""

    def traction(self, gap):
        return super().traction(gap) + np.exp(-1e3 * gap)

    def slope(self, gap):
        return super().slope(gap) - 1e3 * np.exp(-1e3 * gap)


def test_a_trial_state_beyond_what_numbers_hold_is_refused_without_a_warning():
    contact = _contact(E0=1e-6, law=_Exponential(1.0, 1.0))
    y = np.append(np.zeros(contact.unknowns), [50.0, 1.0])
    refused("Newton stopped at a residual", newton, contact, y, Size(1.0), CentralGap(-50.0), error=NotConverged)


def test_a_distant_rigid_punch_has_the_load_of_bradley():
    """Ten lengths away, the load of the 9-3 tail beyond the mesh included."""
    contact = _contact(E0=50.0)
    apart = np.zeros(contact.unknowns + 2)
    apart[-2:] = -10.0, 1.0
    assert contact.load(apart) == pytest.approx(-8 / 3 * np.pi / 11**2, rel=1e-5)
