"""Shapes of punches of the finite elements: heights, slopes, kinks and the meshes that follow them."""

import math

import numpy as np
import pytest

from fem_reference import (
    CustomPunch,
    LennardJones,
    MeasuredPunch,
    NotConverged,
    PowerLaw,
    PowerPunch,
    PowerSum,
    Problem,
    Punch,
    RoundedCone,
)
from fem_reference._contact.mesh_choice import chosen
from fem_reference._contact.mesh_lengths import kinks_within
from fem_reference._elastic.mesh import MeshSpec, graded_grid
from fem_reference._elastic.trace import trace_of
from fem_reference.punch import kinks_of

R = np.array([0.0, 0.3, 1.1, 4.0])


@pytest.mark.parametrize(
    "punch",
    [
        RoundedCone(rounding=0.5, cone_slope=2.0),
        PowerSum((0.5, 0.1), (2.0, 4.0)),
        PowerSum((1.0, -0.1, 0.5), (1.0, 1.5, 3.0)),
        MeasuredPunch((0.0, 1.0, 2.0), (0.0, 0.25, 2.0), growth=3.0),
        CustomPunch(lambda r: np.sqrt(1.0 + r**2) - 1.0, growth=1.0),
    ],
)
def test_slopes_are_those_of_the_heights(punch):
    assert isinstance(punch, Punch)
    h = 1e-6
    differences = (punch.height(R[1:] + h) - punch.height(R[1:] - h)) / (2 * h)
    assert punch.slope(R[1:]) == pytest.approx(differences, rel=1e-7)
    assert float(punch.height(np.array(0.0))) == 0.0
    assert np.shape(punch.slope(R)) == R.shape
    assert hash(punch) == hash(punch)


def test_a_rounded_cone_has_the_limits_of_both():
    punch = RoundedCone(rounding=1e-3, cone_slope=2.0)
    assert float(punch.height(np.array(1e-9))) == pytest.approx(2.0 * 1e-18 / 2e-3, rel=1e-9)
    assert float(punch.slope(np.array(1e3))) == pytest.approx(2.0, rel=1e-9)


def test_a_sum_of_one_power_is_a_power():
    assert PowerSum((0.5,), (2.0,)).height(R) == pytest.approx(PowerPunch(2.0, 1.0).height(R), rel=1e-15)


def test_a_measured_profile():
    punch = MeasuredPunch((0.0, 1.0, 2.0, 3.0), (0.0, 1.0, 2.0, 4.5))
    assert punch.kinks == (2.0, 3.0)
    assert punch.height(np.array([0.5, 2.5, 6.0])) == pytest.approx([0.5, 3.25, 18.0])
    assert punch.slope(np.array([2.0, 3.0])) == pytest.approx([2.5, 3.0])
    assert kinks_of(PowerPunch(2.0, 1.0)) == ()


def test_mesh_lines_at_kinks():
    kinks = (0.2, 0.7, 1.0 + 1e-9, 3.0)
    grid = graded_grid(apex_width=0.05, kinks=kinks)
    assert set(kinks) <= set(grid.r)
    assert 1.0 not in grid.r  # the kink beside it is the line there
    assert np.diff(grid.r).min() > 1e-3
    apart = graded_grid(apex_width=0.05, kinks=(0.2, 3.0)).r
    assert {0.2, 1.0, 3.0} <= set(apart)
    assert apart.size < 2 * graded_grid(apex_width=0.05).r.size
    spec = MeshSpec(0.1, 0.05, 100.0, 0.5, 4, kinks=(2.0,))
    assert 0.5 in spec.moved(4.0).grid().r


def test_derivatives_of_the_surface_functions():
    trace = trace_of(graded_grid(density=1.0), 6)
    s, h = np.array([0.01, 0.9, 1.3, 40.0]), 1e-6
    differences = (trace.evaluate(s * (1 + h)) - trace.evaluate(s * (1 - h))) / (2 * h * s[:, None])
    assert trace.slopes(s) == pytest.approx(differences, abs=1e-7 * np.abs(differences).max())
    node = trace.nodes[5:6]
    assert trace.slopes(node) == pytest.approx(trace.slopes(node * (1 + 1e-12)), rel=1e-9, abs=1e-9)


def _problem(punch):
    return Problem(PowerLaw(1.0, 1.0, 0.0, 0.3), punch, LennardJones(1.0, 1.0))


def test_only_kinks_in_reach_are_lines():
    r = np.linspace(0.0, 60.0, 121)
    found = kinks_within(_problem(MeasuredPunch(r[::2], r[::2] ** 2 / 2)))
    assert len(found) == 24
    assert max(found) < math.sqrt(600.0)


def test_too_many_kinks_are_refused():
    r = np.linspace(0.0, 20.0, 101)
    with pytest.raises(NotConverged, match="the slope of the punch jumps at 100 radii"):
        chosen(_problem(MeasuredPunch(r, r**2 / 2)), ("pull_off",), "quick")


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: RoundedCone(0.0, 1.0), "rounding of a rounded cone = 0.0"),
        (lambda: RoundedCone(1.0, math.inf), "cone_slope of a rounded cone = inf"),
        (lambda: PowerSum((1.0,), (2.0, 3.0)), "do not form a sum"),
        (lambda: PowerSum((1.0, 1.0), (2.0, 2.0)), "do not form a sum"),
        (lambda: PowerSum((1.0,), (0.5,)), "exponent 0.5 is outside"),
        (lambda: PowerSum((1.0, -1.0), (1.0, 2.0)), "coefficient -1 of the largest exponent 2"),
        (lambda: PowerSum((math.nan,), (2.0,)), "no column of finite numbers"),
        (lambda: PowerSum("ab", (2.0,)), "no column of numbers"),
        (lambda: MeasuredPunch((0.0,), (0.0,)), "are no profile"),
        (lambda: MeasuredPunch((0.1, 1.0), (0.0, 1.0)), "begins at"),
        (lambda: MeasuredPunch((0.0, 1.0, 1.0), (0.0, 1.0, 2.0)), "radius 1 in row 2"),
        (lambda: MeasuredPunch((0.0, 1.0), (0.0, -1.0)), "last height -1"),
        (lambda: MeasuredPunch((0.0, 1.0), (0.0, 1.0), growth=0.0), "growth = 0.0"),
        (lambda: CustomPunch(lambda r: r + 1.0, 1.0), "heights are measured from the apex"),
        (lambda: CustomPunch(lambda r: r, 1.0, kinks=(0.0,)), "not all radii"),
    ],
)
def test_impossible_shapes_are_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()
