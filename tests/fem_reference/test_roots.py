"""Roots between two places: those of scipy, with as many evaluations, and refusals."""

import math

import pytest
from scipy.optimize import brentq

from fem_reference import NotConverged
from fem_reference._roots import root_between

FUNCTIONS = {
    "cubic": (lambda x: x**3 - 2.0 * x - 5.0, 2.0, 3.0),
    "steep": (lambda x: math.exp(x) - 1e5, -5.0, 20.0),
    "kink": (lambda x: min(x - 1.0, 30.0 * (x - 1.0)), -3.0, 2.0),
    "jump": (lambda x: math.copysign(1.0, x - 0.123), -1.0, 1.0),
    "flat": (lambda x: (x - 1.0) ** 9, 0.0, 3.0),
    "at an end": (lambda x: x - 1.0, 0.0, 1.0),
}


@pytest.mark.parametrize("sign", [-1.0, 1.0])
@pytest.mark.parametrize(("function", "low", "high"), FUNCTIONS.values(), ids=FUNCTIONS)
def test_a_root_is_that_of_brent_with_as_many_evaluations(function, low, high, sign):
    calls = []

    def counted(x):
        calls.append(x)
        return sign * function(x)

    for ends in ((low, high), (high, low)):
        calls.clear()
        expected, report = brentq(counted, *ends, xtol=1e-9, rtol=1e-12, maxiter=200, full_output=True)
        calls.clear()
        assert root_between(counted, *ends, 1e-9, 1e-12) == pytest.approx(expected, abs=1e-9)
        assert len(calls) <= report.function_calls


def test_places_with_the_same_sign_are_refused():
    with pytest.raises(NotConverged, match="same sign at 1 and 2"):
        root_between(lambda x: x, 1.0, 2.0)


def test_a_root_that_is_not_found_is_no_number():
    values = iter([-1.0, *[1.0] * 1000])
    with pytest.raises(NotConverged, match="not found"):
        root_between(lambda _: next(values), 0.0, 1.0, 0.0, 0.0)
