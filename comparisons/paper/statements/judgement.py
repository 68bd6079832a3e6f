"""Verdicts on the statements of the paper: the table, its evidence, and its texts."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence

import pandas as pd

from comparisons.data.paper_statements import PaperStatement
from comparisons.data.paper_statements import paper_statements as stated
from comparisons.data.toml_text import shipped
from comparisons.numerics.number_text import value_text
from comparisons.paper.paper_figure import Plan, Reading, Tables, paper_figure, together
from comparisons.paper.statements.evidence import (
    FAILS,
    HOLDS,
    UNDECIDED,
    Evidence,
    by_clause,
    clauses,
    flips_text,
    read_number,
    verdict,
)
from comparisons.paper.statements.kinds import comparisons_of

#: Columns for which a terminal and a page have room.
_SHORT = ["section", "statement", "verdict", "holds in", "fails for", "beyond the paper", "flips"]
_ON_PAPER = [name for name in _SHORT if name != "beyond the paper"]
#: A parameter in the name of a clause.
_PARAMETER = re.compile(r"\b(n|k|mu) = ([0-9][0-9.e+-]*)")


def decisive(statement: PaperStatement, comparisons: Iterable[Evidence]) -> list[Evidence]:
    """Return the decisive comparisons of every clause, each with whether it is one of the paper's own cases."""
    rows = []
    for row in by_clause(comparisons):
        case = {name: float(value) for name, value in _PARAMETER.findall(row.clause)}
        rows.append(row._replace(own=statement.is_own(case), beyond=statement.is_beyond(case)))
    return rows


def judged(statement: PaperStatement, evidence: Sequence[Evidence]) -> dict[str, str]:
    """Return the row of a statement from its evidence."""
    stated_rows = [row for row in evidence if not row.beyond]
    stated = clauses(stated_rows)
    number = read_number(stated_rows)
    return {
        "id": statement.id,
        "section": statement.section,
        "statement": statement.statement,
        "test": statement.how,
        "range": statement.range,
        "verdict": verdict(stated_rows),
        "holds_in": _share_text(stated),
        "own_cases": _share_text(clauses(row for row in stated_rows if row.own)),
        "fails_for": _named(stated, FAILS),
        "beyond_paper": _beyond(clauses(row for row in evidence if row.beyond)),
        "number": "" if number is None else f"{number:g}",
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
    least = min(missed or rows, key=lambda row: (row.outcome != FAILS, bool(missed) and not row.own, _share(row)))
    return "; ".join(_sentence(row) for row in rows if row.clause == least.clause and (row is least or row in missed))


def _share(row: Evidence) -> float:
    size = max(abs(row.value.value), abs(row.limit.value))
    return row.margin / size if size else 0.0


def _sentence(row: Evidence) -> str:
    limit = _number(row.limit.value, row.limit.u)
    compared = f"{_number(row.value.value, row.value.u)} {row.relation} {limit} {row.outcome}"
    against = "" if row.is_read or not row.limit.title else f" against {row.limit.title}"
    return f"{row.model}: {row.value.title}{against}: {compared}"


def _number(value: float, u: float) -> str:
    return f"{value:g}" if u == 0.0 else value_text(value, u)


def _evidence_frame(statement: str, evidence: Iterable[Evidence]) -> pd.DataFrame:
    """Return one row a comparison, with all its digits."""
    return pd.DataFrame(
        {
            "statement": statement,
            "clause": row.clause,
            "own_case": row.own,
            "beyond_paper": row.beyond,
            "model": row.model,
            "what": row.value.title,
            "value": row.value.value,
            "u_value": row.value.u,
            "relation": row.relation,
            "limit": row.limit.value,
            "u_limit": row.limit.u,
            "limit_what": row.limit.title,
            "comparisons": row.comparisons,
            "outcome": row.outcome,
        }
        for row in evidence
    )


def readable(table: pd.DataFrame) -> Reading:
    """Return the table for reading: empty columns of a row as nothing."""
    texts = table.fillna("").drop(columns="id").rename(columns={"beyond_paper": "beyond the paper"})
    texts = texts.rename(columns=lambda name: name.replace("_", " "))
    return Reading(texts, texts[_SHORT], texts[_ON_PAPER], shipped("paper_statements.toml")["notes"])


# The turning points are counted at the points that the solver places.
@paper_figure(name="statements", reading=readable, follows_path=True)
def paper_statements() -> Plan[Tables]:
    """Statements of the paper, judged."""
    statements = stated()
    comparisons = yield from together({statement.id: comparisons_of(statement) for statement in statements})
    evidence = {statement.id: decisive(statement, comparisons[statement.id]) for statement in statements}
    rows = [judged(statement, evidence[statement.id]) for statement in statements]
    frames = [_evidence_frame(name, of_statement) for name, of_statement in evidence.items()]
    return {"": pd.DataFrame(rows), "evidence": pd.concat(frames, ignore_index=True)}
