"""Standing of the models of a run: errors, coverage and verdict, a row for each model and quantity."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import pandas as pd

from comparisons.judging.decision import roll_up
from comparisons.output.report.stored_run import Stored
from comparisons.runs.rows import Key


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


def standing(entry: Entry) -> pd.DataFrame:
    """Return the summary of errors of a run (`comparisons.output.errors`) with the verdicts."""
    summary = entry.stored.error_summary(entry.planned)
    pairs = zip(summary["model"], summary["quantity"], strict=True)
    return summary.assign(verdict=[_verdict(entry.stored, *pair) for pair in pairs])


def _verdict(stored: Stored, model: str, quantity: str) -> str:
    """Return the worst verdict on a model about a quantity; that of its report card is on the model as a whole."""
    verdicts = stored.verdicts
    on_model = verdicts[(verdicts["candidate"] == model) & (verdicts["quantity"] == quantity)]
    of_card = [check.verdict for check in stored.checks if check.model == model]
    return "" if on_model.empty else str(roll_up([*on_model["verdict"], *of_card]))
