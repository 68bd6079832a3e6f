"""Grid convergence against examples of the literature and against known values."""

import math

import numpy as np
import pytest

from comparisons.models.stieltjes_model import StieltjesModel
from comparisons.numerics.grid_convergence import three_grids
from comparisons.problem import Problem

# Celik et al., J. Fluids Eng. 130 (2008) 078001, Table 1: numbers of cells in two dimensions, and as printed
# the values, p, the extrapolated value and the grid convergence index in percent.
CELIK = [
    ((18000, 8000, 4500), (6.063, 5.972, 5.863), 1.53, 6.1685, 2.2),
    ((18000, 4500, 980), (10.7880, 10.7250, 10.6050), 0.75, 10.8801, 1.1),
    ((18000, 4500, 980), (6.0042, 5.9624, 6.0909), 1.51, 6.0269, 0.5),
]


@pytest.mark.parametrize(("cells", "values", "order", "extrapolated", "percent"), CELIK)
def test_the_three_examples_of_celik_et_al(cells, values, order, extrapolated, percent):
    found = three_grids([m**-0.5 for m in cells], values, declared=2)
    assert found.value == values[0]
    assert found.observed_order == pytest.approx(order, abs=0.006)
    assert found.extrapolated == pytest.approx(extrapolated, abs=5e-4)
    index = 100 * 1.25 * abs(found.extrapolated - found.value) / values[0]
    assert index == pytest.approx(percent, abs=0.06)


def test_an_oscillating_value_is_not_given_the_small_factor():
    cells, values = CELIK[2][:2]
    found = three_grids([m**-0.5 for m in cells], values, declared=2)
    assert found.u_num >= 3 * abs(values[0] - values[2])


def test_roaches_nozzle():
    fine = three_grids([1, 2, 4], [0.97050, 0.96854, 0.96178], declared=2)
    assert fine.observed_order == pytest.approx(1.786170, abs=1e-6)
    assert fine.extrapolated == pytest.approx(0.97130, abs=5e-6)
    assert fine.u_num / 0.97050 == pytest.approx(0.00103083, abs=1e-8)


def test_an_order_above_the_declared_one_is_not_trusted():
    h = np.array([1.0, 2.0, 4.0])
    values = 1.0 + 1e-3 * h**6
    found = three_grids(h, values, declared=2)
    assert found.observed_order == pytest.approx(6)
    assert found.u_num == pytest.approx(1.25 * abs(values[1] - values[0]) / 3)


def test_divergence_is_seen():
    h = np.array([1.0, 2.0, 4.0])
    found = three_grids(h, 1.0 + h**-1.0, declared=2)
    assert not found.observed_order > 0
    assert found.u_num > 3 * 0.7


@pytest.mark.parametrize("p", [0.6, 1.0, 2.0, 3.5])
def test_exact_powers_give_order_and_limit(p):
    h = np.array([1.0, 1.3, 1.9])
    found = three_grids(h, 5.0 - 0.2 * h**p, declared=4)
    assert found.observed_order == pytest.approx(p, abs=1e-5)
    assert found.extrapolated == pytest.approx(5.0, abs=1e-5)
    assert found.u_num == pytest.approx(1.25 * 0.2, rel=1e-3)


@pytest.mark.parametrize("p", [0.3, 0.49])
def test_an_order_below_a_half_is_not_used(p):
    """The estimate is that of the order 1/2, with the larger factor."""
    h = np.array([1.0, 2.0, 4.0])
    found = three_grids(h, 5.0 + 0.2 * h**p, declared=4)
    assert found.observed_order == pytest.approx(p)
    assert found.u_num == pytest.approx(3.0 * 0.2 * (2.0**p - 1.0) / (2.0**0.5 - 1.0))


def test_equal_values_are_noise():
    assert math.isnan(three_grids([1, 2, 3], [2.0, 2.0, 2.0], declared=2).observed_order)


def test_two_values_that_agree_do_not_hide_a_third():
    for values in ([2.0, 2.0, 2.1], [2.0, 2.1, 2.1]):
        found = three_grids([1, 2, 3], values, declared=2)
        assert math.isnan(found.observed_order)
        assert found.u_num == pytest.approx(3.0 * 0.1)


