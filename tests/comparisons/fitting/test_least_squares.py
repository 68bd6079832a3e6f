"""Least squares of named numbers: known lines, limits, numbers that nothing determines."""

import math

import numpy as np
import pytest

from comparisons.fitting.least_squares import Limits, minimised

X = np.linspace(0.0, 1.0, 40)
NOISE = 0.1 * np.random.default_rng(5).normal(size=X.size)
COLUMNS = {"a": np.ones_like(X), "b": X}


def line(limits=None, columns=COLUMNS, start=0.0):
    """The line through points of 1 + 2 x with noise, and at which numbers its derivatives were computed."""
    asked = []

    def residuals(numbers):
        return sum(numbers[name] * column for name, column in columns.items()) - (1.0 + 2.0 * X + NOISE)

    def jacobian(numbers):
        asked.append(tuple(numbers.values()))
        return np.column_stack(list(columns.values()))

    return minimised(residuals, jacobian, dict.fromkeys(columns, start), limits or {}, 1e-12), asked


def test_values_and_covariance_are_those_of_the_normal_equations():
    (fitted, _), design = line(), np.column_stack([*COLUMNS.values()])
    (intercept, slope), squares, *_ = np.linalg.lstsq(design, 1.0 + 2.0 * X + NOISE, rcond=None)
    covariance = np.linalg.inv(design.T @ design) * squares[0] / (X.size - 2)
    assert fitted.numbers == pytest.approx({"a": intercept, "b": slope}, rel=1e-9)
    assert fitted.covariance == pytest.approx(covariance, rel=1e-9)
    assert fitted.deviations["b"] == pytest.approx(math.sqrt(covariance[1, 1]), rel=1e-9)
    assert fitted.correlation("a", "b") == pytest.approx(covariance[0, 1] / np.prod(np.sqrt(np.diag(covariance))))


def test_limits_that_are_wide_change_nothing():
    (free, _), (limited, _) = line(), line({"b": Limits(-9.0, 9.0)})
    assert limited.numbers == pytest.approx(free.numbers, rel=1e-6)
    assert limited.covariance == pytest.approx(free.covariance, rel=1e-6)


def test_a_number_at_its_limit_is_not_determined():
    fitted, _ = line({"b": Limits(high=1.0)})
    assert fitted.numbers["b"] == pytest.approx(1.0, abs=1e-6)
    assert math.isinf(fitted.deviations["b"])


def test_a_start_at_a_limit_is_moved_inside():
    fitted, _ = line({"b": Limits(low=0.0)}, start=0.0)
    assert fitted.numbers["b"] == pytest.approx(2.0, abs=0.2)


@pytest.mark.parametrize("other", [X, np.zeros_like(X)])
def test_numbers_of_which_only_a_combination_counts_have_no_covariance(other):
    fitted, _ = line(columns=COLUMNS | {"c": other})
    assert fitted.covariance is None
    assert fitted.correlation("b", "c") == 0.0
    assert math.isinf(fitted.deviations["a"])


def test_no_derivative_is_computed_twice_at_one_point():
    _, asked = line()
    assert len(asked) == len({*asked})
