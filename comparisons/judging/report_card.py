"""Report card of an external model: its gates, and in words its domain, its coverage, the checks and one plain verdict.

Two of the checks have a verdict that counts beside those of the gates: the same results again, and digits other than
those of the reference.  They are judged from what the run has recorded of the model
(`comparisons.pipeline.report_cards`) and from the values of its gates.  A run in which they alone are judged is an
ERROR.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import pandas as pd

from comparisons.domain import Domain
from comparisons.judging.decision import Verdict, roll_up
from comparisons.judging.summary import coverage, coverage_text, worst_first
from comparisons.numerics.number_text import error_text
from comparisons.registry import MODELS, create
from comparisons.runs.frames import with_problem

#: Lines of a card with a verdict: a second evaluation of a model, and the digits of its values beside the reference's.
AGAIN, DIGITS = "evaluated again", "digits"

#: References whose values are numerical solutions, with errors in their last digits that no other computation has.  A
#: closed form may have every digit of another one, and so may a solution in the algebraic limit k = 1.
_NUMERICAL = ("fscm", "fem", "atlas")


class ModelCheck(NamedTuple):
    """The verdict of a line of a card, `AGAIN` or `DIGITS`, on a model as a whole; the reason may be that of a pass."""

    model: str
    line: str
    verdict: Verdict
    reason: str


def check_models(verdicts: pd.DataFrame, cards: Mapping[str, Any]) -> list[ModelCheck]:
    """Return the verdicts of the report cards.

    Digits are INCONCLUSIVE if most values of a gate, standing or fresh, are those of a numerical reference in every
    digit.

    Parameters
    ----------
    verdicts : DataFrame
        Of the gates, as of `comparisons.judging.judge.judge`.
    cards : mapping
        Name of an external model -> what the record of the run has of it.

    Examples
    --------
    >>> case = {"gate": "A", "candidate": "mine", "reference": "fscm", "k": 0.0, "reference_value": 1.5}
    >>> check_models(pd.DataFrame([case | {"value": 1.5}]), {"mine": {}})[0].verdict
    <Verdict.INCONCLUSIVE: 'INCONCLUSIVE'>
    """
    compared = verdicts[verdicts[["value", "reference_value"]].notna().all(axis=1)]
    compared = compared.assign(same=compared["value"] == compared["reference_value"])
    checks = []
    for name, card in cards.items():
        if "repeated" in card:
            checks.append(_again(name, card["repeated"]))
        if len(rows := compared[compared["candidate"] == name]):
            checks.append(_digits(name, rows))
    return checks


def _again(name: str, repeated: Mapping[str, Any]) -> ModelCheck:
    same = all(
        case["again"] is not None and abs(case["again"] - case["first"]) <= case["allowed"]
        for case in repeated["cases"]
    )
    return ModelCheck(name, AGAIN, Verdict.PASS if same else Verdict.FAIL, repeated["cause"])


def _digits(name: str, compared: pd.DataFrame) -> ModelCheck:
    reason = ""
    for id, rows in compared.groupby("gate", sort=False):
        same = rows[rows["same"]]
        if 2 * rows["same"].sum() <= len(rows):
            continue
        stated = f"{len(same)} of {len(rows)} values are those of {rows['reference'].iloc[0]} in every digit ({id})"
        if (same["reference"].isin(_NUMERICAL) & ~(same["k"] >= 1.0)).any():
            stated += ": computed with it or copied from it, they show nothing of the model"
            return ModelCheck(name, DIGITS, Verdict.INCONCLUSIVE, stated)
        reason = reason or f"{stated}, as those of a closed form may be"
    return ModelCheck(name, DIGITS, Verdict.PASS, reason)


def overall(verdicts: pd.DataFrame, checks: Iterable[ModelCheck]) -> Verdict:
    """Return the verdict over all gates and checks: ERROR if no gate was evaluated, whatever the report cards are.

    Examples
    --------
    >>> gates, again = pd.DataFrame({"verdict": ["PASS"]}), ModelCheck("mine", AGAIN, Verdict.FAIL, "a clock")
    >>> str(overall(gates, [])), str(overall(gates, [again])), str(overall(gates[1:], [again]))
    ('PASS', 'FAIL', 'ERROR')
    """
    return roll_up([roll_up(verdicts["verdict"]), *(check.verdict for check in checks)])


def card_lines(
    name: str,
    verdicts: pd.DataFrame,
    checks: Iterable[ModelCheck],
    card: Mapping[str, Any] | None,
    domain: Domain | None,
) -> list[tuple[str, str]]:
    """Return the lines of the card of a model, each with its label.

    Parameters
    ----------
    name : str
    verdicts : DataFrame
        As of `comparisons.judging.judge.judge`.
    checks : iterable of ModelCheck
    card : mapping or None
        What the run has recorded of an external model; None for a model of this package.
    domain : Domain or None
        The domain that an external model declares.
    """
    rows_of_model = verdicts[verdicts["candidate"] == name]
    of_model = {check.line: check for check in checks if check.model == name}
    undeclared = "it declares none (applies_to), and is evaluated in every case"
    of_ours = create(name).domain if name in MODELS else undeclared
    lines = [("domain", of_ours if domain is None else str(domain))]
    for gate, rows in rows_of_model.groupby("gate", sort=False):
        covered = coverage_text(coverage(rows["status"]))
        lines.append((str(gate), f"{roll_up(rows['verdict'])}" + (f", a value in {covered}" if covered else "")))
    sentence = verdict_sentence(rows_of_model, of_model.values())
    return [*lines, *(_found(card, of_model) if card else ()), ("verdict", sentence)]


def _found(card: Mapping[str, Any], checks: Mapping[str, ModelCheck]) -> Iterator[tuple[str, str]]:
    again = "nothing: data do not change" if card["kind"] == "data" else "it has no value"
    if repeated := card.get("repeated"):
        same = f"{len(repeated['cases'])} results are the same in a new process and in another order"
        again = repeated["cause"] or same
    yield AGAIN, again
    not_compared = "compared with no reference"
    yield DIGITS, (checks[DIGITS].reason or "not those of the reference") if DIGITS in checks else not_compared
    findings = [finding for finding in card["check_model"] if finding["status"] != "not checked"]
    wrong = "; ".join(f"{finding['check']}: {finding['text']}" for finding in findings if finding["status"] != "ok")
    kept = sum(finding["status"] == "ok" for finding in findings)
    yield "check-model", f"kept: {kept} of {len(findings)} checks" + (f"; not kept: {wrong}" if wrong else "")


def verdict_sentence(rows_of_model: pd.DataFrame, checks: Iterable[ModelCheck]) -> str:
    """Return the verdict on a model over its gates and checks in one plain sentence.

    Examples
    --------
    >>> verdict_sentence(pd.DataFrame({"verdict": []}), [ModelCheck("mine", DIGITS, Verdict.PASS, "")])
    'no gate was evaluated'
    """
    if set(rows_of_model["verdict"]) <= {Verdict.NOT_APPLICABLE}:
        return "no gate was evaluated"
    checks = list(checks)
    verdict = overall(rows_of_model, checks)
    reasons = [_reason(rows_of_model, verdict)] if (rows_of_model["verdict"] == verdict).any() else []
    reasons += [check.reason for check in checks if check.verdict is not Verdict.PASS]
    return f"{verdict}: {'; and '.join(reasons)}"


def _reason(rows_of_model: pd.DataFrame, verdict: Verdict) -> str:
    """Return why a model has a verdict: the reason for a gate as a whole, if there is one, before that for a case."""
    if verdict is Verdict.PASS:
        return f"it is within the limits in all {rows_of_model['error'].notna().sum()} judged cases"
    rows = worst_first(rows_of_model[rows_of_model["verdict"] == verdict])
    worst = rows.loc[(rows["n"].notna() | (with_problem(rows)["problem"] != "")).idxmin()]
    error = f"E = {error_text(worst['error'], worst['uncertainty'])}"
    return f"{worst['reason'] or error} ({worst['gate']}{f', {len(rows)} cases' if len(rows) > 1 else ''})"


def given_models(models: Sequence[str] | None, verdicts: pd.DataFrame, cards: Iterable[str]) -> list[str]:
    """Return the models that have a card: the given ones that are judged, or of which the run has recorded one."""
    judged = {*verdicts["candidate"], *cards}
    return [name for name in models or () if name in judged]
