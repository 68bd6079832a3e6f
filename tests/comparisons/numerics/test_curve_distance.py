"""Distance of curves: closed forms, invariance under sampling and units, folds, and wrong input."""

import numpy as np
import pytest

from comparisons.numerics.curve_distance import curve_distance, mesh_difference


def s_curve(m, shift=0.0):
    """An S-shaped curve: x is not monotone along it."""
    t = np.linspace(-1.6, 1.6, m)
    return t**3 - t, t + shift


def test_the_interpolation_error_is_bounded_and_of_fourth_order():
    distances = [curve_distance(*s_curve(97), *s_curve(m)) for m in (21, 41, 81)]
    assert all(distance.value <= distance.u_interpolation for distance in distances)
    bounds = [distance.u_interpolation for distance in distances]
    assert min(bounds[0] / bounds[1], bounds[1] / bounds[2]) > 8


def test_a_shifted_line_is_at_its_perpendicular_distance():
    x, longer = np.linspace(0.0, 2.0, 30), np.linspace(-1.0, 3.0, 81)
    distance = curve_distance(x, 3.0 * x + 0.6, longer, 3.0 * longer)
    # What is outside the common range of x does not count.
    assert curve_distance(longer, 3.0 * longer, x, 3.0 * x).value < 1e-12
    # Scaled by the ranges 2 and 6 the lines have slope 1 and are 0.1 apart, seen from the vertical.
    assert distance.value == pytest.approx(0.1 / np.sqrt(2), rel=1e-9)


def test_units_of_the_axes_do_not_matter():
    a, b = s_curve(40, 0.05), s_curve(200)
    plain = curve_distance(*a, *b)
    scaled = curve_distance(1e6 * a[0], 1e-9 * a[1], 1e6 * b[0], 1e-9 * b[1])
    assert scaled.value == pytest.approx(plain.value, rel=1e-9)
    reversed_ = curve_distance(a[0][::-1], a[1][::-1], *b)
    assert reversed_.value == pytest.approx(plain.value, rel=1e-12)


def test_a_branch_that_is_left_out_is_far_off():
    t = np.linspace(-1.1, 1.1, 60)
    stable = t[abs(t) > 0.7]
    assert curve_distance(stable**3 - stable, stable, t**3 - t, t).value > 0.3


@pytest.mark.parametrize(
    ("x", "y", "why"),
    [
        ([0, 1], [0, 1], "fewer than 8"),
        (np.linspace(5, 6, 20), np.linspace(0, 1, 20), "fewer than 8"),
        (np.linspace(0, 1, 20), np.full(20, np.nan), "not a finite number"),
    ],
)
def test_what_is_no_curve_is_refused(x, y, why):
    t = np.linspace(0, 1, 20)
    with pytest.raises(ValueError, match=why):
        curve_distance(x, y, t, t**2)
    with pytest.raises(ValueError, match="no range"):
        curve_distance(t, t, t, np.ones(20))


@pytest.mark.parametrize("end", [1.0, 3.0])
def test_the_difference_of_two_meshes_counts_twice(end):
    """However long the last step is."""
    t = np.append(np.linspace(0.0, 0.9, 40), end)
    shift = 1e-3
    distance = mesh_difference(t, 2.0 * t + shift, t, 2.0 * t)
    # The ordinate is scaled by its range; beyond the end of the reference its end is the nearest point.
    assert distance == pytest.approx(2.0 * shift / (2.0 * end), rel=1e-6)
