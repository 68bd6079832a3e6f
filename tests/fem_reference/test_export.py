"""Fields: the surface stress is the traction, the file reads back, the picture is drawn."""

from dataclasses import replace

import meshio
import numpy as np
import pytest

from fem_reference._contact.contact import Contact
from fem_reference._contact.events import PathEvents
from fem_reference._contact.path import traced
from fem_reference._elastic.compliance import compliance_for
from fem_reference._elastic.mesh import MeshSpec
from fem_reference.export import contact_field, draw, write_vtu
from fem_reference.interaction import Derjaguin
from fem_reference.laws import LennardJones
from fem_reference.punch import PowerPunch
from fem_reference.solid import PowerLaw
from tests.refusals import refused

SPEC = MeshSpec(0.125, 2.5e-3, 64.0, 0.9, 6)


@pytest.fixture(scope="module")
def state():
    solid = PowerLaw(1.0, 1.0, 0.4, 0.3)
    contact = Contact(Derjaguin(PowerPunch(2.0, 1.0), LennardJones(1.0, 1.0)), compliance_for(solid, SPEC, 1.0))
    point = PathEvents(traced(contact)).pull_off
    return point, contact_field(solid, SPEC, point)


def test_stress_at_the_surface_is_the_traction(state):
    point, field = state
    contact, y = point.branch.contact, point.state.y
    top = np.flatnonzero((field.points[:, 1] < 1e-9) & (field.points[:, 0] < 5 * y[-1]))
    r = field.points[top, 0]
    trace = contact.compliance.trace
    w = trace.evaluate(r / y[-1]) @ y[:-2]
    pressure = contact.law.traction(-y[-2] + contact.punch.height(r) + w)
    # Derivatives of the displacement lose one order: measured 2e-3 on this mesh.
    assert np.abs(field.stress[top, 2] + pressure).max() <= 5e-3
    assert np.abs(field.stress[top, 3]).max() <= 1e-2
    assert field.displacement[top, 1] == pytest.approx(w, abs=1e-5)


def test_gap_and_pressure_are_those_of_the_surface(state):
    point, field = state
    surface = np.isfinite(field.gap)
    assert (surface == (field.points[:, 1] < 1e-5)).all()
    r, w = field.points[surface, 0], field.displacement[surface, 1]
    contact, y = point.branch.contact, point.state.y
    assert field.gap[surface] == pytest.approx(contact.punch.height(r) - y[-2] + w, abs=1e-5)
    assert field.pressure[surface] == pytest.approx(contact.law.traction(field.gap[surface]), rel=1e-12)
    assert np.isnan(field.pressure[~surface]).all()


def test_one_unit_of_every_length(state):
    """A strain has no unit: stress over modulus changes as displacement over distance."""
    _, field = state
    scaled = field.in_units_of(0.25, 7.0)
    assert scaled.displacement / scaled.points == pytest.approx(field.displacement / field.points, rel=1e-12)
    assert scaled.stress / scaled.modulus[:, None] == pytest.approx(field.stress / field.modulus[:, None], rel=1e-12)
    sheared = replace(field, stress=np.tile([0.0, 0.0, 0.0, 2.0], (len(field.points), 1)))
    assert sheared.von_mises == pytest.approx(2.0 * 3.0**0.5)
    assert 0.25 * scaled.gap == pytest.approx(field.gap, nan_ok=True)
    assert 7.0 * scaled.pressure == pytest.approx(field.pressure, nan_ok=True)
    refused("length = 0", field.in_units_of, 0.0, 1.0)


def test_file_and_picture(state, tmp_path):
    _, field = state
    path = tmp_path / "contact.vtu"
    write_vtu(field, path)
    read = meshio.read(path)
    assert len(read.points) == len(field.points)
    assert {"displacement", "sigma_zz", "von_mises"} <= set(read.point_data)
    assert read.point_data["displacement"][:, 1] == pytest.approx(-field.displacement[:, 1])
    assert np.isnan(read.point_data["gap"]).sum() == np.isnan(field.gap).sum() > 0
    figure = draw(field, 4.0, magnification=0.5, stress="von_mises")
    figure.savefig(tmp_path / "contact.png")
    assert (tmp_path / "contact.png").stat().st_size > 10_000
    refused("unknown", draw, field, 4.0, stress="pressure")
