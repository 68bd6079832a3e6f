"""Verdicts on the statements of the paper: the table, its evidence, and its texts."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from functools import partial
from itertools import pairwise

import pandas as pd

from comparisons.data.paper_statements import PaperStatement
from comparisons.data.paper_statements import paper_statements as stated
from comparisons.numerics.number_text import value_text
from comparisons.paper.paper_figure import Reading, Tables, paper_figure
from comparisons.paper.plan import Plan, together
from comparisons.paper.statements.kinds import FAILS, HOLDS, UNDECIDED, Evidence, comparisons_of, grouped

#: Verdicts on a statement whose comparisons are decided.
TRUE, FALSE, IN_PART = "true", "false", "true in part"
#: The two references: what fails by one must fail by the other, too.
REFERENCES = ("fscm", "fem")
#: The value is zero within its bound: no number above that bound changes the verdict.
NO_FLIP = "none above the bounds"
#: What decides first: a failure, then what is not decided.
_RANK = {FAILS: 0, UNDECIDED: 1, HOLDS: 2}
#: Factor of the range beyond the largest and below the smallest number at which a comparison changes.
_FAR = 2.0
#: A factor below this has an exponent.
_SMALL = 1e-3

#: Columns for which a terminal and a page have room.
_SHORT = ["section", "statement", "verdict", "holds in", "fails for", "beyond the paper", "flips"]
_ON_PAPER = [name for name in _SHORT if name != "beyond the paper"]
#: A parameter in the name of a clause.
_PARAMETER = re.compile(r"\b(n|k|mu) = ([0-9][0-9.e+-]*)")


def decisive(statement: PaperStatement, comparisons: Iterable[Evidence]) -> list[Evidence]:
    """Return the decisive comparison of each clause, model and kind of limit, in the order of the first ones.

    It is the largest failure, else what is least certain to hold.  A limit that reads a word is kept beside the others:
    the verdict may change with it.  Each says whether its clause is one of the paper's own cases.
    """
    evidence = []
    for rows in grouped(comparisons, lambda row: (row.clause, row.model, row.is_read)).values():
        row = min(rows, key=lambda row: (_RANK[row.outcome], row.margin))
        case = {name: float(value) for name, value in _PARAMETER.findall(row.clause)}
        count = sum(row.comparisons for row in rows)
        own, beyond = statement.is_own(case), statement.is_beyond(case)
        evidence.append(row._replace(own_case=own, beyond_paper=beyond, comparisons=count))
    return evidence


def clauses(evidence: Iterable[Evidence]) -> dict[str, str]:
    """Return whether each clause holds.

    A clause holds if all of its evidence holds, and fails if all of what can decide it fails: where `fscm` finds a
    failure, `fem` must find it, too, and otherwise the clause is not decided.

    Examples
    --------
    >>> by_one = Evidence("n = 2", True, False, "fscm", "", 1.0, 0.0, ">", 2.0, 0.0, "")
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
    >>> one = Evidence("n = 1", True, False, "formula", "", 1.0, 0.0, "<", 2.0, 0.0, "")
    >>> rows = [one._replace(clause=f"n = {x}", value=x) for x in (1.0, 2.0, 3.0)]
    >>> verdict(rows[:1]), verdict(rows[2:]), verdict(rows), verdict(rows[:2])
    ('true', 'false', 'true in part', 'not decided')
    """
    outcomes = set(clauses(evidence).values())
    if outcomes <= {HOLDS}:
        return TRUE if outcomes else ""
    if FAILS not in outcomes:
        return UNDECIDED
    return IN_PART if HOLDS in outcomes else FALSE


def verdict_at(evidence: Iterable[Evidence], number: float) -> str:
    """Return the verdict with another number that reads the word.

    Both references are given what only one of them computes: nothing is left open for lack of the other.
    """
    completed: list[Evidence] = []
    for rows in grouped(evidence, lambda row: row.clause).values():
        models = {row.model for row in rows}
        is_alone = len(models) == 1 and models <= set(REFERENCES)
        for row in rows:
            changed = row._replace(limit=number, u_limit=0.0) if row.is_read else row
            completed += [changed._replace(model=model) for model in (REFERENCES if is_alone else [row.model])]
    return verdict(completed)


def flips_text(evidence: Sequence[Evidence]) -> str:
    """Return the other verdicts, each with the factor nearest to 1 by which the number that reads a word must change.

    The nearest is the first; the text is empty where there is no such number.

    Examples
    --------
    >>> row = Evidence("n = 2", True, False, "formula", "", 0.1000341, 0.0, "<", 0.1, 0.0, "limit")
    >>> flips_text([row])
    'true above x 1.00035'
    >>> flips_text([row._replace(clause=f"mu = {x}", value=x / 20.0) for x in (3.0, 5.0)])
    'true in part above x 1.50; true above x 2.50'
    """
    read = [row for row in evidence if row.is_read]
    if not read:
        return ""
    number = read[0].limit
    now = verdict_at(evidence, number)
    ends = sorted({end for row in read for end in (row.value - row.u_value, row.value + row.u_value) if end > 0.0})
    nearest: dict[str, float] = {}
    # Ranges of the number in which no comparison changes its outcome.
    for low, high in pairwise([0.0, *ends, *(_FAR * end for end in ends[-1:])]):
        other = verdict_at(evidence, 0.5 * (low + high))
        if other not in (now, UNDECIDED) and not low <= number <= high:
            factor = (low if low > number else high) / number
            nearest[other] = min(nearest.get(other, math.inf), factor, key=_distance)
    factors = sorted(nearest.items(), key=lambda item: _distance(item[1]))
    texts = [f"{other} {'above' if factor > 1.0 else 'below'} x {_factor_text(factor)}" for other, factor in factors]
    return "; ".join(texts) or NO_FLIP


def _distance(factor: float) -> float:
    return abs(math.log(factor))


def _factor_text(factor: float) -> str:
    """Three digits, or those that tell the factor from 1 to a part in ten, rounded away from 1: it is enough."""
    decimals = max(2 - math.floor(math.log10(factor)), 1 - math.floor(math.log10(abs(factor - 1.0))))
    step = 10.0**-decimals
    steps = math.ceil(factor / step) if factor > 1.0 else math.floor(factor / step)
    return f"{steps * step:.3g}" if factor < _SMALL else f"{steps * step:.{max(decimals, 0)}f}"


def judged(statement: PaperStatement, evidence: Sequence[Evidence]) -> dict[str, str]:
    """Return the row of a statement from its evidence."""
    stated_rows = [row for row in evidence if not row.beyond_paper]
    stated = clauses(stated_rows)
    numbers = [row.limit for row in stated_rows if row.is_read]
    return {
        "id": statement.id,
        "section": statement.section,
        "statement": statement.statement,
        "test": statement.how,
        "range": statement.range,
        "verdict": verdict(stated_rows),
        "holds_in": _share_text(stated),
        "own_cases": _share_text(clauses(row for row in stated_rows if row.own_case)),
        "fails_for": _named(stated, FAILS),
        "beyond_paper": _beyond(clauses(row for row in evidence if row.beyond_paper)),
        "number": f"{numbers[0]:g}" if numbers else "",
        "flips": flips_text(stated_rows),
        "evidence": _sentences(stated_rows),
        "command": statement.command,
    }


def _share_text(outcomes: dict[str, str]) -> str:
    """Return in how many clauses it holds; empty without a clause."""
    return f"{list(outcomes.values()).count(HOLDS)} of {len(outcomes)}" if outcomes else ""


def _named(outcomes: dict[str, str], outcome: str) -> str:
    """Return the clauses of an outcome, those that differ in one parameter together.

    Examples
    --------
    >>> _named({f"n = {n}, mu = {mu}": "fails" for n, mu in ((1, 2), (1, 3), (2, 3), (5, 3))}, "fails")
    'n = 1, mu = 2, 3; n = 2, 5, mu = 3'
    """
    named = [tuple(clause.split(", ")) for clause, of_clause in outcomes.items() if of_clause == outcome]
    for position in reversed(range(max(map(len, named), default=0))):
        named = _together(named, position)
    return "; ".join(map(", ".join, named))


def _together(named: Sequence[tuple[str, ...]], position: int) -> list[tuple[str, ...]]:
    """Join the values at one position of clauses that are equal elsewhere."""
    groups: dict[tuple[str, ...], list[str]] = {}
    for parts in named:
        name, _, value = parts[position].partition(" = ") if position < len(parts) else ("", "", "")
        key = (*parts[:position], f"{name} = ", *parts[position + 1 :]) if value else parts
        groups.setdefault(key, []).append(value)
    return [
        (*key[:position], key[position] + ", ".join(values), *key[position + 1 :]) if values[0] else key
        for key, values in groups.items()
    ]


def _beyond(outcomes: dict[str, str]) -> str:
    present = [outcome for outcome in (HOLDS, FAILS, UNDECIDED) if outcome in outcomes.values()]
    return ", ".join(f"{outcome} for {_named(outcomes, outcome)}" for outcome in present)


def _sentences(rows: Sequence[Evidence]) -> str:
    """Return what decides: the clause that fails by most, the paper's own cases first, or what holds by least."""
    missed = [row for row in rows if row.outcome != HOLDS]
    least = min(missed or rows, key=lambda row: (row.outcome != FAILS, bool(missed) and not row.own_case, _share(row)))
    return "; ".join(_sentence(row) for row in rows if row.clause == least.clause and (row is least or row in missed))


