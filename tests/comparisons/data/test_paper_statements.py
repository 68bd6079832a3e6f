"""Statements of the paper as data."""

import pytest

from comparisons.data.paper_statements import paper_statements, read_statements, verdicts

STATEMENT = """
[[statement]]
id = "a"
section = "Sec. 1"
statement = "It is so."
test = "trend"
how = "It is compared."
range = "n = 2"
command = "fscm-bench list models"
"""


def test_there_are_at_least_25_with_one_id_each():
    ids = [statement.id for statement in paper_statements()]
    assert len(ids) == len(set(ids)) >= 25


def test_every_statement_has_a_shipped_verdict():
    assert [row["id"] for row in verdicts()] == [statement.id for statement in paper_statements()]


def test_numbers_and_shapes_are_read():
    (found,) = read_statements(STATEMENT + "stated_n = [2]\narguments = { n = [1, 2] }")
    assert found.numbers("n") == (1.0, 2.0)
    assert found.numbers("k") == ()
    assert [found.beyond(n) for n in found.numbers("n")] == [True, False]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (STATEMENT.replace('test = "trend"\n', ""), r"statement a: test missing; a statement has id, "),
        (STATEMENT + 'tests = "trend"', r"statement a: unknown key 'tests': did you mean test"),
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
