"""The content of a page: sections of tables, plots and facts; a folder has those for which it has data."""

from __future__ import annotations

import tomllib
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache, cached_property
from importlib.resources import files
from typing import Any, NamedTuple

import pandas as pd

from comparisons.judging.card_gates import overall, without_card_gates
from comparisons.judging.decision import Verdict
from comparisons.numerics.number_text import case_text, percent_text
from comparisons.output.comparison import SUMMARY_FILE, case_tables, summary_tables
from comparisons.output.errors import error_summary, worst_rows
from comparisons.output.gate_sentence import gates_sentence
from comparisons.output.report import plots, tables
from comparisons.output.report.plots import Plot, in_registry
from comparisons.output.report.stored_run import TABLES, Stored
from comparisons.output.table import Record, Table
from comparisons.output.varied_keys import physical_text
from comparisons.problem.problem import split_name
from comparisons.quantities import title_of
from comparisons.runs.csv_format import csv_text
from comparisons.runs.rows import CASE

__all__ = ["Block", "Facts", "File", "Page", "Section", "make_page", "texts"]


class Facts(NamedTuple):
    """Texts with their names."""

    pairs: Sequence[tuple[str, str]]


class File(NamedTuple):
    """The text of a file."""

    name: str
    text: str


#: What a section of a page is made of.
Block = Table | Plot | Facts | File


class Section(NamedTuple):
    """A section of a page."""

    id: str
    title: str
    text: str
    blocks: Sequence[Block]


@dataclass(frozen=True)
class Page:
    """The content of a page.

    Attributes
    ----------
    kind : str
        "report" or "leaderboard".
    headline : str
        What was found, in one sentence.
    lines : list of str
        What is written below it.
    blocks : dict of str to list
        The tables, plots, facts and files of each section, by its name in ``assets/texts.toml``.
    stored : dict of str to DataFrame
        The stored tables behind the tables, by the names of their files.
    facts : list of (str, str)
        Each model and its largest error, largest first.
    verdict, counts
        Over all gates (empty where nothing was judged), and how many cases ended with each, worst first.
    """

    kind: str
    headline: str
    lines: list[str]
    blocks: Mapping[str, Sequence[Block]]
    stored: Mapping[str, pd.DataFrame] = field(default_factory=dict)
    facts: Sequence[tuple[str, str]] = ()
    verdict: str = ""
    counts: Sequence[tuple[str, int]] = ()

    @property
    def sections(self) -> list[Section]:
        """The sections that are not empty, in the order of the texts."""
        return [
            Section(name, text["title"], text["text"], self.blocks[name])
            for name, text in texts()["section"].items()
            if self.blocks.get(name)
        ]

    @property
    def end(self) -> str:
        """What the page was made of."""
        return str(texts()["end"][self.kind])

    @cached_property
    def tables(self) -> dict[str, Table]:
        """The tables of all sections, by their ids."""
        return {block.id: block for blocks in self.blocks.values() for block in blocks if isinstance(block, Table)}

    @cached_property
    def plots(self) -> dict[str, Plot]:
        """The plots of all sections, by their ids."""
        return {block.id: block for blocks in self.blocks.values() for block in blocks if isinstance(block, Plot)}

    @property
    def files(self) -> dict[str, str]:
        """The stored tables as CSV, digit for digit, and those that are only on the page."""
        # The CSV files of a folder have no times.
        stored = {name: table.drop(columns="seconds", errors="ignore") for name, table in self.stored.items()}
        return {table.file: csv_text(stored.get(table.file, table.stored)) for table in self.tables.values()}


@cache
def texts() -> Any:
    """Return the texts of a page."""
    return tomllib.loads(files(__package__).joinpath("assets/texts.toml").read_text(encoding="utf-8"))


