"""Outcomes of comparisons, clauses and verdicts."""

import math
from dataclasses import replace
from itertools import product

import pytest

from comparisons.paper.statements.evidence import (
    FAILS,
    FALSE,
    HOLDS,
    IN_PART,
    READING,
    TRUE,
    UNDECIDED,
    Evidence,
    Number,
    by_clause,
    clauses,
    decisive,
    evidence_frame,
    evidence_of,
    verdict,
)


def comparison(value, limit=0.0, u=0.0, u_limit=0.0, relation="<", model="fscm", clause="n = 2"):
    return Evidence(clause, model, Number(value, u, "value"), relation, Number(limit, u_limit, "limit"))


@pytest.mark.parametrize(
    ("value", "u", "u_limit", "outcome"),
    [
        (-1.0, 0.0, 0.0, HOLDS),
        (1.0, 0.0, 0.0, FAILS),
        # Both bounds are added, and a difference equal to their sum decides nothing.
        (-1.0, 0.75, 0.25, UNDECIDED),
        (1.0, 0.75, 0.25, UNDECIDED),
        (-1.0, 0.7, 0.25, HOLDS),
        (1.0, 0.7, 0.25, FAILS),
        (0.0, 0.0, 0.0, UNDECIDED),
        (math.nan, 0.0, 0.0, UNDECIDED),
        (-1.0, math.nan, 0.0, UNDECIDED),
    ],
)
@pytest.mark.parametrize("relation", "<>")
def test_a_comparison_is_decided_beyond_the_sum_of_the_bounds(value, u, u_limit, outcome, relation):
    signed = value if relation == "<" else -value
    assert comparison(signed, 0.0, u, u_limit, relation).outcome == outcome


def test_the_largest_failure_decides_a_clause_before_what_is_not_decided():
    rows = [comparison(value, u=u) for value, u in ((-1.0, 0.0), (1e-9, 1.0), (0.5, 0.0), (2.0, 0.0))]
    found = decisive(rows)
    assert (found.value.value, found.outcome, found.comparisons) == (2.0, FAILS, 4)
    assert decisive(rows[:2]).outcome == UNDECIDED
    assert decisive(rows[:1]).outcome == HOLDS
    with pytest.raises(ValueError, match="no comparison"):
        decisive([])


def test_every_clause_model_and_kind_of_limit_keeps_its_decisive_comparison():
    rows = [comparison(value, clause=clause) for clause in ("n = 1", "n = 2") for value in (-2.0, -1.0)]
    rows.append(comparison(-3.0, clause="n = 2", model="fem"))
    rows.append(replace(comparison(-4.0, clause="n = 2"), limit=Number(0.0, 0.0, READING)))
    kept = by_clause([replace(row, limit=replace(row.limit, what="other")) for row in rows[:-1]] + rows[-1:])
    assert [(row.clause, row.model, row.value.value, row.comparisons) for row in kept] == [
        ("n = 1", "fscm", -1.0, 2),
        ("n = 2", "fscm", -1.0, 2),
        ("n = 2", "fem", -3.0, 1),
        ("n = 2", "fscm", -4.0, 1),
    ]


@pytest.mark.parametrize(
    ("values", "outcome"),
    [
        ({"fscm": 1.0}, UNDECIDED),
        ({"fem": 1.0}, UNDECIDED),
        ({"fscm": 1.0, "fem": 1.0}, FAILS),
        ({"fscm": 1.0, "fem": -1.0}, UNDECIDED),
        ({"fscm": -1.0, "fem": 1.0}, UNDECIDED),
        ({"fscm": -1.0, "fem": -1.0}, HOLDS),
        ({"formula": 1.0}, FAILS),
        ({"fscm-stieltjes": -1.0}, HOLDS),
    ],
)
def test_a_failure_needs_both_references(values, outcome):
    assert clauses(comparison(value, model=model) for model, value in values.items()) == {"n = 2": outcome}


@pytest.mark.parametrize(
    "outcomes", [found for length in (1, 2, 3) for found in product((HOLDS, FAILS, UNDECIDED), repeat=length)]
)
def test_a_verdict_follows_from_the_clauses(outcomes):
    expected = {
        frozenset({HOLDS}): TRUE,
        frozenset({FAILS}): FALSE,
        frozenset({FAILS, UNDECIDED}): FALSE,
        frozenset({HOLDS, FAILS}): IN_PART,
        frozenset({HOLDS, FAILS, UNDECIDED}): IN_PART,
    }
    assert verdict(outcomes) == expected.get(frozenset(outcomes), UNDECIDED)


def test_evidence_survives_its_table():
    rows = [comparison(1.0 / 3.0, 0.1, 1e-17), replace(comparison(2.0), own=True, beyond=True, comparisons=7)]
    assert evidence_of(evidence_frame("a", rows)) == rows
