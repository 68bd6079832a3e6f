"""Stored rows that count for a task, and their agreement with rows that were evaluated again."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from comparisons.runs.computation import is_row_of
from comparisons.runs.reevaluation import same
from tests.comparisons.rows import row

NUMBER = row(value=2.0, u_num=1e-9)
CURVE = row(value=None, u_num=None, points=([0.0, 2.0], [1.0, 5.0], 1e-3))
REFUSED = row(value=None, u_num=None, status="not-applicable")


@pytest.mark.parametrize(
    ("stored", "change", "agree"),
    [
        (NUMBER, {"value": 2.0 + 1.9e-9}, True),
        (NUMBER, {"value": 2.0 - 2.1e-9}, False),
        (NUMBER, {"status": "failed", "value": None, "u_num": None}, False),
        (CURVE, {}, True),
        (CURVE, {"points": ([0.0, 2.0], [1.0, 5.007], 1e-3)}, True),
        (CURVE, {"points": ([0.0, 2.0], [1.0, 5.009], 1e-3)}, False),
        (CURVE, {"points": ([0.0, 1.0, 2.0], [1.0, 3.0, 5.0], 1e-3)}, False),
        (REFUSED, {}, True),
        (REFUSED, {"status": "failed"}, False),
    ],
)
def test_rows_agree_in_their_status_and_within_both_uncertainties(stored, change, agree):
    assert same(stored, replace(stored, **change)) == same(replace(stored, **change), stored) == agree


@pytest.mark.parametrize(
    ("digest", "version", "counts"), [("a", None, True), ("b", None, False), ("a", "1", True), ("a", "2", False)]
)
def test_a_row_counts_for_its_problem_and_the_version_of_an_external_model(digest, version, counts):
    external = None if version is None else SimpleNamespace(version=version)
    task = SimpleNamespace(problem=SimpleNamespace(digest=digest), external=external)
    assert is_row_of(task, row(digest="a", model_version="1")) == counts
    assert not is_row_of(None, row(digest="a"))
