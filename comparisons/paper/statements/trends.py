"""Tests of trends: a quantity that rises or falls with one parameter at fixed others."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations, product

from comparisons.data.paper_statements import PaperStatement
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.statements.evidence import Evidence, Number, decisive
from comparisons.paper.statements.sources import Case, StatementTest, grid, number, shape, tasks_of

__all__ = ["TESTS", "one_way"]

_PARAMETERS = ("n", "k", "mu")
_RELATIONS = {"rises": ">", "falls": "<"}


def _tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    name = str(statement.arguments["quantity"])
    cases = [("fscm", case) for case in grid(statement)]
    cases += [("fem", case) for pair in _witnesses(statement) for case in pair]
    return [call for model, case in cases for call in tasks_of(model, name, case)]


def _witnesses(statement: PaperStatement) -> Iterator[tuple[Case, Case]]:
    """Pairs of cases that the finite elements compare, too."""
    for first, second in statement.arguments.get("witness", ()):
        yield tuple(map(float, first)), tuple(map(float, second))  # type: ignore[misc]


def _evidence(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    name, relation = str(statement.arguments["quantity"]), _RELATIONS[str(statement.arguments["direction"])]
    along = _PARAMETERS.index(str(statement.arguments["along"]))
    size = bool(statement.arguments.get("size", False))

    def value(model: str, case: Case) -> Number:
        found = number(results, model, name, case)
        return replace(found, value=abs(found.value), what=f"size of {found.what}") if size else found

    rows: list[Evidence] = []
    for n in statement.numbers("n"):
        comparisons = []
        fixed = [statement.numbers(p) for i, p in enumerate(_PARAMETERS) if i != along and p != "n"]
        for others in product(*fixed):
            cases = [_case(n, along, step, others) for step in statement.numbers(_PARAMETERS[along])]
            comparisons += one_way(shape(n), "fscm", [value("fscm", case) for case in cases], relation)
        rows.append(replace(decisive(comparisons), beyond=statement.beyond(n)))
    for first, second in _witnesses(statement):
        pair = [value("fem", case) for case in (first, second)]
        rows.append(
            replace(decisive(one_way(shape(first[0]), "fem", pair, relation)), beyond=statement.beyond(first[0]))
        )
    return rows


def _case(n: float, along: int, step: float, others: Sequence[float]) -> Case:
    rest = [n, *others]
    return (*rest[:along], step, *rest[along:])  # type: ignore[return-value]


def one_way(clause: str, model: str, numbers: Sequence[Number], relation: str) -> list[Evidence]:
    """Compare every number with all before it.

    Examples
    --------
    >>> numbers = [Number(value, 0.0, "") for value in (1.0, 3.0, 2.0)]
    >>> [row.outcome for row in one_way("", "fscm", numbers, ">")]
    ['holds', 'holds', 'fails']
    """
    return [Evidence(clause, model, later, relation, earlier) for earlier, later in combinations(numbers, 2)]


#: Tests of statements on trends over n, k and mu, by name.
TESTS = {"trend": StatementTest(_tasks, _evidence)}
