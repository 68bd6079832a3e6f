"""Laws that are no powers under the potential of a punch: a ball exactly, other faces by their curvature."""

import numpy as np
import pytest

from fscm import Ball, Homogeneous, LennardJones, PowerPunch, Problem, RoundedCone, TabulatedLaw, solve
from fscm._ball import BallUnderLaw, BallUnderMie
from fscm._curved_face import CurvedFace
from fscm.custom_punch import CustomPunch
from fscm.interaction import interaction_of
from fscm.measured_punch import MeasuredPunch
from fscm.punch import ScaledPunch
from tests.refusals import refused

LAW = LennardJones()


def table(law=LAW):
    gap = law.z0 * (np.geomspace(0.6, 100.0, 400) - 1.0)
    return TabulatedLaw(gap, law.traction(gap), z0=law.z0, tail_exponent=3.0)


@pytest.mark.parametrize("unit", [None, (4.0, 0.5)])
def test_a_ball_under_any_law_is_that_of_its_atoms(unit):
    punch = Ball(20.0) if unit is None else ScaledPunch(Ball(20.0), *unit)
    exact, force = BallUnderMie(punch, LAW), BallUnderLaw(punch, LAW)
    r, gap = np.array([0.5, 2.0, 3.0, 30.0, 100.0, 250.0]), np.array([0.2, 0.5, 2.0, 400.0, 9000.0, 90000.0])
    assert force.traction(r, gap) == pytest.approx(exact.traction(r, gap), rel=1e-12)
    assert force.slope(r, gap) == pytest.approx(exact.slope(r, gap), rel=1e-10)
    assert force.drift(r, gap) == pytest.approx(exact.drift(r, gap), rel=1e-10)
    assert force.peak_gap(r[:3]) == pytest.approx(exact.peak_gap(r[:3]), abs=1e-12)
    assert force.energy(r, gap) == pytest.approx(exact.energy(r, gap), rel=1e-10)
    assert isinstance(interaction_of(punch, table(), "body"), BallUnderLaw)


@pytest.mark.parametrize("punch", [PowerPunch(2.0, 100.0), PowerPunch(3.0, 1e4), RoundedCone(20.0, 2.0)], ids=repr)
def test_curvatures_give_the_potential_within_their_estimate(punch):
    exact, force = interaction_of(punch, LAW, "body"), CurvedFace(punch, LAW)
    r, gap = np.meshgrid([1e-3, 1.0, 3.0, 10.0, 30.0, 100.0], [-0.1, 0.2, 1.0, 5.0])
    error = np.abs(force.traction(r, gap) - exact.traction(r, gap))
    left_out = force.remainder(r, gap)
    assert np.all(error <= left_out)
    assert np.sum(error) < 0.1 * np.sum(np.abs(LAW.traction(gap) - exact.traction(r, gap)))
    assert np.all(left_out[1] < 0.1 * np.abs(exact.traction(r, gap)[1]))


@pytest.mark.parametrize("punch", [RoundedCone(20.0, 2.0), ScaledPunch(PowerPunch(3.0, 1e4), 5.0, 0.5)], ids=repr)
def test_slopes_energy_and_peak_belong_to_the_traction(punch):
    force, step = CurvedFace(punch, table()), 1e-5
    r, gap = np.array([0.2, 3.0, 9.0]), np.array([0.3, 0.7, 5.0])
    ends = [force.traction(r, gap + sign * step) for sign in (1.0, -1.0)]
    assert force.slope(r, gap) == pytest.approx((ends[0] - ends[1]) / (2.0 * step), rel=1e-6)
    ends = [force.traction(r * (1.0 + sign * step), gap) for sign in (1.0, -1.0)]
    assert force.drift(r, gap) == pytest.approx((ends[0] - ends[1]) / (2.0 * step), rel=1e-5)
    ends = [force.energy(r, gap + sign * 2e-4) for sign in (1.0, -1.0)]
    assert force.traction(r, gap) == pytest.approx((ends[1] - ends[0]) / 4e-4, rel=1e-5)
    at_peak = force.slope(r, force.peak_gap(r))
    assert np.max(np.abs(at_peak)) < 1e-9 * np.max(np.abs(force.slope(r, gap)))
    outside, inside = force.peak_gap(3.0 * np.exp(np.array([1e-3, -1e-3])))
    assert force.peak_drift(3.0) == pytest.approx((outside - inside) / 2e-3, rel=1e-4)


def test_what_is_left_out_is_in_the_part_of_the_law():
    law = table(LennardJones(1e-3, 0.01))
    problem = Problem(Homogeneous(0.91, nu=0.3), PowerPunch(2.0, 1.0), law, interaction="body")
    force = solve(problem, "pull_off_force")
    # The 9-3 law has 1.3e-4 more.
    assert 2e-4 * force.value < force.parts["law"] < 5e-3 * force.value
    assert force.u_num - force.parts["law"] < 1e-8 * force.value


def test_a_table_needs_a_smooth_convex_face():
    hollow = CustomPunch(lambda x: x**2 / 200 + 1 - np.cos(x / 5), 2.0, lambda x: x / 100 + np.sin(x / 5) / 5)
    kinked = MeasuredPunch([0.0, 4.0, 9.0], [0.0, 0.5, 6.0])
    for punch, reason in ((PowerPunch(1.0, 2.0), "tip"), (hollow, "hollow"), (kinked, "kink")):
        refused(reason, interaction_of, punch, table(), "body")
