"""Potential of a punch of any shape under any powers: its atoms, table, and energy, the rigid solid, and a contact."""

import math

import numpy as np
import pytest
import scipy

import fscm
from fscm import Ball, Coating, Homogeneous, LennardJones, Mie, PowerPunch, PowerSum, Problem, RoundedCone
from fscm._ball import BallUnderMie
from fscm._potential import Profile, log_powers
from fscm._potential_table import power_table
from fscm._surface.breaks import initial_mesh
from fscm._surface.discretisation import Discretisation
from fscm._surface.linearisation import rates_by
from fscm._surface.newton import newton
from fscm._surface.state import Control, rigid_state
from fscm._surface.tail_of_body import TailOfBody
from fscm.measured_punch import MeasuredPunch
from fscm.punch import ScaledPunch
from tests.marks import heavy
from tests.refusals import refused

GAUSS = np.polynomial.legendre.leggauss(24)
SHAPES = {
    "cone": PowerPunch(1.0, 2.0),
    "steep cone": PowerPunch(1.0, 0.4),
    "n = 1.5": PowerPunch(1.5, 3.0),
    "n = 3": PowerPunch(3.0, 400.0),
    "rounded cone": RoundedCone(5.0, 2.0),
    "sum": PowerSum([0.05, 1e-4], [2.0, 4.0]),
    "kinked": MeasuredPunch([0.0, 4.0, 9.0], [0.0, 0.5, 6.0], growth=1.0),
    "reentrant": MeasuredPunch([0.0, 4.0, 9.0, 12.0], [0.0, 6.0, 2.0, 20.0]),
}
by_shape = pytest.mark.parametrize("punch", SHAPES.values(), ids=SHAPES.keys())


def composite(ends):
    """Nodes and weights of a Gauss rule on each interval between neighbours."""
    x, w = GAUSS
    half = 0.5 * np.diff(ends)
    return ((ends[:-1] + half)[:, None] + half[:, None] * x).ravel(), (half[:, None] * w).ravel()


def power_by_columns(punch, m, x, v):
    """p_m of the atoms in vertical columns around the point; in closed form along a column."""
    a, levels = 0.5 * (m + 3.0), float(punch.height(np.array(x))) - v
    s, weight = composite(np.concatenate([[0.0], v * np.geomspace(0.1, 1e4, 16)]))
    count = 240
    phi = math.pi * (np.arange(count) + 0.5)[:, None] / count
    h = punch.height(np.sqrt(np.maximum(x * x + s * s + 2.0 * x * s * np.cos(phi), 0.0))) - levels
    whole = 0.5 * s ** (1.0 - 2.0 * a) * scipy.special.beta(a - 0.5, 0.5)
    above = whole * scipy.special.betainc(a - 0.5, 0.5, s * s / (s * s + h * h))
    density = np.where(h > 0.0, above, 2.0 * whole - above) * s
    return m * (m + 1.0) / (2.0 * math.pi) * 2.0 * math.pi / count * float(np.sum(density @ weight))


@by_shape
def test_the_powers_are_those_of_all_atoms(punch):
    """Real exponents.  The columns resolve a kink to 1e-4, and a pointed tip from the places beside it."""
    kinked, pointed = hasattr(punch, "kinks"), punch.growth < 2.0
    tolerance = 1e-4 if kinked else 1e-7 if pointed else 1e-10
    exponents = (12.0, 4.7, 3.0)
    points = ((0.0, 0.8), (3.0, 1.3), (4.0, 2.0), (9.5, 30.0))
    for x, v in points[:3] if kinked or pointed else points:
        radius, depth = np.array([x]), np.array([v])
        logs = log_powers(Profile(punch, 1.0), exponents, radius, punch.height(radius) - depth, depth)[:, 0]
        for m, log_p in zip(exponents, logs, strict=True):
            assert math.exp(log_p) * v**-m == pytest.approx(power_by_columns(punch, m, x, v), rel=tolerance)