def make_page(stored: Stored) -> Page:
    """Lay out what the folder of a run, of a sweep or of a comparison holds.

    Parameters
    ----------
    stored : Stored
        As `comparisons.output.report.stored_run.read_folder` returns it.
    """
    finding, gates = _headline(stored), _gates(stored)
    verdict = str(overall(stored.verdicts)) if stored.judged else ""
    lines = [f"{gates}." if gates and gates != finding else "", texts()["meaning"][verdict or "none"], _summary(stored)]
    summary = error_summary(stored.comparison)
    errors = errors_of_models(stored.kappa)
    counts = Counter(stored.verdicts["verdict"])
    return Page(
        kind="report",
        headline=f"{finding}.",
        lines=list(filter(None, lines)),
        blocks=_blocks(stored, summary),
        facts=errors if len(errors) > 1 else (),
        verdict=verdict,
        counts=[(str(each), counts[each]) for each in Verdict if counts[each]],
        stored={SUMMARY_FILE: summary} | {f"{name}.csv": getattr(stored, name) for name in TABLES},
    )


def _blocks(stored: Stored, summary: pd.DataFrame) -> dict[str, Sequence[Block]]:
    with_mu, over_keys = stored.kappa["mu"].notna().any(), plots.values_over_keys(stored.results)
    return {
        "gates": _filled(tables.gates(stored)) if stored.judged else [],
        "worst": _filled(tables.worst_cases(stored)) if stored.judged else [],
        "compared": [*summary_tables(summary), *case_tables(stored.comparison)],
        "values": [block for plot, keys in over_keys for block in (plot, tables.values(stored, plot, keys))],
        "errors": [*([plots.kappa(stored.kappa)] if with_mu else []), *_filled(tables.errors(stored))],
        "shapes": [
            block for plot in plots.curves(stored.curves) for block in (plot, tables.curve_points(stored, plot))
        ],
        "order": _filled([tables.convergence(stored.results)]),
        "numbers": list(tables.numbers_of(stored)),
        "cases": [File(name, text) for name, text in stored.texts.items()],
        "origin": [Facts(_provenance(stored.record))],
    }


def _filled(made: Iterable[Table]) -> list[Table]:
    return [table for table in made if len(table.stored)]


def _summary(stored: Stored) -> str:
    rows, arguments = stored.record["rows"]["all"], stored.record["arguments"]
    if not stored.judged:
        names = sorted({*stored.results["model"], *stored.curves["model"]})
        return f"The folder holds {rows} computations. Models: {', '.join(names) or 'none'}."
    models = arguments["model"] if arguments["model"] is not None else sorted(set(stored.summary["candidate"]))
    tier = f" of the {arguments['tier']} tier" if arguments["tier"] else ""
    gates, cases = without_card_gates(stored.summary), without_card_gates(stored.verdicts)
    judged = f"{len(gates)} gates were judged in {len(cases)} cases."
    none = "No gate was evaluated, which is an error and not a pass."
    candidates = ", ".join(models) or "none"
    return f"The run{tier} has {rows} results. {none if gates.empty else judged} Candidates: {candidates}."


#: Entries of a record that other sections of the page have.
_ELSEWHERE = ("files", "models", "domains", "cards", "coverage")


def _provenance(record: Mapping[str, Any]) -> list[tuple[str, str]]:
    """Return the entries of a record as texts, each with its name."""
    parts = {f"part {number}": part for number, part in enumerate(record["parts"], 1)}
    entries = {name: entry for name, entry in record.items() if name not in (*_ELSEWHERE, "parts")} | parts
    return [(name.replace("_", " "), _plain(entry)) for name, entry in entries.items()]


def _plain(entry: Any) -> str:
    if isinstance(entry, dict):
        pairs = (f"{name} {_plain(value)}" for name, value in entry.items() if value not in (None, {}, []))
        return ", ".join(pairs)
    if isinstance(entry, list):
        return (
            "; ".join(map(_plain, entry)) if any(isinstance(one, dict) for one in entry) else " ".join(map(str, entry))
        )
    return "not known" if entry is None else str(entry)


def _headline(stored: Stored) -> str:
    """Return the finding of a folder in one sentence: which model is how wrong, or without errors that on all gates."""
    if stored.judged and stored.kappa.empty:
        return _gates(stored)
    return _of_errors(stored.kappa) or _of_values(stored.results) or "No model has a value where a reference has one"