def riemann(m):
    """The integral of 1/sqrt(x) by midpoints: an edge singularity, order 1/2 whatever the rule."""
    return float(((np.arange(m) + 0.5) / m).__pow__(-0.5).sum() / m)


def test_an_edge_singularity_decides_the_order_not_the_rule():
    sizes = [1 / 640, 1 / 320, 1 / 160]
    values = [riemann(round(1 / h)) for h in sizes]
    assert three_grids(sizes, values, declared=2).observed_order == pytest.approx(0.5, abs=0.01)
    found = three_grids(sizes, values, declared=0.5)
    assert abs(found.value - 2.0) <= found.u_num <= 4 * abs(found.value - 2.0)


@pytest.mark.parametrize(
    "quantity", ["pull_off_force", pytest.param("zero_load_displacement", marks=pytest.mark.heavy)]
)
def test_the_bound_of_a_low_order_scheme_holds_against_a_finer_grid(quantity):
    problem = Problem.dimensionless(n=3, k=0.2, mu=0.5)
    # A ninth of the error of the finest grid; the time grows with the third power.
    reference = StieltjesModel(480).evaluate(problem, quantity).value
    segments = (40, 80, 160)
    values = [StieltjesModel(m).evaluate(problem, quantity).value for m in segments]
    # The scheme is a midpoint sum: 2, measured 1.9 to 2.1 where the edge is wider than a segment.
    found = three_grids([1 / m for m in segments], values, declared=2)
    assert abs(found.value - reference) <= found.u_num <= 3 * abs(found.value - reference)
    assert found.observed_order == pytest.approx(2, abs=0.2)


@pytest.mark.parametrize(
    ("sizes", "values", "why"),
    [
        ([1, 2], [1, 2], "at least 3"),
        ([1, 2, 3], [1, 2], "at least 3"),
        ([1, 1, 2], [1, 2, 3], "same size"),
        ([0, 1, 2], [1, 2, 3], "positive"),
        ([1, 2, 3], [1, math.nan, 3], "finite"),
        ([1, 2, 3, 4], [1, 2, 3, 4], "not three"),
    ],
)
def test_wrong_input(sizes, values, why):
    with pytest.raises(ValueError, match=why):
        three_grids(sizes, values, declared=2)


def test_the_order_of_unequal_ratios_solves_the_equation_of_celik_et_al():
    """p ln r21 = abs(ln abs(ratio) + ln((r21^p - s)/(r32^p - s))), also where a fixed-point iteration does not end."""
    rng = np.random.default_rng(5)
    for p, r21, r32, s in zip(
        rng.uniform(0.6, 8.0, 200),
        rng.uniform(1.1, 3.0, 200),
        rng.uniform(1.1, 3.0, 200),
        rng.choice([-1.0, 1.0], 200),
        strict=True,
    ):
        h = np.array([1.0, r21, r21 * r32])
        found = three_grids(h, 1.0 + 1e-3 * h**p * np.array([1.0, s, 1.0]), declared=9)
        order, ratio = found.observed_order, (r32**p - s) / (r21**p - s) * r21**p
        assert order == pytest.approx(p, rel=1e-6)
        assert order * np.log(r21) == pytest.approx(
            abs(np.log(ratio) + np.log((r21**order - s) / (r32**order - s))), rel=1e-6
        )


def test_growing_oscillations_have_the_positive_order_of_celik_et_al():
    found = three_grids([1.0, 2.0, 3.0], [1.004, 1.0, 1.001], declared=2)
    p = found.observed_order
    assert p * np.log(2.0) == pytest.approx(abs(np.log(0.25) + np.log((2.0**p + 1) / (1.5**p + 1))), rel=1e-9)
    assert found.u_num >= 3 * 0.003


@pytest.mark.parametrize("h", [[1.0, 2.0, 4.0], [1.0, 1.5, 2.9]])
def test_divergence_has_its_negative_order(h):
    values = 1.0 + np.power(h, -0.7)
    assert three_grids(h, values, declared=2).observed_order == pytest.approx(-0.7, abs=1e-9)
