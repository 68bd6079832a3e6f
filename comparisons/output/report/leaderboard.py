"""Leaderboard of models from any number of runs: one table, a row for each model and quantity of each run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from string import ascii_uppercase

import pandas as pd

from comparisons.judging.card_gates import without_card_gates
from comparisons.judging.decision import roll_up
from comparisons.numerics.number_text import percent_text
from comparisons.output.errors import error_summary
from comparisons.output.report.page import Facts, Page
from comparisons.output.report.render import render
from comparisons.output.report.stored_run import Stored
from comparisons.output.table import CASE as CASE_COLUMNS
from comparisons.output.table import Column, Table, columns, numbers, percents, words
from comparisons.runs.case_columns import keys_in, with_problem
from comparisons.runs.rows import CASE, Key

__all__ = ["Entry", "case_sets", "leaderboard_html", "standing"]

_COUNTS = (numbers(name.replace("_", " "), name, ".0f") for name in ("asked", "answered", "not_applicable", "failed"))
_COLUMNS = (
    *columns("quantity", "verdict"),
    Column("largest |κ| (%)", lambda row: _signed(row["largest"], row["u_largest"]), "size"),
    *(*columns(*CASE_COLUMNS), percents("rms κ (%)", "rms", "u")),
    Column("bound (%)", lambda row: "" if pd.isna(row["u"]) else f"{100 * row['u']:.1e}", "u"),
    *(*_COUNTS, numbers("cases with κ", "cases", ".0f"), *columns("reference"), words("version", "version")),
    *(words("date", "date"), words("fscm-bench", "package"), words("run", "run")),
)

_KEY = ["model", "quantity", *CASE]

#: Facts that two runs must share for their errors and verdicts to be comparable, in words for a message.
_FACTS = ("cases", "tier", "gates", "chosen by gates")


def _signed(kappa: float, u: float) -> str:
    return "" if pd.isna(kappa) else percent_text(kappa, u)


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
        other = next(entry for entry in entries if entry.facts == sets[1])
        different = [name for name, a, b in zip(_FACTS, *sets[:2], strict=True) if a != b]
        raise ValueError(
            f"{entries[0].name} and {other.name} were not judged in the same way (different: {', '.join(different)}), "
            "so that their errors are not comparable; --mixed puts them on one page, which states it"
        )
    letters = [ascii_uppercase[place % 26] * (place // 26 + 1) for place in range(len(sets))]
    return [letters[sets.index(entry.facts)] for entry in entries]


def standing(entry: Entry) -> pd.DataFrame:
    """Return the summary of errors of a run (`comparisons.output.errors`) with version and verdict."""
    stored = entry.stored
    kappa = with_problem(stored.kappa)[[*_KEY, "reference", "kappa", "u_kappa"]]
    results, keys = with_problem(stored.results), keys_in(stored.results)
    of_quantity = dict(kappa.groupby("quantity")["reference"].agg("first"))
    planned = entry.planned
    stated = [of_quantity.get(key[1], "") if planned is None else planned.get(key) for key in keys]
    joined = results.assign(stated=stated).dropna(subset="stated").merge(kappa, on=_KEY, how="left")
    # A model without any value has no relative error, which would name the reference.
    joined["reference"] = joined["reference"].fillna(joined["stated"])
    summary = error_summary(joined[joined["model"] != joined["reference"]])
    pairs = zip(summary["model"], summary["quantity"], strict=True)
    return summary.assign(
        version=summary["model"].map(dict(stored.results.groupby("model")["model_version"].agg("first"))),
        verdict=[_verdict(stored.verdicts, *pair) for pair in pairs],
        size=summary["largest"].abs(),
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
    rows = []
    for entry, letter in zip(entries, letters, strict=True):
        package = entry.stored.record["package"]
        commit = f" ({package['commit'][:7]})" if package["commit"] else ""
        facts = {"run": entry.name, "case_set": letter, "date": entry.stored.record["finished"][:10]}
        rows.append(standing(entry).assign(**facts, package=package["version"] + commit))
    every = pd.concat(rows, ignore_index=True)
    every = every.sort_values(["quantity", "case_set", "size"], kind="stable", ignore_index=True)
    sets = {letter: _described(entry) for entry, letter in zip(entries, letters, strict=True)}
    described = [(f"set {letter}", text) for letter, text in sorted(sets.items())] if len(sets) > 1 else []
    layout = [*columns("model"), *([words("set", "case_set")] if described else []), *_COLUMNS]
    models = every["model"].nunique()
    board = Table("leaderboard", "One row a model and quantity of each run", layout, every)
    headline = f"{models} model{'s' * (models != 1)}, {len(entries)} run{'s' * (len(entries) != 1)}"
    return render(
        Page("leaderboard", headline, [], {"sets": [Facts(described)] if described else [], "board": [board]})
    )


def _described(entry: Entry) -> str:
    cases, tier, gates, by_gates = entry.facts
    words = f"the standing cases of the tier {tier}" if tier else "cases of a user"
    words += f" (SHA-256 {cases[:12]}), " + (f"gates {gates[:12]}" if gates else "no gates")
    return words + (", computed as far as the gates need them" if by_gates == "yes" else "")