def _gates(stored: Stored) -> str:
    """Return the finding over all gates in one sentence; empty if nothing was judged."""
    bases = dict(zip(stored.gates["id"], stored.gates["basis"], strict=True))
    return gates_sentence(stored.summary, bases) if stored.judged else ""


def _of_values(results: pd.DataFrame) -> str:
    """Return the range of the first quantity of problem files by one model; empty where no case of one has a value.

    Examples
    --------
    >>> row = {"model": "fscm", "quantity": "pull_off_force", "u_num": 1e-15, "unit": "N", "status": "ok"}
    >>> rows = [row | {"problem": f"pad.toml; punch.R={R} nm", "value": 2e-10 * R} for R in (100, 300)]
    >>> _of_values(pd.DataFrame(rows))
    'The pull-off force of fscm is between 20.0000000(11) nN (punch.R=100 nm) and 60.0000000(11) nN (punch.R=300 nm)'
    """
    rows = results[results["status"] == "ok"]
    if "problem" not in rows or not (rows := rows[rows["problem"] != ""]).size:
        return ""
    rows = rows[rows["model"] == rows["model"].iloc[0]]
    rows = rows[rows["quantity"] == min(rows["quantity"], key=in_registry)].sort_values("value", kind="stable")
    texts = []
    for row in (rows.iloc[0], rows.iloc[-1]):
        file, *keys = split_name(row["problem"])
        texts.append(f"{physical_text(row)} ({', '.join(keys) or file})")
    subject = f"The {title_of(rows['quantity'].iloc[0])} of {rows['model'].iloc[0]} is"
    return f"{subject} {texts[0]}" if len(rows) == 1 else f"{subject} between {texts[0]} and {texts[1]}"


def errors_of_models(kappa: pd.DataFrame) -> list[tuple[str, str]]:
    """Return each model with its largest relative error in words, largest first.

    The error is that of the first quantity of the registry in which the model has one: a pull-off force, as a rule.

    Examples
    --------
    >>> case = {"quantity": "pull_off_force", "n": 2.0, "k": 0.0, "mu": 1.0, "nu": None, "reference": "fscm"}
    >>> rows = [case | {"model": "dmt", "kappa": 0.01, "u_kappa": 1e-9}]
    >>> errors_of_models(pd.DataFrame(rows))
    [('dmt', '1.00000(5) % in the pull-off force at n = 2, k = 0, mu = 1')]
    """
    rank = kappa["quantity"].map(lambda name: in_registry(name)[0])
    worst = worst_rows(kappa[rank == rank.groupby(kappa["model"]).transform("min")], ["model"])
    worst = worst.sort_values("kappa", key=lambda errors: -errors.abs(), kind="stable")
    return [(str(row["model"]), _error_text(row)) for row in worst.to_dict("records")]


def _error_text(row: Record) -> str:
    where = case_text({name: row.get(name) for name in CASE})
    return f"{percent_text(row['kappa'], row['u_kappa'])} % in the {title_of(row['quantity'])} at {where}"


def _of_errors(kappa: pd.DataFrame) -> str:
    """Return which model differs most from its reference, and where; empty without errors.

    Examples
    --------
    >>> case = {"quantity": "pull_off_force", "n": 2.0, "k": 0.0, "mu": 1.0, "nu": None, "reference": "fscm"}
    >>> rows = [case | {"model": "jkr", "kappa": -0.05, "u_kappa": 1e-9}, case | {"model": "dmt", "kappa": 0.01}]
    >>> _of_errors(pd.DataFrame(rows))
    'Of 2 models jkr differs most from fscm: by -5.00000(5) % in the pull-off force at n = 2, k = 0, mu = 1'
    """
    if kappa.empty:
        return ""
    worst = kappa.loc[kappa["kappa"].abs().idxmax()]
    models = kappa["model"].nunique()
    subject = f"Of {models} models {worst['model']} differs most" if models > 1 else f"{worst['model']} differs"
    most = "" if models > 1 else "at most "
    return f"{subject} from {worst['reference']}: by {most}{_error_text(worst)}"
