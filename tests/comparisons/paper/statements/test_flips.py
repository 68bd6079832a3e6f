"""Numbers that read a word, and the factors by which they must change for another verdict."""

import re
from dataclasses import replace

import pytest

from comparisons.data.paper_statements import paper_statements, verdicts
from comparisons.paper.statements.evidence import FALSE, IN_PART, READING, TRUE, Evidence, Number, clauses, verdict
from comparisons.paper.statements.flips import NO_FLIP, flips, flips_text, read_number, with_number

READ = [row for row in verdicts() if row["number"]]
STATEMENTS = {statement.id: statement for statement in paper_statements()}


def rows(*values, limit=2.0, relation="<", u=0.0, what=READING):
    return [
        Evidence(f"mu = {i}", "fscm", Number(value, u, ""), relation, Number(limit, 0.0, what))
        for i, value in enumerate(values)
    ]


@pytest.mark.parametrize(
    ("evidence", "expected"),
    [
        (rows(3.0, 5.0), {IN_PART: 1.5, TRUE: 2.5}),
        (rows(1.0, 5.0), {FALSE: 0.5, TRUE: 2.5}),
        (rows(1.0, 0.5), {IN_PART: 0.5, FALSE: 0.25}),
        (rows(3.0, relation=">"), {FALSE: 1.5}),
        # Within its bound nothing is decided.
        (rows(3.0, u=0.5), {TRUE: 1.75}),
        (rows(1e-9, u=1.0), {}),
        (rows(1.0, what="another computed number"), {}),
    ],
)
def test_the_nearest_factor_of_every_other_verdict(evidence, expected):
    assert flips(evidence) == pytest.approx(expected)


def test_one_number_below_and_above_which_clauses_hold():
    mixed = [*rows(1.0), *(replace(row, clause="other") for row in rows(3.0, relation=">"))]
    assert flips(mixed) == {IN_PART: pytest.approx(1.5)}
    assert verdict(clauses(with_number(mixed, 3.5)).values()) == IN_PART


def test_two_numbers_are_refused():
    with pytest.raises(ValueError, match=r"judged by \[1.0, 2.0\]"):
        read_number([*rows(1.0), *rows(1.0, limit=1.0)])


@pytest.mark.parametrize(
    ("value", "text"),
    [(3.262, "true above x 1.64"), (2.0006817, "true above x 1.00035"), (72.8, "true above x 36.4"), (1e-9, NO_FLIP)],
)
def test_a_factor_is_rounded_away_from_one(value, text):
    u = 1.0 if value < 1.0 else 0.0
    assert flips_text(rows(value, u=u)) == text
    assert flips_text(rows(1.0, what="")) == ""


@pytest.mark.parametrize("row", READ, ids=[row["id"] for row in READ])
def test_a_number_is_that_of_the_statement_and_of_its_text(row):
    number = float(row["number"])
    assert number == float(STATEMENTS[row["id"]].arguments["within"])
    # As a plain number, or in percent.
    texts = re.findall(r"(?<!\.)\b(\d+(?:\.\d+)?(?:e-\d+)?)( %)?(?!\d)", row["test"])
    stated = {float(text) * (0.01 if percent else 1.0) for text, percent in texts}
    assert any(value == pytest.approx(number, rel=1e-12) for value in stated), row["test"]
    assert row["flips"]


def test_every_statement_with_a_number_has_its_factors():
    assert {row["id"] for row in READ} == {id for id, one in STATEMENTS.items() if "within" in one.arguments}
    assert len(READ) > 20
