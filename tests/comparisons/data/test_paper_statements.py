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
    (statement,) = read_statements(STATEMENT + "own = { n = [2], mu = [1, 3] }\narguments = { n = [1, 2] }")
    cases = [{"n": 1.0, "mu": 1.0}, {"n": 2.0, "k": 0.6, "mu": 3.0}, {"n": 2.0, "mu": 2.0}, {"n": 2.0, "k": 0.4}]
    assert [statement.is_own(case) for case in cases] == [False, True, False, True]
    assert [statement.is_beyond(case) for case in cases] == [True, False, True, False]


def test_what_is_stated_in_general_has_no_case_beyond_it():
    (statement,) = read_statements(STATEMENT + "own = { n = [2] }\ngeneral = true")
    assert statement.is_own({"n": 2.0})
    assert not statement.is_own({"n": 1.0})
    assert not statement.is_beyond({"n": 1.0})
    (without_cases,) = read_statements(STATEMENT)
    assert not without_cases.is_own({"n": 2.0})
    assert not without_cases.is_beyond({"n": 2.0})


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (STATEMENT.replace('tests = [{ kind = "trend" }]\n', ""), r"statement a: tests missing; a statement has id, "),
        (STATEMENT + "own = { nu = [0.3] }", r"unknown key 'nu'"),
        (STATEMENT + 'test = "trend"', r"statement a: unknown key 'test': did you mean tests"),
        (STATEMENT.replace('"a"', '"A b"'), r"statement 1 \(id = 'A b'\): id = 'A b' must be lower-case words"),
        (STATEMENT.replace("fscm-bench list", "rm -r"), r"command = .* must be one or more commands fscm-bench"),
        (STATEMENT + STATEMENT, "two statements have the id 'a'; an id must be unique"),
        ("statement = 3", "must be"),
    ],
)
def test_a_wrong_file_is_refused_in_one_sentence(text, message):
    with pytest.raises(ValueError, match=message) as refusal:
        read_statements(text, "mine.toml")
    assert str(refusal.value).startswith("mine.toml: ")
    assert "\n" not in str(refusal.value)
