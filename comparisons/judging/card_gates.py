"""Gates of the report card of an external model: the same results again, and digits other than the reference's.

They are judged from what the run has recorded of the model (`comparisons.pipeline.report_cards`) and from the values
of its gates, and stand in the tables of verdicts beside these.  They are not gates of the user: a run in which they
alone are judged is an ERROR.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import fields
from typing import Any

import pandas as pd

from comparisons.judging.decision import Verdict, roll_up
from comparisons.judging.judge import Judged, verdict_table
from comparisons.problem import PARAMETERS

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
    copied = [(id, rows) for id, rows in compared.groupby("gate", sort=False) if 2 * rows["same"].sum() > len(rows)]
    for id, rows in copied:
        same = rows[rows["same"]]
        if (same["reference"].isin(_NUMERICAL) & ~(same["k"] >= 1.0)).any():
            reason = f"{_same_digits(id, rows)}: computed with it or copied from it, they show nothing of the model"
            return verdict_on_model(DIFFERS, name, Verdict.INCONCLUSIVE, reason)
    reason = f"{_same_digits(*copied[0])}, as those of a closed form may be" if copied else ""
    return verdict_on_model(DIFFERS, name, Verdict.PASS, reason)


def _same_digits(id: object, rows: pd.DataFrame) -> str:
    return f"{rows['same'].sum()} of {len(rows)} values are those of {rows['reference'].iloc[0]} in every digit ({id})"


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
