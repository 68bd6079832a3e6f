"""Roots in a bracket."""

import math

import pytest

from fscm._roots import bracketed_root

#: Function, bracket, root.
FUNCTIONS = {
    "square": (lambda x: x * x - 2.0, 0.0, 2.0, math.sqrt(2.0)),
    "reversed bracket": (lambda x: 2.0 - x * x, 2.0, 0.0, math.sqrt(2.0)),
    "exponential": (lambda x: math.exp(x) - 5.0, 0.0, 3.0, math.log(5.0)),
    "steep": (lambda x: math.tanh(1e4 * (x - 0.3)), 0.0, 1.0, 0.3),
    "flat": (lambda x: x**9 - 1e-9, 0.0, 3.0, 0.1),
    "tiny values": (lambda x: 1e-200 * (x - 0.1) * (1.0 + x), 0.0, 1.0, 0.1),
    "infinite at an end": (lambda x: -math.inf if x == 0.0 else math.log(x) + 1.0, 0.0, 1.0, math.exp(-1.0)),
    "jump": (lambda x: 1.0 if x > 0.7 else -1.0, 0.0, 1.0, 0.7),
}


@pytest.mark.parametrize(("function", "a", "b", "root"), FUNCTIONS.values(), ids=FUNCTIONS)
@pytest.mark.parametrize(("absolute", "relative"), [(1e-300, 1e-15), (1e-6, 0.0)])
def test_the_root_is_within_the_tolerance(function, a, b, root, absolute, relative):
    assert abs(bracketed_root(function, a, b, absolute, relative) - root) <= absolute + (relative + 1e-15) * root


def test_a_root_at_an_end_or_at_zero_is_found_exactly():
    assert bracketed_root(lambda x: x, 0.0, 1.0) == 0.0
    assert bracketed_root(lambda x: x - 1.0, 0.0, 1.0) == 1.0
    assert abs(bracketed_root(lambda x: x**3, -1.0, 2.0)) < 1e-12


def test_evaluations_of_a_smooth_function_are_few():
    """Each is a state of the path: bisection would take 40."""
    points = []
    bracketed_root(lambda x: points.append(x) or math.exp(x) - 1.1, 0.0, 0.5)
    assert len(points) <= 9


def test_one_sign_is_refused():
    with pytest.raises(ValueError, match="one sign"):
        bracketed_root(lambda x: x * x + 1.0, -1.0, 1.0)
