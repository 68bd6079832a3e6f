"""Verdicts on the statements of the paper: the table, its evidence, and its texts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import pandas as pd

from comparisons.data.paper_statements import PaperStatement, paper_statements
from comparisons.numerics.number_text import value_text
from comparisons.output.fitted_table import FittedTable
from comparisons.output.latex import latex
from comparisons.output.markdown import markdown
from comparisons.output.tables import rich_table
from comparisons.paper.cache import CachedCall, Results
from comparisons.paper.paper_figure import PaperFigure, Tables
from comparisons.paper.statements.evidence import (
    FAILS,
    HOLDS,
    UNDECIDED,
    Evidence,
    clauses,
    evidence_frame,
    verdict,
)
from comparisons.paper.statements.registry import find_test

__all__ = ["PAPER_STATEMENTS", "judged", "readable"]

_TITLE = "Statements of the paper, judged"
_NOTES = (
    "Statements in words of our own. True: every comparison holds by more than the sum of the bounds; false: none of "
    "the clauses holds; true in part: some do. A clause that fails by fscm must fail by fem, too. In brackets: a bound "
    "on the error in units of the last digit, at least 5e-10. A word without a number (well, small) is read as the "
    "number in the column of the test."
)


def judged(statement: PaperStatement, evidence: Sequence[Evidence]) -> dict[str, str]:
    """Return the row of a statement from its evidence."""
    stated = clauses(row for row in evidence if not row.beyond)
    beyond = clauses(row for row in evidence if row.beyond)
    return {
        "id": statement.id,
        "section": statement.section,
        "statement": statement.statement,
        "test": statement.how,
        "range": statement.range,
        "verdict": verdict(stated.values()),
        "fails_for": _named(stated, FAILS),
        "beyond_paper": _beyond(beyond),
        "evidence": _sentences(row for row in evidence if not row.beyond),
        "command": statement.command,
    }


def _named(outcomes: dict[str, str], outcome: str) -> str:
    return "; ".join(clause for clause, found in outcomes.items() if found == outcome)


def _beyond(outcomes: dict[str, str]) -> str:
    parts = [f"{outcome} for {_named(outcomes, outcome)}" for outcome in (HOLDS, FAILS, UNDECIDED)]
    return ", ".join(part for part in parts if not part.endswith(" for "))


def _sentences(evidence: Iterable[Evidence]) -> str:
    """Return what decides: the rows of the clause that fails by most, or else the row that holds by least."""
    rows = list(evidence)
    missed = [row for row in rows if row.outcome != HOLDS]
    least = min(missed or rows, key=lambda row: (row.outcome != FAILS, _share(row)))
    return "; ".join(_sentence(row) for row in rows if row.clause == least.clause and (row is least or row in missed))


def _share(row: Evidence) -> float:
    size = max(abs(row.value.value), abs(row.limit.value))
    return row.margin / size if size else 0.0


def _sentence(row: Evidence) -> str:
    limit = _number(row.limit.value, row.limit.u)
    compared = f"{_number(row.value.value, row.value.u)} {row.relation} {limit} {row.outcome}"
    against = "" if row.limit.what in ("limit", "") else f" against {row.limit.what}"
    return f"{row.model}: {row.value.what}{against}: {compared}"


def _number(value: float, u: float) -> str:
    return f"{value:g}" if u == 0.0 else value_text(value, u)


def _tasks() -> Sequence[CachedCall]:
    return list(dict.fromkeys(call for one in paper_statements() for call in find_test(one).tasks(one)))


def _tables(results: Results) -> Tables:
    evidence = [(one, find_test(one).evidence(one, results)) for one in paper_statements()]
    rows = [judged(one, found) for one, found in evidence]
    frames = [evidence_frame(one.id, found) for one, found in evidence]
    return {"": pd.DataFrame(rows), "evidence": pd.concat(frames, ignore_index=True)}


def readable(table: pd.DataFrame) -> pd.DataFrame:
    """Return the table for reading: empty columns of a row as nothing."""
    shown = table.fillna("").drop(columns=["id"])
    return shown.rename(columns={"fails_for": "fails for", "beyond_paper": "beyond the paper"})


def _texts(tables: Tables) -> dict[str, str]:
    shown = readable(tables[""])
    short = shown[["section", "statement", "verdict", "fails for", "beyond the paper"]]
    text = latex(short, f"{_TITLE}. {_NOTES}", "paper-statements")
    return {".md": f"{markdown(shown, _TITLE)}\n{_NOTES}\n", ".tex": text}


def _shown(tables: Tables) -> FittedTable:
    table = readable(tables[""])[["section", "statement", "verdict", "fails for", "beyond the paper"]]
    return rich_table(table, _TITLE)


PAPER_STATEMENTS = PaperFigure(
    name="statements",
    stem="paper_statements",
    title="Statements of the paper in words of our own, a verdict on each, and its evidence",
    tasks=_tasks,
    tables=_tables,
    draw=None,
    texts=_texts,
    shown=_shown,
    # The turning points are counted at the points that the solver places.
    follows_path=True,
)
