"""Report card of a given model in words: its domain, its coverage, the checks of the run, and one plain verdict."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from comparisons.domain import Domain
from comparisons.judging.card_gates import DIFFERS, overall, without_card_gates
from comparisons.judging.decision import Verdict, roll_up
from comparisons.judging.summary import coverage, coverage_text, worst_first
from comparisons.numerics.number_text import error_text
from comparisons.runs.case_columns import with_problem


def card_lines(
    name: str, verdicts: pd.DataFrame, card: Mapping[str, Any] | None, domain: Domain | None
) -> list[tuple[str, str]]:
    """Return the lines of the card of a model, each with its label.

    Parameters
    ----------
    name : str
    verdicts : DataFrame
        As of `comparisons.judging.judge.judge`.
    card : mapping or None
        What the run has recorded of an external model; None for a model of this package.
    domain : Domain or None
        The domain that it declares.
    """
    rows_of_model = verdicts[verdicts["candidate"] == name]
    stated = "it declares none (applies_to), and is evaluated in every case" if domain is None else str(domain)
    lines = [("domain", stated)]
    for gate, rows in without_card_gates(rows_of_model).groupby("gate", sort=False):
        covered = coverage_text(coverage(rows["status"]))
        lines.append((str(gate), f"{roll_up(rows['verdict'])}" + (f", a value in {covered}" if covered else "")))
    return [*lines, *(_checks(card, rows_of_model) if card else ()), ("verdict", verdict_sentence(name, verdicts))]


def _checks(card: Mapping[str, Any], rows_of_model: pd.DataFrame) -> list[tuple[str, str]]:
    again = "nothing: data do not change" if card["kind"] == "data" else "it has no value"
    if repeated := card.get("repeated"):
        same = f"{len(repeated['cases'])} results are the same in a new process and in another order"
        again = repeated["cause"] or same
    reasons = [*rows_of_model.loc[rows_of_model["gate"] == DIFFERS, "reason"], "compared with no reference"]
    statuses = [finding["status"] for finding in card["check_model"]]
    wrong = [
        f"{finding['check']}: {finding['text']}"
        for finding in card["check_model"]
        if finding["status"] in ("wrong", "failed")
    ]
    checks = f"kept: {statuses.count('ok')} of {statuses.count('ok') + len(wrong)} checks"
    return [
        ("evaluated again", again),
        ("digits", reasons[0] or "not those of the reference"),
        ("check-model", "; not kept: ".join([checks, *(["; ".join(wrong)] if wrong else [])])),
    ]


def verdict_sentence(name: str, verdicts: pd.DataFrame) -> str:
    """Return the verdict on a model over all gates in one plain sentence.

    Examples
    --------
    >>> verdict_sentence("mine", pd.DataFrame({"candidate": ["mine"], "gate": ["CARD-DIFFERS"], "verdict": ["PASS"]}))
    'no gate was evaluated'
    """
    rows_of_model = verdicts[verdicts["candidate"] == name]
    if set(without_card_gates(rows_of_model)["verdict"]) <= {Verdict.NOT_APPLICABLE}:
        return "no gate was evaluated"
    verdict = overall(rows_of_model)
    is_copied = (rows_of_model["gate"] == DIFFERS) & (rows_of_model["verdict"] != Verdict.PASS)
    reasons = [_reason(rows_of_model, verdict), *rows_of_model.loc[is_copied, "reason"]]
    return f"{verdict}: {'; and '.join(dict.fromkeys(reasons))}"


def _reason(rows_of_model: pd.DataFrame, verdict: Verdict) -> str:
    """Return why a model has a verdict: the reason for a gate as a whole, if there is one, before that for a case."""
    if verdict is Verdict.PASS:
        judged = without_card_gates(rows_of_model)["error"].notna().sum()
        return f"it is within the limits in all {judged} judged cases"
    rows = worst_first(rows_of_model[rows_of_model["verdict"] == verdict])
    worst = rows.loc[(rows["n"].notna() | (with_problem(rows)["problem"] != "")).idxmin()]
    error = f"E = {error_text(worst['error'], worst['uncertainty'])}"
    return f"{worst['reason'] or error} ({worst['gate']}{f', {len(rows)} cases' if len(rows) > 1 else ''})"


def given_models(models: Sequence[str] | None, verdicts: pd.DataFrame) -> list[str]:
    """Return the models that have a card: the given ones that are judged."""
    judged = set(verdicts["candidate"])
    return [name for name in models or () if name in judged]
