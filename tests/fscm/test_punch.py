"""Punch shapes: closed forms, derivatives, checked properties."""

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest

from fscm._branches import predicted
from fscm._continuation import equilibrium_path
from fscm._newton import shifted
from fscm.custom_punch import CustomPunch
from fscm.measured_punch import MeasuredPunch
from fscm.problem import Problem
from fscm.punch import PowerPunch, PowerSum, PunchShape, RoundedCone, kinks_of
from fscm.solver import solve

RADII = np.array([1e-3, 0.1, 0.5, 1.0, 2.0, 30.0, 1e3])


def paraboloid(r):
    return 0.5 * r**2


SHAPES = [
    PowerPunch(1.0),
    PowerPunch(1.5),
    PowerPunch(2),
    PowerPunch(5.0),
    PowerPunch(0.7),
    RoundedCone(0.3),
    RoundedCone(2.0, 0.25),
    PowerSum([0.5, 0.125], [2, 4]),
    PowerSum([1.0, -0.2, 0.5], [1.0, 1.5, 2.0]),
    CustomPunch(paraboloid, 2.0),
]


@pytest.mark.parametrize("shape", SHAPES)
def test_slope_is_the_derivative_of_the_height(shape):
    h = 1e-4 * RADII
    # Fourth-order central differences with h = 1e-4 r: truncation 1e-16, rounding about 1e-11.
    d = [shape.height(RADII + i * h) for i in (-2, -1, 1, 2)]
    numerical = (d[0] - 8 * d[1] + 8 * d[2] - d[3]) / (12 * h)
    np.testing.assert_allclose(shape.slope(RADII), numerical, rtol=1e-9)


@pytest.mark.parametrize("shape", SHAPES)
def test_growth_is_the_exponent_at_infinity_and_the_tip_is_at_zero(shape):
    assert isinstance(shape, PunchShape)
    far = np.array([1e9, 2e9])
    low, high = shape.height(far)
    # PowerSum([1, -0.2, 0.5], [1, 1.5, 2]) is the slowest to settle: 0.2 / 0.5 r^-1/2.
    assert math.log2(high / low) == pytest.approx(shape.growth, abs=1e-5)
    assert shape.height(np.zeros(1))[0] == 0.0


def test_rounded_cone_is_a_paraboloid_at_the_tip_and_a_cone_far_away():
    punch = RoundedCone(rounding=2.0, cone_slope=0.5)
    # f = s r^2 / (2c) (1 - r^2 / (4 c^2) + ...), without cancellation however small r is
    assert punch.height(np.array([1e-9]))[0] == pytest.approx(0.5 * 1e-18 / 4.0, rel=1e-15)
    assert punch.height(np.array([1e9]))[0] == pytest.approx(0.5 * (1e9 - 2.0), rel=1e-15)


def test_slope_at_the_tip():
    tip = np.zeros(1)
    assert PowerPunch(1).slope(tip)[0] == 1.0
    assert PowerPunch(2).slope(tip)[0] == 0.0
    assert PowerPunch(0.8).slope(tip)[0] == math.inf
    assert RoundedCone(1.0).slope(tip)[0] == 0.0
    assert CustomPunch(paraboloid, 2).slope(tip)[0] == pytest.approx(0.0, abs=1e-7)


@pytest.mark.parametrize(
    ("f", "df", "growth"),
    [
        (lambda r: r**1.5 / 1.5, np.sqrt, 1.5),
        (lambda r: r**5 / 5, lambda r: r**4, 5),
        (lambda r: r**2 / 2 + 0.1 * (1 - np.cos(3 * r)), lambda r: r + 0.3 * np.sin(3 * r), 2),
        # Dyadic steps at r = 32 would all fall near multiples of this wavelength.
        (lambda r: r**2 / 2 + 0.01 * (1 - np.cos(100 * r)), lambda r: r + np.sin(100 * r), 2),
    ],
)
def test_numerical_slope(f, df, growth):
    r = np.array([1e-2, 0.3, 1.0, 2.7, 4.0, 31.9, 32.0])
    punch = CustomPunch(f, growth)
    # Measured worst 3e-11, on the punch with 100 waves.
    np.testing.assert_allclose(punch.slope(r), df(r), rtol=1e-9)
    assert punch.slope(r.reshape(7, 1)).shape == (7, 1)
    np.testing.assert_array_equal(CustomPunch(f, growth, df).slope(r), df(r))


