"""Statements of the paper as data."""

import pytest

from comparisons.data.paper_statements import read_statements

STATEMENT = """
[[statement]]
id = "a"
section = "Sec. 1"
statement = "It is so."
tests = [{ kind = "trend" }]
how = "It is compared."
range = "n = 2"
command = "fscm-bench list models"
"""


def test_own_cases_are_read():
    (statement,) = read_statements(STATEMENT + "own = { n = [2], mu = [1, 3] }")
    cases = [{"n": 1.0, "mu": 1.0}, {"n": 2.0, "k": 0.6, "mu": 3.0}, {"n": 2.0, "mu": 2.0}, {"n": 2.0, "k": 0.4}]
    assert [statement.is_own(case) for case in cases] == [False, True, False, True]
    assert [statement.is_beyond(case) for case in cases] == [True, False, True, False]


@pytest.mark.parametrize("more", ["own = { n = [2] }\ngeneral = true", ""])
def test_what_is_stated_in_general_or_without_cases_has_no_case_beyond_it(more):
    (statement,) = read_statements(STATEMENT + more)
    assert statement.is_own({"n": 2.0}) == bool(more)
    assert not statement.is_own({"n": 1.0})
    assert not statement.is_beyond({"n": 1.0})


def test_a_wrong_key_is_refused():
    with pytest.raises(ValueError, match="statement a: unknown key 'test'"):
        read_statements(STATEMENT + 'test = "trend"', "mine.toml")