@by_shape
def test_the_table_is_the_quadrature_within_its_measured_error(punch):
    """At contact, at the surface seen from there, and far away; the values of both charts."""
    table, exponents = power_table(ScaledPunch(punch, 3.0, 1.0), (12.0, 3.0)), np.array([[12.0], [3.0]])
    r = np.array([0.0, 0.4, 1.3, 2.9, 3.1, 40.0])
    f = punch.height(3.0 * r)
    for v in (np.full_like(r, 1.1), f + 0.6):
        value, by_depth, by_radius = table(r, v)
        exact = log_powers(Profile(punch, 1.0), (12.0, 3.0), 3.0 * r, f - v, v, finer=3.0) - exponents * np.log(v)
        noise = 1e-14 * (1.0 + f / v) * (1.0 + punch.slope(3.0 * np.maximum(r, 1e-30))) ** 2
        assert np.all(np.abs(value - exact) < 5e-13 + 10.0 * noise)
        assert np.all(table.error(r, v) < 5e-12 + 10.0 * noise)
        step = 1e-5
        ends = [table(r, v * (1.0 + sign * step))[0] for sign in (1.0, -1.0)]
        assert by_depth * v == pytest.approx((ends[0] - ends[1]) / (2.0 * step), rel=1e-5, abs=1e-5)
        ends = [table(r * (1.0 + sign * step), v)[0] for sign in (1.0, -1.0)]
        assert by_radius == pytest.approx((ends[0] - ends[1]) / (2.0 * step), rel=1e-4, abs=1e-5)


def test_a_sphere_acts_as_its_ball():
    """Under steep powers, for which the atoms beyond the sphere of the profile do not count: the closed form."""
    law, ball = Mie(m=14.0, n=10.5), Ball(200.0)
    of_profile = fscm.interaction.BodyOfRevolution(ScaledPunch(ball, 15.0, 1.0), law)
    closed = BallUnderMie(ScaledPunch(ball, 15.0, 1.0), law)
    r, gap = np.array([0.0, 0.5, 2.0, 4.0]), np.array([0.1, -0.1, 3.0, 1.0])
    for name in ("traction", "slope", "drift"):
        expected, size = getattr(closed, name)(r, gap), closed.size(r, gap)
        assert np.all(np.abs(getattr(of_profile, name)(r, gap) - expected) < 1e-9 * size)
    assert of_profile.energy(r, gap) == pytest.approx(closed.energy(r, gap), rel=1e-10)
    assert of_profile.peak_gap(r) == pytest.approx(closed.peak_gap(r), rel=1e-9)


@pytest.mark.parametrize(("name", "law"), [("n = 1.5", Mie(m=12.0, n=6.0)), *heavy(("kinked", Mie(m=8.5, n=3.7)))])
def test_over_a_rigid_plane_the_load_is_that_of_vertical_gaps(name, law):
    """Slices of the punch are parallel to the plane, so that the force of all atoms is that of the law."""
    punch, gap = SHAPES[name], 0.2
    body = fscm.interaction.BodyOfRevolution(punch, law)
    kinks = [4.0, 9.0] if name == "kinked" else []
    r, weight = composite(np.sort(np.concatenate([[0.0], np.geomspace(1e-3, 1e7, 60), kinks])))
    loads = [float((weight * r) @ body.traction(r, gap + punch.height(r)))]
    loads.append(float((weight * r) @ law.traction(gap + punch.height(r))))
    assert loads[0] == pytest.approx(loads[1], rel=1e-8)


def posed(punch, softness=1e-3, law=None, solid=None):
    """R = 1 or a like size, on E* = 1, of the Tabor number 1 for a sphere."""
    law = law or LennardJones(softness, softness ** (2 / 3))
    return Problem(solid or Homogeneous(0.91, 0.3), punch, law, interaction="body")


@pytest.mark.heavy
def test_the_energy_of_a_cone_changes_by_the_work():
    """Its tail diverges as the logarithm of the radius; what differs between states is finite."""
    state, h = fscm.Analysis(posed(PowerPunch(1.0, 2.0)).dimensionless).event("pull_off").value, 1e-5
    rates = rates_by(state, "log_scale")
    ends = [
        newton(
            state.shifted(rates.unknowns, rates.displacement, rates.log_scale, sign * h),
            Control(math.log(state.scale) + sign * h, log_scale=1.0),
            1e-12,
        )
        for sign in (1.0, -1.0)
    ]
    work = state.load * (ends[0].displacement - ends[1].displacement)
    assert ends[0].energy - ends[1].energy == pytest.approx(work, rel=1e-4)


