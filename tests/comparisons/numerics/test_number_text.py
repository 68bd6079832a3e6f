"""Texts of numbers: a printed bound is at least the bound and hardly more; without one it is below the last digit."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from comparisons.numerics.number_text import number_parts, percent_text, short
from comparisons.problem.units import si_text

VALUE, BOUND = st.floats(-50.0, 50.0), st.floats(1e-12, 0.5)


def parsed(text):
    """Value, bound and unit of the last digit of a text; the bound is None without brackets."""
    _, decimals, bracket, _ = number_parts(text).groups()
    digit = 10.0 ** -len(decimals or "")
    return float(text.partition("(")[0]), None if bracket is None else int(bracket) * digit, digit


@given(VALUE, BOUND, st.sampled_from([0.0, 1e-3, 1e-5]))
def test_a_printed_bound_is_the_bound_rounded_up(value, u, last):
    printed, bound, digit = parsed(short(value, u, last))
    assert abs(printed - value) <= 0.5 * digit * (1.0 + 1e-9)
    if bound is None:
        assert digit == pytest.approx(last)
        assert u <= 0.5 * digit
    else:
        assert u <= bound * (1.0 + 1e-9)
        assert bound <= 1.5 * u * (1.0 + 1e-9)
        assert u > 0.5 * last


@pytest.mark.parametrize(("u", "text"), [(4.9e-4, "-4.514"), (5.1e-4, "-4.5141(6)"), (0.0, "-4.514")])
def test_brackets_begin_at_half_of_the_last_digit(u, text):
    assert percent_text(-0.04514091, u / 100.0, 1e-3) == text
    assert si_text(-4.514091e-9, u * 1e-9, "N", 1e-12) == f"{text} nN"
