"""Potential of a punch of any shape in the integral equation: its table, its energy, its tail, and a contact."""

import math

import numpy as np
import pytest

import fscm
from fscm import Coating, Homogeneous, LennardJones, PowerPunch, PowerSum, Problem, RoundedCone
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
from tests.solvers.potentials import composite

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
#: Several seconds each, with charts that the others have.
LONG = ("reentrant", "sum")


@pytest.mark.parametrize("name", [*(name for name in SHAPES if name not in LONG), *heavy(*LONG)])
def test_the_table_is_the_quadrature_within_its_measured_error(name):
    """At contact, at the surface seen from there, and far away; the values of both charts."""
    punch = SHAPES[name]
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
