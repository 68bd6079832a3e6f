"""The content of a page: sections of tables, plots and files; a folder has those for which it has data."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib.resources import files
from typing import NamedTuple

import pandas as pd

from comparisons.judging.report_card import overall
from comparisons.numerics.number_text import case_text, percent_text
from comparisons.output import plots
from comparisons.output.plots import Plot
from comparisons.output.report import tables
from comparisons.output.report.stored_run import Stored
from comparisons.output.summaries import case_tables, computations_sentence
from comparisons.output.table import Table, laid_out
from comparisons.output.verdicts import gates_sentence
from comparisons.quantities import title_of
from comparisons.runs.rows import CASE

#: The texts of a page: its end, the meaning of the verdict, and its sections.
TEXTS = tomllib.loads(files(__package__).joinpath("assets/texts.toml").read_text(encoding="utf-8"))


class File(NamedTuple):
    """The text of a file."""

    name: str
    text: str


#: What a section of a page is made of.
Block = Table | Plot | File


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
    gates = [f"{gates_sentence(stored.summary, stored.verdicts, stored.checks)}."] if stored.judged else []
    computed = f"{computations_sentence(stored.record['rows'])}."
    summary = stored.error_summary()
    headline = _largest_error(summary) or (gates or [computed])[0]
    lines = [*gates, TEXTS["meaning"][verdict or "none"], computed]
    blocks = {name: list(blocks) for name, blocks in _blocks(stored, summary).items()}
    return Page("report", headline, blocks, lines, verdict)


def _blocks(stored: Stored, summary: pd.DataFrame) -> dict[str, Iterable[Block]]:
    over_keys, curves = plots.values_over_keys(stored.results), plots.curves(stored.curves)
    errors = errors_and_plot(stored.kappa)
    ordered = summary.sort_values(["quantity", "size"], ascending=[True, False], ignore_index=True)
    solved = stored.results[(stored.results["size"] > 0) & (stored.results["status"] == "ok")]
    return {
        "compared": [laid_out("summary", ordered), *case_tables(stored.comparison)],
        "gates": tables.gates(stored) if stored.judged else [],
        "worst": tables.worst_cases(stored) if stored.judged else [],
        "values": [block for plot, keys in over_keys for block in (plot, tables.values(stored, plot, keys))],
        "errors": [*errors, tables.largest_errors(stored)] if errors else [],
        "shapes": [block for plot in curves for block in (plot, tables.curve_points(stored, plot))],
        "order": [laid_out("convergence", solved)],
        "numbers": [tables.models(stored), laid_out("results", stored.results)],
        "cases": [File(name, text) for name, text in stored.texts.items()],
        "origin": [tables.provenance(stored.record)],
    }


def errors_and_plot(kappa: pd.DataFrame) -> list[Block]:
    """Return the plot of relative errors and the table of its numbers; nothing where there is no error."""
    if not kappa["kappa"].notna().any():
        return []
    plot = plots.kappa(kappa)
    return [plot, laid_out("kappa", kappa, group=plot.group)]


def _largest_error(summary: pd.DataFrame) -> str:
    """Return which model differs most from its reference, and where; empty without errors.

    Examples
    --------
    >>> worst = {"model": "jkr", "reference": "fscm", "quantity": "pull_off_force", "largest": -0.05, "size": 0.05}
    >>> _largest_error(pd.DataFrame([worst | {"u_largest": 1e-9, "n": 2.0, "k": 0.0, "mu": 1.0}]))
    'jkr differs most from fscm: by -5.00000(5) % in the pull-off force at n = 2, k = 0, mu = 1.'
    """
    if not summary["size"].notna().any():
        return ""
    worst = summary.loc[summary["size"].idxmax()]
    error = f"{percent_text(worst['largest'], worst['u_largest'])} % in the {title_of(worst['quantity'])}"
    where = case_text({name: worst.get(name) for name in CASE})
    return f"{worst['model']} differs most from {worst['reference']}: by {error} at {where}."
