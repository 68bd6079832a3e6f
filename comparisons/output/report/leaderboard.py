"""Leaderboard of models from any number of runs: one table, a row for each model and quantity of each run."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from string import ascii_uppercase

import pandas as pd

from comparisons.judging.decision import roll_up
from comparisons.judging.report_card import without_card_gates
from comparisons.output.report.page import Page
from comparisons.output.report.render import render
from comparisons.output.report.stored_run import Stored
from comparisons.output.table import Column, laid_out
from comparisons.runs.rows import Key

#: Facts that two runs must share for their errors and verdicts to be comparable, in words for a message.
_FACTS = ("cases", "tier", "gates", "chosen by gates")


@dataclass(frozen=True, slots=True)
class Entry:
    """A run on the leaderboard.

    Attributes
    ----------
    name : str
        The folder as the user named it.
    stored : Stored
    planned : set of (Key, str), or None
        The keys of the results that its tables of errors are about, with a reference of each; None if they are not
        known any more, since the standing cases have changed.
    """

    name: str
    stored: Stored
    planned: Collection[tuple[Key, str]] | None = None

    @property
    def facts(self) -> tuple[str, ...]:
        """What `_FACTS` names: checksums of cases and gates, the tier, and whether gates chose what was computed."""
        record, arguments = self.stored.record, self.stored.record["arguments"]
        gates = record.get("judged_again", record).get("gates_sha256", "")
        by_gates = arguments["tier"] is not None and (arguments["model"] is not None or arguments["gates"] is not None)
        return record["cases_sha256"], str(arguments["tier"] or ""), gates, "yes" if by_gates else "no"


def case_sets(entries: Sequence[Entry], mixed: bool) -> list[str]:
    """Return the letter of each run's cases and gates; all are A unless they are mixed.

    Raises
    ------
    ValueError
        If they differ and are not meant to; one sentence names two runs and what is different.
    """
    sets = list(dict.fromkeys(entry.facts for entry in entries))
    if len(sets) > 1 and not mixed:
        name = next(entry.name for entry in entries if entry.facts == sets[1])
        different = [fact for fact, a, b in zip(_FACTS, *sets[:2], strict=True) if a != b]
        raise ValueError(
            f"{entries[0].name} and {name} were not judged in the same way (different: {', '.join(different)}), "
            "so that their errors are not comparable; --mixed puts them on one page, which states it"
        )
    letters = [ascii_uppercase[index % 26] * (index // 26 + 1) for index in range(len(sets))]
    return [letters[sets.index(entry.facts)] for entry in entries]


def standing(entry: Entry) -> pd.DataFrame:
    """Return the summary of errors of a run (`comparisons.output.errors`) with versions, verdicts and origin."""
    stored, package = entry.stored, entry.stored.record["package"]
    summary = stored.error_summary(entry.planned)
    commit = f" ({package['commit'][:7]})" if package["commit"] else ""
    pairs = zip(summary["model"], summary["quantity"], strict=True)
    return summary.assign(
        version=summary["model"].map(dict(stored.results.groupby("model")["model_version"].agg("first"))),
        verdict=[_verdict(stored.verdicts, *pair) for pair in pairs],
        run=entry.name,
        date=stored.record["finished"][:10],
        package=package["version"] + commit,
    )


def _verdict(verdicts: pd.DataFrame, model: str, quantity: str) -> str:
    """Return the worst verdict on a model about a quantity; one without a quantity is on the model as a whole."""
    on_model = verdicts[(verdicts["candidate"] == model) & verdicts["quantity"].isin([quantity, ""])]
    return "" if without_card_gates(on_model).empty else str(roll_up(on_model["verdict"]))


def leaderboard_html(entries: Sequence[Entry], mixed: bool = False) -> str:
    """Return the page.

    Parameters
    ----------
    entries : sequence of Entry
    mixed : bool
        Whether runs of different cases or gates may stand on one page, which then states it.

    Raises
    ------
    ValueError
        If they may not, and are different.
    """
    letters = case_sets(entries, mixed)
    rows = [standing(entry).assign(case_set=letter) for entry, letter in zip(entries, letters, strict=True)]
    board_rows = pd.concat(rows, ignore_index=True)
    board_rows = board_rows.sort_values(["quantity", "case_set", "size"], kind="stable", ignore_index=True)
    facts = {letter: entry.facts for entry, letter in zip(entries, letters, strict=True)}
    sets = pd.DataFrame([[letter, *facts[letter]] for letter in sorted(facts)], columns=["set", *_FACTS])
    several = len(sets) > 1
    case_set = Column("set", lambda row: row["case_set"] if several else "")
    bound = Column("bound (%)", lambda row: "" if pd.isna(row["u"]) else f"{100 * row['u']:.1e}", "u")
    blocks = {
        "sets": [laid_out("sets", sets if several else sets.head(0))],
        "board": [laid_out("leaderboard", board_rows, case_set, bound)],
    }
    headline = f"Models: {board_rows['model'].nunique()}, runs: {len(entries)}"
    return render(Page("leaderboard", headline, blocks))
