"""Agreement of a stored row with the row of the same task that was evaluated again."""

from dataclasses import replace

import pytest

from comparisons.problem import Problem
from comparisons.runs import reevaluation
from comparisons.runs.tasks import Task, evaluate_task


@pytest.mark.parametrize(
    ("change", "agree"),
    [
        ({}, True),
        ({"value": 2.0 + 1.9e-9}, True),
        ({"value": 2.0 + 2.1e-9}, False),
        ({"status": "failed", "value": None, "u_num": None}, False),
    ],
)
def test_rows_agree_within_both_uncertainties(toys, change, agree):
    row = evaluate_task(Task("exact", "pull_off_force", Problem.dimensionless(2, 0, 1)))
    assert reevaluation.same(row, replace(row, **change)) == agree


@pytest.mark.parametrize(
    ("points", "agree"),
    [
        (([0.0, 2.0], [1.0, 5.0], 1e-3), True),
        (([0.0, 2.0], [1.0, 5.007], 1e-3), True),
        (([0.0, 2.0], [1.0, 5.009], 1e-3), False),
        (([0.0, 1.0, 2.0], [1.0, 3.0, 5.0], 1e-3), False),
    ],
)
def test_curves_agree_point_by_point(toys, points, agree):
    row = evaluate_task(Task("exact", "pull_off_force", Problem.dimensionless(2, 0, 1)))
    stored = replace(row, value=None, u_num=None, points=([0.0, 2.0], [1.0, 5.0], 1e-3))
    assert reevaluation.same(stored, replace(stored, points=points)) == agree


@pytest.mark.parametrize(("stored", "now"), [("not-applicable", "failed"), ("failed", "not-applicable")])
def test_a_refusal_that_has_become_a_failure_is_a_difference(toys, stored, now):
    row = evaluate_task(Task("exact", "pull_off_force", Problem.dimensionless(2, 0, 1)))
    without = replace(row, status=stored, value=None, u_num=None)
    assert reevaluation.same(without, without)
    assert not reevaluation.same(without, replace(without, status=now))
