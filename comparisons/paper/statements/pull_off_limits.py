"""Tests of the pull-off force over the gradient exponent and towards its limits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

from comparisons.data.paper_statements import PaperStatement
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.statements.closeness import relative_error
from comparisons.paper.statements.evidence import Evidence, Number, decisive
from comparisons.paper.statements.sources import StatementTest, grid, number, shape, tasks_of

__all__ = ["TESTS"]

_FORCE = "pull_off_force"


def _tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    homogeneous = [(n, 0.0, mu) for n in statement.numbers("n") for mu in statement.numbers("mu")]
    cases = [*grid(statement), *homogeneous]
    return list(dict.fromkeys(call for case in cases for call in tasks_of("fscm", _FORCE, case)))


def _sensitivity(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """Largest deviation from the homogeneous solid: below the limit for some shapes, above it for the others."""
    limit = Number(float(statement.arguments["within"]), 0.0, "limit")
    small = statement.numbers("small_for")
    rows = []
    for n in statement.numbers("n"):
        found = []
        for case in (case for case in grid(statement) if case[0] == n):
            exact = number(results, "fscm", _FORCE, (n, 0.0, case[2]))
            error = relative_error("the graded solid", number(results, "fscm", _FORCE, case), "k = 0", exact)
            found.append(Evidence(shape(n), "fscm", error, "<", limit))
        largest = max(found, key=lambda row: row.value.value)
        relation = "<" if n in small else ">"
        rows.append(replace(largest, relation=relation, comparisons=len(found), beyond=statement.beyond(n)))
    return rows


def _jkr_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    return [call for case in grid(statement) for model in ("fscm", "jkr") for call in tasks_of(model, _FORCE, case)]


def _earlier_limit(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The relative distance of the force from JKR's falls with k at every Tabor number."""
    rows = []
    for n in statement.numbers("n"):
        found = []
        for mu in statement.numbers("mu"):
            errors = []
            for k in statement.numbers("k"):
                value, jkr = (number(results, model, _FORCE, (n, k, mu)) for model in ("fscm", "jkr"))
                errors.append(relative_error("fscm", value, "jkr", jkr))
            found += [Evidence(shape(n), "fscm", later, "<", earlier) for earlier, later in pairwise(errors)]
        rows.append(replace(decisive(found), beyond=statement.beyond(n)))
    return rows


#: Tests of statements on limits of the pull-off force, by name.
TESTS = {
    "sensitivity_to_k": StatementTest(_tasks, _sensitivity),
    "jkr_earlier_with_k": StatementTest(_jkr_tasks, _earlier_limit),
}
