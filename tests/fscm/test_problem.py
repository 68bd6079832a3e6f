"""The dimensionless problem: accepted input, refused input, and the reasons."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fscm.laws import LennardJones, Mie
from fscm.problem import Problem
from fscm.punch import PowerPunch
from tests.refusals import refused


@given(st.floats(0.7, 50.0), st.floats(0.0, 1.0), st.floats(1e-3, 100.0))
def test_compliance_is_the_factor_of_eq_28(n, k, mu):
    problem = Problem(n, k, mu)
    assert problem.compliance == pytest.approx(2 * math.exp((2 * n + k - 1) / n * math.log(mu)), rel=1e-12)
    assert (problem.punch, problem.law) == (PowerPunch(n), LennardJones())


BAD = [math.nan, -math.inf, -1.0, 10**400, "1", True, 1j, None, np.array([1.0]), [1.0]]


@pytest.mark.parametrize(
    ("name", "values", "message"),
    [
        ("n", [*BAD, math.inf, 0.0], r"shape index n = .*\(0, inf\)"),
        # A punch too steep for doubles.
        ("n", [301, 1.7e308], r"shape index n = .* is outside \(0, 300\]"),
        ("k", [*BAD, -1e-12, 1.0000001], r"gradient exponent k = .*\[0, 1\]"),
        ("mu", [*BAD, math.inf, 0.0], r"Tabor number mu = .*\(0, inf\)"),
    ],
)
def test_bad_numbers_are_refused_in_one_sentence(name, values, message):
    for bad in values:
        refused(message, Problem, **{"n": 2.0, "k": 0.4, "mu": 1.0, name: bad})


def test_a_tabor_number_at_which_doubles_end_is_refused():
    for mu, size in ((1e300, "10^450"), (1e11, "10^17"), (1e-21, "10^-31"), (5e-324, "10^-485")):
        with pytest.raises(ValueError, match=r"Tabor number mu = .* outside \[1e-30, 1e\+15\]") as caught:
            Problem(2, 0, mu)
        assert f" = {size}," in str(caught.value)
    for n, k, mu in ((300, 0, 1.0), (2, 0, 6e9), (2, 1, 1e7), (2, 0, 1e-20)):
        assert Problem(n, k, mu).compliance >= 1e-30


def test_a_divergent_load_integral_is_refused():
    # The limit of the law comes first: it is the stricter one, also where the Tabor number has no value.
    for n in (2 / 3, 0.66666666, 0.5):
        with pytest.raises(ValueError, match=rf"r\^{n} .* outside \(2/3, inf\): .*load integral"):
            Problem(n, 0.0, 1.0)
    assert Problem(0.67, 0.4, 1.0).n == 0.67
    # A shorter-ranged law admits the sharper punch, a longer-ranged one does not admit the cone.
    assert Problem(2 / 3, 0.4, 1.0, law=Mie(m=12, n=6)).n == 2 / 3
    refused("load integral", Problem, 1.0, 0.4, 1.0, law=Mie(m=9, n=2))


def test_the_tabor_number_of_a_punch_too_sharp_is_undefined():
    for n, k, low in ((0.5, 0.0, "0.5"), (0.4999999, 0.0, "0.5"), (0.35, 0.3, "0.35")):
        refused(rf"n = {n} is outside \({low}, inf\) for k = {k}: .*Eq\. 29", Problem, n, k, 1.0, law=Mie(m=12, n=6))


def test_what_is_not_a_profile_or_a_law_is_refused():
    refused("punch shape", Problem, 2, 0, 1, punch=lambda r: r)
    refused("surface law", Problem, 2, 0, 1, law=np.sin)
    refused("does not fit n", replace, Problem(2, 0, 1), n=3.0)
