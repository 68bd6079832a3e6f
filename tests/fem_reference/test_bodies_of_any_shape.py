"""The potential of a punch of any profile under any exponents: its volume, a plane, a sphere, its bound."""

import math

import numpy as np
import pytest

import fem_reference._body_of_revolution as potential
from fem_reference import (
    Ball,
    CustomPunch,
    LennardJones,
    MeasuredPunch,
    Mie,
    NeoHookean,
    PowerLaw,
    PowerPunch,
    PowerSum,
    Problem,
    RoundedCone,
    solve,
    solve_large_strain,
)
from fem_reference._azimuth import azimuth
from fem_reference._face import Fineness
from fem_reference.interaction import Body, interaction_of
from fem_reference.punch import radius_at_height


def kinked_height(r):
    return r**2 / 40.0 + 0.3 * np.maximum(r - 6.0, 0.0)


def kinked_slope(r):
    return r / 20.0 + 0.3 * (r >= 6.0)


SHAPES = {
    "cone": PowerPunch(1.0, 2.0),
    "n = 1.5": PowerPunch(1.5, 4.0),
    "paraboloid": PowerPunch(2.0, 20.0),
    "n = 3": PowerPunch(3.0, 300.0),
    "n = 6": PowerPunch(6.0, 1e6),
    "slope 0.5": RoundedCone(2.0, 0.5),
    "slope 2": RoundedCone(2.0, 2.0),
    "sum": PowerSum((0.025, 1e-4), (2.0, 4.0)),
    "measured": MeasuredPunch((0.0, 2.0, 6.0, 12.0), (0.0, 0.1, 1.0, 4.0)),
    "own": CustomPunch(kinked_height, 2.0, kinked_slope, kinks=(6.0,)),
}
EXPONENTS = [(9.0, 3.0), (12.0, 6.0), (8.2, 2.7)]
by_shape = pytest.mark.parametrize("shape", SHAPES)
by_exponents = pytest.mark.parametrize("exponents", EXPONENTS, ids=lambda e: f"{e[0]:g}-{e[1]:g}")


def gauss(ends, count):
    """Nodes and weights of a rule on each interval between neighbours."""
    x, w = np.polynomial.legendre.leggauss(count)
    half = 0.5 * np.diff(ends)
    return ((ends[:-1] + half)[:, None] + half[:, None] * x).ravel(), (half[:, None] * w).ravel()


def power_by_volume(punch, m, x, v):
    """Power m of the law: columns of atoms above each place of the face, around the axis and outwards."""
    z, q = float(punch.height(np.array(x))) - v, m + 3.0
    near = np.concatenate([-np.geomspace(0.1, 1e3, 20)[::-1], [0.0], np.geomspace(0.1, 1e5, 30)]) * v + x
    t, weight = gauss(np.unique(np.concatenate([[0.0], near[near > 0.0], [2.0, 6.0, 12.0]])), 10)
    count = 2 * math.ceil(16.0 * (1.0 + x / v * math.hypot(1.0, float(punch.slope(np.array(x))))))
    w, of_w = gauss(np.array([0.0, 0.5, 1.0]), 14)
    total = 0.0
    for cosine in np.cos(2.0 * math.pi * (np.arange(count) + 0.5) / count):
        away = np.sqrt(t * t + x * x - 2.0 * t * x * cosine)
        lowest = np.arctan2(away, punch.height(t) - z)  # angle from the vertical to the lowest atom of a column
        column = (np.sin(np.outer(lowest, w * w)) ** (q - 2.0) * 2.0 * w) @ of_w * lowest
        total += float((weight * t * away ** (1.0 - q)) @ column)
    return m * (m + 1.0) / count * total


@by_exponents
@by_shape
def test_the_traction_is_that_of_all_atoms_of_the_volume(shape, exponents):
    body = interaction_of(SHAPES[shape], Mie(1.0, 1.0, *exponents), "body")
    for x, v in ((0.0, 0.9), (1.5, 1.1), (6.0, 1.4)):
        exact = [power_by_volume(body.punch, m, x, v) for m in exponents]
        strength = body.law.powers[0][0]
        traction = float(body.traction(np.array(x), np.array(v - 1.0)))
        assert traction == pytest.approx(strength * (exact[0] - exact[1]), abs=1e-8 * strength * sum(exact))


@by_exponents
@by_shape
@pytest.mark.parametrize("gap", [0.0, 3.0])
def test_over_a_plane_the_load_is_that_of_vertical_gaps(shape, exponents, gap):
    """Slices of the punch are parallel to the plane, whatever its shape."""
    law = Mie(1.0, 1.0, *exponents)
    body = interaction_of(SHAPES[shape], law, "body")
    octaves = np.concatenate([[0.0], np.geomspace(1e-5, 1.0, 12), np.geomspace(1.0, 1e14, 280), [2.0, 6.0, 12.0]])
    r, weight = gauss(np.unique(octaves), 10)
    height = body.punch.height(r)
    near = height < 1e14  # nothing is left farther away
    r, weight, height = r[near], weight[near], height[near]
    loads = [float((weight * r) @ p) for p in (body.traction(r, gap + height), law.traction(gap + height))]
    size = float((weight * r) @ np.abs(law.traction(gap + height)))
    assert loads[0] == pytest.approx(loads[1], abs=1e-6 * size)


