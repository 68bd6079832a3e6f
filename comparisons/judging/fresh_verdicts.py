"""Verdicts on fresh cases beside those on the standing cases: a model that knows the standing cases by heart."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import pandas as pd

from comparisons.judging.decision import Verdict
from comparisons.judging.fresh_cases import RANDOM
from comparisons.judging.judge import Judged, verdict_table

#: The errors in fresh cases may be so many times the errors in the standing cases.  Those of a formula differ little
#: between two samples of one range: measured at most 0.93 times, md-original in 150 fresh cases.
WORSE = 10.0


def judge_undrawn(undrawn: Iterable[Mapping[str, str]]) -> pd.DataFrame:
    """Return INCONCLUSIVE for each gate with standing cases that no fresh case can be drawn beside.

    Examples
    --------
    >>> gate = {"gate": "A", "candidate": "mine", "quantity": "pull_off_force", "reason": "its domain is points"}
    >>> table = judge_undrawn([gate])
    >>> table["gate"].item(), str(table["verdict"].item())
    ('A-RANDOM', 'INCONCLUSIVE')
    """
    entries = pd.DataFrame(undrawn, columns=["gate", "candidate", "quantity", "reason"])
    return verdict_table(
        _on_gate(f"{gate}{RANDOM}", candidate, quantity, Verdict.INCONCLUSIVE, reason)
        for gate, candidate, quantity, reason in entries.itertuples(index=False, name=None)
    )


def compare_with_standing(verdicts: pd.DataFrame, fresh: pd.DataFrame) -> pd.DataFrame:
    """Return a FAIL for each model and gate that is right in the standing cases and wrong in the fresh ones.

    Parameters
    ----------
    verdicts, fresh : DataFrame
        Of the standing and of the fresh cases, as of `comparisons.judging.judge.judge`.
    """
    failures = []
    for (id, candidate), rows in fresh.groupby(["gate", "candidate"], sort=False):
        is_standing = (verdicts["gate"] == id.removesuffix(RANDOM)) & (verdicts["candidate"] == candidate)
        if reason := _difference(verdicts[is_standing], rows):
            quantity = str(rows["quantity"].iloc[0])
            failures.append(_on_gate(id, candidate, quantity, Verdict.FAIL, reason))
    return verdict_table(failures)


def _on_gate(gate: str, candidate: str, quantity: str, verdict: Verdict, reason: str) -> Judged:
    return Judged(gate, quantity, candidate, candidate, verdict=verdict, reason=reason)


def _difference(standing: pd.DataFrame, fresh: pd.DataFrame) -> str:
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
    # Fresh cases of problem files are drawn between the standing ones, and have no n, k and mu.
    ranges = {name: (right[name].min(), right[name].max()) for name in ("n", "k", "mu")}
    between = pd.Series(True, index=new.index)
    for name, ends in ranges.items():
        between &= new[name].between(*ends) | new[name].isna()
    beyond, size, size_of_new = new["verdict"] == Verdict.FAIL, _size(right), _size(new)
    # What is certain of the error of a fresh case, against the most that the error of a standing one can be.
    certain, most = size_of_new - new["uncertainty"], (size + right["uncertainty"]).max()
    much_worse = (certain[between] > WORSE * most).any()
    if not beyond.any() and not much_worse:
        return ""
    where = "between them" if much_worse or between[beyond].any() else "elsewhere in its domain"
    return (
        f"right at the standing cases and wrong {where}: the error is at most {size.max():.2g} in "
        f"{len(right)} standing cases and {size_of_new.max():.2g} in {len(new)} fresh ones"
        + (f", beyond the limits in {beyond.sum()}" if beyond.any() else "")
    )


def _size(table: pd.DataFrame) -> pd.Series:
    return table["error"].astype(float).abs()
