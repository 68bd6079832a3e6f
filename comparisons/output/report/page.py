"""The content of a page: the texts, tables and plots of its sections, before there is any HTML."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import pandas as pd

from comparisons.data.paper_statements import verdicts
from comparisons.judging.card_gates import overall, without_card_gates
from comparisons.judging.decision import Verdict
from comparisons.output.error_summary import error_summary
from comparisons.output.report import plots, problem_plots
from comparisons.output.report.headline import errors_of_models, gates_of, headline
from comparisons.output.report.plot import Plot
from comparisons.output.report.provenance import provenance, verdict_counts
from comparisons.output.report.stored_run import Stored
from comparisons.output.report.tables import (
    SUMMARY_FILE,
    TABLE_FILE,
    case_tables,
    curve_points,
    run_tables,
    summary_tables,
    verdict_tables,
)
from comparisons.output.style import ModelStyle, model_styles
from comparisons.output.table import Table, table_csv
from comparisons.runs.csv_format import csv_text

__all__ = ["Page", "make_page"]


@dataclass(frozen=True, slots=True)
class Page:
    """The content of a page.

    Attributes
    ----------
    headline : str
        What was found, in one sentence.
    errors : list of (str, str)
        Each model and its largest error, largest first.
    gates : str
        The finding over all gates in one sentence; empty where nothing was judged.
    verdict, meaning : str
        Over all gates; no verdict where nothing was judged.
    counts : list of (str, int)
        How many cases ended with each verdict, worst first.
    summary : str
        What was run, in one sentence.
    texts : dict of str to str
        The files of cases and problem files, by their names.
    tables : dict of str to Table
        By their ids.
    compared : list of Table
        Of a comparison: coverage and errors, then every case; also among `tables`.
    plots : dict of str to list of Plot
        By section.
    provenance : list of (str, str)
        Where the numbers come from.
    files : dict of str to str
        The stored tables behind the tables, as CSV.
    model_styles : dict of str to ModelStyle
        How each model is drawn.
    """

    headline: str
    errors: list[tuple[str, str]]
    gates: str
    verdict: str
    meaning: str
    counts: list[tuple[str, int]]
    summary: str
    texts: dict[str, str]
    tables: dict[str, Table]
    compared: list[Table]
    plots: dict[str, list[Plot]]
    provenance: list[tuple[str, str]]
    files: dict[str, str]
    model_styles: dict[str, ModelStyle]

    @property
    def every_plot(self) -> list[Plot]:
        """The plots of all sections."""
        return [plot for section in self.plots.values() for plot in section]


#: The verdict over all gates in words, for a reader who sees it for the first time.
_MEANINGS = {
    Verdict.ERROR: "Something could not be judged: a value, a row or a case is missing, or no gate was evaluated.",
    Verdict.FAIL: "At least one gate fails: an error is outside its limits, whatever the uncertainties.",
    Verdict.XPASS: "A gate that is declared to fail passes: its declaration is out of date.",
    Verdict.INCONCLUSIVE: "Nothing fails, but for at least one gate the uncertainties are too large for a verdict.",
    Verdict.XFAIL: "Every gate passes, but for known failures, which are declared with their reasons.",
    Verdict.PASS: "Every gate passes.",
}

_UNJUDGED = "Nothing was judged: these are results without gates."


def make_page(stored: Stored) -> Page:
    """Lay out what the folder of a run, of a sweep or of a comparison holds.

    Parameters
    ----------
    stored : Stored
        As `comparisons.output.report.stored_run.read_folder` returns it.
    """
    specs = stored.record["arguments"]["external"]
    curves = plots.curves(stored)
    over_keys = problem_plots.plots(stored.results)
    compared = [] if stored.compared is None else _compared(stored.compared)
    made = [
        *(verdict_tables(stored, specs) if stored.judged else ()),
        *compared,
        *(values.numbers for values in over_keys),
        *(curve_points(stored, plot.table, (plot.x_label, plot.y_label)) for plot in curves),
        *run_tables(stored, specs),
    ]
    tables = {table.id: table for table in made}
    sections = {
        "values": [values.plot for values in over_keys],
        "kappa": [plots.kappa(stored)] if stored.kappa["mu"].notna().any() else [],
        "curves": curves,
        "convergence": plots.convergence(stored),
    }
    drawn = {name for section in sections.values() for plot in section for name in plot.models}
    verdict = overall(stored.verdicts)
    gates = gates_of(stored)
    return Page(
        headline=headline(stored),
        errors=errors_of_models(stored.kappa),
        gates=gates,
        verdict=str(verdict) if stored.judged else "",
        meaning=_MEANINGS[verdict] if stored.judged else _UNJUDGED,
        counts=verdict_counts(stored),
        summary=_summary(stored),
        texts=stored.texts,
        tables=tables,
        compared=compared,
        plots=sections,
        provenance=provenance(stored),
        files=_files(stored, made),
        model_styles=model_styles(drawn),
    )


def _summary(stored: Stored) -> str:
    rows = stored.record["rows"]["all"]
    if not stored.judged:
        names = sorted({*stored.results["model"], *stored.curves["model"]})
        return f"The folder holds {rows} computations. Models: {', '.join(names) or 'none'}."
    models = stored.record["arguments"]["model"]
    candidates = ", ".join(models if models is not None else sorted(set(stored.summary["candidate"]))) or "none"
    tier = stored.record["arguments"]["tier"]
    size = f"The run{f' of the {tier} tier' if tier else ''} has {rows} results."
    gates, cases = without_card_gates(stored.summary), without_card_gates(stored.verdicts)
    if gates.empty:
        return f"{size} No gate was evaluated, which is an error and not a pass. Candidates: {candidates}."
    return f"{size} {len(gates)} gates were judged in {len(cases)} cases. Candidates: {candidates}."


def _compared(table: pd.DataFrame) -> list[Table]:
    return [*summary_tables(error_summary(table)), *case_tables(table)]


def _files(stored: Stored, tables: Iterable[Table]) -> dict[str, str]:
    """Return the tables of the folder, digit for digit, and those that are only on the page."""
    files = {
        "kappa.csv": csv_text(stored.kappa),
        "largest_kappa.csv": csv_text(stored.largest),
        "curves.csv": csv_text(stored.curves.drop(columns="seconds")),
        "results.csv": csv_text(stored.results.drop(columns="seconds")),
        "paper_statements.csv": csv_text(pd.DataFrame(verdicts())),
    }
    if stored.judged:
        files |= {"verdicts.csv": csv_text(stored.verdicts), "summary.csv": csv_text(stored.summary)}
    if stored.compared is not None:
        files |= {TABLE_FILE: csv_text(stored.compared), SUMMARY_FILE: csv_text(error_summary(stored.compared))}
    return files | {table.source: table_csv(table) for table in tables if table.source not in files}
