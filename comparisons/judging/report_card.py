"""Report card of a given model in words: its domain, its coverage, the checks of the run, and one plain verdict."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import pandas as pd

from comparisons.domain import Domain
from comparisons.judging.card_gates import INDEPENDENT, SAME_AGAIN
from comparisons.judging.decision import Verdict, roll_up
from comparisons.judging.fresh_cases import RANDOM
from comparisons.judging.summary import coverage, coverage_text

__all__ = ["card_lines", "given_models", "verdict_sentence"]

#: Lines of a card about the checks of external models.
_CARD_GATES = (SAME_AGAIN, INDEPENDENT)


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
    own = verdicts[verdicts["candidate"] == name]
    lines = [
        ("domain", "it declares none (applies_to), and is evaluated in every case" if domain is None else str(domain))
    ]
    for gate, rows in own.groupby("gate", sort=False):
        if gate not in _CARD_GATES:
            lines.append(
                (str(gate), f"{roll_up(rows['verdict'])}, a value in {coverage_text(coverage(rows['status']))}")
            )
    return [*lines, *(_checks(card) if card else ()), ("verdict", verdict_sentence(name, verdicts))]


def _checks(card: Mapping[str, Any]) -> list[tuple[str, str]]:
    lines = []
    if repeated := card.get("repeated"):
        count = len(repeated["cases"])
        found = repeated["cause"] or f"{count} results are the same in a new process and in another order"
        lines.append(("evaluated again", found))
    else:
        lines.append(
            ("evaluated again", "nothing: data do not change" if card["kind"] == "data" else "it has no value")
        )
    lines.append(("independence", _independence(card)))
    findings = card["check_model"]
    wrong = [
        f"{finding['check']}: {finding['text']}" for finding in findings if finding["status"] in ("wrong", "failed")
    ]
    kept = sum(finding["status"] == "ok" for finding in findings)
    words = f"kept: {kept} of {kept + len(wrong)} checks" + (f"; not kept: {'; '.join(wrong)}" if wrong else "")
    return [*lines, ("check-model", words)]


def _independence(card: Mapping[str, Any]) -> str:
    if card["kind"] == "data":
        return "not known: data do not show how they were made"
    if card["kind"] == "program":
        return "not known: nothing is seen inside a program"
    if card["uses"]:
        return f"not independent: it {' and '.join(card['uses'])}"
    started = ", but it starts other programs, in which nothing is seen" if card["starts_programs"] else ""
    return f"no use of the references was seen{started}"


def verdict_sentence(name: str, verdicts: pd.DataFrame) -> str:
    """Return the verdict on a model over all gates in one plain sentence.

    Examples
    --------
    >>> from comparisons.judging.card_gates import judge_cards
    >>> verdict_sentence("mine", judge_cards({"mine": {"uses": ["imports fscm"]}}))
    'INCONCLUSIVE: it is not independent of the reference: it imports fscm, so that agreement shows nothing'
    """
    own = verdicts[verdicts["candidate"] == name]
    if own.empty:
        return "no gate was evaluated"
    verdict = roll_up(own["verdict"])
    dependent = own[(own["gate"] == INDEPENDENT) & (own["verdict"] != Verdict.PASS)]
    uses = "" if dependent.empty else dependent["reason"].iloc[0].partition(": ")[2]
    if verdict is Verdict.INCONCLUSIVE and uses:
        return f"INCONCLUSIVE: it is not independent of the reference: {uses}, so that agreement shows nothing"
    also = f"; and it is not independent: {uses}" if uses else ""
    return f"{verdict}: {_reason(own, verdict)}{also}"


def _reason(own: pd.DataFrame, verdict: Verdict) -> str:
    if verdict is Verdict.PASS:
        judged = own[own["error"].notna() & ~own["gate"].isin(_CARD_GATES)]
        return f"it is within the limits in all {len(judged)} judged cases"
    worst = own[own["verdict"] == verdict]
    changed = worst[worst["gate"] == SAME_AGAIN]
    if len(changed) and verdict is Verdict.FAIL:
        return f"it gives another number when it is evaluated again: {changed['reason'].iloc[0]}"
    if verdict is not Verdict.FAIL:
        return str(worst["reason"].iloc[0]) or f"{len(worst)} of {len(own)} cases"
    whole = worst[worst["n"].isna()]
    standing = ~whole["gate"].str.endswith(RANDOM)
    if len(whole):
        return str((whole[standing] if standing.any() else whole)["reason"].iloc[0 if standing.any() else -1])
    refused = worst[worst["status"] == "not-applicable"]
    if len(refused):
        asked = coverage(own.loc[own["gate"].isin(refused["gate"]), "status"])["asked"]
        return f"it is not applicable in {len(refused)} of the {asked} cases of the domain that it declares"
    largest = worst.loc[worst["error"].astype(float).abs().idxmax()]
    total = int(own["error"].notna().sum())
    return (
        f"its error is beyond the limits in {len(worst)} of {total} cases, "
        f"at worst {largest['error']:.3g} in {largest['gate']}"
    )


def given_models(models: Sequence[str] | None, verdicts: pd.DataFrame) -> list[str]:
    """Return the models that have a card: the given ones that are judged."""
    judged = set(verdicts["candidate"])
    return [name for name in models or () if name in judged]
