"""Comparisons of numbers with bounds, the verdict on a statement, and the factors that change it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import pairwise
from typing import NamedTuple, TypeVar

T = TypeVar("T")
K = TypeVar("K")

#: Outcomes of a comparison of a clause.
HOLDS, FAILS, UNDECIDED = "holds", "fails", "not decided"
#: Verdicts on a statement whose comparisons are decided.
TRUE, FALSE, IN_PART = "true", "false", "true in part"

#: The two references: what fails by one must fail by the other, too.
REFERENCES = ("fscm", "fem")

#: What a limit is that reads a word without a number ("well", "small"), or that the paper states as a round number.
READING = "limit"

#: The value is zero within its bound: no number above that bound changes the verdict.
NO_FLIP = "none above the bounds"

#: Relation -> sign of value - limit where it holds.
_SIGNS = {"<": -1.0, ">": 1.0}
#: What decides first: a failure, then what is not decided.
_RANK = {FAILS: 0, UNDECIDED: 1, HOLDS: 2}
#: Factor of the range beyond the largest and below the smallest number at which a comparison changes.
_FAR = 2.0
#: A factor below this has an exponent.
_SMALL = 1e-3


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


class Number(NamedTuple):
    """A value, a bound on its numerical error, and what it is of."""

    value: float
    u: float
    title: str


class Evidence(NamedTuple):
    """One comparison of a clause of a statement: the decisive one of several.

    Attributes
    ----------
    clause : str
        Part of the statement, e.g. a case.
    model : str
        Model or formula that the value is of.
    value, limit : Number
        What is compared.
    relation : {"<", ">"}
        The value to the limit, according to the statement.
    own : bool
        Whether the clause is a case that the paper shows or names.
    beyond : bool
        Whether the clause is beyond what the paper states.
    comparisons : int
        How many comparisons this one was selected from.
    """

    clause: str
    model: str
    value: Number
    relation: str
    limit: Number
    own: bool = False
    beyond: bool = False
    comparisons: int = 1

    @property
    def margin(self) -> float:
        """Distance from the limit, positive on the side that the statement names."""
        return _SIGNS[self.relation] * (self.value.value - self.limit.value)

    @property
    def is_read(self) -> bool:
        """Whether the limit reads a word."""
        return self.limit.title == READING

    @property
    def outcome(self) -> str:
        """Whether it holds, fails, or is not decided within the sum of both bounds.

        Examples
        --------
        >>> low, high = Number(1.0, 0.1, "a"), Number(1.5, 0.1, "b")
        >>> [Evidence("", "fscm", low, relation, high).outcome for relation in "<>"]
        ['holds', 'fails']
        >>> Evidence("", "fscm", low, "<", Number(1.15, 0.1, "b")).outcome
        'not decided'
        """
        bound = self.value.u + self.limit.u
        if not math.isfinite(self.margin) or not math.isfinite(bound) or abs(self.margin) <= bound:
            return UNDECIDED
        return HOLDS if self.margin > 0.0 else FAILS


def by_clause(comparisons: Iterable[Evidence]) -> list[Evidence]:
    """Return the decisive comparison of each clause, model and kind of limit, in the order of the first ones.

    It is the largest failure, else what is least certain to hold.  A limit that reads a word is kept beside the others:
    the verdict may change with it.

    Examples
    --------
    >>> limit = Number(2.0, 0.0, READING)
    >>> rows = [Evidence(clause, "fscm", Number(x, 0.0, ""), "<", limit) for clause, x in zip("aba", (1, 2, 3))]
    >>> [(row.clause, row.value.value, row.comparisons) for row in by_clause(rows)]
    [('a', 3, 2), ('b', 2, 1)]
    """
    groups = grouped(comparisons, lambda row: (row.clause, row.model, row.is_read))
    decisive = []
    for rows in groups.values():
        least_certain = min(rows, key=lambda row: (_RANK[row.outcome], row.margin))
        decisive.append(least_certain._replace(comparisons=sum(row.comparisons for row in rows)))
    return decisive


def clauses(evidence: Iterable[Evidence]) -> dict[str, str]:
    """Return whether each clause holds.

    A clause holds if all of its evidence holds, and fails if all of what can decide it fails: where `fscm` finds a
    failure, `fem` must find it, too, and otherwise the clause is not decided.

    Examples
    --------
    >>> one, two = Number(1.0, 0.0, ""), Number(2.0, 0.0, "")
    >>> by_one = Evidence("n = 2", "fscm", one, ">", two)
    >>> clauses([by_one]), clauses([by_one, by_one._replace(model="fem")])
    ({'n = 2': 'not decided'}, {'n = 2': 'fails'})
    """
    return {clause: _outcome(rows) for clause, rows in grouped(evidence, lambda row: row.clause).items()}


def _outcome(rows: Sequence[Evidence]) -> str:
    if all(row.outcome == HOLDS for row in rows):
        return HOLDS
    failed = {row.model for row in rows if row.outcome == FAILS}
    # Formulas need no second reference; the two references need each other.
    confirmed = failed and (not failed.intersection(REFERENCES) or failed.issuperset(REFERENCES))
    return FAILS if confirmed else UNDECIDED


def verdict(evidence: Iterable[Evidence]) -> str:
    """Return the verdict on a statement from its clauses; empty without a clause.

    Examples
    --------
    >>> limit = Number(2.0, 0.0, "")
    >>> rows = [Evidence(f"n = {x}", "formula", Number(x, 0.0, ""), "<", limit) for x in (1.0, 2.0, 3.0)]
    >>> verdict(rows[:1]), verdict(rows[2:]), verdict(rows), verdict(rows[:2])
    ('true', 'false', 'true in part', 'not decided')
    """
    outcomes = set(clauses(evidence).values())
    if outcomes <= {HOLDS}:
        return TRUE if outcomes else ""
    if FAILS not in outcomes:
        return UNDECIDED
    return IN_PART if HOLDS in outcomes else FALSE


def read_number(evidence: Iterable[Evidence]) -> float | None:
    """Return the number that reads a word of the statement, or None if every comparison is of two computed numbers."""
    return next((row.limit.value for row in evidence if row.is_read), None)


def verdict_at(evidence: Iterable[Evidence], number: float) -> str:
    """Return the verdict with another number that reads the word.

    Both references are given what only one of them computes: nothing is left open for lack of the other.
    """
    completed: list[Evidence] = []
    for rows in grouped(evidence, lambda row: row.clause).values():
        models = {row.model for row in rows}
        is_alone = len(models) == 1 and models <= set(REFERENCES)
        for row in rows:
            changed = row._replace(limit=Number(number, 0.0, READING)) if row.is_read else row
            completed += [changed._replace(model=model) for model in (REFERENCES if is_alone else [row.model])]
    return verdict(completed)


def flips(evidence: Sequence[Evidence]) -> dict[str, float]:
    """Return the other verdicts, each with the factor nearest to 1 by which the number must change for it.

    Examples
    --------
    >>> rows = [Evidence(f"mu = {x}", "fscm", Number(x, 0.0, ""), "<", Number(2.0, 0.0, READING)) for x in (3.0, 5.0)]
    >>> flips(rows)
    {'true in part': 1.5, 'true': 2.5}
    """
    number = read_number(evidence)
    if number is None:
        return {}
    now = verdict_at(evidence, number)
    nearest: dict[str, float] = {}
    for low, high in _ranges(evidence):
        other = verdict_at(evidence, 0.5 * (low + high))
        if other in (now, UNDECIDED) or low <= number <= high:
            continue
        factor = (low if low > number else high) / number
        nearest[other] = min(nearest.get(other, math.inf), factor, key=_distance)
    return dict(sorted(nearest.items(), key=lambda item: _distance(item[1])))


def _ranges(evidence: Sequence[Evidence]) -> Iterator[tuple[float, float]]:
    """Ranges of the number in which no comparison changes its outcome."""
    ends = {row.value.value + u for row in evidence if row.is_read for u in (-row.value.u, row.value.u)}
    positive = sorted(end for end in ends if end > 0.0)
    if positive:
        yield from pairwise([0.0, *positive, _FAR * positive[-1]])


def _distance(factor: float) -> float:
    return max(factor, 1.0 / factor) if factor > 0.0 else math.inf


def flips_text(evidence: Sequence[Evidence]) -> str:
    """Return the factors as a text, the nearest first; empty where there is no number.

    Examples
    --------
    >>> row = Evidence("n = 2", "formula", Number(0.1000341, 0.0, ""), "<", Number(0.1, 0.0, READING))
    >>> flips_text([row])
    'true above x 1.00035'
    """
    if read_number(evidence) is None:
        return ""
    factors = flips(evidence).items()
    texts = [f"{other} {'above' if factor > 1.0 else 'below'} x {_factor_text(factor)}" for other, factor in factors]
    return "; ".join(texts) or NO_FLIP


def _factor_text(factor: float) -> str:
    """Three digits, or those that tell the factor from 1 to a part in ten, rounded away from 1: it is enough."""
    decimals = max(2 - math.floor(math.log10(factor)), 1 - math.floor(math.log10(abs(factor - 1.0))))
    step = 10.0**-decimals
    steps = math.ceil(factor / step) if factor > 1.0 else math.floor(factor / step)
    return f"{steps * step:.3g}" if factor < _SMALL else f"{steps * step:.{max(decimals, 0)}f}"
