"""Choice of the mesh where contact begins on a small spot, where the edge is very narrow, and where a path fails."""

import math

import numpy as np
import pytest

from fem_reference import CustomPunch, LennardJones, NotConverged, PowerLaw, Problem, solve
from fem_reference._contact.mesh_choice import MeshChoice
from fem_reference._elastic.mesh import graded_grid
from fem_reference.accuracy import level_for
from tests.fem_reference.solved_together import problem_with

#: The edge is 1e-10 of its radius wide.
UNRESOLVED = problem_with(0.8778961468202925, 5.103826446508255, 1.8234594621046147, 0.3894883306671959)

#: At k = 0, mu = 3, by the integral equation; all digits shown.
CONE_JUMP_OUT_GAP = -0.03186462


def test_an_edge_that_no_mesh_resolves_is_refused():
    with pytest.raises(NotConverged, match="of its radius, and the smallest that are meshed"):
        solve(UNRESOLVED, "pull_off_force", "quick")


def test_far_elements_have_a_share_of_the_density():
    plain, finer = (graded_grid(1.0, 0.01, 0.01, 1000.0, 1.2, 0.05, far_share=share).r for share in (1.0, 0.5))
    assert np.array_equal(graded_grid(1.0, 0.01, 0.01, 1000.0, 1.2, 0.05).r, plain)
    far = finer[finer >= 2.0 * (1.0 - 1e-12)]
    assert np.max(far[1:] / far[:-1]) <= math.exp(0.6) * (1.0 + 1e-12) < np.max(plain[-5:] / plain[-6:-1])
    assert (finer[0], finer[-1]) == (0.0, 1000.0)
    assert 1.0 in finer
    for share in (0.0, 1.5):
        with pytest.raises(ValueError, match="share of the density"):
            graded_grid(far_share=share)


@pytest.mark.heavy
def test_an_edge_that_does_not_settle_is_searched_with_a_mesh_for_each_radius():
    """A flat end whose edge has the curvature radius 1: the deepest load was elsewhere on each mesh."""

    def outside(r):
        return np.maximum(r - 0.05, 0.0)

    punch = CustomPunch(lambda r: outside(r) ** 2 / 2.0, 2.0, outside, kinks=(0.05,))
    problem = Problem(PowerLaw(1.0, 1.0, 0.3, 0.3), punch, LennardJones(0.0005, 0.004))
    choice, spec, size = MeshChoice(problem, level_for("quick")).adapted(("pull_off",))
    assert choice.event == "pull_off"
    assert spec.edge_width > 1e-3
    finest = choice.traced(spec, size)
    assert finest.at("pull_off").edge_radius == pytest.approx(size, rel=0.01)
    assert finest.at("pull_off").state.load == pytest.approx(-3.7757154e-3, rel=1e-5)


def test_the_gap_under_the_tip_of_a_cone_is_certain():
    """The pressure is singular there: with elements at the tip like those of a sphere the bound was 9 % of the gap."""
    gap = solve(problem_with(0.0, 3.0, n=1.0), "jump_out_gap", "quick")
    assert gap.u_num <= 1e-3 * abs(gap.value)
    assert gap.value == pytest.approx(CONE_JUMP_OUT_GAP, abs=gap.u_num)
