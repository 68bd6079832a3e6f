"""Tests of the pull-off force over the gradient exponent."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

from comparisons.data.paper_statements import PaperStatement
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.statements.closeness import relative_error
from comparisons.paper.statements.evidence import Evidence
from comparisons.paper.statements.sources import StatementTest, grid, number, reading, tasks_of
from comparisons.paper.statements.trends import families

__all__ = ["TESTS"]

_FORCE = "pull_off_force"


def _tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    homogeneous = [(n, 0.0, mu) for n in statement.numbers("n") for mu in statement.numbers("mu")]
    cases = [*grid(statement), *homogeneous]
    return list(dict.fromkeys(call for case in cases for call in tasks_of("fscm", _FORCE, case)))


def _sensitivity(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """Largest deviation from the homogeneous solid: below the limit for some shapes, above it for the others."""
    small = statement.numbers("small_for")
    rows = []
    for n in statement.numbers("n"):
        errors = []
        for case in (case for case in grid(statement) if case[0] == n):
            exact = number(results, "fscm", _FORCE, (n, 0.0, case[2]))
            errors.append(relative_error("the graded solid", number(results, "fscm", _FORCE, case), "k = 0", exact))
        largest = max(errors, key=lambda error: error.value)
        relation = "<" if n in small else ">"
        rows.append(Evidence(f"n = {n:g}", "fscm", largest, relation, reading(statement), comparisons=len(errors)))
    return rows


def _jkr_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    return [call for case in grid(statement) for model in ("fscm", "jkr") for call in tasks_of(model, _FORCE, case)]


def _earlier_limit(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The relative distance of the force from JKR's falls with k at every Tabor number."""
    rows = []
    for label, cases in families(statement, "k").items():
        errors = []
        for case in cases:
            value, jkr = (number(results, model, _FORCE, case) for model in ("fscm", "jkr"))
            errors.append(relative_error("fscm", value, "jkr", jkr))
        rows += [Evidence(label, "fscm", later, "<", earlier) for earlier, later in pairwise(errors)]
    return rows


#: Tests of statements on the pull-off force over the gradient exponent, by name.
TESTS = {
    "sensitivity_to_k": StatementTest(_tasks, _sensitivity),
    "jkr_earlier_with_k": StatementTest(_jkr_tasks, _earlier_limit),
}
