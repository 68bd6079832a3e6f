"""The summary of verdicts: one row a gate and candidate, worst first."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np
import pandas as pd

from comparisons.judging.decision import Verdict, roll_up
from comparisons.runs.case_columns import with_problem

__all__ = ["COVERAGE", "coverage", "coverage_text", "summarise", "worst_first"]

#: Numbers of cases in which a candidate was evaluated, has a value (or there is none), is not applicable, has failed or
#: has no row, and was not evaluated since they are outside its domain.
COVERAGE = ("asked", "answered", "not_applicable", "failed", "outside")


def coverage(statuses: Iterable[str]) -> dict[str, int]:
    """Return the numbers of `COVERAGE` for the statuses of a candidate's cases.

    Examples
    --------
    >>> coverage(["ok", "ok", "not-applicable", "missing", "outside", ""])
    {'asked': 4, 'answered': 2, 'not_applicable': 1, 'failed': 1, 'outside': 1}
    """
    counts = Counter(statuses)
    with_value, refused, failed = (
        counts["ok"] + counts["no-event"],
        counts["not-applicable"],
        counts["failed"] + counts["missing"],
    )
    return dict(
        zip(COVERAGE, (with_value + refused + failed, with_value, refused, failed, counts["outside"]), strict=True)
    )


def coverage_text(numbers: Mapping[str, Any]) -> str:
    """Return a coverage in a few words; an entry that is not there is zero.

    Examples
    --------
    >>> coverage_text({"asked": 12, "answered": 4, "not_applicable": 7, "failed": 1, "outside": 3})
    '4 of 12 (7 n/a, 1 failed, 3 outside)'
    """
    if not any(numbers.get(name) for name in COVERAGE):
        return ""
    words = {"not_applicable": "n/a", "failed": "failed", "outside": "outside"}
    remainder = ", ".join(f"{int(numbers[name])} {word}" for name, word in words.items() if numbers.get(name))
    return f"{int(numbers['answered'])} of {int(numbers['asked'])}" + (f" ({remainder})" if remainder else "")


def summarise(judged: pd.DataFrame) -> pd.DataFrame:
    """Return one row a gate and candidate, worst first: the rolled-up verdict and the worst case.

    Of cases with the same verdict the worst is the one nearest to a limit, or farthest beyond.  `cases`
    counts those evaluated, `skipped` those that did not apply.
    """
    places: dict[tuple[str, str], list[int]] = {}
    for index, names in enumerate(zip(judged["gate"], judged["candidate"], strict=True)):
        places.setdefault(names, []).append(index)
    verdicts = [Verdict(verdict) for verdict in judged["verdict"]]
    margins, statuses = _margin(judged).to_numpy(), judged["status"].to_numpy()
    is_case = (judged["mu"].notna() | (with_problem(judged)["problem"] != "")).to_numpy()
    summary: list[dict[str, Any]] = []
    worst_places = []
    for group in places.values():
        applies = [index for index in group if verdicts[index] is not Verdict.NOT_APPLICABLE]
        verdict = roll_up([verdicts[index] for index in group])
        candidates = [index for index in applies if verdicts[index] is verdict] or group
        worst_places.append(candidates[int(margins[candidates].argmax())])
        counts = {"cases": int(is_case[applies].sum()), "skipped": len(group) - len(applies)}
        summary.append({"verdict": verdict, **counts, **coverage(statuses[group])})
    summary = [
        counted | {name: value for name, value in worst.items() if name != "verdict"}
        for counted, worst in zip(summary, judged.iloc[worst_places].to_dict("records"), strict=True)
    ]
    table = pd.DataFrame(
        summary,
        columns=["verdict", *judged.columns.drop(["verdict", "reason"]), "cases", "skipped", *COVERAGE, "reason"],
    )
    order = table["verdict"].map(lambda verdict: Verdict(verdict).rank).astype(int)
    return table.iloc[order.argsort(kind="stable")].reset_index(drop=True)


def worst_first(judged: pd.DataFrame) -> pd.DataFrame:
    """Return the rows with the worst verdict first; of one verdict, the nearest to a limit or farthest beyond."""
    order = pd.DataFrame(
        {"rank": [Verdict(verdict).rank for verdict in judged["verdict"]], "nearness": -_margin(judged).to_numpy()}
    )
    return judged.iloc[order.sort_values(["rank", "nearness"], kind="stable").index].reset_index(drop=True)


def _margin(rows: pd.DataFrame) -> pd.Series:
    """How far error and uncertainty reach towards or beyond the nearer limit, in widths of the gate."""
    numbers = rows[["error", "uncertainty", "lower", "upper"]].astype(float)
    width = (numbers["upper"] - numbers["lower"]).where(lambda w: np.isfinite(w) & (w > 0.0), 1.0)
    beyond = np.maximum(numbers["error"] - numbers["upper"], numbers["lower"] - numbers["error"])
    return ((beyond + numbers["uncertainty"]) / width).fillna(np.inf)
