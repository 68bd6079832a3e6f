"""The first page of the board: errors of the newest versions, errors by region, history, and all submissions."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import pandas as pd

from comparisons.judging.decision import roll_up
from comparisons.judging.report_card import overall
from comparisons.judging.standing import inside, range_text, stated_range
from comparisons.output.errors import error_summary, ranked, within_ranges
from comparisons.output.region_table import region_table
from comparisons.output.report.page import Block, Page, errors_and_plot, predicted_plot, regime_maps
from comparisons.output.report.regime_map import RegimeMap
from comparisons.output.report.stored_run import Stored
from comparisons.output.table import Table, laid_out
from comparisons.quantities import ALL_QUANTITIES
from comparisons.runs.rows import Key


@dataclass(frozen=True, slots=True)
class Submission:
    """A version of a model, as its authors describe it.

    Attributes
    ----------
    name, version, date, citation, licence : str
    authors : tuple of str
    spec : str
        The SPEC that finds the model.
    """

    name: str
    version: str
    date: str
    authors: tuple[str, ...]
    citation: str
    licence: str
    spec: str

    @property
    def folder(self) -> str:
        """The folder of its results in the site."""
        return f"models/{self.name}/{self.version}"


@dataclass(frozen=True, slots=True)
class Entry:
    """A run whose models stand on the board.

    Attributes
    ----------
    stored : Stored
    planned : set of (Key, str)
        The keys of the results that its tables of errors are about, with a reference of each.
    """

    stored: Stored
    planned: Collection[tuple[Key, str]]


@dataclass(frozen=True, slots=True)
class BoardEntry:
    """A submission and its results.

    Attributes
    ----------
    path : str
        Its folder among the submissions.
    submission : Submission or None
        None if its description cannot be read.
    judged : Entry or None
        None if it was not judged.
    reason : str
        Why it was not judged.
    """

    path: str
    submission: Submission | None
    judged: Entry | None
    reason: str = ""


def standing(entry: Entry) -> pd.DataFrame:
    """Return the summary of errors of a run within the ranges that its models declare, with ranges and verdicts."""
    stored = entry.stored
    summary = error_summary(within_ranges(stored.evaluations(entry.planned)))
    pairs = zip(summary["model"], summary["quantity"], strict=True)
    ranges = [range_text(stated_range(name, stored.domains)) for name in summary["model"]]
    return summary.assign(range=ranges, verdict=[_verdict(stored, *pair) for pair in pairs])


def _judged_verdicts(stored: Stored) -> pd.DataFrame:
    """Return the verdicts within the ranges that the models declare, as those of a domain are."""
    verdicts = stored.verdicts
    return verdicts[inside(verdicts, verdicts["candidate"], stored.domains)]


def _verdict(stored: Stored, model: str, quantity: str) -> str:
    """Return the worst verdict on a model about a quantity; that of its report card is on the model as a whole."""
    verdicts = _judged_verdicts(stored)
    on_model = verdicts[(verdicts["candidate"] == model) & (verdicts["quantity"] == quantity)]
    of_card = [check.verdict for check in stored.checks if check.model == model]
    return "" if on_model.empty else str(roll_up([*on_model["verdict"], *of_card]))


def standings(entries: Sequence[BoardEntry]) -> pd.DataFrame:
    """Return the errors and verdicts of every version that was judged; `newest` marks the newest one of a model.

    Parameters
    ----------
    entries : sequence of BoardEntry

    Returns
    -------
    DataFrame
        As of `standing`, one row a quantity, by model and date; `order` sorts the
        quantities, of which the judged one is the first.
    """
    tables = []
    for submission, judged in _judged(entries):
        stated = {name: getattr(submission, name) for name in ("version", "date", "licence", "folder")}
        errors = standing(judged).assign(**stated, authors=", ".join(submission.authors))
        tables.append(errors[errors["model"] == submission.name])
    if not tables:
        return pd.DataFrame()
    rows = pd.concat(tables, ignore_index=True)
    rows = rows.assign(order=rows["quantity"].map(list(ALL_QUANTITIES).index))
    rows = rows.sort_values(["model", "date", "version", "order"], ignore_index=True)
    return rows.assign(newest=rows["folder"] == rows.groupby("model")["folder"].transform("last"))


def board_page(entries: Sequence[BoardEntry]) -> Page:
    """Return the content of the first page.

    Parameters
    ----------
    entries : sequence of BoardEntry
    """
    rows = standings(entries)
    blocks = {"submissions": [_submissions(entries)]} | ({} if rows.empty else _results(entries, rows))
    count = rows["model"].nunique() if len(rows) else 0
    judged = sum(entry.judged is not None for entry in entries)
    lines = [f"Submissions: {len(entries)}, of which {judged} are judged."]
    return Page("board", f"{count} models of adhesive contact and their errors", blocks, lines)


def _results(entries: Sequence[BoardEntry], rows: pd.DataFrame) -> dict[str, Sequence[Block]]:
    """Return the sections of what was judged."""
    newest = ranked(rows[rows["newest"]]).sort_values(["order", "size"], kind="stable", ignore_index=True)
    history = rows[rows.groupby("model")["version"].transform("nunique") > 1]
    folders = set(newest["folder"])
    kappa = _of_newest(entries, folders, lambda judged: judged.stored.kappa)
    within = _of_newest(entries, folders, lambda judged: judged.stored.kappa_inside)
    evaluations = _of_newest(entries, folders, lambda judged: judged.stored.evaluations(judged.planned))
    domains = {name: table for _, judged in _judged(entries) for name, table in judged.stored.domains.items()}
    return {
        "map": regime_maps(RegimeMap(evaluations, domains)),
        "models": [laid_out("newest", newest, id="models")],
        "regions": [region_table(within, newest)] if len(within) else [],
        "predicted": predicted_plot(within),
        "errors": errors_and_plot(kappa),
        "history": [laid_out("history", history)],
    }


def _judged(entries: Sequence[BoardEntry]) -> list[tuple[Submission, Entry]]:
    """Return the submissions that were judged, with their results."""
    return [(entry.submission, entry.judged) for entry in entries if entry.submission and entry.judged]


def _of_newest(
    entries: Sequence[BoardEntry], folders: set[str], table_of: Callable[[Entry], pd.DataFrame]
) -> pd.DataFrame:
    """Return the rows that the runs of the versions in these folders have of their own models."""
    tables = [
        (submission.name, table_of(judged)) for submission, judged in _judged(entries) if submission.folder in folders
    ]
    return pd.concat([table[table["model"] == name] for name, table in tables], ignore_index=True)


def _submissions(entries: Sequence[BoardEntry]) -> Table:
    """Return every submission with what it states, and its verdict or the reason why it has none."""
    rows = []
    for entry in entries:
        row: dict[str, Any] = {"path": entry.path, "status": "not judged", "reason": entry.reason, "folder": ""}
        if submission := entry.submission:
            row |= asdict(submission) | {"model": submission.name, "authors": ", ".join(submission.authors)}
        if entry.judged and submission:
            stored = entry.judged.stored
            row |= {"status": str(overall(_judged_verdicts(stored), stored.checks)), "folder": submission.folder}
        rows.append(row)
    return laid_out("submissions", pd.DataFrame(rows))
