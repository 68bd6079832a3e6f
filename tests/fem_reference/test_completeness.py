"""Completeness of the path: no pair of turning points between two samples, and both ends of each jump."""

from itertools import pairwise

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from fem_reference import NotConverged
from fem_reference._contact import completeness
from fem_reference._contact.completeness import complete_path, displacement_range
from fem_reference._contact.events import PathEvents
from fem_reference._contact.mesh_choice import chosen
from tests.fem_reference.analytic_branch import AnalyticBranch
from tests.fem_reference.solved_together import problem_with


@pytest.mark.parametrize("shift", [0.0, 0.013, 0.4])
def test_a_hidden_pair_of_turning_points_is_found(shift):
    """A fall over 0.1 of the parameter, in samples 0.8 apart between which the function rises."""
    turns = np.array([shift - 0.05, shift + 0.05])
    slope = Polynomial.fromroots(turns) * Polynomial([1.0, 0.1, 0.02])
    branch = AnalyticBranch(slope.integ(), [0.0, 1.0])
    points = branch.points(np.arange(-2.2, 2.3, 0.8))
    assert all(point.displacement_rate > 0 for point in points)
    complete = complete_path(points)
    changes = [
        (a.parameter, b.parameter) for a, b in pairwise(complete) if a.displacement_rate * b.displacement_rate < 0
    ]
    assert len(changes) == 2
    for (low, high), turn in zip(changes, turns, strict=True):
        assert low <= turn <= high


def test_a_path_that_stays_undecided_is_refused(monkeypatch):
    slope = Polynomial.fromroots([0.0, 1e-3]) * Polynomial([1.0, 0.1, 0.02])
    points = AnalyticBranch(slope.integ(), [0.0, 1.0]).points(np.arange(-2.2, 2.3, 0.8))
    assert len(complete_path(points)) > len(points)
    monkeypatch.setattr(completeness, "ROUNDS", 1)
    with pytest.raises(NotConverged, match="pair of turning points"):
        complete_path(points)


def test_a_path_that_turns_back_between_the_branches_is_refused():
    approach = AnalyticBranch(Polynomial([0.0, -1.0]), [0.0, -1.0], touching=False).points([3.0, 2.0, 1.0])
    touching = AnalyticBranch(Polynomial([-1.0, -1.0]), [-1.0, -1.0]).points([0.0, 1.0, 2.0])
    with pytest.raises(NotConverged, match="turns back"):
        complete_path([*approach, *touching])


def test_the_range_includes_turning_points_between_samples():
    low, high = displacement_range(
        AnalyticBranch(Polynomial([0.0, -1.0, 0.0, 1.0]), [0.0, 1.0]).points([-1.0, 0.0, 1.0])
    )
    assert (low, high) == pytest.approx((-2 / 27**0.5, 2 / 27**0.5))


def test_a_level_reached_only_at_a_turning_point_between_samples_counts():
    """The load falls below zero and rises again between two samples with compression."""
    branch = AnalyticBranch(Polynomial([0.0, 1.0]), Polynomial.fromroots([-3.0, 0.2, 0.3]).coef)
    events = PathEvents(branch.points([-4.0, -2.0, -1.0, 0.0, 0.5, 1.0, 2.0]))
    assert events.zero_load.parameter == pytest.approx(0.3)


def test_the_path_begins_beyond_the_jump_out_of_contact():
    """The jump out of a soft solid ends at a distance of 13 lengths of the law; on the coarsest mesh alone."""
    choice, spec, size = chosen(problem_with(0.0, 8.0), ("zero_load",), "quick")
    points = choice.search_path(spec, size).points
    assert points[0].state.displacement < min(p.state.displacement for p in points if p.branch.touching) < -12.0
