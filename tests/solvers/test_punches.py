"""Shapes of punches of both references: heights, slopes, growth, kinks, refusals."""

import math
import pickle

import numpy as np
import pytest

import fem_reference
import fscm
from comparisons.problem.punch_shapes import SmoothedProfile
from fem_reference.punch import check_without_asperities
from tests.marks import heavy
from tests.refusals import refused

both = pytest.mark.parametrize("package", [fscm, fem_reference], ids=lambda package: package.__name__)
RADII = np.array([0.1, 0.3, 0.7, 1.1, 4.0, 30.0, 1e3])


def hyperboloid(r):
    return np.sqrt(1.0 + np.asarray(r) ** 2) - 1.0


SHAPES = {
    "cone": lambda package: package.PowerPunch(1.0, 1.0),
    "power": lambda package: package.PowerPunch(2.5, 0.7),
    "rounded cone": lambda package: package.RoundedCone(rounding=0.5, cone_slope=2.0),
    "sum": lambda package: package.PowerSum((0.5, 0.125), (2.0, 4.0)),
    "sum with a dip": lambda package: package.PowerSum((1.0, -0.1, 0.5), (1.0, 1.5, 3.0)),
    "measured": lambda package: package.MeasuredPunch((0.0, 1.0, 2.0), (0.0, 0.25, 2.0), growth=3.0),
    "own": lambda package: package.CustomPunch(hyperboloid, growth=1.0),
}


@both
@pytest.mark.parametrize("make", SHAPES.values(), ids=SHAPES)
def test_slope_growth_and_apex_belong_to_the_height(package, make):
    punch = make(package)
    h = 1e-4 * RADII
    # Central differences of fourth order: truncation 1e-16, rounding about 1e-11.
    d = [punch.height(RADII + i * h) for i in (-2, -1, 1, 2)]
    assert punch.slope(RADII) == pytest.approx((d[0] - 8 * d[1] + 8 * d[2] - d[3]) / (12 * h), rel=1e-7)
    if package is fscm:  # the sum with a dip is the slowest to settle
        low, high = punch.height(np.array([1e9, 2e9]))
        assert math.log2(high / low) == pytest.approx(punch.growth, abs=1e-5)
    assert float(punch.height(np.array([0.0]))[0]) == 0.0
    assert punch.slope(RADII.reshape(7, 1)).shape == (7, 1)
    assert pickle.loads(pickle.dumps(punch)) == punch
    assert hash(make(package)) == hash(punch)


@both
def test_a_rounded_cone_is_a_paraboloid_at_the_apex_and_a_cone_far_away(package):
    punch = package.RoundedCone(rounding=2.0, cone_slope=0.5)
    # Without cancellation, however small r is.
    assert punch.height(np.array([1e-9]))[0] == pytest.approx(0.5 * 1e-18 / 4.0, rel=1e-14)
    assert punch.height(np.array([1e9]))[0] == pytest.approx(0.5 * (1e9 - 2.0), rel=1e-14)


@both
def test_a_measured_profile_is_its_segments_and_a_power(package):
    punch = package.MeasuredPunch([0, 1, 2, 3], [0, 0.5, 1.0, 3.0], growth=3)
    r = np.array([0.0, 0.5, 1.5, 2.5, 3.0, 6.0])
    assert punch.height(r) == pytest.approx([0.0, 0.25, 0.75, 2.0, 3.0, 24.0])
    assert punch.slope(r) == pytest.approx([0.5, 0.5, 0.5, 2.0, 3.0, 12.0])
    # The slope does not jump at 1.
    assert punch.kinks == (2.0, 3.0)
    assert package.MeasuredPunch([0.0, 1.0, 2.5], [0.0, 1.0, 2.5], growth=1).kinks == ()


def bent(growth, power=2.3):
    """A tip that grows like a power of r up to its last row at 400 nm."""
    r = np.linspace(0.0, 400e-9, 81)
    return SmoothedProfile(tuple(r), tuple(1e-6 * (r / 400e-9) ** power), 1e-13, growth)


@both
def test_a_profile_that_bends_down_beyond_its_last_row_is_told_its_growth(package):
    """On a soft solid, whose path may go on there; both name the radius and the growth that helps."""
    law = package.LennardJones(0.05, 0.3e-9)
    tips = {"2.3": bent(2.0), "2.29": package.MeasuredPunch(bent(2.0).radii, bent(2.0).heights)}
    for growth, tip in tips.items():
        words = rf"bends down at r = 4e-07, its last row.*r\^{growth},.*r\^2,.*set growth = {growth}; "
        problem = package.Problem(package.Homogeneous(2e6, 0.4), tip, law)
        failure = refused(words, package.solve, problem, "pull_off_force", "quick", error=package.NotConverged)
        assert failure.failure is package.Failure.GROWTH


