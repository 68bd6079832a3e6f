"""Kinds of tests of a statement: a comparison, a trend, a sequence that vanishes, and whether cases are alike."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import combinations, pairwise, product
from typing import Any, NamedTuple

from comparisons.data.paper_statements import PaperStatement
from comparisons.paper.paper_figure import Plan, together
from comparisons.paper.statements.evidence import READING, Evidence, Number, grouped
from comparisons.paper.statements.measures import Case, is_refused, label, measured, model_of

Test = Mapping[str, Any]
#: Parameters of a case; s is the distance from s = 1 of a ratio of radii.
_PARAMETERS = ("n", "k", "mu", "s")


class Family(NamedTuple):
    """Cases that differ in one parameter at most, by one reference or model; the clause is what they have in common."""

    model: str
    clause: str
    cases: list[Case]


def _listed(values: Iterable[Iterable[float]]) -> list[Case]:
    return [tuple(zip(_PARAMETERS, map(float, case), strict=False)) for case in values]


def _families(test: Test) -> list[Family]:
    """Return the families of a test: of its ``cases`` and every combination of its parameters, and of the witness."""
    along, prefix = test.get("along", ""), test.get("prefix", "")
    names = [name for name in _PARAMETERS if name in test]
    lattice = product(*(map(float, test[name]) for name in names)) if names else ()
    cases = _listed(test.get("cases", ())) + [tuple(zip(names, values, strict=True)) for values in lattice]
    model = model_of(test["value"]) or "fscm"
    families = [
        Family(model, clause, group) for clause, group in grouped(cases, lambda case: label(case, along)).items()
    ]
    for witness in test.get("witness", ()):
        group = _listed(witness if along else [witness])
        families.append(Family("fem", label(group[0], along), group))
    return [family._replace(clause=test.get("clause", prefix + family.clause)) for family in families]


def _limit(test: Test) -> Number:
    """The number of the test, by default that as which a word of the statement is read."""
    return Number(float(test.get("limit", test.get("within"))), 0.0, test["of"] if "limit" in test else READING)


def _compared(test: Test, family: Family, values: list[Number], limits: list[Number]) -> list[Evidence]:
    """The value is on one side of a limit, or of another value."""
    (limit,) = limits or [_limit(test)]
    return [Evidence(family.clause, family.model, values[0], test.get("relation", "<"), limit)]


def _ordered(test: Test, family: Family, values: list[Number], limits: list[Number]) -> list[Evidence]:
    """The value rises or falls along one parameter."""
    relation = {"rises": ">", "falls": "<"}[test["direction"]]
    pairs = pairwise(values) if test.get("neighbours") else combinations(values, 2)
    return [Evidence(family.clause, family.model, later, relation, earlier) for earlier, later in pairs]


def _vanishing(test: Test, family: Family, values: list[Number], limits: list[Number]) -> list[Evidence]:
    """The values vanish along a parameter, in its order."""
    return vanishes(family.clause, values, _limit(test), family.model)


def _alike(test: Test, family: Family, values: list[Number], limits: list[Number]) -> list[Evidence]:
    """Every case along a parameter has a quantity, or none has: a model refuses the energy where nothing jumps."""
    having = [value for value in values if not is_refused(value)]
    lacking = [dict(case)[test["along"]] for case, value in zip(family.cases, values, strict=True) if is_refused(value)]
    failed = [value for value in values if math.isnan(value.u)]
    if failed or (lacking and having):
        limit = Number(0.0, 0.0, f"no jump at k = {', '.join(f'{k:g}' for k in lacking)}")
        return [Evidence(family.clause, family.model, [*failed, *having][0], "<", limit)]
    title = f"gradient exponents unlike the others, {family.clause}: {len(having)} of {len(values)} have jumps"
    return [Evidence(family.clause, family.model, Number(0.0, 0.0, title), "<", Number(1.0, 0.0, "one of them"))]


#: Kind of a test -> the comparisons of the numbers of a family, and of those that they are compared with.
_KINDS: dict[str, Callable[[Test, Family, list[Number], list[Number]], list[Evidence]]] = {
    "compare": _compared,
    "trend": _ordered,
    "vanish": _vanishing,
    "alike": _alike,
}


def judged_by(test: Test) -> Plan[list[Evidence]]:
    """Plan the comparisons of a test; with ``largest`` that of the largest value."""
    families = _families(test)
    terms = [test[name] for name in ("value", "than") if name in test]
    numbers = yield from together(
        {
            (text, family.model, case): measured(text, family.model, case)
            for text in terms
            for family in families
            for case in family.cases
        }
    )
    rows: list[Evidence] = []
    for family in families:
        values, *limits = ([numbers[text, family.model, case] for case in family.cases] for text in terms)
        rows += _KINDS[test["kind"]](test, family, values, limits[0] if limits else [])
    if test.get("largest"):
        return [max(rows, key=lambda row: row.value.value)._replace(comparisons=len(rows))]
    return rows


def extrapolated(earliest: Number, second: Number, third: Number) -> Number:
    """Return the limit of a sequence from its last three members (Aitken), with the bound that theirs give it.

    It is exact for a power of a parameter that changes by one factor from each member to the next.

    Examples
    --------
    >>> members = [Number(0.3 + value, 1e-9, "x") for value in (0.4, 0.2, 0.1)]
    >>> round(extrapolated(*members).value, 12)
    0.3
    """
    bend = earliest.value + third.value - 2.0 * second.value
    title = f"limit of the sequence that ends with {third.title}"
    if bend == 0.0:
        return Number(third.value, third.u, title)
    limit = (earliest.value * third.value - second.value**2) / bend
    # Derivatives by the three members.
    parts = (third.value - limit, 2.0 * (limit - second.value), earliest.value - limit)
    u = sum(abs(slope / bend) * member.u for slope, member in zip(parts, (earliest, second, third), strict=True))
    return Number(limit, u, title)


def vanishes(clause: str, values: Sequence[Number], limit: Number, model: str = "fscm") -> list[Evidence]:
    """Compare the size of every number with that of the one before it, and their extrapolated limit with a number."""

    def size(value: Number, of: str) -> Number:
        return Number(abs(value.value), value.u, f"size of {of}{value.title}")

    sizes = [size(value, "") for value in values]
    rows = [Evidence(clause, model, later, "<", earlier) for earlier, later in pairwise(sizes)]
    return [*rows, Evidence(clause, model, size(extrapolated(*values[-3:]), "the "), "<", limit)]


def comparisons_of(statement: PaperStatement) -> Plan[list[Evidence]]:
    """Plan the comparisons of a statement, in the order of its tests."""
    tests = [{**statement.arguments, **test} for test in statement.tests]
    rows = yield from together({index: judged_by(test) for index, test in enumerate(tests)})
    return [row for of_test in rows.values() for row in of_test]
