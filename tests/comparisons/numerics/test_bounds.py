"""Combined bounds: no pair of exact values within two bounds is farther apart."""

from itertools import product

import pytest
from hypothesis import given
from hypothesis import strategies as st

from comparisons.numerics.bounds import combined, relative_difference, relative_uncertainty

VALUE, BOUND = st.floats(0.5, 5.0), st.floats(0.0, 1e-3)
SIGN = st.sampled_from([-1.0, 1.0])


@given(VALUE, BOUND, SIGN, VALUE, BOUND, SIGN)
def test_the_bound_of_a_difference_is_reached_and_never_exceeded(x, u, sign, r, u_r, sign_r):
    x, r = sign * x, sign_r * r
    changes = [abs((x + a * u - (r + b * u_r)) - (x - r)) for a, b in product((-1.0, 1.0), repeat=2)]
    assert max(changes) == pytest.approx(combined(u, u_r), abs=1e-14)


@given(VALUE, BOUND, SIGN, VALUE, BOUND, SIGN)
def test_the_bound_of_kappa_is_exact_but_for_one_factor(x, u, sign, r, u_r, sign_r):
    """The largest change of kappa over all exact values is u_kappa / (1 - u_r / abs(r))."""
    x, r = sign * x, sign_r * r
    changes = [
        abs(relative_difference(x + a * u, r + b * u_r) - relative_difference(x, r))
        for a, b in product((-1.0, 1.0), repeat=2)
    ]
    exact = relative_uncertainty(x, u, r, u_r) / (1.0 - u_r / abs(r))
    assert max(changes) == pytest.approx(exact, abs=1e-13)
