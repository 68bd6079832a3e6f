"""Verdicts: where PASS ends and FAIL begins, and which verdict wins."""

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from comparisons.judging.decision import Verdict, decide, expecting_failure, roll_up

NUMBERS = st.floats(-1e3, 1e3)


@pytest.mark.parametrize(
    ("error", "uncertainty", "verdict"),
    [
        (1.0, 0.0, "PASS"),
        (0.5, 0.5, "PASS"),
        (0.5, 0.500001, "INCONCLUSIVE"),
        (1.5, 0.5, "INCONCLUSIVE"),
        (1.5, 0.499999, "FAIL"),
        (-2.4, 0.4, "INCONCLUSIVE"),
        (math.nan, 0.1, "ERROR"),
        (0.0, math.inf, "ERROR"),
        (0.0, -0.1, "ERROR"),
    ],
)
def test_the_interval_decides(error, uncertainty, verdict):
    assert decide(error, uncertainty, -2.0, 1.0) == verdict


@given(NUMBERS, st.floats(0, 1e3), NUMBERS, st.floats(0, 1e3))
def test_more_uncertainty_never_makes_a_verdict_surer(error, u, lower, width):
    before, after = (decide(error, factor * u, lower, lower + width) for factor in (1.0, 2.0))
    assert after == before or after == Verdict.INCONCLUSIVE


@given(NUMBERS, st.floats(0, 1e3), NUMBERS, st.floats(0, 1e3))
def test_the_sign_of_everything_is_a_symmetry(error, u, lower, width):
    assert decide(error, u, lower, lower + width) == decide(-error, u, -lower - width, -lower)


ORDER = ["ERROR", "FAIL", "XPASS", "INCONCLUSIVE", "XFAIL", "PASS"]


def test_the_order_of_the_roll_up():
    for worse, better in pairwise(ORDER):
        assert roll_up([better, worse, better]) == worse
    assert roll_up([]) == roll_up([Verdict.NOT_APPLICABLE]) == "ERROR"


def test_an_expected_failure_is_strict():
    expected = ["ERROR", "XFAIL", "XPASS", "INCONCLUSIVE", "XFAIL", "XPASS"]
    assert [expecting_failure(Verdict(name)) for name in ORDER] == expected
