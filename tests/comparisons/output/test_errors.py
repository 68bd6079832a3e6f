"""Relative errors, the largest of them, and those of a comparison."""

import math

import pandas as pd
import pytest

from comparisons.output.errors import agreement, comparison_table, largest, relative_error
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


def test_two_references_are_compared_also_where_one_alone_depends_on_the_poisson_ratio():
    rows = [stored("fem", 1.0, 2.002, 0.002, nu=0.3), stored("fscm", 1.0, 2.0)]
    (row,) = agreement(pd.DataFrame(rows), "fem", "fscm").to_dict("records")
    assert (row["nu"], row["en"]) == (0.3, pytest.approx(1.0))


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