def test_the_growth_that_the_elements_name_is_not_rounded_down():
    """The last segment has the exponent 2.30005, and 2.30 would bend the profile down again."""
    tip = fem_reference.MeasuredPunch((0.0, 1.9, 2.0), (0.0, 1.0 - 0.1 * 2.30005 / 2.0, 1.0))
    refused("set growth = 2.31; ", check_without_asperities, tip, 1e-6, 1e4, error=fem_reference.NotConverged)


@both
def test_the_radius_at_which_a_punch_bends_down_is_named(package):
    """A plain of 1 um around an asperity."""
    heights = 1e-6 * np.array([0.0, 1.0, 1.01, 9.0])
    tip = package.MeasuredPunch(1e-6 * np.array([0.0, 1.0, 2.0, 3.0]), heights)
    problem = package.Problem(package.Homogeneous(1e6, 0.4), tip, package.LennardJones(0.05, 0.3e-9))
    words = "bends down at r = 1e-06, as outside an asperity"
    failure = refused(words, package.solve, problem, "pull_off_force", "quick", error=package.NotConverged)
    assert failure.failure is package.Failure.END


@pytest.mark.parametrize(("work", "accuracy"), [(0.0625, "quick"), *heavy((0.05, "default"), (0.02, "default"))])
def test_a_sphere_of_twenty_rows_pulls_off_with_one_force(work, accuracy):
    """By the elements the first was the force of another minimum, the second not found, the third off by 4 bounds."""
    r = np.linspace(0.0, 2e-7, 20)
    forces = []
    for package in (fscm, fem_reference):
        tip, law = package.MeasuredPunch(tuple(r), tuple(r**2 / 1e-6)), package.LennardJones(work, 4e-10)
        forces.append(
            package.solve(package.Problem(package.Homogeneous(1e9, 0.4), tip, law), "pull_off_force", accuracy)
        )
    assert abs(forces[0].value - forces[1].value) <= forces[0].u_num + forces[1].u_num
    assert forces[1].u_num < 1e-4 * forces[1].value


@both
def test_impossible_shapes_are_refused_in_one_sentence(package):
    for name, arguments, message in (
        *(("PowerPunch", (bad, 1.0), "n = ") for bad in (0.0, -1.0, math.inf, math.nan)),
        ("RoundedCone", (0.0, 1.0), "rounding"),
        ("RoundedCone", (1.0, math.inf), "cone_slope"),
        ("PowerSum", ((), ()), "exponents"),
        ("PowerSum", ((1.0,), (2.0, 3.0)), "exponents"),
        ("PowerSum", ((1.0, 1.0), (2.0, 2.0)), "exponents"),
        ("PowerSum", ((1.0,), (0.0,)), "exponent"),
        ("PowerSum", ((1.0, -1.0), (1.0, 2.0)), "coefficient -1 of the largest exponent 2"),
        ("PowerSum", ((math.nan,), (2.0,)), "nan"),
        ("PowerSum", ("ab", (2.0,)), "coefficient"),
        ("MeasuredPunch", ((0.0, 1.0), (0.0,)), "not form a profile"),
        ("MeasuredPunch", ((0.0,), (0.0,)), "not form a profile"),
        ("MeasuredPunch", ((0.1, 1.0), (0.0, 1.0)), r"\(0.1, 0\)"),
        ("MeasuredPunch", ((0.0, 1.0), (0.5, 1.0)), r"\(0, 0.5\)"),
        ("MeasuredPunch", ((0.0, 1.0, 1.0), (0.0, 1.0, 2.0)), "radius 1 in row 2"),
        ("MeasuredPunch", ((0.0, 1.0), (0.0, -1.0)), "last height -1"),
        ("MeasuredPunch", ((0.0, 1.0), (0.0, 1.0), 0.0), "growth = 0.0"),
        ("MeasuredPunch", ((0.0, math.nan), (0.0, 1.0)), "finite"),
        ("CustomPunch", (lambda r: r + 1.0, 1.0), r"f\(0\)"),
    ):
        refused(message, getattr(package, name), *arguments)
