"""Statements of the paper: which cases they are about."""

import pytest

from comparisons.data.paper_statements import PaperStatement

CASES = [{"n": 1.0, "mu": 1.0}, {"n": 2.0, "k": 0.6, "mu": 3.0}, {"n": 2.0, "mu": 2.0}, {"n": 2.0, "k": 0.4}]


@pytest.mark.parametrize(
    ("entries", "own", "beyond"),
    [
        ({"own": {"n": [2], "mu": [1, 3]}}, [False, True, False, True], [True, False, True, False]),
        # What is stated in general or without cases has no case beyond it.
        ({"own": {"n": [2]}, "general": True}, [False, True, True, True], [False] * 4),
        ({}, [False] * 4, [False] * 4),
    ],
)
def test_a_case_is_one_of_the_paper_or_beyond_it(entries, own, beyond):
    statement = PaperStatement("a", "Sec. 1", "It is so.", [], "It is compared.", "n = 2", "", **entries)
    assert [statement.is_own(case) for case in CASES] == own
    assert [statement.is_beyond(case) for case in CASES] == beyond
