"""Relative errors, their uncertainty, and the verdict on printed digits."""

import math

import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st

from comparisons.data.paper_values import PaperValue
from comparisons.output.errors import comparison_table, largest, relative_error
from comparisons.problem import Problem
from comparisons.runs.cases import Grid


def stored(model, mu, value, u_num=0.0, **more):
    content = {"quantity": "pull_off_force", "n": 2.0, "k": 0.4, "nu": math.nan, "status": "ok"}
    return content | {"model": model, "mu": mu, "value": value, "u_num": u_num} | more


def test_kappa_is_relative_to_the_one_reference_of_the_same_case():
    rows = [stored("m", 1, 3.0), stored("ref", 1, math.nan, status="failed")]
    rows += [stored("m", 2, math.nan, status="failed"), stored("ref", 2, 2.0), stored("ref", 3, 2.0)]
    assert relative_error(pd.DataFrame(rows), "ref").empty
    twice = [stored("m", 1, 3.0), stored("ref", 1, 2.0), stored("ref", 1, 2.1)]
    with pytest.raises(pd.errors.MergeError):
        relative_error(pd.DataFrame(twice), "ref")


unit = st.floats(min_value=-1, max_value=1)


@given(st.floats(0.1, 10), st.floats(0.5, 10), st.floats(0, 1e-3), st.floats(0, 1e-3), unit, unit)
def test_u_kappa_bounds_what_the_true_values_can_give(value, reference, u, u_ref, a, b):
    rows = pd.DataFrame([stored("m", 1, value, u), stored("ref", 1, reference, u_ref)])
    (kappa,) = relative_error(rows, "ref").itertuples()
    true = (value + a * u) / (reference + b * u_ref) - 1
    # To first order: the second-order term is u_ref / reference times the first, at most 2e-3 of it.
    assert abs(true - kappa.kappa) <= kappa.u_kappa * 1.003 + 1e-13


@pytest.mark.parametrize(
    ("percent", "kappa", "u", "verdict"),
    [
        ("6.7", 0.0674, 1e-6, "agrees"),
        ("6.7", -0.0666, 1e-6, "agrees"),
        ("6.7", 0.0676, 1e-6, "agrees if truncated"),
        ("6.7", 0.0681, 1e-6, "differs"),
        ("6.7", 0.06749, 1e-3, "undecided"),
        ("0.73", 0.00741, 1e-7, "differs"),
    ],
)
def test_verdict_is_on_the_printed_digits(percent, kappa, u, verdict):
    assert PaperValue("", "", "", percent, "%").verdict(100 * abs(kappa), 100 * u) == verdict


def test_a_comparison_states_why_the_reference_has_no_value():
    grid = Grid("g", "", "quick", "atlas", ("jkr",), ("pull_off_force",), (Problem.dimensionless(2.0, 0.4, 20.0),))
    rows = [stored("jkr", 20.0, 1.7, reason=""), stored("atlas", 20.0, math.nan, status="failed", reason="mu is large")]
    (row,) = comparison_table(pd.DataFrame(rows), [grid], None).to_dict("records")
    assert (row["status"], row["value"], row["reason"]) == ("ok", 1.7, "the reference atlas: failed: mu is large")
    assert math.isnan(row["kappa"])


def test_largest_error_is_signed_and_says_when_it_is_at_an_end():
    rows = [stored("ref", mu, 1.0) for mu in (0.1, 1, 10)]
    rows += [stored("md-improved", mu, value) for mu, value in [(0.1, 1.001), (1, 0.9927), (10, 1.005)]]
    rows += [stored("x", mu, value) for mu, value in [(0.1, 1.5), (1, 1.1), (10, 1.0)]]
    columns = ["mu", "cases", "at_end", "kappa", "paper_percent", "verdict"]
    improved, worst = largest(relative_error(pd.DataFrame(rows), "ref"))[columns].values.tolist()
    assert improved == [1, 3, False, pytest.approx(-0.0073, abs=1e-12), "0.73", "agrees"]
    assert worst == [0.1, 3, True, 0.5, "", ""]
