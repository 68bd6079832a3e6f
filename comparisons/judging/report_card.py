"""Report card of a given model in words: its domain, its coverage, the checks of the run, and one plain verdict."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from comparisons.domain import Domain
from comparisons.judging.card_gates import DIFFERS, SAME_AGAIN, overall, without_card_gates
from comparisons.judging.decision import Verdict, roll_up
from comparisons.judging.fresh_cases import RANDOM
from comparisons.judging.summary import coverage, coverage_text
from comparisons.runs.case_columns import with_problem

__all__ = ["card_lines", "given_models", "verdict_sentence"]


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
    copied = list(rows_of_model.loc[is_copied, "reason"])
    if copied and verdict is Verdict.INCONCLUSIVE:
        return f"INCONCLUSIVE: {copied[0]}"
    return "; and ".join([f"{verdict}: {_reason(rows_of_model, verdict)}", *copied])


def _reason(rows_of_model: pd.DataFrame, verdict: Verdict) -> str:
    judged = without_card_gates(rows_of_model[rows_of_model["error"].notna()])
    if verdict is Verdict.PASS:
        return f"it is within the limits in all {len(judged)} judged cases"
    worst = rows_of_model[rows_of_model["verdict"] == verdict]
    if verdict is not Verdict.FAIL:
        return str(worst["reason"].iloc[0]) or f"{len(worst)} of {len(rows_of_model)} cases"
    changed = worst.loc[worst["gate"] == SAME_AGAIN, "reason"]
    if len(changed):
        return f"it gives another number when it is evaluated again: {changed.iloc[0]}"
    of_gates = worst[worst["n"].isna() & (with_problem(worst)["problem"] == "")]
    if len(of_gates):
        # On the standing cases before that on the fresh ones.
        return str(
            of_gates.sort_values("gate", key=lambda ids: ids.str.endswith(RANDOM), kind="stable")["reason"].iloc[0]
        )
    refused = worst.loc[worst["status"] == "not-applicable", "gate"]
    if len(refused):
        count = coverage(rows_of_model.loc[rows_of_model["gate"].isin(refused), "status"])["asked"]
        return f"it is not applicable in {len(refused)} of the {count} cases of the domain that it declares"
    worst = without_card_gates(worst)
    largest = worst.loc[worst["error"].astype(float).abs().idxmax()]
    return (
        f"its error is beyond the limits in {len(worst)} of {len(judged)} cases, "
        f"at worst {largest['error']:.3g} in {largest['gate']}"
    )


def given_models(models: Sequence[str] | None, verdicts: pd.DataFrame) -> list[str]:
    """Return the models that have a card: the given ones that are judged."""
    judged = set(verdicts["candidate"])
    return [name for name in models or () if name in judged]
