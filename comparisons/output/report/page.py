"""The content of a page: the texts, tables and plots of its sections, before there is any HTML."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import Any

import pandas as pd

from comparisons.data.paper_statements import verdicts
from comparisons.judging.decision import Verdict, roll_up
from comparisons.output.latex import latex
from comparisons.output.report import card_table, number_tables, plots, verdict_tables
from comparisons.output.report.plot import Plot
from comparisons.output.report.statement_table import statements
from comparisons.output.report.stored_run import Stored
from comparisons.output.report.table import Table, table_tex
from comparisons.output.style import ModelStyle, model_styles
from comparisons.output.verdicts import worst_cases
from comparisons.runs.csv_format import csv_text

__all__ = ["Page", "make_page"]


@dataclass(frozen=True, slots=True)
class Page:
    """The content of a page.

    Attributes
    ----------
    verdict, meaning : str
        Over all gates; no verdict where nothing was judged.
    counts : list of (str, int)
        How many cases ended with each verdict, worst first.
    summary : str
        What was run, in one sentence.
    tables : dict of str to Table
        By their ids.
    plots : dict of str to list of Plot
        By section.
    provenance : list of (str, str)
        Where the numbers come from.
    files : dict of str to str
        What can be downloaded.
    model_styles : dict of str to ModelStyle
        How each model is drawn.
    """

    verdict: str
    meaning: str
    counts: list[tuple[str, int]]
    summary: str
    tables: dict[str, Table]
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


def make_page(stored: Stored) -> Page:
    """Lay out what a run folder holds.

    Parameters
    ----------
    stored : Stored
        As `comparisons.output.report.stored_run.read_folder` returns it.
    """
    specs = stored.record["arguments"]["external"]
    curves = plots.curves(stored)
    of_verdicts = [
        verdict_tables.matrix(stored),
        verdict_tables.offenders(stored, specs),
        verdict_tables.all_verdicts(stored),
        card_table.cards(stored),
    ]
    made = [
        *(of_verdicts if stored.judged else ()),
        number_tables.kappa(stored),
        number_tables.largest(stored),
        *(number_tables.curve_points(stored, plot.table, (plot.x_label, plot.y_label)) for plot in curves),
        number_tables.convergence(stored),
        number_tables.results(stored),
        number_tables.models(stored, specs),
        statements(),
    ]
    tables = {table.id: table for table in made}
    sections = {
        "kappa": [plots.kappa(stored)] if len(stored.kappa) else [],
        "curves": curves,
        "convergence": plots.convergence(stored),
    }
    drawn = {name for section in sections.values() for plot in section for name in plot.models}
    verdict = roll_up(stored.verdicts["verdict"])
    return Page(
        verdict=str(verdict) if stored.judged else "",
        meaning=_MEANINGS[verdict] if stored.judged else "Nothing was judged: these are results without gates.",
        counts=_counts(stored),
        summary=_summary(stored),
        tables=tables,
        plots=sections,
        provenance=_provenance(stored),
        files=_files(stored, tables),
        model_styles=model_styles(drawn),
    )


def _counts(stored: Stored) -> list[tuple[str, int]]:
    found = Counter(stored.verdicts["verdict"])
    return [(str(verdict), found[verdict]) for verdict in Verdict if found[verdict]]


def _summary(stored: Stored) -> str:
    rows = stored.record["rows"]["all"]
    if not stored.judged:
        names = sorted({*stored.results["model"], *stored.curves["model"]})
        return f"The folder holds {rows} computations. Models: {', '.join(names) or 'none'}."
    models = stored.record["arguments"]["model"]
    candidates = ", ".join(models if models is not None else sorted(set(stored.summary["candidate"]))) or "none"
    shipped = stored.record["rows"].get("shipped")
    of_package = f", {shipped} of them shipped with fscm-bench" if shipped else ""
    size = f"The run of the {stored.record['arguments']['tier']} tier has {rows} results{of_package}."
    if stored.summary.empty:
        return f"{size} No gate was evaluated, which is an error and not a pass. Candidates: {candidates}."
    gates = f"{len(stored.summary)} gates were judged in {len(stored.verdicts)} cases."
    return f"{size} {gates} Candidates: {candidates}."


def _files(stored: Stored, tables: dict[str, Table]) -> dict[str, str]:
    """Return the CSV files of the folder, digit for digit, and the shorter tables as LaTeX."""
    files = {
        "kappa.csv": csv_text(stored.kappa),
        "largest_kappa.csv": csv_text(stored.largest),
        "curves.csv": csv_text(stored.curves.drop(columns="seconds")),
        "results.csv": csv_text(stored.results.drop(columns="seconds")),
        "largest_kappa.tex": table_tex(tables["largest"]),
        "paper_statements.csv": csv_text(pd.DataFrame(verdicts())),
    }
    if stored.judged:
        caption = "Verdicts of fscm-bench, worst first, each in its worst case"
        files |= {
            "verdicts.csv": csv_text(stored.verdicts),
            "verdicts.tex": latex(worst_cases(stored.summary), caption),
            "offenders.tex": table_tex(tables["offenders"]),
        }
    return files


def _provenance(stored: Stored) -> list[tuple[str, str]]:
    record = stored.record
    package, machine = record["package"], record["machine"]
    dirty = {True: "changed since that commit", False: "clean", None: "not known"}[package["dirty"]]
    facts = [
        ("command", " ".join(record["command"])),
        ("arguments", _pairs(record["arguments"])),
        ("started", record["started"]),
        ("finished", record["finished"]),
        ("seconds", f"{record['seconds']['run']:.4g}"),
        ("rows", _pairs(record["rows"])),
        ("package", f"{package['name']} {package['version']}"),
        ("commit", package["commit"] or "not known"),
        ("work tree", dirty),
        ("SHA-256 of the code", package["code_sha256"]),
        ("SHA-256 of the cases", record["cases_sha256"]),
        *([("SHA-256 of the gates", record["gates_sha256"])] if stored.judged else []),
        ("Python", record["python"]),
        ("dependencies", _pairs(record["dependencies"])),
        ("system", machine["system"]),
        ("CPU", f"{machine['cpu']}, {machine['cores']} cores"),
        ("BLAS", "; ".join(f"{one['library']} {one['version']}, {one['threads']} threads" for one in record["blas"])),
    ]
    facts += [(f"part {number} of the computations", _pairs(part)) for number, part in enumerate(record["parts"], 1)]
    if "shipped" in record:
        facts += _shipped(record["shipped"], record["rows"]["shipped"])
    if "judged_by_other_code" in record:
        facts.append(("judged by other code", record["judged_by_other_code"]))
    if "judged_again" in record:
        again = record["judged_again"]
        facts.append(("judged again", f"by {again['gates']}, SHA-256 {again['gates_sha256']}"))
    then, now = record["verdicts"], {"all": str(roll_up(stored.verdicts["verdict"])), **dict(_counts(stored))}
    if stored.judged and then != now:
        facts.append(("judged again", f"yes; at the end of the run the verdicts were {_pairs(then)}"))
    return facts


def _shipped(shipped: dict[str, Any], count: int) -> list[tuple[str, str]]:
    """Return the facts about the values that came with the package."""
    again = shipped["evaluated_again"]
    tasks = [f"{model} {_pairs(task)}" for model, one in again["models"].items() for task in one["tasks"]]
    return [
        ("shipped values", f"{count}, solvers {shipped['origin']['solvers_sha256']}"),
        *(
            (f"part {number} of the shipped values", _pairs(part))
            for number, part in enumerate(shipped["origin"]["parts"], 1)
        ),
        (f"shipped values computed again (seed {again['seed']})", "; ".join(tasks)),
    ]


def _pairs(content: dict[str, Any]) -> str:
    return ", ".join(f"{name} {_plain(value)}" for name, value in content.items() if value not in (None, {}, []))


def _plain(value: object) -> str:
    if isinstance(value, dict):
        return "(" + _pairs(value) + ")"
    return " ".join(map(str, value)) if isinstance(value, list) else str(value)
