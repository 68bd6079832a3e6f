"""Tables of a page: verdicts, errors, models, and every stored row."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import pandas as pd

from comparisons.domain import Domain
from comparisons.judging.decision import Verdict
from comparisons.judging.gates import METRICS
from comparisons.judging.report_card import card_lines, given_models
from comparisons.judging.summary import worst_first
from comparisons.output.plots import Plot
from comparisons.output.report.stored_run import Stored
from comparisons.output.table import CASE as CASE_COLUMNS
from comparisons.output.table import Column, Record, Table, columns, key_columns, numbers, physical_text, words
from comparisons.output.verdicts import command, verdict_counts
from comparisons.runs.frames import with_problem
from comparisons.runs.rows import CASE

#: So many rows are shown where fewer than that do not pass, so that a clean run still shows what is nearest
#: to its limits; and at most the second, because the table of every verdict has the rest.
_AT_LEAST, _AT_MOST = 12, 60

_PLOT = "Numbers of this plot"

#: Entries of a record that other tables of the page have.
_ELSEWHERE = ("files", "models", "domains", "cards", "coverage")

_DESCRIPTION = ["domain", "citation"]


def _small(column: Column, small: Callable[[Record], str], kind: str = "") -> Column:
    return replace(column, small=small, kind=kind or column.kind)


def gates(stored: Stored) -> Iterator[Table]:
    """Yield one row for each gate and candidate, worst first, and the report cards of the given models."""
    facts = {row["id"]: row for row in stored.gates.to_dict("records")}
    counts = {key: verdict_counts(rows) for key, rows in stored.verdicts.groupby(["gate", "candidate"])}

    def grounds(row: Record) -> str:
        fact = facts.get(row["gate"])
        return f"E = {METRICS.get(fact['metric'], fact['metric'])}; {fact['basis']}: {fact['grounds']}" if fact else ""

    gate, limits = columns("gate", "limits")
    layout = [
        *columns("verdict"),
        _small(gate, lambda row: facts.get(row["gate"], {}).get("requirement", ""), "prose"),
        *columns("candidate", "reference"),
        Column(
            "cases",
            lambda row: counts[row["gate"], row["candidate"]],
            kind="prose",
            small=lambda row: row["reason"] or "",
        ),
        *columns("coverage", "E(U)"),
        _small(limits, grounds, "prose"),
    ]
    yield Table("matrix", "Gates, worst first, each with its worst error", layout, stored.summary)
    cards, domains = stored.record.get("cards", {}), stored.record.get("domains", {})
    lines: list[tuple[str, str, str]] = []
    for name in given_models(stored.record["arguments"].get("model"), stored.verdicts):
        domain = Domain.of_json(domains[name]) if name in domains else None
        lines += [(name, *line) for line in card_lines(name, stored.verdicts, cards.get(name), domain)]
    card = [*columns("model"), words("item"), words("result", kind="prose")]
    yield Table(
        "cards", "Report cards of the given models", card, pd.DataFrame(lines, columns=["model", "item", "result"])
    )


def worst_cases(stored: Stored) -> Iterator[Table]:
    """Yield what does not pass, worst first, or is nearest to its limits, with its command; and every verdict."""
    judged = worst_first(stored.verdicts[stored.verdicts["verdict"] != Verdict.NOT_APPLICABLE])
    bad = int((judged["verdict"] != Verdict.PASS).sum())
    rows = judged.head(min(max(bad, _AT_LEAST), _AT_MOST))
    note = f"{bad} of {len(judged)} judged cases do not pass; declared failures (XFAIL) count here."
    if bad < _AT_LEAST:
        note += " Cases that pass are here too: those nearest to a limit, as a share of the gate's width."
    case_numbers = columns(*CASE_COLUMNS, "candidate's value", "reference's value", "E(U)")
    case_numbers += [numbers("U", "uncertainty", ".1e"), *columns("limits")]
    verdict, gate, *whose = columns("verdict", "gate", "candidate", "quantity")
    again = Column("computed again by", partial(command, specs=stored.specs), kind="code")
    worst = [verdict, _small(gate, lambda row: row["reason"] or "", "prose"), *whose, *case_numbers, again]
    caption = "Worst cases first, with the command that computes the value of the candidate again"
    yield Table("offenders", caption, worst, rows, note)
    layout = [*columns("verdict", "gate", "candidate", "reference", "quantity"), *case_numbers, *columns("reason")]
    yield Table("verdicts", "Every gate in every case", layout, stored.verdicts, fold="Every verdict")


def errors_of_models(summary: pd.DataFrame) -> Table:
    """Return the errors and the coverage of each model."""
    layout = [*columns("quantity", "model", "largest |κ| (%)", *CASE_COLUMNS, "rms κ (%)", "coverage", "reference")]
    ordered = summary.sort_values(["quantity", "size"], ascending=[True, False], ignore_index=True)
    return Table("summary", "Largest and root mean square error of each model", layout, ordered)


def relative_errors(kappa: pd.DataFrame, plot: Plot) -> Table:
    """Return the relative errors of a plot."""
    layout = columns("model", "quantity", *CASE_COLUMNS, "value", "reference", "reference's value", "κ (%)", "u of κ")
    return Table("kappa", "Relative errors against the reference", layout, kappa, fold=_PLOT, group=plot.group)


def largest_errors(stored: Stored) -> Table:
    """Return the largest relative error of each model for each n and k."""
    layout = columns("model", "quantity", "n", "k", "μ", "κ (%)")
    layout += [Column("where", lambda row: "an end of the range" if row["at_end"] else "inside")]
    layout += [*columns("cases"), words("paper (%)", "paper_percent"), words("digits of the paper", "verdict")]
    caption = "Relative error of largest absolute value over the computed Tabor numbers, with its sign"
    fold = "Largest error of each model for each n and k"
    return Table("largest", caption, layout, stored.largest_kappa, fold=fold)


def convergence(results: pd.DataFrame) -> Table:
    """Return the numbers of discretisations."""
    layout = [*columns("model", "quantity", *CASE_COLUMNS, "value", "u_num")]
    layout += [numbers("observed order", "observed_order", ".2f"), numbers("unknowns", "size", ".0f")]
    layout += [numbers("iterations", "iterations", ".0f"), numbers("residual", "residual", ".1e")]
    rows = results[(results["size"] > 0) & (results["status"] == "ok")]
    return Table("convergence", "Numbers from a discretisation", layout, rows, fold="These numbers")


def values(stored: Stored, plot: Plot, keys: Sequence[str]) -> Table:
    """Return the values of problem files over the keys of a plot."""
    layout = [*columns("model"), *key_columns(keys), Column("value", physical_text, "value"), *columns("u_num", "unit")]
    rows = stored.results.loc[plot.points.index.sort_values()]
    return Table(plot.table, plot.title, layout, rows, fold=_PLOT, group=plot.group)


def curve_points(stored: Stored, plot: Plot) -> Table:
    """Return the stored points of the curves of a plot."""
    layout = [*columns("model", *CASE_COLUMNS), numbers("point", form=".0f"), numbers(plot.x_label, "x", ".8g")]
    layout += [numbers(plot.y_label, "y", ".8g"), numbers("u, share of the picture", "u_distance", ".1e")]
    rows = stored.curves[(stored.curves["quantity"] == plot.table) & (stored.curves["status"] == "ok")]
    return Table(plot.table, f"Stored points: {plot.title}", layout, rows, fold=_PLOT, group=plot.group)


def numbers_of(stored: Stored) -> Iterator[Table]:
    """Yield each model with its description and how its computations ended, and every computed number."""
    key = ["model", "model_version", "quantity", *CASE]
    traced = with_problem(stored.curves).drop_duplicates(key)
    evaluations = pd.concat([table[["model", "model_version", "status"]] for table in (stored.results, traced)])
    models = (
        evaluations.groupby(["model", "model_version"])["status"].value_counts().unstack(fill_value=0).reset_index()
    )
    models["seconds"] = models["model"].map(stored.record["seconds"]["by_model"])
    models["spec"] = models["model"].map(stored.specs)
    described = pd.DataFrame.from_dict(stored.record.get("models", {}), orient="index")
    models = models.join(described.reindex(columns=_DESCRIPTION), on="model")
    ended = [numbers(name, form=".0f") for name in ("ok", "not-applicable", "failed")]
    layout = [*columns("model", "version"), *ended, numbers("seconds", form=".3g")]
    layout += [words("SPEC, if external", "spec", "code"), *(words(name, kind="prose") for name in _DESCRIPTION)]
    yield Table("models", "Models, and how their computations ended", layout, models)
    layout = columns("model", "version", "quantity", *CASE_COLUMNS, "value", "u_num", "unit")
    layout += [numbers("dimensionless value", "dimensionless_value"), words("its unit", "dimensionless_unit")]
    layout += columns("status", "reason")
    yield Table("results", "Every computed number", layout, stored.results, fold="Every computed number")


def provenance(record: Mapping[str, Any]) -> Table:
    """Return the entries of a record, but for those that other tables have."""
    entries = pd.json_normalize({name: entry for name, entry in record.items() if name not in _ELSEWHERE})
    rows = pd.DataFrame({"entry": entries.columns, "content": [str(entry) for entry in entries.iloc[0]]})
    return Table("provenance", "Record of the run", [words("entry"), words("content", kind="prose")], rows)
