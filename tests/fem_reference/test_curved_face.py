"""Laws that are no powers under the potential of a punch: a ball exactly, other faces by their curvature."""

import numpy as np
import pytest

from fem_reference import Ball, CustomPunch, LennardJones, PowerPunch, RoundedCone, TabulatedLaw
from fem_reference._curved_face import CurvedFace
from fem_reference.interaction import BodyUnderTable, interaction_of
from tests.refusals import refused


def table_of(law):
    gap = law.z0 * (np.geomspace(0.75, 30.0, 80) - 1.0)
    return TabulatedLaw(tuple(gap), tuple(law.traction(gap)), z0=law.z0, tail_exponent=3.0)


def test_a_ball_under_any_law_is_that_of_its_atoms():
    law = LennardJones(1.0, 1.0)
    exact, force = interaction_of(Ball(20.0), law, "body"), BodyUnderTable(Ball(20.0), law)
    r, gap = np.array([0.5, 3.0, 18.0, 30.0, 100.0, 250.0]), np.array([0.2, 0.5, 2.0, 40.0, 5000.0, 30000.0])
    assert force.traction(r, gap) == pytest.approx(exact.traction(r, gap), rel=1e-12)
    for slope, of_atoms in zip(force.slopes(r, gap), exact.slopes(r, gap), strict=True):
        assert slope == pytest.approx(of_atoms, rel=1e-9)
    assert force.peak_gap(r[:3]) == pytest.approx(exact.peak_gap(r[:3]), abs=1e-10)
    assert isinstance(interaction_of(Ball(20.0), table_of(law), "body"), BodyUnderTable)


@pytest.mark.parametrize("punch", [PowerPunch(2.0, 100.0), PowerPunch(3.0, 1e4), RoundedCone(20.0, 2.0)], ids=repr)
def test_curvatures_give_the_potential_within_their_estimate(punch):
    law = LennardJones(1.0, 1.0)
    exact, force = interaction_of(punch, law, "body"), CurvedFace(punch, law)
    r, gap = np.meshgrid([0.0, 1.0, 3.0, 10.0, 30.0, 100.0], [-0.1, 0.2, 1.0, 5.0])
    left_out = force.finer.traction(r, gap) - force.traction(r, gap)
    error = np.abs(force.traction(r, gap) - exact.traction(r, gap))
    assert np.all(error <= left_out)
    # Both the normal distance and the vertical gap leave more out.
    assert np.sum(error) < 0.1 * np.sum(np.abs(law.traction(gap) - exact.traction(r, gap)))
    assert np.all(left_out[1] < 0.1 * np.abs(exact.traction(r, gap)[1]))


def test_a_table_needs_a_smooth_convex_face():
    law = table_of(LennardJones(1.0, 1.0))
    hollow = CustomPunch(lambda x: x**2 / 200 + 1 - np.cos(x / 5), 2.0, lambda x: x / 100 + np.sin(x / 5) / 5)
    step = CustomPunch(lambda x: 9.0 * np.maximum(x - 4.0, 0.0), 1.0, lambda x: 9.0 * (x >= 4.0), kinks=(4.0,))
    for punch, reason in ((PowerPunch(1.0, 2.0), "tip"), (hollow, "hollow"), (step, "kink")):
        refused(reason, interaction_of, punch, law, "body")


def test_slopes_energy_and_peak_of_a_table_belong_to_the_traction():
    force, step = interaction_of(RoundedCone(20.0, 2.0), table_of(LennardJones(1.0, 1.0)), "body"), 1e-5
    r, gap = np.array([0.2, 3.0, 9.0]), np.array([0.3, 0.7, 5.0])
    by_radius, by_gap = force.slopes(r, gap)
    ends = [force.traction(r, gap + sign * step) for sign in (1.0, -1.0)]
    assert by_gap == pytest.approx((ends[0] - ends[1]) / (2.0 * step), rel=1e-6)
    ends = [force.traction(r + sign * step, gap) for sign in (1.0, -1.0)]
    assert by_radius == pytest.approx((ends[0] - ends[1]) / (2.0 * step), rel=1e-5)
    ends = [force.energy(r, gap + sign * 2e-4) for sign in (1.0, -1.0)]
    assert force.traction(r, gap) == pytest.approx((ends[1] - ends[0]) / 4e-4, rel=1e-5)
    at_peak = force.slopes(r, force.peak_gap(r))[1]
    assert np.max(np.abs(at_peak)) < 1e-9 * np.max(np.abs(by_gap))
    beside = [force.peak_gap(r + sign * step) for sign in (1.0, -1.0)]
    assert force.peak_slope(r) == pytest.approx((beside[0] - beside[1]) / (2.0 * step), rel=1e-4)