@pytest.mark.parametrize(
    ("f", "growth", "reason"),
    [
        (np.log1p, 1.0, "does not grow"),
        (np.sin, 1.0, "does not grow"),
        (lambda r: 0.0 * r, 1.0, "does not grow"),
        (lambda r: -(r**2), 2.0, "does not grow"),
        (np.expm1, 2.0, "not the exponent"),
        (lambda r: r**2, 1.9, "not the exponent"),
        (lambda r: r**2, math.nan, "growth"),
        (lambda r: r**2, -1.0, "growth"),
        (lambda r: r**2, "2", "growth"),
        (lambda r: 1.0 + r, 1.0, "subtract"),
        (lambda r: r**2 / (r > 0.01), 2.0, "finite"),
        (lambda r: 1.0, 1.0, "shape"),
        (math.sqrt, 0.5, "array"),
    ],
)
# An array of one radius is a number for older versions of NumPy, which warn.
@pytest.mark.filterwarnings("ignore:Conversion of an array:DeprecationWarning")
def test_functions_that_break_a_promise_are_refused(f, growth, reason):
    with pytest.raises(ValueError, match=reason) as caught:
        CustomPunch(f, growth)
    assert "\n" not in str(caught.value)


def test_a_wrong_derivative_is_refused():
    with pytest.raises(ValueError, match="not the slope"):
        CustomPunch(paraboloid, 2.0, lambda r: 1.01 * r)


@pytest.mark.parametrize(
    "build",
    [
        lambda: PowerPunch(0),
        lambda: PowerPunch(-1.0),
        lambda: PowerPunch(math.inf),
        lambda: PowerPunch(math.nan),
        lambda: PowerPunch(True),
        lambda: PowerPunch("2"),
        lambda: PowerPunch(1j),
        lambda: RoundedCone(0.0),
        lambda: RoundedCone(1.0, -1.0),
        lambda: PowerSum([], []),
        lambda: PowerSum([1.0], [1.0, 2.0]),
        lambda: PowerSum([1.0, 1.0], [2.0, 2.0]),
        lambda: PowerSum([1.0, -1.0], [1.0, 2.0]),
        lambda: PowerSum([1.0], [0.0]),
    ],
)
def test_bad_parameters_are_refused_in_one_sentence(build):
    with pytest.raises(ValueError, match=r"outside|real number|pair up") as caught:
        build()
    assert "\n" not in str(caught.value)


def test_profiles_are_values():
    for shape in SHAPES:
        assert pickle.loads(pickle.dumps(shape)) == shape
        assert hash(pickle.loads(pickle.dumps(shape))) == hash(shape)
    assert PowerPunch(2) == PowerPunch(np.float64(2.0))


def test_a_measured_profile_is_its_segments_and_a_power():
    punch = MeasuredPunch([0, 1, 2, 3], [0, 0.5, 1.0, 3.0], growth=3)
    assert isinstance(punch, PunchShape)
    r = np.array([0.0, 0.5, 1.5, 2.5, 3.0, 6.0])
    np.testing.assert_allclose(punch.height(r), [0.0, 0.25, 0.75, 2.0, 3.0, 24.0])
    np.testing.assert_allclose(punch.slope(r), [0.5, 0.5, 0.5, 2.0, 3.0, 12.0])
    # The slope does not jump at 1.
    assert punch.kinks == kinks_of(punch) == (2.0, 3.0)
    assert pickle.loads(pickle.dumps(punch)) == punch
    assert hash(pickle.loads(pickle.dumps(punch))) == hash(punch)


def test_a_straight_profile_is_a_cone():
    table = MeasuredPunch([0.0, 1.0, 2.5], [0.0, 1.0, 2.5], growth=1)
    assert table.kinks == ()
    force = solve(Problem(1, 0, 0.5, punch=table), "pull_off_force").value
    assert force == pytest.approx(solve(Problem(1, 0, 0.5), "pull_off_force").value, rel=1e-11)


