"""Tests of limits at a large or at a vanishing Tabor number: what falls at each step, and is extrapolated."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from comparisons.data.paper_statements import PaperStatement
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.statements.closeness import clause_of, models_of, signed_error
from comparisons.paper.statements.evidence import Evidence, Number
from comparisons.paper.statements.sources import Case, StatementTest, family_label, number, reading, tasks_of

__all__ = ["TESTS", "extrapolated", "vanishes"]

_JUMP_IN = "jump_in_displacement"


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


def vanishes(clause: str, numbers: Sequence[Number], limit: Number) -> list[Evidence]:
    """Compare the size of every number with that of the one before it, and their extrapolated limit with a number."""
    sizes = [Number(abs(value.value), value.u, f"size of {value.what}") for value in numbers]
    rows = [Evidence(clause, "fscm", later, "<", earlier) for earlier, later in pairwise(sizes)]
    end = extrapolated(*numbers[-3:])
    return [*rows, Evidence(clause, "fscm", Number(abs(end.value), end.u, f"size of the {end.what}"), "<", limit)]


def _sequences(statement: PaperStatement) -> list[list[Case]]:
    """Cases of one shape and one gradient exponent, in the order of the statement's Tabor numbers."""
    return [
        [(n, k, mu) for mu in statement.numbers("mu")] for n in statement.numbers("n") for k in statement.numbers("k")
    ]


def _tasks(statement: PaperStatement) -> Sequence[CachedCall]:
    name = str(statement.arguments["quantity"])
    return [
        call
        for cases in _sequences(statement)
        for case in cases
        for model in ("fscm", *models_of(statement))
        for call in tasks_of(model, name, case)
    ]


def _errors(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The error of each model, or its difference where the limit may be zero, vanishes along the Tabor numbers."""
    name = str(statement.arguments["quantity"])
    relative = not statement.arguments.get("difference", False)
    rows = []
    for model in models_of(statement):
        for cases in _sequences(statement):
            errors = []
            for case in cases:
                value, exact = (number(results, one, name, case) for one in (model, "fscm"))
                errors.append(
                    signed_error(model, value, "fscm", exact) if relative else _difference(model, value, exact)
                )
            clause = clause_of(statement, model, family_label(cases[0], "mu"))
            rows += vanishes(clause, errors, reading(statement))
    return rows


def _difference(model: str, value: Number, exact: Number) -> Number:
    return Number(exact.value - value.value, exact.u + value.u, f"difference of {model} from fscm: {value.what}")


def _powers(statement: PaperStatement, results: Results) -> Sequence[Evidence]:
    """The power of mu between neighbouring Tabor numbers tends to that of the asymptote."""
    name = str(statement.arguments["quantity"])
    rows = []
    for cases in _sequences(statement):
        n, k, _ = cases[0]
        # Eq. 47 is 1 - C mu^p; Eq. 54 is -C mu.
        shift, expected = (1.0, (2 * n + k - 1) / (4 * n + k - 1)) if name == _JUMP_IN else (0.0, 1.0)
        sizes = []
        for case in cases:
            value = number(results, "fscm", name, case)
            sizes.append(Number(shift - value.value, value.u, value.what))
        differences = []
        for (low, small), (high, large) in pairwise(zip(cases, sizes, strict=True)):
            steps = math.log(high[2] / low[2])
            power = math.log(large.value / small.value) / steps
            u = (small.u / small.value + large.u / large.value) / steps
            what = (
                f"difference of the power {power:.4f} of mu from {expected:.4f}, {family_label(high, 'mu')}, "
                f"mu from {low[2]:g} to {high[2]:g}"
            )
            differences.append(Number(power - expected, u, what))
        rows += vanishes(family_label(cases[0], "mu"), differences, reading(statement))
    return rows


#: Tests of statements on limits of the Tabor number, by name.
TESTS = {"vanishing_error": StatementTest(_tasks, _errors), "power_of_mu": StatementTest(_tasks, _powers)}
