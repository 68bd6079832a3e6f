"""Leaderboard of models from any number of runs: one table, a row for each model and quantity of each run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from string import ascii_uppercase
from typing import Any

import pandas as pd

from comparisons.judging.card_gates import without_card_gates
from comparisons.judging.decision import roll_up
from comparisons.output.error_summary import error_summary
from comparisons.output.report.render import filled
from comparisons.output.report.stored_run import Stored
from comparisons.output.table import CASE_LABELS, Cell, Column, chosen, kappa_cell, numbers, table_of, words
from comparisons.runs.case_columns import keys_in, with_problem
from comparisons.runs.csv_format import csv_text
from comparisons.runs.rows import CASE, Key

__all__ = ["Entry", "case_sets", "leaderboard_html", "standing"]


def _size(label: str, name: str, u: str) -> Column:
    """Return a column of relative errors with their signs, which sorts by their sizes."""

    def cell(row: Mapping[str, Any]) -> Cell:
        found = kappa_cell(row[name], row[u])
        return Cell(found.text, None if found.value is None else abs(found.value))

    return Column(label, "number", cell)


def _bound(row: Mapping[str, Any]) -> Cell:
    return Cell("") if pd.isna(row["u"]) else Cell(f"{100 * row['u']:.1e}", float(row["u"]))


_COLUMNS = (
    *(*chosen("quantity", "verdict"), _size("largest |κ| (%)", "largest", "u_largest"), *chosen(*CASE_LABELS)),
    *(_size("rms κ (%)", "rms", "u"), Column("bound (%)", "number", _bound)),
    *(numbers(name.replace("_", " "), name, ".0f") for name in ("asked", "answered", "not_applicable", "failed")),
    *(numbers("cases with κ", "cases", ".0f"), *chosen("reference"), words("version", "version")),
    *(words("date", "finished"), words("fscm-bench", "package"), words("run", "run")),
)

_KEY = ["model", "quantity", *CASE]

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
    planned : mapping of Key to str, or None
        The keys of the results that its tables of errors are about, and the reference of each; None if they are not
        known any more, since the standing cases have changed.
    """

    name: str
    stored: Stored
    planned: Mapping[Key, str] | None = None

    @property
    def facts(self) -> tuple[str, ...]:
        """What `_FACTS` names: checksums of cases and gates, the tier, and whether gates chose what was computed."""
        record, arguments = self.stored.record, self.stored.record["arguments"]
        gates = record.get("judged_again", record).get("gates_sha256", "")
        chosen = arguments["tier"] is not None and (arguments["model"] is not None or arguments["gates"] is not None)
        tier = "" if arguments["tier"] is None else str(arguments["tier"])
        return record["cases_sha256"], tier, gates, "yes" if chosen else "no"


def case_sets(entries: Sequence[Entry], mixed: bool) -> list[str]:
    """Return the letter of each run's cases and gates; all are A unless they are mixed.

    Raises
    ------
    ValueError
        If they differ and are not meant to; one sentence names two runs and what is different.
    """
    found: dict[tuple[str, ...], str] = {}
    letters = []
    for entry in entries:
        if entry.facts not in found:
            place = len(found)
            found[entry.facts] = ascii_uppercase[place % 26] * (place // 26 + 1)
        letters.append(found[entry.facts])
    if len(found) > 1 and not mixed:
        first = entries[0]
        other = next(entry for entry in entries if entry.facts != first.facts)
        different = [name for name, one, two in zip(_FACTS, first.facts, other.facts, strict=True) if one != two]
        raise ValueError(
            f"{first.name} and {other.name} were not judged in the same way (different: {', '.join(different)}), so "
            "that their errors are not comparable; --mixed puts them on one page, which states it"
        )
    return letters


def standing(entry: Entry) -> pd.DataFrame:
    """Return the summary of errors of a run (`comparisons.output.error_summary`) with version and verdict."""
    stored = entry.stored
    kappa = with_problem(stored.kappa)[[*_KEY, "reference", "kappa", "u_kappa"]]
    keys = keys_in(stored.results)
    results = with_problem(stored.results)
    if entry.planned is None:
        of_quantity = dict(kappa.groupby("quantity")["reference"].agg("first"))
        results = results.assign(stated=[of_quantity.get(key[1], "") for key in keys])
    else:
        results = results.assign(stated=[entry.planned.get(key) for key in keys])
        results = results[results["stated"].notna()]
    joined = results.merge(kappa, on=_KEY, how="left")
    # A model without any value has no relative error, which would name the reference.
    joined["reference"] = joined["reference"].fillna(joined["stated"])
    found = error_summary(joined[joined["model"] != joined["reference"]])
    versions = dict(stored.results.groupby("model")["model_version"].agg("first"))
    found["version"] = found["model"].map(versions)
    found["verdict"] = [
        _verdict(stored.verdicts, *pair) for pair in zip(found["model"], found["quantity"], strict=True)
    ]
    return found


def _verdict(verdicts: pd.DataFrame, model: str, quantity: str) -> str:
    """Return the worst verdict on a model about a quantity; one without a quantity is on the model as a whole."""
    own = verdicts[(verdicts["candidate"] == model) & verdicts["quantity"].isin([quantity, ""])]
    return "" if without_card_gates(own).empty else str(roll_up(own["verdict"]))


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
    every = pd.concat(
        [
            standing(entry).assign(
                run=entry.name,
                case_set=letter,
                finished=entry.stored.record["finished"][:10],
                package=_package(entry.stored.record),
            )
            for entry, letter in zip(entries, letters, strict=True)
        ],
        ignore_index=True,
    )
    order = every.assign(size=every["largest"].abs()).sort_values(["quantity", "case_set", "size"], kind="stable").index
    every = every.loc[order].reset_index(drop=True)
    mixed_sets = [words("set", "case_set")] if len(set(letters)) > 1 else []
    columns = (*chosen("model"), *mixed_sets, *_COLUMNS)
    table = table_of("leaderboard", "One row a model and quantity of each run", columns, every, "leaderboard.csv")
    return filled(
        "leaderboard.html",
        [table],
        {"leaderboard.csv": csv_text(every)},
        table=table,
        models=every["model"].nunique(),
        runs=len(entries),
        sets=_sets(entries, letters),
    )


def _package(record: dict[str, Any]) -> str:
    package = record["package"]
    commit = (package["commit"] or "")[:7]
    return package["version"] + (f" ({commit})" if commit else "")


def _sets(entries: Sequence[Entry], letters: Sequence[str]) -> list[tuple[str, str]]:
    """Return the letter and the description of each set of cases; nothing if there is only one."""
    described: dict[str, str] = {}
    for entry, letter in zip(entries, letters, strict=True):
        cases, tier, gates, chosen = entry.facts
        words = f"the standing cases of the tier {tier}" if tier else "cases of a user"
        words += f" (SHA-256 {cases[:12]})"
        words += f", gates {gates[:12]}" if gates else ", no gates"
        described.setdefault(letter, words + (", computed as far as the gates need them" if chosen == "yes" else ""))
    return sorted(described.items()) if len(described) > 1 else []
