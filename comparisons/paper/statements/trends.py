"""Tests of order: a quantity that rises or falls with one parameter, and quantities that rise along the path."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations, pairwise

from comparisons.data.paper_statements import PaperStatement
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.statements.evidence import Evidence, Number
from comparisons.paper.statements.sources import (
    PARAMETERS,
    Case,
    StatementTest,
    case_label,
    family_label,
    grid,
    number,
    tasks_of,
    witnesses,
)

__all__ = ["TESTS", "families", "one_way"]

_RELATIONS = {"rises": ">", "falls": "<"}


def _tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    name = str(statement.arguments["quantity"])
    cases = [("fscm", case) for case in grid(statement)]
    cases += [("fem", case) for pair in _witness_pairs(statement) for case in pair]
    return [call for model, case in cases for call in tasks_of(model, name, case)]


def _witness_pairs(statement: PaperStatement) -> Iterator[tuple[Case, Case]]:
    """Pairs of cases that the finite elements compare, too."""
    for first, second in statement.arguments.get("witness", ()):
        yield tuple(map(float, first)), tuple(map(float, second))  # type: ignore[misc]


def families(statement: PaperStatement, along: str) -> dict[str, list[Case]]:
    """Return the cases of the grid that differ in one parameter only, by their label."""
    of_label: dict[str, list[Case]] = {}
    for case in grid(statement):
        of_label.setdefault(family_label(case, along), []).append(case)
    return {label: sorted(cases, key=lambda case: case[PARAMETERS.index(along)]) for label, cases in of_label.items()}


def _evidence(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    name, relation = str(statement.arguments["quantity"]), _RELATIONS[str(statement.arguments["direction"])]
    along = str(statement.arguments["along"])
    size = bool(statement.arguments.get("size", False))

    def value(model: str, case: Case) -> Number:
        signed = number(results, model, name, case)
        return replace(signed, value=abs(signed.value), what=f"size of {signed.what}") if size else signed

    rows: list[Evidence] = []
    for label, cases in families(statement, along).items():
        rows += one_way(label, "fscm", [value("fscm", case) for case in cases], relation)
    for pair in _witness_pairs(statement):
        label = family_label(pair[0], along)
        rows += one_way(label, "fem", [value("fem", case) for case in pair], relation)
    return rows


def one_way(clause: str, model: str, numbers: Sequence[Number], relation: str) -> list[Evidence]:
    """Compare every number with all before it.

    Examples
    --------
    >>> numbers = [Number(value, 0.0, "") for value in (1.0, 3.0, 2.0)]
    >>> [row.outcome for row in one_way("", "fscm", numbers, ">")]
    ['holds', 'holds', 'fails']
    """
    return [Evidence(clause, model, later, relation, earlier) for earlier, later in combinations(numbers, 2)]


def _order_tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    names = [str(name) for name in statement.arguments["quantities"]]
    cases = [("fscm", case) for case in grid(statement)] + [("fem", case) for case in witnesses(statement)]
    return list(dict.fromkeys(call for model, case in cases for name in names for call in tasks_of(model, name, case)))


def _order(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """Several quantities of a case, each above the one before it."""
    names = [str(name) for name in statement.arguments["quantities"]]
    rows = []
    for model, cases in (("fscm", grid(statement)), ("fem", witnesses(statement))):
        for case in cases:
            numbers = [number(results, model, name, case) for name in names]
            rows += [Evidence(case_label(case), model, later, ">", earlier) for earlier, later in pairwise(numbers)]
    return rows


#: Tests of statements on trends over n, k and mu, and on the order of quantities, by name.
TESTS = {"trend": StatementTest(_tasks, _evidence), "order": StatementTest(_order_tasks, _order)}
