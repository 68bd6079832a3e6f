"""The content of the page of a sweep over a problem file, before there is any HTML."""

from __future__ import annotations

from dataclasses import dataclass

import pandas as pd

from comparisons.numerics.number_text import percent_text
from comparisons.output.problem_sweep_text import key_text, unit_in
from comparisons.output.problem_tables import varied_of
from comparisons.output.report.plot import Plot
from comparisons.output.report.problem_page_tables import counted, errors, models, results, without_value
from comparisons.output.report.problem_plots import numbers_of, plots
from comparisons.output.report.provenance import record_facts
from comparisons.output.report.stored_problem_sweep import StoredProblemSweep
from comparisons.output.report.table import Table
from comparisons.output.style import ModelStyle, model_styles
from comparisons.problem_file.overview import REFERENCES
from comparisons.problem_file.units import si_text
from comparisons.quantities import title_of
from comparisons.runs.csv_format import csv_text

__all__ = ["ProblemPage", "make_problem_page", "problem_headline"]

#: Bound on a value, relative to it, below which four digits are right or next to it.
_ROUNDING = 5e-5


@dataclass(frozen=True, slots=True)
class ProblemPage:
    """The content of the page of a sweep over a problem file.

    Attributes
    ----------
    headline, summary : str
        What was found, and what was computed.
    text, name : str
        The problem file and its name.
    vary : list of str
        The varied keys as they were given.
    tables : dict of str to Table
        By their ids.
    every_plot : list of Plot
    provenance : list of (str, str)
    files : dict of str to str
        The stored tables, as CSV.
    model_styles : dict of str to ModelStyle
    """

    headline: str
    summary: str
    text: str
    name: str
    vary: list[str]
    tables: dict[str, Table]
    every_plot: list[Plot]
    provenance: list[tuple[str, str]]
    files: dict[str, str]
    model_styles: dict[str, ModelStyle]


def make_problem_page(stored: StoredProblemSweep) -> ProblemPage:
    """Lay out what the folder of a sweep over a problem file holds."""
    drawn = plots(stored)
    over = {unit_in(name)[0]: name for name in stored.varied}
    made = [
        *(numbers_of(stored, plot, over[plot.title.removeprefix("Values over ")]) for plot in drawn),
        errors(stored),
        results(stored),
        without_value(stored),
        models(stored),
    ]
    return ProblemPage(
        headline=problem_headline(stored.results),
        summary=_summary(stored),
        text=stored.text,
        name=stored.record["inputs"]["problem"].rpartition("/")[2],
        vary=stored.record["arguments"]["vary"],
        tables={table.id: table for table in made},
        every_plot=drawn,
        provenance=record_facts(stored.record),
        files={
            "results.csv": csv_text(stored.results.drop(columns="seconds")),
            "kappa.csv": csv_text(stored.errors),
            "models.csv": csv_text(counted(stored)),
        },
        model_styles=model_styles({name for plot in drawn for name in plot.models}),
    )


def problem_headline(values: pd.DataFrame) -> str:
    """Return the range of the pull-off force, or of the first quantity, of the reference among the models.

    Examples
    --------
    >>> row = {"model": "fscm", "quantity": "pull_off_force", "u_num": 1e-13, "unit": "N", "status": "ok"}
    >>> rows = [row | {"punch.R [m]": R, "value": 0.2 * R} for R in (1e-7, 3e-7)]
    >>> problem_headline(pd.DataFrame(rows))
    'The pull-off force of fscm is between 20 nN (R = 100 nm) and 60 nN (R = 300 nm)'
    """
    known = values[values["status"] == "ok"]
    if known.empty:
        return "No computation of this sweep has a value"
    models = set(known["model"])
    model = next((name for name in REFERENCES if name in models), known["model"].iloc[0])
    of_model = known[known["model"] == model]
    quantity = "pull_off_force" if "pull_off_force" in set(of_model["quantity"]) else of_model["quantity"].iloc[0]
    rows = of_model[of_model["quantity"] == quantity]
    ends = [rows.loc[place] for place in (rows["value"].idxmin(), rows["value"].idxmax())]
    texts = [f"{_number(row)} ({_where(row, values)})" for row in ends]
    first = f"The {title_of(quantity)} of {model} is"
    return f"{first} {texts[0]}" if len(rows) == 1 else f"{first} between {texts[0]} and {texts[1]}"


def _number(row: pd.Series) -> str:
    """Four digits, or those that the bound leaves."""
    value, u_num = float(row["value"]), float(row["u_num"])
    certain = u_num < _ROUNDING * abs(value)
    return si_text(float(f"{value:.4g}") if certain else value, 0.0 if certain else u_num, str(row["unit"]))


def _where(row: pd.Series, table: pd.DataFrame) -> str:
    """The varied keys without their sections, where no two of them are the same."""
    varied = varied_of(table)
    names = [unit_in(name)[0].partition(".")[2] for name in varied]
    pairs = zip(varied, names if len(set(names)) == len(names) else map(_full, varied), strict=True)
    return ", ".join(f"{name} = {key_text(row[column], unit_in(column)[1])}" for column, name in pairs)


def _full(column: str) -> str:
    return unit_in(column)[0]


def _largest_error(stored: StoredProblemSweep) -> str:
    """A sentence on the model that differs most from the reference; empty without errors."""
    kappa = stored.errors
    if kappa.empty:
        return ""
    worst = kappa.loc[kappa["kappa"].abs().idxmax()]
    size = percent_text(worst["kappa"], worst["u_kappa"])
    first = f"Of {kappa['model'].nunique()} models {worst['model']}" if kappa["model"].nunique() > 1 else worst["model"]
    return (
        f" {first} differs most from {worst['reference']}: by {size} % in the {title_of(worst['quantity'])} "
        f"({_where(worst, stored.results)})."
    )


def _summary(stored: StoredProblemSweep) -> str:
    arguments, results = stored.record["arguments"], stored.results
    whole = f" (part {arguments['shard']} of {arguments['computations']})" if "shard" in arguments else ""
    keys = ", ".join(unit_in(name)[0] for name in stored.varied)
    ended = ", ".join(f"{count} {status}" for status, count in results["status"].value_counts().items())
    problems = len(results[stored.varied].drop_duplicates())
    return (
        f"The sweep has {len(results)} computations{whole} of {problems} problems: values of {keys}. Models: "
        f"{', '.join(sorted(set(results['model'])))}. Status: {ended}."
        f"{_largest_error(stored)}"
    )