def test_a_sphere_by_quadrature_is_a_ball():
    """Under powers that do not feel where the profile leaves the sphere."""
    law = Mie(1.0, 1.0, 12.0, 9.0)
    ball = Ball(400.0)
    sphere = sphere_of(ball, law)
    r = np.array([0.0, 3.0, 60.0, 250.0])
    for gap in (-0.1, 0.2, 3.0):
        forces = [
            force(r, np.full(4, gap))
            for kind in (Body, potential.BodyOfRevolution)
            for force in (kind(ball if kind is Body else sphere, law).traction,)
        ]
        assert forces[1] == pytest.approx(forces[0], rel=1e-9)


@pytest.mark.parametrize("shape", ["cone", "n = 1.5", "n = 6", "slope 2", "measured", "own"])
def test_slopes_energy_and_peak_belong_to_the_traction(shape):
    body, step = interaction_of(SHAPES[shape], Mie(1.0, 1.0, 8.2, 2.7), "body"), 1e-5
    r, gap = np.array([0.2, 3.0, 9.0, 30.0]), np.array([0.1, -0.1, 5.0, 30.0])
    by_radius, by_gap = body.slopes(r, gap)
    ends = [body.traction(r, gap + sign * step * (1.0 + gap)) for sign in (1.0, -1.0)]
    assert by_gap == pytest.approx((ends[0] - ends[1]) / (2.0 * step * (1.0 + gap)), rel=1e-6)
    ends = [body.traction(r * (1.0 + sign * step), gap) for sign in (1.0, -1.0)]
    scale = np.max(np.abs(by_gap * body.punch.slope(r)))
    assert by_radius == pytest.approx((ends[0] - ends[1]) / (2.0 * step * r), rel=1e-5, abs=1e-8 * scale)
    ends = [body.energy(r, gap + sign * 10 * step * (1.0 + gap)) for sign in (1.0, -1.0)]
    assert body.traction(r, gap) == pytest.approx((ends[1] - ends[0]) / (20.0 * step * (1.0 + gap)), rel=1e-5)
    peak = body.peak_gap(r)
    assert np.all(np.abs(body.slopes(r, peak)[1]) < 1e-7 * np.abs(body.traction(r, peak)))
    ends = [body.peak_gap(r * (1.0 + sign * 1e-3)) for sign in (1.0, -1.0)]
    assert body.peak_slope(r) == pytest.approx((ends[0] - ends[1]) / (2e-3 * r), rel=1e-3, abs=1e-6)


@by_shape
def test_the_quadrature_is_that_of_a_finer_one(shape):
    body = interaction_of(SHAPES[shape], Mie(1.0, 1.0, 12.0, 3.3), "body")
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


def pressed(punch, law, E=0.91, interaction="body"):
    return Problem(PowerLaw(E, 1.0, 0.0, 0.3), punch, law, interaction=interaction)


def test_the_bound_has_the_error_of_the_potential(monkeypatch):
    law = LennardJones(1e-3, 5e-2)
    exact = solve(pressed(PowerPunch(2.0, 1.0), law), "pull_off_force", "quick")
    # Another problem for the caches.
    problem = pressed(CustomPunch(lambda r: 0.5 * r * r, 2.0, lambda r: r), law)
    coarse = potential.BodyOfRevolution(problem.punch, law, Fineness(nodes=4, ratio=0.5, roughness=1e-2, beyond=1e-4))
    monkeypatch.setattr(Problem, "force", property(lambda _: coarse))
    rough = solve(problem, "pull_off_force", "quick")
    difference = abs(rough.value - exact.value)
    assert 10.0 * exact.u_num < difference <= rough.u_num + exact.u_num


def sphere_of(ball, law):
    """The same profile as a function, which grows far away as `Problem` finds it."""
    far = radius_at_height(ball, 1e4 * law.z0)
    growth = far * float(ball.slope(np.array(far))) / float(ball.height(np.array(far)))
    return CustomPunch(ball.height, growth, ball.slope, kinks=ball.kinks)


@pytest.mark.heavy
def test_the_pull_off_of_a_sphere_by_quadrature_is_that_of_a_ball():
    law = Mie(1e-3, 5e-2, 12.0, 9.0)
    ball, sphere = (
        solve(pressed(punch, law), "pull_off_force", "quick") for punch in (Ball(1.0), sphere_of(Ball(1.0), law))
    )
    assert sphere.value == pytest.approx(ball.value, abs=ball.u_num + sphere.u_num)


@pytest.mark.heavy
@pytest.mark.parametrize("nu", [0.3, 0.5])
def test_at_finite_strain_a_sphere_by_quadrature_is_a_ball(nu):
    law = Mie(1e-3, 2e-2, 12.0, 9.0)
    gel = NeoHookean(1.0 - nu**2, nu)
    ball, sphere = (
        solve_large_strain(Problem(gel, punch, law), "pull_off_force", interaction="body")
        for punch in (Ball(1.0), sphere_of(Ball(1.0), law))
    )
    assert sphere.value == pytest.approx(ball.value, abs=ball.u_num + sphere.u_num)


@pytest.mark.heavy
@pytest.mark.parametrize("shape", ["cone", "paraboloid"])
def test_a_stiff_solid_of_finite_strain_is_one_of_small_strain(shape):
    """The strain changes the force by its own size."""
    punch, law = SHAPES[shape], LennardJones(1e-3, 1.0)
    small = solve(pressed(punch, law), "pull_off_force", "quick")
    finite = solve_large_strain(Problem(NeoHookean(0.91, 0.3), punch, law), "pull_off_force", interaction="body")
    assert finite.value == pytest.approx(small.value, rel=2e-3)
