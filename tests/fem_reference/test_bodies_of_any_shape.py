"""The potential of a punch of any profile by the finite elements: its quadrature, its bound, a sphere, large strain."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

import fem_reference
import fem_reference._body_of_revolution as potential
from fem_reference._azimuth import azimuth
from fem_reference._face import Fineness
from fem_reference._vertical_line import energy_above
from fem_reference.interaction import interaction_of
from fem_reference.punch import radius_at_height
from tests.solvers.test_bodies_of_any_shape import SHAPES


@pytest.mark.parametrize("shape", SHAPES)
def test_the_quadrature_is_that_of_a_finer_one(shape):
    body = interaction_of(SHAPES[shape](fem_reference), fem_reference.Mie(1.0, 1.0, 12.0, 3.3), "body")
    r = np.concatenate([[0.0], np.geomspace(1e-4, 40.0, 30), [2.0, 6.0, 12.0]])
    for gap in (-0.15, 0.5, 20.0):
        powers, finer = (force._powers(r, np.full(r.size, gap)) for force in (body, body.finer))
        assert np.max(np.abs(powers[:, 0] / finer[:, 0] - 1.0)) < 1e-9


@pytest.mark.parametrize("orders", [(6.0, 3.0), (7.5, 4.5), (2.05, 13.37)])
def test_integrals_around_the_axis_are_those_of_equal_angles(orders):
    t, count = np.array([0.02, 0.3, 0.97]), 2000
    phi = 2.0 * math.pi * np.arange(count) / count
    square = t[:, None] + (1.0 - t[:, None]) * np.sin(0.5 * phi) ** 2
    for s, (g, k) in zip(orders, azimuth(orders).values(t), strict=True):
        around = np.mean(square**-s, axis=1), np.mean(np.cos(phi) * square**-s, axis=1)
        assert g == pytest.approx(around[0] * t ** (s - 0.5), rel=1e-12)
        assert k == pytest.approx(around[1] * t ** (s - 0.5) / (1.0 - t), rel=1e-11)


def test_an_energy_has_what_lies_beyond_its_last_piece():
    """Of a traction 1/(1 + gap)^1.1, a thousandth is left where the pieces end."""
    slow = SimpleNamespace(
        traction=lambda rho, gap: (1.0 + gap) ** -1.1, slopes=lambda rho, gap: (None, -1.1 * (1.0 + gap) ** -2.1)
    )
    gap = np.array([-0.1, 3.0])
    assert energy_above(slow, np.zeros(2), gap, -1.0) == pytest.approx(10.0 * (1.0 + gap) ** -0.1, rel=1e-9)


def pressed(punch, law, E=0.91, interaction="body"):
    return fem_reference.Problem(fem_reference.PowerLaw(E, 1.0, 0.0, 0.3), punch, law, interaction=interaction)


def test_the_bound_has_the_error_of_the_potential(monkeypatch):
    law = fem_reference.LennardJones(1e-3, 5e-2)
    exact = fem_reference.solve(pressed(fem_reference.PowerPunch(2.0, 1.0), law), "pull_off_force", "quick")
    # Another problem for the caches.
    problem = pressed(fem_reference.CustomPunch(lambda r: 0.5 * r * r, 2.0, lambda r: r), law)
    coarse = potential.BodyOfRevolution(problem.punch, law, Fineness(nodes=4, ratio=0.5, roughness=1e-2, beyond=1e-4))
    monkeypatch.setattr(fem_reference.Problem, "force", property(lambda _: coarse))
    rough = fem_reference.solve(problem, "pull_off_force", "quick")
    difference = abs(rough.value - exact.value)
    assert 10.0 * exact.u_num < difference <= rough.u_num + exact.u_num


def sphere_of(ball, law):
    """The same profile as a function, which grows far away as `Problem` finds it."""
    far = radius_at_height(ball, 1e4 * law.z0)
    growth = far * float(ball.slope(np.array(far))) / float(ball.height(np.array(far)))
    return fem_reference.CustomPunch(ball.height, growth, ball.slope, kinks=ball.kinks)


@pytest.mark.heavy
def test_the_pull_off_of_a_sphere_by_quadrature_is_that_of_a_ball():
    law = fem_reference.Mie(1e-3, 5e-2, 12.0, 9.0)
    ball, sphere = (
        fem_reference.solve(pressed(punch, law), "pull_off_force", "quick")
        for punch in (fem_reference.Ball(1.0), sphere_of(fem_reference.Ball(1.0), law))
    )
    assert sphere.value == pytest.approx(ball.value, abs=ball.u_num + sphere.u_num)


@pytest.mark.heavy
@pytest.mark.parametrize("nu", [0.3, 0.5])
def test_at_finite_strain_a_sphere_by_quadrature_is_a_ball(nu):
    law = fem_reference.Mie(1e-3, 2e-2, 12.0, 9.0)
    gel = fem_reference.NeoHookean(1.0 - nu**2, nu)
    ball, sphere = (
        fem_reference.solve_large_strain(fem_reference.Problem(gel, punch, law), "pull_off_force", interaction="body")
        for punch in (fem_reference.Ball(1.0), sphere_of(fem_reference.Ball(1.0), law))
    )
    assert sphere.value == pytest.approx(ball.value, abs=ball.u_num + sphere.u_num)


@pytest.mark.heavy
@pytest.mark.parametrize("shape", ["cone", "paraboloid"])
def test_a_stiff_solid_of_finite_strain_is_one_of_small_strain(shape):
    """The strain changes the force by its own size."""
    punch, law = SHAPES[shape](fem_reference), fem_reference.LennardJones(1e-3, 1.0)
    small = fem_reference.solve(pressed(punch, law), "pull_off_force", "quick")
    finite = fem_reference.solve_large_strain(
        fem_reference.Problem(fem_reference.NeoHookean(0.91, 0.3), punch, law), "pull_off_force", interaction="body"
    )
    assert finite.value == pytest.approx(small.value, rel=2e-3)
