"""Tables of a page: verdicts, errors, models, and every stored row."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial

import pandas as pd

from comparisons.domain import Domain
from comparisons.judging.decision import Verdict
from comparisons.judging.gates import METRICS
from comparisons.judging.report_card import card_lines, given_models
from comparisons.judging.summary import worst_first
from comparisons.output.report.plots import Plot, curve_group, kappa_group, value_group
from comparisons.output.report.stored_run import Stored
from comparisons.output.table import CASE as CASE_COLUMNS
from comparisons.output.table import Column, Record, Table, columns, numbers, percents, words
from comparisons.output.varied_keys import key_columns, physical_text
from comparisons.output.verdicts import command
from comparisons.runs.case_columns import with_problem
from comparisons.runs.rows import CASE

__all__ = ["convergence", "curve_points", "errors", "gates", "numbers_of", "values", "worst_cases"]

#: So many rows are shown where fewer than that do not pass, so that a clean run still shows what is nearest
#: to its limits; and at most the second, because the table of every verdict has the rest.
_AT_LEAST, _AT_MOST = 12, 60

_PLOT = "Numbers of this plot"


def _small(column: Column, small: Callable[[Record], str], kind: str = "") -> Column:
    return replace(column, small=small, kind=kind or column.kind)


def gates(stored: Stored) -> Iterator[Table]:
    """Yield one row for each gate and candidate, worst first, and the report cards of the given models."""
    facts = {row["id"]: row for row in stored.gates.to_dict("records")}
    counts = {key: Counter(rows) for key, rows in stored.verdicts.groupby(["gate", "candidate"])["verdict"]}

    def cases(row: Record) -> str:
        count = counts[row["gate"], row["candidate"]]
        return ", ".join(f"{count[verdict]} {verdict}" for verdict in Verdict if count[verdict])

    def grounds(row: Record) -> str:
        fact = facts.get(row["gate"])
        return f"E = {METRICS.get(fact['metric'], fact['metric'])}; {fact['basis']}: {fact['grounds']}" if fact else ""

    gate, limits = columns("gate", "limits")
    layout = [
        *columns("verdict"),
        _small(gate, lambda row: facts.get(row["gate"], {}).get("requirement", ""), "prose"),
        *columns("candidate", "reference"),
        Column("cases", cases, kind="prose", small=lambda row: row["reason"] or ""),
        *columns("coverage", "E(U)"),
        _small(limits, grounds, "prose"),
    ]
    yield Table("matrix", "Gates, worst first, each with its worst error", layout, stored.summary, "summary.csv")
    recorded_cards, domains = stored.record.get("cards", {}), stored.record.get("domains", {})
    lines = [
        (name, *line)
        for name in given_models(stored.record["arguments"].get("model"), stored.verdicts)
        for line in card_lines(
            name, stored.verdicts, recorded_cards.get(name), Domain.of_json(domains[name]) if name in domains else None
        )
    ]
    card = [*columns("model"), words("item", "item"), words("result", "result", "prose")]
    rows = pd.DataFrame(lines, columns=["model", "item", "result"])
    yield Table("cards", "Report cards of the given models", card, rows)


def worst_cases(stored: Stored) -> Iterator[Table]:
    """Yield what does not pass, worst first, or is nearest to its limits, with its command; and every verdict."""
    numbered = stored.verdicts.assign(lines=range(len(stored.verdicts)))
    judged = worst_first(numbered[numbered["verdict"] != Verdict.NOT_APPLICABLE])
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
    caption = "Worst cases first, with the command that computes the candidate's side again"
    yield Table("offenders", caption, worst, rows, "verdicts.csv", note)
    every = [*columns("verdict", "gate", "candidate", "reference", "quantity"), *case_numbers, *columns("reason")]
    yield Table("verdicts", "Every gate in every case", every, stored.verdicts, "verdicts.csv", fold="Every verdict")


def errors(stored: Stored) -> Iterator[Table]:
    """Yield the relative errors, and the largest of each n and k."""
    layout = columns("model", "quantity", *CASE_COLUMNS, "value", "reference", "reference's value", "κ (%)", "u of κ")
    caption = "Relative errors against the reference"
    yield Table("kappa", caption, layout, stored.kappa, "kappa.csv", fold=_PLOT, group=kappa_group)
    largest = [*columns("model", "quantity", "n", "k"), percents("largest κ (%)", "kappa", "u_kappa")]
    largest += [
        numbers("at μ", "mu"),
        Column("where", lambda row: "an end of the range" if row["at_end"] else "inside"),
    ]
    largest += [numbers("cases", "cases", ".0f"), words("paper (%)", "paper_percent")]
    largest += [words("digits of the paper", "verdict")]
    caption = "Largest relative error over the computed Tabor numbers, by size, with its sign"
    fold = "Largest error of each model for each n and k"
    yield Table("largest", caption, largest, stored.largest_kappa, "largest_kappa.csv", fold=fold)


def convergence(results: pd.DataFrame) -> Table:
    """Return the numbers of discretisations."""
    layout = [*columns("model", "quantity", *CASE_COLUMNS, "value", "u_num")]
    layout += [numbers("observed order", "observed_order", ".2f"), numbers("unknowns", "size", ".0f")]
    layout += [numbers("iterations", "iterations", ".0f"), numbers("residual", "residual", ".1e")]
    rows = results[(results["size"] > 0) & (results["status"] == "ok")]
    return Table("convergence", "Numbers from a discretisation", layout, rows, "results.csv", fold="These numbers")


def values(stored: Stored, plot: Plot, keys: Sequence[str]) -> Table:
    """Return the values of problem files over the keys of a plot."""
    layout = [*columns("model"), *key_columns(keys), Column("value", physical_text, "value")]
    layout += [numbers("u_num", "u_num", ".1e"), *columns("unit")]
    rows = stored.results.loc[plot.points.sort_index().index]
    return Table(plot.table, plot.title, layout, rows, "results.csv", fold=_PLOT, group=value_group(keys))


def curve_points(stored: Stored, plot: Plot) -> Table:
    """Return the stored points of the curves of a plot."""
    layout = [*columns("model", *CASE_COLUMNS), numbers("point", "point", ".0f"), numbers(plot.x_label, "x", ".8g")]
    layout += [numbers(plot.y_label, "y", ".8g"), numbers("u, share of the picture", "u_distance", ".1e")]
    rows = stored.curves[(stored.curves["quantity"] == plot.table) & (stored.curves["status"] == "ok")]
    caption = f"Stored points: {plot.title}"
    return Table(plot.table, caption, layout, rows, "curves.csv", fold=_PLOT, group=curve_group)


def numbers_of(stored: Stored) -> Iterator[Table]:
    """Yield each model with its description and how its computations ended, and every computed number."""
    key = ["model", "model_version", "quantity", *CASE]
    whole = with_problem(stored.curves).drop_duplicates(key)
    every = pd.concat([table[["model", "model_version", "status"]] for table in (stored.results, whole)])
    described, seconds = stored.record.get("models", {}), stored.record["seconds"]["by_model"]
    models = every.groupby(["model", "model_version"])["status"].value_counts().unstack(fill_value=0).reset_index()
    models["seconds"], models["spec"] = models["model"].map(seconds), models["model"].map(stored.specs)
    for name in ("domain", "citation"):
        models[name] = [described.get(model, {}).get(name) for model in models["model"]]
    layout = [
        *columns("model", "version"),
        *(numbers(name, name, ".0f") for name in ("ok", "not-applicable", "failed")),
    ]
    layout += [numbers("seconds", "seconds", ".3g"), words("SPEC, if external", "spec", "code")]
    layout += [words("domain", "domain", "prose"), words("citation", "citation", "prose")]
    yield Table("models", "Models, and how their computations ended", layout, models)
    layout = columns("model", "version", "quantity", *CASE_COLUMNS, "value", "u_num", "unit")
    layout += [numbers("dimensionless value", "dimensionless_value"), words("its unit", "dimensionless_unit")]
    layout += columns("status", "reason")
    yield Table("results", "Every computed number", layout, stored.results, "results.csv", fold="Every computed number")
