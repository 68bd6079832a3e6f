"""The content of a page: sections of tables, plots and files; a folder has those for which it has data."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib.resources import files
from typing import NamedTuple

import pandas as pd

from comparisons.description.overview import LIMITS
from comparisons.judging.report_card import overall
from comparisons.numerics.number_text import case_text, percent_text
from comparisons.output import plots
from comparisons.output.errors import error_summary, ranked, within_ranges
from comparisons.output.plots import Plot
from comparisons.output.report import tables
from comparisons.output.report.regime_map import RegimeMap
from comparisons.output.report.stored_run import Stored
from comparisons.output.summaries import case_tables, computations_sentence
from comparisons.output.table import Table, laid_out
from comparisons.output.verdicts import checks_sentence
from comparisons.quantities import ALL_QUANTITIES, title_of
from comparisons.runs.rows import CASE

#: The texts of a page: its end, the meaning of the verdict, and its sections.
TEXTS = tomllib.loads(files(__package__).joinpath("assets/texts.toml").read_text(encoding="utf-8"))


class File(NamedTuple):
    """The text of a file."""

    name: str
    text: str


#: What a section of a page is made of.
Block = RegimeMap | Table | Plot | File


@dataclass(frozen=True)
class Page:
    """The content of a page.

    Attributes
    ----------
    kind : str
        "report" or "board".
    headline : str
        The result in one sentence.
    blocks : dict of str to list
        The tables, plots and files of each section, by its name in ``assets/texts.toml``.
    lines : list of str
        What is written below the headline.
    verdict : str
        Over all gates; empty where nothing was judged.
    """

    kind: str
    headline: str
    blocks: Mapping[str, Sequence[Block]]
    lines: Sequence[str] = ()
    verdict: str = ""

    @cached_property
    def sections(self) -> dict[str, list[Block]]:
        """The sections that are not empty, in the order of the texts; a table without rows is left out."""
        sections = {}
        for name in TEXTS["section"]:
            blocks = self.blocks.get(name, ())
            if filled := [block for block in blocks if not isinstance(block, Table) or len(block.stored)]:
                sections[name] = filled
        return sections

    @cached_property
    def tables(self) -> dict[str, Table]:
        """The tables of all sections, by their ids."""
        return {block.id: block for blocks in self.sections.values() for block in blocks if isinstance(block, Table)}

    @cached_property
    def maps(self) -> list[RegimeMap]:
        """The maps of all sections."""
        return [block for blocks in self.sections.values() for block in blocks if isinstance(block, RegimeMap)]

    @cached_property
    def plots(self) -> dict[str, Plot]:
        """The plots of all sections, by their ids."""
        return {block.id: block for blocks in self.sections.values() for block in blocks if isinstance(block, Plot)}


def make_page(stored: Stored) -> Page:
    """Lay out what the folder of a run, of a sweep or of a comparison holds.

    Parameters
    ----------
    stored : Stored
        As `comparisons.output.report.stored_run.read_folder` returns it.
    """
    verdict = str(overall(stored.verdicts, stored.checks)) if stored.judged else ""
    checked = [checks_sentence(stored.summary, stored.checks)] if stored.judged else []
    computed = f"{computations_sentence(stored.record['rows'])}."
    evaluations = stored.evaluations()
    judged = within_ranges(evaluations)
    headline = _nearest_models(judged) or (checked or [computed])[0]
    lines = [*checked, TEXTS["meaning"][verdict or "none"], computed]
    blocks = {name: list(blocks) for name, blocks in _blocks(stored, evaluations, error_summary(judged)).items()}
    return Page("report", headline, blocks, lines, verdict)


def _blocks(stored: Stored, evaluations: pd.DataFrame, summary: pd.DataFrame) -> dict[str, Iterable[Block]]:
    over_keys, curves = plots.values_over_keys(stored.results), plots.curves(stored.curves)
    errors = errors_and_plot(stored.kappa)
    ordered = ranked(summary).sort_values(["quantity", "reference", "size"], ignore_index=True)
    solved = stored.results[(stored.results["size"] > 0) & (stored.results["status"] == "ok")]
    return {
        "map": regime_maps(RegimeMap(evaluations, stored.domains, stored.problem_kinds)),
        "compared": [laid_out("summary", ordered), *case_tables(stored.comparison)],
        "gates": tables.gates(stored) if stored.judged else [],
        "worst": tables.worst_cases(stored) if stored.judged else [],
        "values": [block for plot, keys in over_keys for block in (plot, tables.values(stored, plot, keys))],
        "predicted": predicted_plot(stored.kappa_inside),
        "errors": [*errors, tables.largest_errors(stored)] if errors else [],
        "shapes": [block for plot in curves for block in (plot, tables.curve_points(stored, plot))],
        "order": [laid_out("convergence", solved)],
        "numbers": [tables.models(stored), laid_out("results", stored.results)],
        "cases": [File(name, text) for name, text in stored.texts.items()],
        "origin": [tables.provenance(stored.record)],
    }


def regime_maps(regimes: RegimeMap) -> list[Block]:
    """Return the map as what a section has; nothing where there is no error."""
    return [regimes] if regimes.views else []


def predicted_plot(kappa: pd.DataFrame) -> list[Block]:
    """Return the plot of values over those of the reference; nothing where there is none."""
    return [plots.predicted(kappa)] if kappa["kappa"].notna().any() else []


def errors_and_plot(kappa: pd.DataFrame) -> list[Block]:
    """Return the plot of relative errors and the table of its numbers; nothing where there is no error."""
    if not kappa["kappa"].notna().any():
        return []
    plot = plots.kappa(kappa)
    return [plot, laid_out("kappa", kappa, group=plot.group)]


def _nearest_models(judged: pd.DataFrame) -> str:
    """Return how far the models are from their reference in the first quantity, or which of them is near most often.

    Empty where nothing is compared.

    Examples
    --------
    >>> case = {"reference": "fscm", "quantity": "pull_off_force", "status": "ok", "u_kappa": 1e-9, "n": 2.0, "k": 0.0}
    >>> errors = ((5.0, -0.02), (2.0, -0.06))
    >>> rows = [case | {"model": "jkr", "mu": mu, "kappa": kappa, "nu": None} for mu, kappa in errors]
    >>> _nearest_models(pd.DataFrame(rows[:1]))
    'jkr differs from fscm by at most -2.00000 % in the pull-off force, at n = 2, k = 0, mu = 5.'
    >>> _nearest_models(pd.DataFrame([*rows, *({**row, "model": "dmt"} for row in rows[1:])]))
    'jkr is certainly within 5 % of fscm in 1 of 2 cases of the pull-off force, more often than any other model here.'
    """
    known = judged[judged["kappa"].notna()]
    if known.empty:
        beyond = "No case is within the range that its model declares; the map has the errors in brackets."
        return beyond if (judged["status"] == "outside").any() else ""
    quantity = min(known["quantity"], key=list(ALL_QUANTITIES).index)
    known = known[known["quantity"] == quantity]
    reference = known["reference"].mode().iloc[0]
    known = known[known["reference"] == reference]
    if known["model"].nunique() == 1:
        worst = known.loc[known["kappa"].abs().idxmax()]
        error = f"{percent_text(worst['kappa'], worst['u_kappa'])} % in the {title_of(quantity)}"
        where = case_text({name: worst.get(name) for name in CASE})
        return f"{worst['model']} differs from {reference} by at most {error}, at {where}."
    near = known["kappa"].abs() + known["u_kappa"] <= LIMITS[-1]
    counts = near.groupby(known["model"]).sum()
    best = counts.index[counts == counts.max()].tolist()
    cases = len(known.drop_duplicates([name for name in CASE if name in known]))
    names = f"{', '.join(best[:-1])} and {best[-1]} are" if len(best) > 1 else f"{best[0]} is"
    others = ", more often than any other model here" if len(best) < len(counts) else ""
    return (
        f"{names} certainly within {100 * LIMITS[-1]:g} % of {reference} in {counts.max()} of {cases} cases of the "
        f"{title_of(quantity)}{others}."
    )
