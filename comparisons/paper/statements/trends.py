"""Tests of order and of limits: a quantity along one parameter, quantities along the path, and what vanishes."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import combinations, pairwise, product

from comparisons.data.paper_statements import PaperStatement
from comparisons.paper.statements.evidence import Evidence, Number
from comparisons.paper.statements.numbers import (
    Case,
    Comparisons,
    both,
    case_label,
    clause_of,
    families,
    family_label,
    grid,
    models_of,
    number,
    numbers,
    quantity_of,
    reading,
    signed_error,
    tasks_of,
)

__all__ = ["TESTS", "extrapolated", "one_way", "ordered", "vanishes"]

_RELATIONS = {"rises": ">", "falls": "<"}


def one_way(clause: str, model: str, values: Sequence[Number], relation: str) -> list[Evidence]:
    """Compare every number with all before it.

    Examples
    --------
    >>> values = [Number(value, 0.0, "") for value in (1.0, 3.0, 2.0)]
    >>> [row.outcome for row in one_way("", "fscm", values, ">")]
    ['holds', 'holds', 'fails']
    """
    return [Evidence(clause, model, later, relation, earlier) for earlier, later in combinations(values, 2)]


def ordered(values: Mapping[Case, Number], along: str, relation: str) -> list[Evidence]:
    """Compare numbers of the FSCM along one parameter, every one with all before it."""
    return [
        row
        for label, cases in families(values, along).items()
        for row in one_way(label, "fscm", [values[case] for case in cases], relation)
    ]


def extrapolated(first: Number, second: Number, third: Number) -> Number:
    """Return the limit of a sequence from its last three members (Aitken), with the bound that theirs give it.

    It is exact for a power of a parameter that changes by one factor from each member to the next.

    Examples
    --------
    >>> members = [Number(0.3 + value, 1e-9, "x") for value in (0.4, 0.2, 0.1)]
    >>> round(extrapolated(*members).value, 12)
    0.3
    """
    bend = first.value + third.value - 2.0 * second.value
    what = f"limit of the sequence that ends with {third.what}"
    if bend == 0.0:
        return Number(third.value, third.u, what)
    limit = (first.value * third.value - second.value**2) / bend
    # Derivatives by the three members.
    parts = (third.value - limit, 2.0 * (limit - second.value), first.value - limit)
    u = sum(abs(part / bend) * member.u for part, member in zip(parts, (first, second, third), strict=True))
    return Number(limit, u, what)


def vanishes(clause: str, values: Sequence[Number], limit: Number, model: str = "fscm") -> list[Evidence]:
    """Compare the size of every number with that of the one before it, and their extrapolated limit with a number."""

    def size(value: Number, of: str) -> Number:
        return Number(abs(value.value), value.u, f"size of {of}{value.what}")

    sizes = [size(value, "") for value in values]
    rows = [Evidence(clause, model, later, "<", earlier) for earlier, later in pairwise(sizes)]
    return [*rows, Evidence(clause, model, size(extrapolated(*values[-3:]), "the "), "<", limit)]


def trend(statement: PaperStatement) -> Comparisons:
    """A quantity, or its size, rises or falls along one parameter; pairs of cases by the finite elements, too."""
    relation, along = _RELATIONS[str(statement.arguments["direction"])], str(statement.arguments["along"])
    witness = statement.arguments.get("witness", ())
    pairs: list[list[Case]] = [[(float(n), float(k), float(mu)) for n, k, mu in pair] for pair in witness]
    places = [("fscm", case) for case in grid(statement)] + [("fem", case) for pair in pairs for case in pair]
    found = yield from numbers(quantity_of(statement), places)
    if statement.arguments.get("size", False):
        found = {at: replace(one, value=abs(one.value), what=f"size of {one.what}") for at, one in found.items()}
    rows = ordered({case: found["fscm", case] for case in grid(statement)}, along, relation)
    for pair in pairs:
        rows += one_way(family_label(pair[0], along), "fem", [found["fem", case] for case in pair], relation)
    return rows


def order(statement: PaperStatement) -> Comparisons:
    """Several quantities of a case, each above the one before it."""
    names = [str(name) for name in statement.arguments["quantities"]]
    results = yield [call for model, case in both(statement) for name in names for call in tasks_of(model, name, case)]
    return [
        Evidence(case_label(case), model, later, ">", earlier)
        for model, case in both(statement)
        for earlier, later in pairwise([number(results, model, name, case) for name in names])
    ]


def _sequences(statement: PaperStatement) -> dict[str, list[Case]]:
    """Cases of one shape and one gradient exponent, in the order of the statement's Tabor numbers."""
    return {
        family_label((n, k, 0.0), "mu"): [(n, k, mu) for mu in statement.numbers("mu")]
        for n, k in product(statement.numbers("n"), statement.numbers("k"))
    }


def _difference(model: str, value: Number, reference: str, exact: Number) -> Number:
    what = f"difference of {model} from {reference}: {value.what}"
    return Number(exact.value - value.value, exact.u + value.u, what)


def vanishing_error(statement: PaperStatement) -> Comparisons:
    """The error of each model, or its difference where the limit may be zero, vanishes along the Tabor numbers."""
    models, error = models_of(statement), _difference if statement.arguments.get("difference") else signed_error
    found = yield from numbers(
        quantity_of(statement), [(model, case) for case in grid(statement) for model in ("fscm", *models)]
    )
    rows: list[Evidence] = []
    for model in models:
        for label, cases in _sequences(statement).items():
            errors = [error(model, found[model, case], "fscm", found["fscm", case]) for case in cases]
            rows += vanishes(clause_of(statement, model, label), errors, reading(statement))
    return rows


def power_of_mu(statement: PaperStatement) -> Comparisons:
    """The power of mu between neighbouring Tabor numbers tends to that of the asymptote."""
    name = quantity_of(statement)
    found = yield from numbers(name, [("fscm", case) for case in grid(statement)])
    rows: list[Evidence] = []
    for label, cases in _sequences(statement).items():
        n, k, _ = cases[0]
        # Eq. 47 is 1 - C mu^p; Eq. 54 is -C mu.
        is_jump_in = name == "jump_in_displacement"
        shift, expected = (1.0, (2 * n + k - 1) / (4 * n + k - 1)) if is_jump_in else (0.0, 1.0)
        differences = []
        for low, high in pairwise(cases):
            small, large = (found["fscm", case] for case in (low, high))
            steps = math.log(high[2] / low[2])
            power = math.log((shift - large.value) / (shift - small.value)) / steps
            u = (small.u / (shift - small.value) + large.u / (shift - large.value)) / steps
            what = (
                f"difference of the power {power:.4f} of mu from {expected:.4f}, {label}, "
                f"mu from {low[2]:g} to {high[2]:g}"
            )
            differences.append(Number(power - expected, u, what))
        rows += vanishes(label, differences, reading(statement))
    return rows


#: Tests of statements on trends over n, k and mu, on limits, and on the order of quantities, by name.
TESTS = {"trend": trend, "order": order, "vanishing_error": vanishing_error, "power_of_mu": power_of_mu}
