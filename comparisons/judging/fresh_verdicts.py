"""Verdicts on fresh cases beside those on the standing cases: a model that knows the standing cases by heart."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from comparisons.judging.card_gates import verdict_on_model
from comparisons.judging.decision import Verdict
from comparisons.judging.fresh_cases import RANDOM, Undrawn
from comparisons.judging.judge import verdict_table
from comparisons.runs.case_columns import with_problem

__all__ = ["WORSE", "compare_with_standing", "judge_undrawn"]

#: The errors in fresh cases may be so many times the errors in the standing cases.  Those of a formula differ little
#: between two samples of one range: measured at most 0.93 times, md-original in 150 fresh cases.
WORSE = 10.0


def judge_undrawn(undrawn: Iterable[Undrawn]) -> pd.DataFrame:
    """Return INCONCLUSIVE for each gate with standing cases that no fresh case can be drawn beside.

    Examples
    --------
    >>> table = judge_undrawn([Undrawn("A", "mine", "pull_off_force", "its domain is points")])
    >>> table[["gate", "verdict"]].astype(str).values.tolist()
    [['A-RANDOM', 'INCONCLUSIVE']]
    """
    judged = [
        verdict_on_model(
            f"{gate.gate}{RANDOM}", gate.candidate, Verdict.INCONCLUSIVE, gate.reason, quantity=gate.quantity
        )
        for gate in undrawn
    ]
    return verdict_table(judged)


def compare_with_standing(verdicts: pd.DataFrame, fresh: pd.DataFrame) -> pd.DataFrame:
    """Return a FAIL for each model and gate that is right in the standing cases and wrong in the fresh ones.

    Parameters
    ----------
    verdicts, fresh : DataFrame
        Of the standing and of the fresh cases, as of `comparisons.judging.judge.judge`.
    """
    failures = [
        verdict_on_model(str(id), str(candidate), Verdict.FAIL, reason, quantity=str(new["quantity"].iloc[0]))
        for (id, candidate), new in fresh.groupby(["gate", "candidate"], sort=False)
        if (reason := _between(_of(verdicts, str(id).removesuffix(RANDOM), candidate), new))
    ]
    return verdict_table(failures)


def _of(verdicts: pd.DataFrame, id: str, candidate: object) -> pd.DataFrame:
    return verdicts[(verdicts["gate"] == id) & (verdicts["candidate"] == candidate)]


def _between(standing: pd.DataFrame, fresh: pd.DataFrame) -> str:
    """Return how a model that is right in the standing cases is wrong in fresh ones; nothing if it is not."""
    right, new = (table[table["error"].notna()] for table in (standing, fresh))
    if right.empty or set(right["verdict"]) != {Verdict.PASS}:
        return ""
    evaluated = fresh[fresh["status"].isin(["ok", "not-applicable", "failed", "missing"])]
    shares = [(table["status"] == "ok").mean() for table in (standing[standing["status"] != "outside"], evaluated)]
    if len(evaluated) and shares[1] < 0.5 * shares[0]:
        return (
            f"it has a value in {len(right)} standing cases, and in {len(new)} of the {len(evaluated)} fresh ones: it "
            "knows the standing cases only"
        )
    if new.empty:
        return ""
    wrong = new[new["verdict"] == Verdict.FAIL]
    between = pd.Series(True, index=new.index)
    for name in ("n", "k", "mu"):
        between &= new[name].between(right[name].min(), right[name].max())
    # Those of problem files are drawn between the standing ones.
    between |= with_problem(new)["problem"].fillna("") != ""
    largest, certain = _errors(right), _errors(new[between])
    # What is certain of the error of a fresh case, against the most that the error of a standing one can be.
    much_worse = len(certain) > 0 and _is_much_worse(largest, certain)
    if wrong.empty and not much_worse:
        return ""
    where = "between them" if much_worse or between[wrong.index].any() else "elsewhere in its domain"
    beyond = f", beyond the limits in {len(wrong)}" if len(wrong) else ""
    return (
        f"right at the standing cases and wrong {where}: the error is at most {largest[:, 0].max():.2g} in "
        f"{len(right)} standing cases and {_errors(new)[:, 0].max():.2g} in {len(new)} fresh ones{beyond}"
    )


def _errors(table: pd.DataFrame) -> NDArray[np.float64]:
    """Return the sizes of the errors and their bounds, in two columns."""
    return np.abs(table[["error", "uncertainty"]].to_numpy(dtype=float))


def _is_much_worse(standing: NDArray[np.float64], fresh: NDArray[np.float64]) -> bool:
    """Whether the largest error that is certain in fresh cases is `WORSE` times what it can be in the standing ones."""
    return bool((fresh[:, 0] - fresh[:, 1]).max() > WORSE * standing.sum(axis=1).max())