def test_a_profile_with_kinks_is_the_limit_of_rounded_ones():
    """The slope rises from 0.5 to 2 at r = 1; rounded over w there, the force deviates by the second order of w."""

    def rounded(w):
        def f(r):
            return 1.25 * r + 0.75 * (np.hypot(r - 1.0, w) - math.hypot(1.0, w))

        return CustomPunch(f, 1.0)

    kinked = MeasuredPunch([0.0, 1.0, 2.0], [0.0, 0.5, 2.5], growth=1.25)
    assert len(kinked.kinks) == 2
    problem = Problem(1, 0, 0.3, punch=MeasuredPunch([0.0, 1.0, 1e3], [0.0, 0.5, 0.5 + 2.0 * 999.0], growth=1.0))
    solution = solve(problem, "pull_off_force")
    errors = [
        abs(solve(Problem(1, 0, 0.3, punch=rounded(w)), "pull_off_force").value - solution.value) for w in (0.1, 0.05)
    ]
    assert errors[1] < 1e-2
    assert 2.0 < errors[0] / errors[1] < 6.0


@pytest.mark.parametrize("growth", [2.0, 12.0])
def test_a_shifted_state_keeps_its_anchor_and_moves_by_the_exact_height(growth):
    """Also where the punch is so steep that the deformations are the unknowns."""
    punch = MeasuredPunch([0.0, 1.0, 2.0], [0.0, 0.3, 1.6], growth)
    point = next(equilibrium_path(Problem(2, 0.2, 0.5, punch=punch), 8, 1e-4))
    state = replace(point.state, turned=("load", -1.0), edge_gap=0.3)
    still = np.zeros_like(state.gap)
    for new in (shifted(state, still, 0.0, 0.1), predicted(state, replace(point.rates, log_scale=0.1), 1.0)):
        assert (new.turned, new.edge_gap, new.lift is None) == (state.turned, 0.3, growth < 10.0)
        assert new.scale == pytest.approx(state.scale * math.exp(0.1))
    new = shifted(state, still, 0.0, 0.1)
    change = punch.height(new.radius) - punch.height(state.radius)
    if growth < 10.0:
        change -= 0.1 * state.radius * punch.slope(state.radius)
    near = punch.height(new.radius) < 1e6
    np.testing.assert_allclose((new.gap - state.gap)[near], change[near], rtol=1e-9, atol=1e-9)


def test_a_steep_profile_with_kinks_is_continuous_in_its_growth():
    """Above a growth of 10 the deformations are the unknowns, below it the gaps."""
    forces = [
        solve(Problem(2, 0.2, 0.5, punch=MeasuredPunch([0.0, 1.0, 2.0], [0.0, 0.3, 1.6], growth)), "pull_off_force")
        for growth in (10.0, 10.0 + 1e-9)
    ]
    assert abs(forces[1].value - forces[0].value) <= forces[0].u_num + forces[1].u_num


@pytest.mark.parametrize(
    ("radii", "heights", "growth", "reason"),
    [
        ([0.0, 1.0], [0.0], 2, "no profile"),
        ([0.0], [0.0], 2, "no profile"),
        ([0.1, 1.0], [0.0, 1.0], 2, "measured from the tip"),
        ([0.0, 1.0], [0.5, 1.0], 2, "measured from the tip"),
        ([0.0, 1.0, 1.0], [0.0, 1.0, 2.0], 2, "increase"),
        ([0.0, 1.0], [0.0, -1.0], 2, "must grow"),
        ([0.0, 1.0], [0.0, 1.0], 0, "must grow"),
        ([0.0, math.nan], [0.0, 1.0], 2, "finite"),
        (["0", "1"], [0.0, 1.0], 2, "finite"),
        ([[0.0], [1.0, 2.0]], [0.0, 1.0], 2, "real numbers"),
    ],
)
def test_what_is_no_profile_is_refused(radii, heights, growth, reason):
    with pytest.raises(ValueError, match=reason) as caught:
        MeasuredPunch(radii, heights, growth)
    assert "\n" not in str(caught.value)
