"""Kinds of tests of a statement: a comparison, a trend, a sequence that vanishes, and whether cases are alike."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import combinations, pairwise, product
from typing import Any

from comparisons.data.paper_statements import PaperStatement
from comparisons.paper.paper_figure import Plan, result_of, together
from comparisons.paper.statements.evidence import READING, REFERENCES, Evidence, Number
from comparisons.paper.statements.measures import Case, label, measured, model_of
from comparisons.paper.tasks import quantity
from comparisons.quantities import title_of

__all__ = ["KINDS", "comparisons_of", "extrapolated", "vanishes"]

Test = Mapping[str, Any]
#: Parameters of a case; s is the distance from s = 1 of a ratio of radii.
_PARAMETERS = ("n", "k", "mu", "s")


def _listed(values: Iterable[Iterable[float]]) -> list[Case]:
    return [tuple(zip(_PARAMETERS, map(float, case), strict=False)) for case in values]


def _cases(parameters: Test) -> list[Case]:
    """The ``cases`` of a test, and every combination of its parameters."""
    names = [name for name in _PARAMETERS if name in parameters]
    lattice = product(*(map(float, parameters[name]) for name in names)) if names else ()
    return _listed(parameters.get("cases", ())) + [tuple(zip(names, values, strict=True)) for values in lattice]


def _families(cases: Iterable[Case], along: str) -> dict[str, list[Case]]:
    """Return the cases that differ in one parameter only, by their label."""
    of_label: dict[str, list[Case]] = {}
    for case in cases:
        of_label.setdefault(label(case, along), []).append(case)
    return of_label


def _numbers(terms: Iterable[str], places: Sequence[tuple[str, Case]]) -> Plan[dict[tuple[str, str, Case], Number]]:
    return together({(term, *at): measured(term, *at) for term in terms for at in places})


def _limit(test: Test) -> Number:
    """The number of the test, by default that as which a word of the statement is read."""
    return Number(float(test.get("limit", test.get("within"))), 0.0, test["of"] if "limit" in test else READING)


def compare(test: Test) -> Plan[list[Evidence]]:
    """Every value is on one side of a limit, or of another value; with ``largest`` the largest of them."""
    terms = [test[name] for name in ("value", "than") if name in test]
    model, relation = model_of(terms[0]), test.get("relation", "<")
    places = [(model or "fscm", case) for case in _cases(test)]
    places += [("fem", case) for case in _listed(test.get("witness", ()))]
    numbers = yield from _numbers(terms, places)
    rows = []
    for reference, case in places:
        value, *than = (numbers[term, reference, case] for term in terms)
        clause = test.get("clause", test.get("prefix", "") + label(case))
        rows.append(Evidence(clause, reference, value, relation, than[0] if than else _limit(test)))
    if test.get("largest"):
        return [max(rows, key=lambda row: row.value.value)._replace(comparisons=len(rows))]
    return rows


def trend(test: Test) -> Plan[list[Evidence]]:
    """A value rises or falls along one parameter; pairs of cases by the finite elements, too."""
    term, along, relation = test["value"], test["along"], {"rises": ">", "falls": "<"}[test["direction"]]
    reference = model_of(term) or "fscm"
    families = [(reference, of, cases) for of, cases in _families(_cases(test), along).items()]
    for pair in map(_listed, test.get("witness", ())):
        families.append(("fem", label(pair[0], along), pair))
    numbers = yield from _numbers([term], [(model, case) for model, _, cases in families for case in cases])
    rows: list[Evidence] = []
    for model, of, cases in families:
        values = [numbers[term, model, case] for case in cases]
        pairs = pairwise(values) if test.get("neighbours") else combinations(values, 2)
        clause = test.get("prefix", "") + of
        rows += [Evidence(clause, model, later, relation, earlier) for earlier, later in pairs]
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
    what = f"limit of the sequence that ends with {third.what}"
    if bend == 0.0:
        return Number(third.value, third.u, what)
    limit = (earliest.value * third.value - second.value**2) / bend
    # Derivatives by the three members.
    parts = (third.value - limit, 2.0 * (limit - second.value), earliest.value - limit)
    u = sum(abs(slope / bend) * member.u for slope, member in zip(parts, (earliest, second, third), strict=True))
    return Number(limit, u, what)


def vanishes(clause: str, values: Sequence[Number], limit: Number, model: str = "fscm") -> list[Evidence]:
    """Compare the size of every number with that of the one before it, and their extrapolated limit with a number."""

    def size(value: Number, of: str) -> Number:
        return Number(abs(value.value), value.u, f"size of {of}{value.what}")

    sizes = [size(value, "") for value in values]
    rows = [Evidence(clause, model, later, "<", earlier) for earlier, later in pairwise(sizes)]
    return [*rows, Evidence(clause, model, size(extrapolated(*values[-3:]), "the "), "<", limit)]


def vanish(test: Test) -> Plan[list[Evidence]]:
    """The values vanish along a parameter, in its order."""
    term = test["value"]
    reference = model_of(term) or "fscm"
    cases = _cases(test)
    numbers = yield from _numbers([term], [(reference, case) for case in cases])
    rows: list[Evidence] = []
    for of, family in _families(cases, test["along"]).items():
        values = [numbers[term, reference, case] for case in family]
        rows += vanishes(test.get("prefix", "") + of, values, _limit(test), reference)
    return rows


def alike(test: Test) -> Plan[list[Evidence]]:
    """Every case along a parameter has a quantity, or none has: a model refuses the energy where nothing jumps."""
    name, along = test["value"], test["along"]
    places = [("fscm", case) for case in _cases(test)] + [("fem", case) for case in _listed(test["witness"])]
    results = yield from together(
        {(model, case): result_of(quantity, model, name, *dict(case).values()) for model, case in places}
    )
    rows = []
    for model in REFERENCES:
        for of, family in _families((case for reference, case in places if reference == model), along).items():
            lacking = [case for case in family if results[model, case]["status"] == "not-applicable"]
            having = [case for case in family if case not in lacking]
            if lacking and having:
                result, what = results[model, having[0]], f"{title_of(name)}, {label(having[0])}"
                value = Number(result["value"], result["u_num"], what)
                limit = Number(0.0, 0.0, f"no jump at k = {', '.join(f'{dict(case)[along]:g}' for case in lacking)}")
            else:
                what = f"gradient exponents unlike the others, {of}: {len(having)} of {len(family)} have jumps"
                value, limit = Number(0.0, 0.0, what), Number(1.0, 0.0, "one of them")
            rows.append(Evidence(of, model, value, "<", limit))
    return rows


#: Every kind, by its name.
KINDS: dict[str, Callable[[Test], Plan[list[Evidence]]]] = {
    "compare": compare,
    "trend": trend,
    "vanish": vanish,
    "alike": alike,
}


def comparisons_of(statement: PaperStatement) -> Plan[list[Evidence]]:
    """Plan the comparisons of a statement, in the order of its tests."""
    tests = [{**statement.arguments, **test} for test in statement.tests]
    rows = yield from together({index: KINDS[test["kind"]](test) for index, test in enumerate(tests)})
    return [row for of_test in rows.values() for row in of_test]
