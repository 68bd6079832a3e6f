"""Combined bounds: no pair of exact values within two bounds is farther apart."""

from itertools import product
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

import comparisons
from comparisons.numerics.bounds import combined, relative_difference, relative_uncertainty

VALUE, BOUND = st.floats(0.5, 5.0), st.floats(0.0, 1e-3)
SIGN = st.sampled_from([-1.0, 1.0])


def test_bounds_add():
    assert combined(3.0, 4.0, 12.0) == 19.0


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


#: Lengths of vectors in the plane of a picture, a task of a cache as an example, deviations of the values of a user.
_LENGTHS = {"curve_distance.py", "fscm_model.py", "reevaluation.py", "contour_labels.py", "cache.py", "uncertainty.py"}


def test_nothing_else_combines_bounds():
    """A root of a sum of squares is the rule of standard deviations; it also measures lengths."""
    sources = Path(comparisons.__file__).parent.rglob("*.py")
    assert {path.name for path in sources if "hypot" in path.read_text(encoding="utf-8")} <= _LENGTHS
