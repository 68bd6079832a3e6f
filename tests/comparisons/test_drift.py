"""Drift of results from the stored ones, by made-up tables: values, bounds, statuses, and rows on one side only."""

import math

import pandas as pd
import pytest

from comparisons.baseline import drift


def _results(**changes):
    common = {"model": "fscm", "quantity": "pull_off_force", "n": 2.0, "k": 0.4, "mu": [0.5, 1.0], "nu": math.nan}
    return pd.DataFrame({**common, "value": [1.8, 1.7], "u_num": [1e-9, 2e-9], "status": "ok", **changes})


STORED = _results()


def test_equal_results_have_not_drifted_and_rows_that_are_not_computed_do_not_matter():
    assert drift(STORED, STORED).empty
    assert drift(STORED, STORED.head(1)).empty


@pytest.mark.parametrize(("apart", "seen"), [(0.9, 0), (1.1, 2), (-1.1, 2)])
def test_values_may_differ_by_the_sum_of_both_bounds_and_by_no_more(apart, seen):
    bounds = 2.0 * STORED["u_num"]
    changed = _results(value=STORED["value"] + apart * (STORED["u_num"] + bounds), u_num=bounds)
    assert len(drift(STORED, changed)) == len(drift(changed, STORED)) == seen


@pytest.mark.parametrize(("factor", "seen"), [(0.3, 2), (0.34, 0), (2.9, 0), (3.1, 2)])
def test_a_bound_may_change_by_the_declared_factor_and_by_no_more(factor, seen):
    assert len(drift(STORED, _results(u_num=factor * STORED["u_num"]))) == seen


def test_bounds_of_rounding_do_not_drift():
    zero = _results(u_num=0.0)
    assert drift(zero, _results(u_num=1e-13)).empty
    assert len(drift(zero, _results(u_num=6e-13))) == 2


def test_another_status_and_a_row_that_is_not_stored_have_drifted():
    assert drift(STORED, _results(status=["ok", "failed"]))["mu"].tolist() == [1.0]
    assert drift(STORED.head(1), STORED)["mu"].tolist() == [1.0]