def tails_of_cone():
    """Tails beyond two radii, a rule between these, and the gaps there."""
    problem = posed(PowerPunch(1.0, 2.0)).dimensionless
    r, weight = composite(np.geomspace(300.0, 900.0, 12))
    return (
        problem.force,
        *(TailOfBody(problem, T, 0.7) for T in (300.0, 900.0)),
        r,
        weight,
        problem.punch.height(r) - 0.7,
    )


def test_the_load_of_the_tail_of_a_cone_does_not_depend_on_its_beginning():
    """Within the bound of what is beyond the quadrature."""
    force, inner, outer, r, weight, gap = tails_of_cone()
    load = 2.0 * float((weight * r) @ force.traction(r, gap))
    bound = sum(tail.errors(energy=False)[1][0] for tail in (inner, outer))
    assert 0.0 < bound < 1e-5 * abs(load)
    assert abs(inner.load[0] - outer.load[0] - load) <= bound


@pytest.mark.heavy
def test_the_divergent_energy_of_the_tail_of_a_cone_does_not_either():
    force, inner, outer, r, weight, gap = tails_of_cone()
    between = 2.0 * float((weight * r) @ force.energy(r, gap))
    assert inner.energy - outer.energy == pytest.approx(between, rel=1e-7)


@pytest.mark.heavy
def test_a_layer_of_the_same_solid_changes_nothing():
    """Bodies that are no power law have the tail of any punch as well."""
    same = Coating(0.91, 0.91, 0.2, 0.05, 0.3)
    values = [fscm.solve(posed(PowerPunch(2.0, 1.0), solid=solid), "pull_off_force") for solid in (None, same)]
    assert abs(values[0].value - values[1].value) <= values[0].u_num + values[1].u_num


@pytest.mark.heavy
@pytest.mark.parametrize("punch", [PowerPunch(1.0, 2.0), RoundedCone(0.3, 0.5), RoundedCone(0.3, 2.0)])
def test_the_pull_off_force_is_that_of_finer_meshes(punch):
    coarse, fine = (fscm.solve(posed(punch), "pull_off_force", accuracy) for accuracy in ("default", "fine"))
    assert coarse.u_num < 1e-10 * coarse.value
    assert abs(coarse.value - fine.value) <= coarse.u_num + fine.u_num


STEEP = Problem(Homogeneous(0.91, nu=0.3), PowerPunch(6.0, 1.0), LennardJones(1e-3, 0.01), interaction="body")


def test_a_surface_at_rest_stays_at_its_level_far_out_in_a_step_of_the_scale():
    """A gap that is linear in log c moves it by half of the height: the path of r^6 then takes hundreds of steps."""
    problem = STEEP.dimensionless
    state = rigid_state(Discretisation(problem, initial_mesh(problem, 8, 1e6)), 1.0)
    step = 1e-6
    wider = state.of_problem(state.disc, math.exp(step)).with_deformation(np.zeros(state.disc.mesh.size))
    moved = state.shifted((wider.unknowns - state.unknowns) * (0.5 / step), 0.0, 0.5)
    level = problem.punch.height(moved.radius) - moved.gap
    assert np.max(problem.punch.height(moved.radius)) > 1e5
    assert np.max(np.abs(level - state.displacement)) < 1e-3


def test_far_out_the_distance_opens_by_the_move_of_the_point_and_not_by_the_gap():
    """Weighed by the gap, which is 1e16 there, a mesh would resolve a traction of 1e-21."""
    problem = STEEP.dimensionless
    r = np.array([[0.01, 60.0], [0.02, 70.0]])
    H = problem.punch.height(r) + 1.0
    near, far = problem.force.opening(r, H)
    assert near == pytest.approx(H[1, 0] - H[0, 0], rel=1e-12)
    unit = problem.punch.radius / problem.punch.height_unit
    assert far == pytest.approx(10.0 * unit, rel=1e-9)


def test_what_has_no_potential_is_refused():
    solid = Homogeneous(1.0, 0.3)
    refused("as slender as a cone", Problem, solid, PowerPunch(0.8, 1.0), LennardJones(), interaction="body")
