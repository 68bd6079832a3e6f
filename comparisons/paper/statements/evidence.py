"""Comparisons of numbers with bounds, and the verdict on a statement that follows from them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import pandas as pd

__all__ = [
    "FAILS",
    "FALSE",
    "HOLDS",
    "IN_PART",
    "READING",
    "REFERENCES",
    "TRUE",
    "UNDECIDED",
    "Evidence",
    "Number",
    "by_clause",
    "clauses",
    "decisive",
    "evidence_frame",
    "evidence_of",
    "verdict",
]

#: Outcomes of a comparison of a clause.
HOLDS, FAILS, UNDECIDED = "holds", "fails", "not decided"
#: Verdicts on a statement whose comparisons are decided.
TRUE, FALSE, IN_PART = "true", "false", "true in part"

#: The two references: what fails by one must fail by the other, too.
REFERENCES = ("fscm", "fem")

#: What a limit is that reads a word without a number ("well", "small"), or that the paper states as a round number.
READING = "limit"

#: Relation -> sign of value - limit where it holds.
_SIGNS = {"<": -1.0, ">": 1.0}


@dataclass(frozen=True, slots=True)
class Number:
    """A value, a bound on its numerical error, and what it is of."""

    value: float
    u: float
    what: str


@dataclass(frozen=True, slots=True)
class Evidence:
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
    def bound(self) -> float:
        """Bound on the error of the margin: the sum of both bounds, not a combination of them."""
        return self.value.u + self.limit.u

    @property
    def outcome(self) -> str:
        """Whether it holds, fails, or is not decided within the bounds.

        Examples
        --------
        >>> low, high = Number(1.0, 0.1, "a"), Number(1.5, 0.1, "b")
        >>> [Evidence("", "fscm", low, relation, high).outcome for relation in "<>"]
        ['holds', 'fails']
        >>> Evidence("", "fscm", low, "<", Number(1.15, 0.1, "b")).outcome
        'not decided'
        """
        if not math.isfinite(self.margin) or not math.isfinite(self.bound):
            return UNDECIDED
        if abs(self.margin) <= self.bound:
            return UNDECIDED
        return HOLDS if self.margin > 0.0 else FAILS


#: What decides first: a failure, then what is not decided.
_RANK = {FAILS: 0, UNDECIDED: 1, HOLDS: 2}


def decisive(comparisons: Iterable[Evidence]) -> Evidence:
    """Return the comparison that decides: the largest failure, else what is least certain to hold.

    Examples
    --------
    >>> rows = [Evidence("", "", Number(x, 0.0, ""), "<", Number(2.0, 0.0, "")) for x in (1.0, 1.9, 1.5)]
    >>> row = decisive(rows)
    >>> row.value.value, row.comparisons
    (1.9, 3)
    """
    rows = list(comparisons)
    if not rows:
        raise ValueError("a clause has no comparison: the cases of its statement are empty")
    first = min(rows, key=lambda row: (_RANK[row.outcome], row.margin))
    return replace(first, comparisons=sum(row.comparisons for row in rows))


def by_clause(comparisons: Iterable[Evidence]) -> list[Evidence]:
    """Return the decisive comparison of each clause, model and kind of limit, in the order of the first ones.

    A limit that reads a word is kept beside the others: the verdict may change with it.

    Examples
    --------
    >>> limit = Number(2.0, 0.0, READING)
    >>> rows = [Evidence(clause, "fscm", Number(x, 0.0, ""), "<", limit) for clause, x in zip("aba", (1, 2, 3))]
    >>> [(row.clause, row.value.value) for row in by_clause(rows)]
    [('a', 3), ('b', 2)]
    """
    groups: dict[tuple[str, str, bool], list[Evidence]] = {}
    for row in comparisons:
        groups.setdefault((row.clause, row.model, row.limit.what == READING), []).append(row)
    return [decisive(rows) for rows in groups.values()]


def clauses(evidence: Iterable[Evidence]) -> dict[str, str]:
    """Return whether each clause holds.

    A clause holds if all of its evidence holds, and fails if all of what can decide it fails: where `fscm` finds a
    failure, `fem` must find it, too, and otherwise the clause is not decided.

    Examples
    --------
    >>> one, two = Number(1.0, 0.0, ""), Number(2.0, 0.0, "")
    >>> by_one = Evidence("n = 2", "fscm", one, ">", two)
    >>> clauses([by_one]), clauses([by_one, replace(by_one, model="fem")])
    ({'n = 2': 'not decided'}, {'n = 2': 'fails'})
    """
    rows_of: dict[str, list[Evidence]] = {}
    for row in evidence:
        rows_of.setdefault(row.clause, []).append(row)
    return {clause: _outcome(rows) for clause, rows in rows_of.items()}


def _outcome(rows: Sequence[Evidence]) -> str:
    outcomes = {row.outcome for row in rows}
    if outcomes == {HOLDS}:
        return HOLDS
    failed = {row.model for row in rows if row.outcome == FAILS}
    if not failed:
        return UNDECIDED
    # Formulas need no second reference; the two references need each other.
    confirmed = not failed.intersection(REFERENCES) or failed.issuperset(REFERENCES)
    return FAILS if confirmed else UNDECIDED


def verdict(outcomes: Iterable[str]) -> str:
    """Return the verdict on a statement from the outcomes of its clauses; empty without a clause.

    Examples
    --------
    >>> verdict([HOLDS, HOLDS]), verdict([FAILS]), verdict([HOLDS, FAILS]), verdict([HOLDS, UNDECIDED])
    ('true', 'false', 'true in part', 'not decided')
    """
    known = set(outcomes)
    if not known:
        return ""
    if known == {HOLDS}:
        return TRUE
    if FAILS not in known:
        return UNDECIDED
    return IN_PART if HOLDS in known else FALSE


def evidence_frame(statement: str, evidence: Iterable[Evidence]) -> pd.DataFrame:
    """Return one row a comparison, with all its digits."""
    return pd.DataFrame(
        {
            "statement": statement,
            "clause": row.clause,
            "own_case": row.own,
            "beyond_paper": row.beyond,
            "model": row.model,
            "what": row.value.what,
            "value": row.value.value,
            "u_value": row.value.u,
            "relation": row.relation,
            "limit": row.limit.value,
            "u_limit": row.limit.u,
            "limit_what": row.limit.what,
            "comparisons": row.comparisons,
            "outcome": row.outcome,
        }
        for row in evidence
    )


def evidence_of(table: pd.DataFrame) -> list[Evidence]:
    """Return the comparisons of a table that `evidence_frame` made."""
    return [
        Evidence(
            str(row.clause),
            str(row.model),
            Number(float(row.value), float(row.u_value), str(row.what)),
            str(row.relation),
            Number(float(row.limit), float(row.u_limit), str(row.limit_what)),
            bool(row.own_case),
            bool(row.beyond_paper),
            int(row.comparisons),
        )
        for row in table.itertuples(index=False)
    ]
