"""Report card of an external model: its gates, and in words its domain, its coverage, the checks and one plain verdict.

The gates are: the same results again, and digits other than the reference's.  They are judged from what the run has
recorded of the model (`comparisons.pipeline.report_cards`) and from the values of its gates, and stand in the tables of
verdicts beside these.  They are not gates of the user: a run in which they alone are judged is an ERROR.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields
from typing import Any

import pandas as pd

from comparisons.domain import Domain
from comparisons.judging.decision import Verdict, roll_up
from comparisons.judging.judge import Judged, verdict_table
from comparisons.judging.summary import coverage, coverage_text, worst_first
from comparisons.numerics.number_text import error_text
from comparisons.problem import PARAMETERS
from comparisons.registry import MODELS, create
from comparisons.runs.frames import with_problem

#: How the ids of these gates begin.
CARD = "CARD-"
#: Ids of the gates on a second evaluation of a model, and on the digits of its values beside those of the reference.
SAME_AGAIN, DIFFERS = f"{CARD}SAME-AGAIN", f"{CARD}DIFFERS"

#: References whose values are numerical solutions, with errors in their last digits that no other computation has.  A
#: closed form may have every digit of another one, and so may a solution in the algebraic limit k = 1.
_NUMERICAL = ("fscm", "fem", "atlas")

#: Columns of numbers of a table of verdicts.
_NUMBERS = [field.name for field in fields(Judged) if "float" in str(field.type)]


def without_card_gates(table: pd.DataFrame) -> pd.DataFrame:
    """Return the rows of verdicts, or of their summary, that are on gates of the user.

    Examples
    --------
    >>> without_card_gates(pd.DataFrame({"gate": ["MINE", "CARD-DIFFERS"]}))["gate"].tolist()
    ['MINE']
    """
    return table[~table["gate"].astype(str).str.startswith(CARD)]


def overall(verdicts: pd.DataFrame) -> Verdict:
    """Return the verdict over all gates: ERROR if no gate of the user was evaluated, whatever the report cards are.

    Examples
    --------
    >>> passed = pd.DataFrame({"gate": ["MINE", "CARD-DIFFERS"], "verdict": ["PASS", "PASS"]})
    >>> str(overall(passed)), str(overall(passed[1:]))
    ('PASS', 'ERROR')
    """
    of_user = roll_up(without_card_gates(verdicts)["verdict"])
    return of_user if of_user is Verdict.ERROR else roll_up(verdicts["verdict"])


def judge_cards(cards: Mapping[str, Any]) -> pd.DataFrame:
    """Return the verdicts on repeated evaluations, in the columns of `comparisons.judging.judge.judge`.

    Parameters
    ----------
    cards : mapping
        Name of a model -> what the record of the run has of it.
    """
    return verdict_table(
        row for name, card in cards.items() if "repeated" in card for row in _repeated(name, card["repeated"])
    )


def _repeated(name: str, repeated: Mapping[str, Any]) -> Iterator[Judged]:
    for case in repeated["cases"]:
        value, again, allowed = case["first"], case["again"], case["allowed"]
        error = None if again is None else again - value
        same = error is not None and abs(error) <= allowed
        facts = {key: case[key] for key in ("quantity", *PARAMETERS)} | {"problem": case.get("problem", "")}
        facts |= {"value": again, "reference_value": value, "error": error, "lower": 0.0 - allowed, "upper": allowed}
        facts |= dict.fromkeys(("u_num", "u_reference", "uncertainty"), 0.0) | {"status": "ok"}
        verdict, reason = (Verdict.PASS, "") if same else (Verdict.FAIL, repeated["cause"])
        yield verdict_on_model(SAME_AGAIN, name, verdict, reason, **facts)


def judge_digits(verdicts: pd.DataFrame, models: Iterable[str]) -> pd.DataFrame:
    """Return the verdict on each model whose values are compared with those of a reference.

    INCONCLUSIVE if most values of a gate, standing or fresh, are those of a numerical reference in every digit.

    Parameters
    ----------
    verdicts : DataFrame
        Of the gates of the user.
    models : iterable of str
        The external models.

    Examples
    --------
    >>> case = {"gate": "A", "candidate": "mine", "reference": "fscm", "k": 0.0, "reference_value": 1.5}
    >>> table = judge_digits(pd.DataFrame([case | {"value": 1.5}]), ["mine"])
    >>> table["verdict"].map(str).tolist()
    ['INCONCLUSIVE']
    """
    compared = verdicts[verdicts[["value", "reference_value"]].notna().all(axis=1)]
    compared = compared.assign(same=compared["value"] == compared["reference_value"])
    return verdict_table(_digits(name, rows) for name in models if len(rows := compared[compared["candidate"] == name]))


def _digits(name: str, compared: pd.DataFrame) -> Judged:
    verdict, reason = Verdict.PASS, ""
    for id, rows in compared.groupby("gate", sort=False):
        same = rows[rows["same"]]
        if 2 * rows["same"].sum() <= len(rows):
            continue
        stated = f"{len(same)} of {len(rows)} values are those of {rows['reference'].iloc[0]} in every digit ({id})"
        if (same["reference"].isin(_NUMERICAL) & ~(same["k"] >= 1.0)).any():
            verdict = Verdict.INCONCLUSIVE
            reason = f"{stated}: computed with it or copied from it, they show nothing of the model"
            break
        reason = reason or f"{stated}, as those of a closed form may be"
    return verdict_on_model(DIFFERS, name, verdict, reason)


def verdict_on_model(id: str, name: str, verdict: Verdict, reason: str, **facts: Any) -> Judged:
    """Return a verdict on a model as a whole, or with the facts of a case."""
    names = {"gate": id, "quantity": "", "candidate": name, "reference": name}
    return Judged(**names | facts, verdict=verdict, reason=reason)


def every_verdict(tables: Iterable[pd.DataFrame]) -> pd.DataFrame:
    """Return tables of verdicts as one; its columns of numbers have the type of numbers whatever is missing in them."""
    joined = pd.concat([table.astype(object) for table in tables], ignore_index=True)
    if "problem" in joined:
        joined["problem"] = joined["problem"].fillna("")
    return joined.assign(**{name: pd.to_numeric(joined[name]).astype(float) for name in _NUMBERS})


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
        The domain that an external model declares.
    """
    rows_of_model = verdicts[verdicts["candidate"] == name]
    undeclared = "it declares none (applies_to), and is evaluated in every case"
    of_ours = create(name).domain if name in MODELS else undeclared
    lines = [("domain", of_ours if domain is None else str(domain))]
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
    findings = [finding for finding in card["check_model"] if finding["status"] != "not checked"]
    wrong = "; ".join(f"{finding['check']}: {finding['text']}" for finding in findings if finding["status"] != "ok")
    kept = sum(finding["status"] == "ok" for finding in findings)
    checks = f"kept: {kept} of {len(findings)} checks" + (f"; not kept: {wrong}" if wrong else "")
    digits = reasons[0] or "not those of the reference"
    return [("evaluated again", again), ("digits", digits), ("check-model", checks)]


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
