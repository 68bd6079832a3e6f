"""Gates of the report card of an external model: the same results again, independence, fresh cases.

They are judged from what the run has recorded of the model (`comparisons.pipeline.report_cards`), and stand in the
tables of verdicts beside the gates of the run.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from comparisons.judging.decision import Verdict
from comparisons.judging.fresh_cases import RANDOM
from comparisons.judging.gates import GIVEN, Gate
from comparisons.judging.judge import Judged

__all__ = [
    "CARD",
    "INDEPENDENT",
    "SAME_AGAIN",
    "WORSE",
    "card_gates",
    "compare_with_standing",
    "every_verdict",
    "judge_cards",
]

#: How the ids of these gates begin.
CARD = "CARD-"
#: Ids of the gates on a second evaluation of a model, and on its independence of the stored references.
SAME_AGAIN, INDEPENDENT = f"{CARD}SAME-AGAIN", f"{CARD}INDEPENDENT"

#: The errors in fresh cases may be so many times the errors in the standing cases.  Those of a formula differ little
#: between two samples of one range: measured at most 0.93 times, md-original in 150 fresh cases.
WORSE = 10.0

#: Columns of numbers of a table of verdicts.
_NUMBERS = (
    *("n", "k", "mu", "nu", "value", "u_num", "reference_value", "u_reference"),
    *("error", "uncertainty", "lower", "upper"),
)

_REQUIREMENTS = {
    SAME_AGAIN: (
        "The model gives the same number again in a new process with the evaluations in another order.",
        "evaluate is a function of its arguments.  On another machine the bounds of both numbers are tolerated.",
    ),
    INDEPENDENT: (
        "The model does not compute its values with the references, and does not read theirs.",
        "A value that comes from the reference agrees with it whatever the model is.",
    ),
}


def card_gates(cards: Mapping[str, Any]) -> list[Gate]:
    """Return the gates that the report cards of a run are judged by.

    Examples
    --------
    >>> [gate.id for gate in card_gates({"mine": {"uses": []}})]
    ['CARD-INDEPENDENT']
    """
    present = [(SAME_AGAIN, "repeated"), (INDEPENDENT, "uses")]
    return [
        Gate(
            id=id,
            requirement=_REQUIREMENTS[id][0],
            quantity="pull_off_force",
            candidate=GIVEN,
            reference=GIVEN,
            cases={},
            metric="abs",
            lower=0.0,
            upper=0.0,
            max_reference_uncertainty=math.inf,
            basis="derived",
            grounds=_REQUIREMENTS[id][1],
            min_cases=1,
            tier="quick",
        )
        for id, key in present
        if any(key in card for card in cards.values())
    ]


def judge_cards(cards: Mapping[str, Any]) -> pd.DataFrame:
    """Return the verdicts on report cards, in the columns of `comparisons.judging.judge.judge`.

    Parameters
    ----------
    cards : mapping
        Name of a model -> what the record of the run has of it.

    Examples
    --------
    >>> table = judge_cards({"mine": {"uses": ["imports fscm"]}})
    >>> [*table["verdict"].map(str), *table["reason"]]
    ['INCONCLUSIVE', 'mine is not independent: it imports fscm']
    """
    judged: list[Judged] = []
    for name, card in cards.items():
        if repeated := card.get("repeated"):
            judged += _repeated(name, repeated)
        if "uses" in card:
            uses = " and ".join(card["uses"])
            verdict = Verdict.INCONCLUSIVE if uses else Verdict.PASS
            judged.append(_one(INDEPENDENT, name, verdict, f"{name} is not independent: it {uses}" if uses else ""))
    return pd.DataFrame([asdict(one) for one in judged], columns=list(Judged.__slots__))


def _repeated(name: str, repeated: Mapping[str, Any]) -> Iterator[Judged]:
    for case in repeated["cases"]:
        first, again, allowed = case["first"], case["again"], case["allowed"]
        same = again is not None and abs(again - first) <= allowed
        facts = {key: case[key] for key in ("quantity", "n", "k", "mu", "nu")} | {
            "value": again,
            "u_num": 0.0,
            "reference_value": first,
            "u_reference": 0.0,
            "error": None if again is None else again - first,
            "uncertainty": 0.0,
            "lower": 0.0 - allowed,
            "upper": allowed,
            "status": "ok",
        }
        verdict = Verdict.PASS if same else Verdict.FAIL
        yield _one(SAME_AGAIN, name, verdict, "" if same else repeated["cause"], **facts)


def compare_with_standing(verdicts: pd.DataFrame, fresh: pd.DataFrame) -> pd.DataFrame:
    """Return a FAIL for each model and gate that is right in the standing cases and wrong in the fresh ones.

    Parameters
    ----------
    verdicts, fresh : DataFrame
        Of the standing and of the fresh cases, as of `comparisons.judging.judge.judge`.
    """
    found = [
        _one(str(id), str(candidate), Verdict.FAIL, reason, quantity=str(new["quantity"].iloc[0]))
        for (id, candidate), new in fresh.groupby(["gate", "candidate"], sort=False)
        if (reason := _between(_of(verdicts, str(id).removesuffix(RANDOM), candidate), new))
    ]
    return pd.DataFrame([asdict(one) for one in found], columns=list(Judged.__slots__))


def _of(verdicts: pd.DataFrame, id: str, candidate: object) -> pd.DataFrame:
    return verdicts[(verdicts["gate"] == id) & (verdicts["candidate"] == candidate)]


def _between(standing: pd.DataFrame, fresh: pd.DataFrame) -> str:
    """Return how a model that is right in the standing cases is wrong in fresh ones; nothing if it is not."""
    known, new = (table[table["error"].notna()] for table in (standing, fresh))
    if known.empty or set(known["verdict"]) != {Verdict.PASS}:
        return ""
    asked = fresh[fresh["status"].isin(["ok", "not-applicable", "failed", "missing"])]
    shares = [(table["status"] == "ok").mean() for table in (standing[standing["status"] != "outside"], asked)]
    if len(asked) and shares[1] < 0.5 * shares[0]:
        return (
            f"it has a value in {len(known)} standing cases, and in {len(new)} of the {len(asked)} fresh ones: it "
            "knows the standing cases only"
        )
    if new.empty:
        return ""
    wrong = new[new["verdict"] == Verdict.FAIL]
    between = pd.Series(True, index=new.index)
    for name in ("n", "k", "mu"):
        between &= new[name].between(known[name].min(), known[name].max())
    largest, certain = _errors(known), _errors(new[between])
    # What is certain of the error of a fresh case, against the most that the error of a standing one can be.
    much_worse = len(certain) > 0 and _is_much_worse(largest, certain)
    if wrong.empty and not much_worse:
        return ""
    where = "between them" if much_worse or between[wrong.index].any() else "elsewhere in its domain"
    beyond = f", beyond the limits in {len(wrong)}" if len(wrong) else ""
    return (
        f"right at the standing cases and wrong {where}: the error is at most {largest[:, 0].max():.2g} in "
        f"{len(known)} standing cases and {_errors(new)[:, 0].max():.2g} in {len(new)} fresh ones{beyond}"
    )


def _errors(table: pd.DataFrame) -> NDArray[np.float64]:
    """Return the sizes of the errors and their bounds, in two columns."""
    return np.abs(table[["error", "uncertainty"]].to_numpy(dtype=float))


def _is_much_worse(standing: NDArray[np.float64], fresh: NDArray[np.float64]) -> bool:
    """Whether the largest error that is certain in fresh cases is `WORSE` times what it can be in the standing ones."""
    return bool((fresh[:, 0] - fresh[:, 1]).max() > WORSE * standing.sum(axis=1).max())


def _one(id: str, name: str, verdict: Verdict, reason: str, **facts: Any) -> Judged:
    blank: dict[str, Any] = dict.fromkeys(Judged.__slots__)
    limits = {"lower": math.nan, "upper": math.nan, "status": "", "quantity": ""}
    known = {"gate": id, "candidate": name, "reference": name, "verdict": verdict, "reason": reason}
    return Judged(**blank | limits | known | facts)


def every_verdict(tables: Iterable[pd.DataFrame]) -> pd.DataFrame:
    """Return tables of verdicts as one; its columns of numbers have the type of numbers whatever is missing in them."""
    every = list(tables)
    filled = [table.astype(object) for table in every if len(table)] or every[:1]
    joined = pd.concat(filled, ignore_index=True)
    return joined.assign(**{name: pd.to_numeric(joined[name]).astype(float) for name in _NUMBERS})
