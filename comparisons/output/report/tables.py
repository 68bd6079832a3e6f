"""Tables of a page that need more than stored rows: verdicts, points of plots, models, and the record."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import pandas as pd

from comparisons.domain import Domain
from comparisons.judging.decision import Verdict
from comparisons.judging.gates import METRICS
from comparisons.judging.report_card import card_lines, given_models
from comparisons.judging.summary import worst_first
from comparisons.output.markup import in_words
from comparisons.output.plots import Plot
from comparisons.output.report.stored_run import Stored
from comparisons.output.table import CASE as CASE_COLUMNS
from comparisons.output.table import LAYOUT, Column, Record, Table, columns, key_columns, laid_out, physical_text
from comparisons.output.table import column as column_of
from comparisons.output.verdicts import command, verdict_counts
from comparisons.runs.frames import with_problem
from comparisons.runs.rows import CASE

#: So many rows are shown where fewer than that do not pass, so that a clean run still shows what is nearest
#: to its limits; and at most the second, because the table of every verdict has the rest.
_AT_LEAST, _AT_MOST = 12, 60

#: Entries of a record that other tables of the page have.
_ELSEWHERE = ("files", "models", "domains", "cards", "coverage")


def _reason(row: Record) -> str:
    return row["reason"] or ""


def gates(stored: Stored) -> Iterator[Table]:
    """Yield one row for each gate and candidate, worst first, and the report cards of the given models."""
    facts = {row["id"]: row for row in stored.gates.to_dict("records")}
    counts = {key: verdict_counts(rows["verdict"]) for key, rows in stored.verdicts.groupby(["gate", "candidate"])}

    def requirement(row: Record) -> str:
        return facts.get(row["gate"], {}).get("requirement", "")

    def grounds(row: Record) -> str:
        fact = facts.get(row["gate"])
        return f"E = {METRICS.get(fact['metric'], fact['metric'])}; {fact['basis']}: {fact['grounds']}" if fact else ""

    gate, limits = columns("gate", "limits")
    yield laid_out(
        "matrix",
        stored.summary,
        replace(gate, small=requirement, kind="prose"),
        Column("cases", lambda row: in_words(counts[row["gate"], row["candidate"]]), kind="prose", small=_reason),
        replace(limits, small=grounds, kind="prose"),
    )
    cards, domains = stored.record.get("cards", {}), stored.record.get("domains", {})
    lines: list[tuple[str, str, str]] = []
    for name in given_models(stored.record["arguments"].get("model"), stored.verdicts, cards):
        domain = Domain.of_json(domains[name]) if name in domains else None
        lines += [(name, *line) for line in card_lines(name, stored.verdicts, stored.checks, cards.get(name), domain)]
    spoken = [(name, item, in_words(result)) for name, item, result in lines]
    yield laid_out("cards", pd.DataFrame(spoken, columns=["model", "item", "result"]))


def worst_cases(stored: Stored) -> Iterator[Table]:
    """Yield what does not pass, worst first, or is nearest to its limits, with its command; and every verdict."""
    judged = worst_first(stored.verdicts[stored.verdicts["verdict"] != Verdict.NOT_APPLICABLE])
    bad = int((judged["verdict"] != Verdict.PASS).sum())
    rows = judged.head(min(max(bad, _AT_LEAST), _AT_MOST))
    note = f"{bad} of {len(judged)} judged cases do not pass; expected deviations count here."
    if bad < _AT_LEAST:
        note += " Cases that pass are here too: those nearest to a limit, as a share of the gate's width."
    (gate,) = columns("gate")
    again = Column("computed again by", partial(command, specs=stored.specs), kind="code")
    yield laid_out("offenders", rows, replace(gate, small=_reason, kind="prose"), again, note=note)
    yield laid_out("verdicts", stored.verdicts)


def largest_errors(stored: Stored) -> Table:
    """Return the largest relative error of each model for each n and k."""
    where = Column("where", lambda row: "an end of the range" if row["at_end"] else "inside")
    return laid_out("largest", stored.largest_kappa, where)


def values(stored: Stored, plot: Plot, keys: Sequence[str]) -> Table:
    """Return the values of problem files over the keys of a plot."""
    value = Column("value", physical_text, "value")
    layout = [*columns("model"), *key_columns(keys), value, *columns("u_num", "unit")]
    return _numbers(plot, plot.title, layout, stored.results.loc[plot.points.index.sort_values()])


def curve_points(stored: Stored, plot: Plot) -> Table:
    """Return the stored points of the curves of a plot."""
    layout = [*columns("model", *CASE_COLUMNS), column_of("point", form=".0f")]
    layout += [column_of(plot.x_label, "x", ".8g"), column_of(plot.y_label, "y", ".8g")]
    layout += [column_of("u, share of the picture", "u_distance", ".1e")]
    rows = stored.curves[(stored.curves["quantity"] == plot.table) & (stored.curves["status"] == "ok")]
    return _numbers(plot, f"Stored points: {plot.title}", layout, rows)


def _numbers(plot: Plot, caption: str, layout: Sequence[Column], rows: pd.DataFrame) -> Table:
    """Return the numbers of a plot, folded as its errors are."""
    return Table(plot.table, caption, layout, rows, fold=LAYOUT["table"]["kappa"]["fold"], group=plot.group)


def models(stored: Stored) -> Table:
    """Return each model with its description and how its computations ended."""
    traced = with_problem(stored.curves).drop_duplicates(["model", "model_version", "quantity", *CASE])
    evaluations = pd.concat([table[["model", "model_version", "status"]] for table in (stored.results, traced)])
    counts = evaluations.groupby(["model", "model_version"])["status"].value_counts().unstack(fill_value=0)
    rows = counts.reset_index()
    rows["seconds"] = rows["model"].map(stored.record["seconds"]["by_model"])
    rows["spec"] = rows["model"].map(stored.specs)
    described = pd.DataFrame.from_dict(stored.record.get("models", {}), orient="index")
    return laid_out("models", rows.join(described.reindex(columns=["domain", "citation"]), on="model"))


def provenance(record: Mapping[str, Any]) -> Table:
    """Return the entries of a record, but for those that other tables have."""
    entries = pd.json_normalize({name: entry for name, entry in record.items() if name not in _ELSEWHERE})
    rows = pd.DataFrame({"entry": entries.columns, "content": [str(entry) for entry in entries.iloc[0]]})
    return laid_out("provenance", rows)
