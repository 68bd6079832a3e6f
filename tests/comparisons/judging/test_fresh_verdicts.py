"""Fresh cases beside the standing ones: which differences are a failure, and which are none."""

import pandas as pd
import pytest

from comparisons.judging.decision import Verdict
from comparisons.judging.fresh_verdicts import compare_with_standing
from comparisons.judging.judge import Judged


def rows(gate, cases):
    """Verdicts of one model; a case is mu, error, uncertainty, verdict and status."""
    blank = dict.fromkeys(Judged.__slots__)
    names = {"gate": gate, "candidate": "mine", "quantity": "pull_off_force", "n": 2.0, "k": 0.4}
    return pd.DataFrame(
        [
            blank | names | {"mu": mu, "error": error, "uncertainty": u, "verdict": verdict, "status": status}
            for mu, error, u, verdict, status in cases
        ]
    )


def ok(mu, error, u=0.0, verdict=Verdict.PASS):
    return mu, error, u, verdict, "ok"


REFUSED = (0.5, None, None, Verdict.FAIL, "not-applicable")
STANDING = [ok(0.1, 1e-3, 1e-4), ok(1.0, -1e-3, 1e-4)]
#: Ten times what the error of a standing case can be at most.
LIMIT = 1.1e-2


@pytest.mark.parametrize(
    ("fresh", "fails"),
    [
        ([ok(0.5, 1e-3)], False),
        # Between the standing cases an error counts that is certainly more than ten times as large.
        ([ok(0.5, 0.99 * LIMIT)], False),
        ([ok(0.5, 1.01 * LIMIT)], True),
        ([ok(0.5, -1.01 * LIMIT)], True),
        ([ok(0.5, 1.01 * LIMIT, 0.02 * LIMIT)], False),
        ([ok(0.5, 1e-3), ok(0.6, 1.01 * LIMIT), ok(0.7, 1e-3)], True),
        # Elsewhere it does not, unless it is beyond the limits of the gate; also where none is between them.
        ([ok(5.0, 1.01 * LIMIT)], False),
        ([ok(5.0, 1.01 * LIMIT), ok(0.5, 1e-3)], False),
        ([ok(5.0, 1.01 * LIMIT, verdict=Verdict.FAIL)], True),
        ([ok(0.5, 2e-3, verdict=Verdict.FAIL)], True),
        # Half as many values as in the standing cases are enough.
        ([ok(0.5, 1e-3), REFUSED], False),
        ([ok(0.5, 1e-3), REFUSED, REFUSED], True),
        ([REFUSED], True),
        ([], False),
    ],
)
def test_a_model_that_is_right_in_the_standing_cases_alone_fails(fresh, fails):
    failures = compare_with_standing(rows("A", STANDING), rows("A-RANDOM", fresh) if fresh else rows("A", STANDING)[:0])
    assert failures["verdict"].tolist() == [Verdict.FAIL] * fails
    assert failures["gate"].tolist() == ["A-RANDOM"] * fails


@pytest.mark.parametrize("standing", [[], [*STANDING, ok(0.3, 1.0, verdict=Verdict.FAIL)]])
def test_a_model_that_is_not_right_in_the_standing_cases_has_failed_there(standing):
    fresh = rows("A-RANDOM", [ok(0.5, 1.0, verdict=Verdict.FAIL)])
    assert compare_with_standing(rows("A", standing) if standing else rows("A", STANDING)[:0], fresh).empty


def test_fresh_cases_of_a_problem_file_are_between_its_standing_ones():
    standing, fresh = (rows(gate, [ok(None, error)]) for gate, error in (("A", 1e-3), ("A-RANDOM", 0.5)))
    tables = (
        table.assign(n=None, k=None, mu=None).astype({"n": float, "k": float, "mu": float})
        for table in (standing, fresh)
    )
    assert len(compare_with_standing(*tables)) == 1