def _share(row: Evidence) -> float:
    size = max(abs(row.value), abs(row.limit))
    return row.margin / size if size else 0.0


def _sentence(row: Evidence) -> str:
    limit = _number(row.limit, row.u_limit)
    compared = f"{_number(row.value, row.u_value)} {row.relation} {limit} {row.outcome}"
    against = "" if row.is_read or not row.limit_what else f" against {row.limit_what}"
    return f"{row.model}: {row.what}{against}: {compared}"


def _number(value: float, u: float) -> str:
    return f"{value:g}" if u == 0.0 else value_text(value, u)


def readable(table: pd.DataFrame) -> Reading:
    """Return the table for reading: empty columns of a row as nothing."""
    texts = table.fillna("").drop(columns="id").rename(columns={"beyond_paper": "beyond the paper"})
    texts = texts.rename(columns=lambda name: name.replace("_", " "))
    return texts, texts[_SHORT], texts[_ON_PAPER]


# The turning points are counted at the points that the solver places.
@paper_figure(name="statements", reading=readable, follows_path=True)
def paper_statements() -> Plan[Tables]:
    """Statements of the paper, judged."""
    statements = stated()
    decided = {statement.id: comparisons_of(statement).then(partial(decisive, statement)) for statement in statements}

    def make(evidence: dict[str, list[Evidence]]) -> Tables:
        rows = [judged(statement, evidence[statement.id]) for statement in statements]
        # One row a comparison, with all its digits.
        comparison_rows = [
            {"statement": name, **row._asdict(), "outcome": row.outcome} for name, of in evidence.items() for row in of
        ]
        return {"": pd.DataFrame(rows), "evidence": pd.DataFrame(comparison_rows)}

    return together(decided).then(make)
