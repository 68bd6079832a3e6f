"""Completeness of the path: no pair of turning points between two samples, and both ends of each jump."""

import math
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from fem_reference import LennardJones, NotConverged, Problem, solve_together, trace
from fem_reference._contact import completeness, path
from fem_reference._contact.completeness import complete_path, displacement_range
from fem_reference._contact.events import PathEvents
from fem_reference._contact.hermite import Interval, Sample
from fem_reference._contact.mesh_choice import chosen
from fem_reference._contact.path import Point
from tests.fem_reference.solved_together import problem_with


class AnalyticBranch:
    """A branch whose displacement and load are polynomials of the parameter."""

    def __init__(self, displacement, load, touching=True):
        self.displacement, self.load, self.touching = Polynomial(displacement), Polynomial(load), touching
        self.contact = SimpleNamespace(law=SimpleNamespace(z0=1.0))

    def largest_step(self, parameter):
        return math.inf

    def solve(self, t, y):
        state = SimpleNamespace(
            displacement=self.displacement(t),
            displacement_rate=self.displacement.deriv()(t),
            load=self.load(t),
            load_rate=self.load.deriv()(t),
            y=np.ones(1),
            rate=np.zeros(1),
            size=1.0,
            iterations=1,
        )
        return Point(self, t, state)

    def points(self, parameters):
        return [self.solve(t, None) for t in parameters]


@pytest.mark.parametrize("shift", [0.0, 0.013, 0.4])
def test_a_hidden_pair_of_turning_points_is_found(shift):
    """A fall over 0.1 of the parameter, in samples 0.8 apart between which the function rises."""
    turns = np.array([shift - 0.05, shift + 0.05])
    slope = Polynomial.fromroots(turns) * Polynomial([1.0, 0.1, 0.02])
    branch = AnalyticBranch(slope.integ().coef, [0.0, 1.0])
    points = branch.points(np.arange(-2.2, 2.3, 0.8))
    assert all(point.displacement_rate > 0 for point in points)
    complete = complete_path(points)
    changes = [
        (a.parameter, b.parameter) for a, b in pairwise(complete) if a.displacement_rate * b.displacement_rate < 0
    ]
    assert len(changes) == 2
    for (low, high), turn in zip(changes, turns, strict=True):
        assert low <= turn <= high


def test_a_path_that_rises_all_along_needs_no_sample():
    points = AnalyticBranch([0.0, 1.0, 0.2, 0.05, 0.01], [0.0, 1.0, 0.3]).points(np.linspace(0.0, 2.0, 6))
    assert complete_path(points) == points


def test_an_interval_without_neighbours_is_not_decided():
    ends = Sample(0.0, 0.0, 1.0), Sample(1.0, 1.0, 1.0)
    assert not Interval(*ends, []).decided(1e-9)
    assert Interval(*ends, [Sample(2.0, 2.0, 1.0)]).decided(1e-9)
    # The neighbour shows a fourth difference larger than the slope.
    assert not Interval(*ends, [Sample(2.0, 20.0, 1.0)]).decided(1e-9)


def test_a_path_that_stays_undecided_is_refused(monkeypatch):
    slope = Polynomial.fromroots([0.0, 1e-3]) * Polynomial([1.0, 0.1, 0.02])
    points = AnalyticBranch(slope.integ().coef, [0.0, 1.0]).points(np.arange(-2.2, 2.3, 0.8))
    assert len(complete_path(points)) > len(points)
    monkeypatch.setattr(completeness, "ROUNDS", 1)
    with pytest.raises(NotConverged, match="pair of turning points"):
        complete_path(points)


def test_a_path_that_turns_back_between_the_branches_is_refused():
    approach = AnalyticBranch([0.0, -1.0], [0.0, -1.0], touching=False).points([3.0, 2.0, 1.0])
    touching = AnalyticBranch([-1.0, -1.0], [-1.0, -1.0]).points([0.0, 1.0, 2.0])
    with pytest.raises(NotConverged, match="turns back"):
        complete_path([*approach, *touching])


def test_the_range_includes_turning_points_between_samples():
    low, high = displacement_range(AnalyticBranch([0.0, -1.0, 0.0, 1.0], [0.0, 1.0]).points([-1.0, 0.0, 1.0]))
    assert (low, high) == pytest.approx((-2 / 27**0.5, 2 / 27**0.5))


def test_a_level_reached_only_at_a_turning_point_between_samples_counts():
    """The load falls below zero and rises again between two samples with compression."""
    branch = AnalyticBranch([0.0, 1.0], Polynomial.fromroots([-3.0, 0.2, 0.3]).coef)
    events = PathEvents(branch.points([-4.0, -2.0, -1.0, 0.0, 0.5, 1.0, 2.0]))
    assert events.zero_load.parameter == pytest.approx(0.3)


@pytest.fixture(scope="module")
def folded():
    """Three folds before the contact edge is formed; two are within one step of the central gap."""
    return problem_with(0.7, 1.5, 3.3)


#: Values of the integral equation, solved with 85 points of an arc length.
FOLDED = {"jump_in_displacement": -2.2016538716, "jump_in_gap": 1.1841111197, "hysteresis_energy": 0.2888663007}


@pytest.mark.heavy
def test_the_jump_into_contact_is_the_first_fold(folded):
    """The next test has the gap of the jump alone."""
    found = solve_together(folded, tuple(FOLDED), "quick")
    for name, value in FOLDED.items():
        unit = math.pi if name == "hysteresis_energy" else 1.0
        assert abs(found[name].value / unit - value) <= found[name].u_num / unit, name
        assert found[name].u_num <= 1e-4 * unit
    samples = trace(folded, "quick").displacement
    first_fall = int(np.flatnonzero(np.diff(samples) < 0)[0])
    assert samples[: first_fall + 1].max() <= found["jump_in_displacement"].value + 1e-6


def _with_steps(monkeypatch, step):
    """The problem of three folds, whose path is traced with these steps of the gap: it has a key of its own."""
    monkeypatch.setattr(path, "GAP_STEP", step)
    problem = problem_with(0.7, 1.5, 3.3)
    return Problem(problem.solid, problem.punch, LennardJones(1.0 + step * 1e-12, 1.0))


@pytest.mark.heavy
@pytest.mark.parametrize("step", [0.05, 0.4])
def test_the_step_of_the_path_does_not_choose_the_fold(monkeypatch, step):
    """Steps of the gap four times smaller and twice as large."""
    found = solve_together(_with_steps(monkeypatch, step), ("jump_in_gap",), "quick")
    assert found["jump_in_gap"].value == pytest.approx(FOLDED["jump_in_gap"], abs=2e-5)


def test_the_path_begins_beyond_the_jump_out_of_contact():
    """The jump out of a soft solid ends at a distance of 13 lengths of the law; its values are in the next test.

    On the coarsest mesh of the choice alone.
    """
    choice, spec, size = chosen(problem_with(0.0, 8.0), ("zero_load",), "quick")
    points = choice.search_path(spec, size).points
    assert points[0].state.displacement < min(p.state.displacement for p in points if p.branch.touching) < -12.0


@pytest.mark.heavy
def test_the_path_begins_where_the_jump_out_of_contact_ends():
    problem = problem_with(0.0, 8.0)
    found = solve_together(problem, ("jump_out_displacement", "hysteresis_energy"), "quick")
    energy = found["hysteresis_energy"]
    assert abs(energy.value / math.pi - 10.280270542) <= energy.u_num / math.pi <= 1e-4
    samples = trace(problem, "quick").displacement
    assert samples[0] < found["jump_out_displacement"].value < -12.0
