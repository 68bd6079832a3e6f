"""The tables of verdicts: the matrix of gates, the worst offenders, and every row."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

import pandas as pd

from comparisons.judging.decision import Verdict
from comparisons.judging.gates import METRICS
from comparisons.judging.summary import coverage_text, worst_first
from comparisons.numerics.number_text import case_text, error_text, exact, limits_text
from comparisons.output.report.stored_run import Stored
from comparisons.output.report.table import (
    CASE_COLUMNS,
    Cell,
    Column,
    Row,
    Table,
    case_cells,
    number,
    value,
    without_empty,
)
from comparisons.output.verdicts import command
from comparisons.quantities import title_of
from comparisons.runs.rows import CASE

__all__ = ["all_verdicts", "matrix", "offenders"]

#: So many rows are shown where fewer than that do not pass, so that a clean run still shows what is nearest
#: to its limits; and at most the second, because the table of every verdict has the rest.
_AT_LEAST, _AT_MOST = 12, 60

_NUMBERS = (
    Column("candidate's value", "number"),
    Column("reference's value", "number"),
    Column("E", "number"),
    Column("U", "number", paper=False),
    Column("limits of E"),
)


def _case_label(row: pd.Series) -> str:
    return case_text({name: row.get(name) for name in CASE}) or "the gate as a whole"


def _error(row: pd.Series) -> Cell:
    return (
        Cell("") if pd.isna(row["error"]) else Cell(error_text(row["error"], row["uncertainty"]), float(row["error"]))
    )


def _numbers(row: pd.Series) -> tuple[Cell, ...]:
    return (
        value(row["value"], row["u_num"]),
        value(row["reference_value"], row["u_reference"]),
        _error(row),
        number(row["uncertainty"], ".1e"),
        _limits(row),
    )


def _limits(row: pd.Series) -> Cell:
    lower, upper = row["lower"], row["upper"]
    if pd.isna(lower):
        return Cell("")
    if lower == float("-inf"):
        return Cell(f"≤ {exact(upper)}")
    return Cell(f"≥ {exact(lower)}" if upper == float("inf") else limits_text(lower, upper))


def matrix(stored: Stored) -> Table:
    """Return one row a gate and candidate, worst first, with a mark for each case."""
    facts: dict[Any, dict[Any, Any]] = (
        {} if stored.gates is None else stored.gates.drop_duplicates("id").set_index("id").to_dict("index")
    )
    cases = dict(list(stored.verdicts.groupby(["gate", "candidate"])))
    rows = []
    for _, gate in stored.summary.iterrows():
        fact = facts.get(gate["gate"], {})
        of_gate = cases[gate["gate"], gate["candidate"]]
        marks = tuple(
            (str(row["verdict"]), _case_label(row) + (f": {row['reason']}" if row["reason"] else ""))
            for _, row in of_gate.iterrows()
        )
        rows.append(
            Row(
                (
                    Cell(str(gate["verdict"]), float(Verdict(gate["verdict"]).rank)),
                    Cell(gate["gate"], more=fact.get("requirement", "")),
                    Cell(gate["candidate"]),
                    Cell(gate["reference"]),
                    Cell(_counted(of_gate["verdict"]), float(len(of_gate)), marks, gate["reason"] or ""),
                    Cell(coverage_text(gate), float(gate["answered"])),
                    _error(gate),
                    replace(_limits(gate), more=_grounds(fact)),
                )
            )
        )
    columns = (
        Column("verdict", "verdict"),
        Column("gate", "head"),
        Column("candidate"),
        Column("reference"),
        Column("cases", "marks"),
        Column("coverage"),
        Column("worst E(U)", "number"),
        Column("limits of E", "prose"),
    )
    caption = "Gates, worst first; one square a case"
    return without_empty(Table("matrix", caption, columns, rows, "summary.csv"))


def _grounds(fact: dict[Any, Any]) -> str:
    if not fact:
        return ""
    return f"E = {METRICS.get(fact['metric'], fact['metric'])}; {fact['basis']}: {fact['grounds']}"


def _counted(verdicts: Iterable[str]) -> str:
    counts = pd.Series(list(verdicts)).value_counts()
    return ", ".join(f"{counts[verdict]} {verdict}" for verdict in map(str, Verdict) if verdict in counts)


def offenders(stored: Stored, specs: Mapping[str, str]) -> Table:
    """Return what does not pass, worst first, or else what is nearest to its limits; with its command."""
    numbered = stored.verdicts.assign(line=range(len(stored.verdicts)))
    judged = worst_first(numbered[numbered["verdict"] != Verdict.NOT_APPLICABLE])
    bad = int((judged["verdict"] != Verdict.PASS).sum())
    shown = judged.head(min(max(bad, _AT_LEAST), _AT_MOST))
    rows = [
        Row(
            (
                _verdict(row),
                Cell(row["gate"], more=row["reason"] or ""),
                Cell(row["candidate"]),
                Cell(title_of(row["quantity"])),
                *case_cells(row),
                *_numbers(row),
                Cell(command(row, specs)),
            )
        )
        for _, row in shown.iterrows()
    ]
    columns = (
        Column("verdict", "verdict"),
        Column("gate", "head"),
        Column("candidate"),
        Column("quantity"),
        *CASE_COLUMNS,
        *_NUMBERS,
        Column("computed again by", "code"),
    )
    more = len(judged) - len(shown)
    note = "Every judged case passes."
    if bad:
        note = f"{bad} of {len(judged)} judged cases do not pass; declared failures (XFAIL) count here."
    if bad < _AT_LEAST:
        note += " Cases that pass are here too: those nearest to a limit, as a share of the gate's width."
    if more:
        note += f" The other {more} are in the table of every verdict."
    lines = tuple(shown["line"].astype(int).tolist())
    caption = "Worst cases first, with the command that computes the candidate's side again"
    return without_empty(Table("offenders", caption, columns, rows, "verdicts.csv", note, lines))


def _verdict(row: pd.Series) -> Cell:
    return Cell(str(row["verdict"]), float(Verdict(row["verdict"]).rank))


def all_verdicts(stored: Stored) -> Table:
    """Return every verdict in the stored order."""
    rows = [
        Row(
            (
                _verdict(row),
                Cell(row["gate"]),
                Cell(row["candidate"]),
                Cell(row["reference"]),
                Cell(title_of(row["quantity"])),
                *case_cells(row),
                *_numbers(row),
                Cell(row["reason"] or ""),
            )
        )
        for _, row in stored.verdicts.iterrows()
    ]
    columns = (
        Column("verdict", "verdict"),
        Column("gate", "head"),
        Column("candidate"),
        Column("reference"),
        Column("quantity"),
        *CASE_COLUMNS,
        *_NUMBERS,
        Column("reason", "prose"),
    )
    return without_empty(Table("verdicts", "Every gate in every case", columns, rows, "verdicts.csv"))
