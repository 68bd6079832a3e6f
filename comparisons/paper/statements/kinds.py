"""Kinds of tests of a statement: a comparison, a trend, a sequence that vanishes, and whether cases are alike."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import chain, combinations, pairwise
from typing import Any, NamedTuple, TypeVar

from comparisons.data.paper_statements import PaperStatement
from comparisons.paper.plan import Plan, cases, together
from comparisons.paper.statements.measures import PARAMETERS, Case, Number, case_of, label, measured, model_of, refused

T = TypeVar("T")
K = TypeVar("K")

#: Outcomes of a comparison of a clause.
HOLDS, FAILS, UNDECIDED = "holds", "fails", "not decided"
#: What a limit is that reads a word without a number ("well", "small"), or that the paper states as a round number.
READING = "limit"
#: Relation -> sign of value - limit where it holds.
_SIGNS = {"<": -1.0, ">": 1.0}

Test = Mapping[str, Any]


class Family(NamedTuple):
    """Cases that differ in one parameter at most, by one reference or model; the clause is what they have in common."""

    model: str
    clause: str
    cases: Sequence[Case] = ()


class Evidence(NamedTuple):
    """One comparison of a clause of a statement: the decisive one of several.

    Attributes
    ----------
    clause : str
        Part of the statement, e.g. a case.
    own_case : bool
        Whether the clause is a case that the paper shows or names.
    beyond_paper : bool
        Whether the clause is beyond what the paper states.
    model : str
        Model or formula that the value is of.
    what, value, u_value
        What is compared, and its bound.
    relation : {"<", ">"}
        The value to the limit, according to the statement.
    limit, u_limit, limit_what
        With what it is compared.
    comparisons : int
        How many comparisons this one was selected from.
    """

    clause: str
    own_case: bool
    beyond_paper: bool
    model: str
    what: str
    value: float
    u_value: float
    relation: str
    limit: float
    u_limit: float
    limit_what: str
    comparisons: int = 1

    @classmethod
    def of(cls, family: Family, value: Number, relation: str, limit: Number) -> Evidence:
        """Return the comparison of two numbers for a clause by a model."""
        (size, u, what), (limit_size, u_limit, limit_what) = value, limit
        return cls(family.clause, False, False, family.model, what, size, u, relation, limit_size, u_limit, limit_what)

    @property
    def margin(self) -> float:
        """Distance from the limit, positive on the side that the statement names."""
        return _SIGNS[self.relation] * (self.value - self.limit)

    @property
    def is_read(self) -> bool:
        """Whether the limit reads a word."""
        return self.limit_what == READING

    @property
    def outcome(self) -> str:
        """Whether it holds, fails, or is not decided within the sum of both bounds.

        Examples
        --------
        >>> low, high = Number(1.0, 0.1, "a"), Number(1.5, 0.1, "b")
        >>> [Evidence.of(Family("fscm", ""), low, relation, high).outcome for relation in "<>"]
        ['holds', 'fails']
        >>> Evidence.of(Family("fscm", ""), low, "<", Number(1.15, 0.1, "b")).outcome
        'not decided'
        """
        bound = self.u_value + self.u_limit
        if not math.isfinite(self.margin) or not math.isfinite(bound) or abs(self.margin) <= bound:
            return UNDECIDED
        return HOLDS if self.margin > 0.0 else FAILS


def grouped(items: Iterable[T], key: Callable[[T], K]) -> dict[K, list[T]]:
    """Return the items of each key, in the order of the first ones.

    Examples
    --------
    >>> grouped([1, 3, 2], lambda number: number % 2)
    {1: [1, 3], 0: [2]}
    """
    groups: dict[K, list[T]] = {}
    for item in items:
        groups.setdefault(key(item), []).append(item)
    return groups


def _listed(values: Iterable[Iterable[float]]) -> list[Case]:
    return [tuple(zip(PARAMETERS, map(float, case), strict=False)) for case in values]


def _families(test: Test) -> list[Family]:
    """Return the families of a test: of its ``cases`` and every combination of its parameters, and of the witness."""
    along, prefix = test.get("along", ""), test.get("prefix", "")
    lattice = {name: test[name] for name in PARAMETERS if name in test}
    all_cases = _listed(test.get("cases", ())) + [case_of(case) for case in cases(**lattice) if lattice]
    groups = grouped(all_cases, lambda case: label(case, along))
    families = [Family(model_of(test["value"]) or "fscm", clause, group) for clause, group in groups.items()]
    for witness in test.get("witness", ()):
        group = _listed(witness if along else [witness])
        families.append(Family("fem", label(group[0], along), group))
    return [family._replace(clause=test.get("clause", prefix + family.clause)) for family in families]


def _limit(test: Test) -> Number:
    """The number of the test, by default that as which a word of the statement is read."""
    return Number(float(test.get("limit", test.get("within"))), 0.0, test["of"] if "limit" in test else READING)


def compared(test: Test, family: Family, values: list[Number], limits: list[Number]) -> list[Evidence]:
    """The value is on one side of a limit, or of another value."""
    (limit,) = limits or [_limit(test)]
    return [Evidence.of(family, values[0], test.get("relation", "<"), limit)]


def ordered(test: Test, family: Family, values: list[Number], limits: list[Number]) -> list[Evidence]:
    """The value rises or falls along one parameter."""
    relation = {"rises": ">", "falls": "<"}[test["direction"]]
    pairs = pairwise(values) if test.get("neighbours") else combinations(values, 2)
    return [Evidence.of(family, later, relation, earlier) for earlier, later in pairs]


def vanishing(test: Test, family: Family, values: list[Number], limits: list[Number]) -> list[Evidence]:
    """The values vanish along a parameter, in its order: each is smaller than that before it, and their limit small."""

    def size(value: Number, of: str) -> Number:
        return Number(abs(value.value), value.u, f"size of {of}{value.title}")

    sizes = [size(value, "") for value in values]
    rows = [Evidence.of(family, later, "<", earlier) for earlier, later in pairwise(sizes)]
    return [*rows, Evidence.of(family, size(extrapolated(*values[-3:]), "the "), "<", _limit(test))]


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


def alike(test: Test, family: Family, values: list[Number], limits: list[Number]) -> list[Evidence]:
    """Every case along a parameter has a quantity, or none has: a model refuses the energy where nothing jumps."""
    having = [value for value in values if not refused(value)]
    lacking = [dict(case)[test["along"]] for case, value in zip(family.cases, values, strict=True) if refused(value)]
    failed = [value for value in values if math.isnan(value.u)]
    if failed or (lacking and having):
        limit = Number(0.0, 0.0, f"no jump at k = {', '.join(f'{k:g}' for k in lacking)}")
        return [Evidence.of(family, [*failed, *having][0], "<", limit)]
    title = f"gradient exponents unlike the others, {family.clause}: {len(having)} of {len(values)} have jumps"
    return [Evidence.of(family, Number(0.0, 0.0, title), "<", Number(1.0, 0.0, "one of them"))]


#: Kind of a test -> the comparisons of the numbers of a family, and of those that they are compared with.
_KINDS: dict[str, Callable[[Test, Family, list[Number], list[Number]], list[Evidence]]] = {
    "compare": compared,
    "trend": ordered,
    "vanish": vanishing,
    "alike": alike,
}


def judged_by(test: Test) -> Plan[list[Evidence]]:
    """Plan the comparisons of a test; with ``largest`` that of the largest value."""
    families = _families(test)
    terms = [test[name] for name in ("value", "than") if name in test]
    plans = {
        (text, family.model, case): measured(text, family.model, case)
        for text in terms
        for family in families
        for case in family.cases
    }

    def evidence(numbers: dict[tuple[str, str, Case], Number]) -> list[Evidence]:
        rows: list[Evidence] = []
        for family in families:
            values, *limits = ([numbers[text, family.model, case] for case in family.cases] for text in terms)
            rows += _KINDS[test["kind"]](test, family, values, limits[0] if limits else [])
        if test.get("largest"):
            return [max(rows, key=lambda row: row.value)._replace(comparisons=len(rows))]
        return rows

    return together(plans).then(evidence)


def comparisons_of(statement: PaperStatement) -> Plan[list[Evidence]]:
    """Plan the comparisons of a statement, in the order of its tests."""
    tests = [{**statement.arguments, **test} for test in statement.tests]
    judgements = together({index: judged_by(test) for index, test in enumerate(tests)})
    return judgements.then(lambda of_tests: list(chain.from_iterable(of_tests.values())))
