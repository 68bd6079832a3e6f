"""Displacement, load and energy behind the mesh against an adaptive quadrature of their integrals."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from fem_reference import Mie, PowerPunch
from fem_reference._contact.contact import Contact
from fem_reference._contact.event_mesh import chosen
from fem_reference._contact.far_rule import far_rule
from fem_reference._contact.tail import TailContact
from fem_reference._elastic.mesh import MeshSpec
from fem_reference.interaction import Derjaguin
from tests.fem_reference.solved_together import problem_with

#: Of the two quadratures, relative; measured 3e-11.
QUADRATURE = 3e-10
#: The displacement at R = 16 c is read as that of a point load, without terms of (c/R)^2 = 0.004; measured 0.0014.
POINT_LOAD = 0.005

SPEC = MeshSpec(0.0625, 0.01, 16.0, 1.4, 4, 0.05)
DISPLACEMENT, SIZE, AT_EDGE = -0.5, 1.5, 0.1


def _contacts(k):
    """Contact, the same with the tail, and a displacement that falls to `AT_EDGE` at the end of the mesh."""
    problem = problem_with(k, 1.0)
    mesh = chosen(problem, ("pull_off",), "quick")
    plain = mesh.meshes.contact(SPEC, mesh.size)
    tail = TailContact(plain.force, plain.compliance, k)
    y = np.concatenate([np.full(plain.unknowns, AT_EDGE), [DISPLACEMENT, SIZE]])
    return problem, plain, tail, y


def _beyond(contact, density):
    """Integral of 2 pi r density(r) behind the mesh, in powers of R/r."""
    R = contact.compliance.trace.extent * SIZE
    value, _ = quad(lambda x: density(R / x) * 2.0 * math.pi * R**2 / x**3, 0.0, 1.0, epsrel=1e-11, limit=200)
    return value


@pytest.mark.parametrize("k", [0.0, 0.3])
def test_load_and_energy_behind_the_mesh(k):
    """The surface there is that of a load far away: w falls with r^-(1+k)."""
    _, plain, tail, y = _contacts(k)
    R, law, height = plain.compliance.trace.extent * SIZE, plain.law, plain.punch.height

    def rise(r):
        return AT_EDGE * (R / r) ** (1.0 + k)

    def gap(r):
        return float(height(np.array(r))) - DISPLACEMENT

    load = _beyond(plain, lambda r: float(law.traction(gap(r) + rise(r)) - law.traction(gap(r))))
    assert tail.load(y) - plain.load(y) == pytest.approx(load, abs=QUADRATURE * abs(plain.load_beyond(y)))
    surface = _beyond(plain, lambda r: float(law.energy(gap(r) + rise(r)) - law.energy(gap(r))))
    elastic = _beyond(plain, lambda r: 0.5 * rise(r) * float(law.traction(gap(r) + rise(r))))

    change = tail.energy(y) - plain.energy(y)
    assert abs(elastic) > 0.1 * abs(surface)
    assert change == pytest.approx(surface + elastic, abs=QUADRATURE * (abs(surface) + abs(elastic)))


@pytest.mark.parametrize("law", [None, Mie(1.0, 1.0, m=9.0, n=1.1)])
def test_the_gradient_of_the_load_is_its_derivative(law):
    """Under a slow law the quadrature lost 2 % of the load beyond, so that the load did not change as its gradient."""
    _, plain, tail, y = _contacts(0.3)
    h = 1e-6
    for contact in (plain, tail):
        contact = replace(contact, force=Derjaguin(contact.punch, law or contact.law))
        for index in (0, int(tail.compliance.trace.nodes.size) - 1, -2, -1):
            step = np.zeros(y.size)
            step[index] = h
            slope = (contact.load(y + step) - contact.load(y - step)) / (2 * h)
            assert contact.load_gradient(y)[index] == pytest.approx(slope, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize(("growth", "n"), [(2.0, 3.0), (2.0, 1.1), (2.0, 1.001), (1.0, 2.1), (10.0, 4.0)])
def test_the_load_beyond_a_distant_end_is_that_of_a_power(growth, n):
    """R^2 p(R)/(m g - 2), up to the height of the end; m g - 2 from 0.002 to 38."""
    punch, law, R = PowerPunch(growth, 1.0), Mie(1.0, 1.0, m=20.0, n=n), 1e13 ** (1.0 / growth)
    r, weight = far_rule(24, Derjaguin(punch, law), R)
    load = float((weight * r) @ law.traction(punch.height(r)))
    assert load == pytest.approx(R**2 * float(law.traction(punch.height(R))) / (n * growth - 2.0), rel=1e-11)


def test_the_traction_behind_the_mesh_moves_the_surface_by_the_integral_of_a_homogeneous_half_space():
    """Far from the axis a pressure p(r) moves it by 2/E* times the integral of p dr."""
    problem, plain, tail, y = _contacts(0.0)
    R, E_star = plain.compliance.trace.extent * SIZE, problem.solid.E0 / (1.0 - problem.solid.nu**2)
    expected = 2.0 / E_star * _beyond(plain, lambda r: float(_traction(tail, r, R)) / (2.0 * math.pi * r))
    moved = (Contact.residual(plain, y) - tail.residual(y))[: plain.compliance.trace.nodes.size]
    assert moved == pytest.approx(np.full(moved.size, expected), rel=POINT_LOAD)


def _traction(contact, r, R):
    return contact.law.traction(contact.punch.height(np.array(r)) - DISPLACEMENT + AT_EDGE * R / r)
