"""Tables of the page: verdicts, errors, comparisons, models, every stored row, and the statements of the paper."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

import pandas as pd

from comparisons.data import paper_statements
from comparisons.domain import Domain
from comparisons.judging.decision import Verdict
from comparisons.judging.gates import METRICS
from comparisons.judging.report_card import card_lines, given_models
from comparisons.judging.summary import worst_first
from comparisons.numerics.number_text import case_text
from comparisons.output.comparison import SUMMARY, by_case, case_columns
from comparisons.output.report.plots import curve_group, kappa_group
from comparisons.output.report.stored_run import Stored
from comparisons.output.table import (
    CASE_LABELS,
    COLUMNS,
    Cell,
    Column,
    Table,
    chosen,
    numbers,
    table_of,
    words,
)
from comparisons.output.verdicts import command
from comparisons.quantities import title_of
from comparisons.runs.case_columns import with_problem
from comparisons.runs.rows import CASE

__all__ = [
    "SUMMARY_FILE",
    "TABLE_FILE",
    "case_tables",
    "curve_points",
    "run_tables",
    "summary_tables",
    "verdict_tables",
]

#: Stored tables behind those of a comparison: the summary of the errors, and one row for each case and model.
SUMMARY_FILE, TABLE_FILE = "error_summary.csv", "comparison.csv"

#: So many rows are shown where fewer than that do not pass, so that a clean run still shows what is nearest
#: to its limits; and at most the second, because the table of every verdict has the rest.
_AT_LEAST, _AT_MOST = 12, 60

#: Verdicts on the statements of the paper in the order of the table: what does not hold is first.
_ORDER = ("false", "true in part", "not decided", "true")

#: Numbers of a verdict.
_OF_VERDICT = (*CASE_LABELS, "candidate's value", "reference's value", "E(U)", "U", "limits")


def _small(column: Column, more: Any, kind: str = "") -> Column:
    """Return a column with small print: a text of the row below each cell."""

    def cell(row: Mapping[str, Any]) -> Cell:
        found = column.cell(row)
        return Cell(found.text, found.value, found.marks, more(row) or "")

    return Column(column.label, kind or column.kind, cell)


def verdict_tables(stored: Stored, specs: Mapping[str, str]) -> Iterator[Table]:
    """Yield the matrix of gates, what does not pass, every verdict, and the report cards of the given models.

    Parameters
    ----------
    stored : Stored
    specs : mapping of str to str
        The SPEC that finds each external model.
    """
    yield _matrix(stored)
    yield _offenders(stored, specs)
    columns = chosen("verdict", "gate", "candidate", "reference", "quantity", *_OF_VERDICT, "reason")
    yield table_of("verdicts", "Every gate in every case", columns, stored.verdicts, "verdicts.csv")
    yield _cards(stored)


def _matrix(stored: Stored) -> Table:
    """One row a gate and candidate, worst first, with a mark for each case."""
    facts = {} if stored.gates is None else {row["id"]: row for row in stored.gates.to_dict("records")}
    cases = dict(list(stored.verdicts.groupby(["gate", "candidate"])))

    def marked(gate: Mapping[str, Any]) -> Cell:
        of_gate = cases[gate["gate"], gate["candidate"]]
        marks = tuple(
            (str(row["verdict"]), _case_label(row) + (f": {row['reason']}" if row["reason"] else ""))
            for row in of_gate.to_dict("records")
        )
        found = Counter(of_gate["verdict"])
        text = ", ".join(f"{found[verdict]} {verdict}" for verdict in map(str, Verdict) if found[verdict])
        return Cell(text, float(len(of_gate)), marks, gate["reason"] or "")

    def grounds(gate: Mapping[str, Any]) -> str:
        fact = facts.get(gate["gate"])
        return f"E = {METRICS.get(fact['metric'], fact['metric'])}; {fact['basis']}: {fact['grounds']}" if fact else ""

    columns = (
        COLUMNS["verdict"],
        _small(COLUMNS["gate"], lambda row: facts.get(row["gate"], {}).get("requirement")),
        *(*chosen("candidate", "reference"), Column("cases", "marks", marked), *chosen("coverage", "worst E(U)")),
        _small(COLUMNS["limits"], grounds, "prose"),
    )
    return table_of("matrix", "Gates, worst first; one square a case", columns, stored.summary, "summary.csv")


def _case_label(row: Mapping[str, Any]) -> str:
    return case_text({name: row.get(name) for name in CASE}) or "the gate as a whole"


def _offenders(stored: Stored, specs: Mapping[str, str]) -> Table:
    """What does not pass, worst first, or else what is nearest to its limits; with its command."""
    numbered = stored.verdicts.assign(line=range(len(stored.verdicts)))
    judged = worst_first(numbered[numbered["verdict"] != Verdict.NOT_APPLICABLE])
    bad = int((judged["verdict"] != Verdict.PASS).sum())
    shown = judged.head(min(max(bad, _AT_LEAST), _AT_MOST))
    columns = (
        COLUMNS["verdict"],
        _small(COLUMNS["gate"], lambda row: row["reason"]),
        *chosen("candidate", "quantity", *_OF_VERDICT),
        Column("computed again by", "code", lambda row: Cell(command(row, specs))),
    )
    note = "Every judged case passes."
    if bad:
        note = f"{bad} of {len(judged)} judged cases do not pass; declared failures (XFAIL) count here."
    if bad < _AT_LEAST:
        note += " Cases that pass are here too: those nearest to a limit, as a share of the gate's width."
    if more := len(judged) - len(shown):
        note += f" The other {more} are in the table of every verdict."
    caption = "Worst cases first, with the command that computes the candidate's side again"
    return table_of("offenders", caption, columns, shown, "verdicts.csv", note, lines=shown["line"].astype(int))


def _cards(stored: Stored) -> Table:
    """The lines of the card of each given model; no rows if none is given."""
    found, domains = stored.record.get("cards", {}), stored.record.get("domains", {})
    rows = [
        (name, *line)
        for name in given_models(stored.record["arguments"].get("model"), stored.verdicts)
        for line in card_lines(
            name, stored.verdicts, found.get(name), Domain.of_json(domains[name]) if name in domains else None
        )
    ]
    columns = (COLUMNS["model"], words("item", "item"), words("found", "found", "prose"))
    lines = pd.DataFrame(rows, columns=["model", "item", "found"])
    return table_of("cards", "Report cards of the given models", columns, lines, "cards.csv")


def run_tables(stored: Stored, specs: Mapping[str, str]) -> Iterator[Table]:
    """Yield the tables of numbers of any folder: errors, convergence, every number, models, and statements.

    Parameters
    ----------
    stored : Stored
    specs : mapping of str to str
        The SPEC that finds each external model.
    """
    case = ("model", "quantity", *CASE_LABELS, "value")
    columns = chosen(*case, "reference", "reference's value", "κ (%)", "u of κ")
    yield table_of(
        "kappa", "Relative errors against the reference", columns, stored.kappa, "kappa.csv", group=kappa_group
    )
    columns = [
        *(*chosen("model", "quantity", "n", "k", "largest κ (%)"), numbers("at μ", "mu", "")),
        Column("where", cell=lambda row: Cell("an end of the range" if row["at_end"] else "inside")),
        *(numbers("cases", "cases", ".0f"), words("paper (%)", "paper_percent", "number")),
        words("digits of the paper", "verdict"),
    ]
    caption = "Largest relative error over the computed Tabor numbers, by size, with its sign"
    yield table_of("largest", caption, columns, stored.largest, "largest_kappa.csv")
    numbered = stored.results.reset_index(drop=True)
    discrete = numbered[(numbered["size"] > 0) & (numbered["status"] == "ok")]
    columns = [*chosen(*case, "u_num"), numbers("observed order", "observed_order", ".2f")]
    columns += [numbers("unknowns", "size", ".0f"), numbers("iterations", "iterations", ".0f")]
    yield table_of(
        *("convergence", "Numbers from a discretisation", [*columns, numbers("residual", "residual", ".1e")]),
        *(discrete, "results.csv"),
        group=lambda row: row["quantity"],
        lines=discrete.index,
    )
    columns = chosen("model", "version", *case[1:], "u_num", "unit", "status", "reason")
    yield table_of("results", "Every computed number", columns, stored.results, "results.csv")
    yield _models(stored, specs)
    yield _statements()


def curve_points(stored: Stored, quantity: str, labels: tuple[str, str]) -> Table:
    """Return the stored points of one kind of curve, with the labels of its axes."""
    numbered = stored.curves.reset_index(drop=True)
    points = numbered[(numbered["quantity"] == quantity) & (numbered["status"] == "ok")]
    columns = (
        *(*chosen("model", *CASE_LABELS), numbers("point", "point", ".0f")),
        *(numbers(label, name, ".8g") for label, name in zip(labels, "xy", strict=True)),
        numbers("u, share of the picture", "u_distance", ".1e"),
    )
    caption = f"Stored points: {title_of(quantity)}"
    return table_of(quantity, caption, columns, points, "curves.csv", group=curve_group, lines=points.index)


def _models(stored: Stored, specs: Mapping[str, str]) -> Table:
    """What was run: each model with its own description, and how its computations ended."""
    key = ["model", "model_version", "quantity", *CASE]
    whole = with_problem(stored.curves).drop_duplicates(key)
    every = pd.concat([table[["model", "model_version", "status"]] for table in (stored.results, whole)])
    described, seconds = stored.record.get("models", {}), stored.record["seconds"]["by_model"]
    found = every.groupby(["model", "model_version"])["status"].value_counts().unstack(fill_value=0).reset_index()
    found = found.assign(
        seconds=found["model"].map(seconds),
        spec=found["model"].map(specs),
        **{name: [described.get(model, {}).get(name) for model in found["model"]] for name in ("domain", "citation")},
    )
    columns = (
        *chosen("model", "version"),
        *(Column(name, "number", _count(name.replace(" ", "-"))) for name in ("ok", "not applicable", "failed")),
        *(numbers("seconds", "seconds", ".3g"), words("SPEC, if external", "spec", "code")),
        *(words("domain", "domain", "prose"), words("citation", "citation", "prose")),
    )
    return table_of("models", "Models, and how their computations ended", columns, found, "models.csv")


def _count(status: str) -> Any:
    return lambda row: Cell(str(row.get(status, 0)), float(row.get(status, 0)))


def _statements() -> Table:
    """One row a statement of the paper, from the shipped verdicts, those that do not hold first."""
    stored = pd.DataFrame(paper_statements.verdicts())
    stored = stored.sort_values("verdict", key=lambda column: column.map(_ORDER.index), kind="stable")
    columns = (
        Column("verdict", cell=lambda row: Cell(row["verdict"], float(_ORDER.index(row["verdict"])))),
        _with(words("holds in", "holds_in"), "of the paper's own cases: {own_cases}"),
        _with(words("statement, in words of our own", "statement", "prose"), "{section}; {range}"),
        _with(words("test and evidence", "test", "prose"), "{evidence}"),
        _with(words("fails for", "fails_for", "prose"), "beyond the paper: {beyond_paper}"),
        _with(words("other verdict, with the number times a factor", "flips", "prose"), "the number is {number}"),
        words("computed again by", "command", "code"),
    )
    found = Counter(stored["verdict"])
    counts = ", ".join(f"{found[verdict]} {verdict}" for verdict in _ORDER if found[verdict])
    note = f"{len(stored)} statements: {counts}. The verdicts are those of fscm-bench paper, shipped with this version."
    caption = "Statements of the paper and their verdicts"
    return table_of("statements", caption, columns, stored, "paper_statements.csv", note, lines=stored.index)


def _with(column: Column, form: str) -> Column:
    """Return a column with small print in a form, where every text of the form is stored."""
    names = [part.partition("}")[0] for part in form.split("{")[1:]]
    return _small(column, lambda row: form.format_map(row) if all(row[name] for name in names) else "")


def summary_tables(summary: pd.DataFrame) -> Iterator[Table]:
    """Yield a table for each quantity and reference: in how many cases a model has a value, and its errors.

    Parameters
    ----------
    summary : DataFrame
        As of `comparisons.output.error_summary.error_summary`.
    """
    numbered = summary.reset_index(drop=True)
    for (quantity, reference), group in numbered.groupby(["quantity", "reference"], sort=False):
        caption = f"{quantity}: coverage, largest and root mean square κ in percent, against {reference}"
        name = f"summary-{quantity}-{reference}"
        yield table_of(name, caption, SUMMARY, group, SUMMARY_FILE, lines=group.index)


def case_tables(table: pd.DataFrame, most: int | None = None) -> Iterator[Table]:
    """Yield a table for each quantity and reference: one row a case, one column a model.

    Pointing at a number shows all its digits.

    Parameters
    ----------
    table : DataFrame
        As of `comparisons.output.comparison.comparison_table`.
    most : int, optional
        Rows that are shown; the caption then states how many there are.
    """
    for quantity, reference, models, rows in by_case(table):
        shown = rows.head(len(rows) if most is None else most)
        caption = f"{quantity}: κ in percent with its uncertainty, against {reference}"
        if len(shown) < len(rows):
            caption += f" (the first {len(shown)} of {len(rows)} cases; {TABLE_FILE} has all)"
        columns, name = case_columns(reference, models), f"cases-{quantity}-{reference}"
        yield table_of(name, caption, columns, shown, TABLE_FILE, lines=list(shown["lines"]))
