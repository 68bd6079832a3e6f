"""The summary of verdicts: one row a gate and candidate, worst first."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import lazy_loader
import numpy as np

from comparisons.judging.decision import Verdict, roll_up
from comparisons.runs.frames import with_problem

if TYPE_CHECKING:
    import pandas as pd
else:
    pd = lazy_loader.load("pandas")

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
    with_value, failed = counts["ok"] + counts["no-event"], counts["failed"] + counts["missing"]
    evaluated = with_value + counts["not-applicable"] + failed
    return dict(
        zip(COVERAGE, (evaluated, with_value, counts["not-applicable"], failed, counts["outside"]), strict=True)
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
    names = ["gate", "candidate"]
    is_case = judged["mu"].notna() | (with_problem(judged)["problem"] != "")
    worst_cases = worst_first(judged).drop_duplicates(names).set_index(names, drop=False).to_dict("index")
    summary: list[dict[str, Any]] = []
    for gate, rows in judged.groupby(names, sort=False):
        applies = rows.index[rows["verdict"] != Verdict.NOT_APPLICABLE]
        counts = {"cases": int(is_case[applies].sum()), "skipped": len(rows) - len(applies)}
        summary.append({**worst_cases[gate], "verdict": roll_up(rows["verdict"]), **counts, **coverage(rows["status"])})
    columns = ["verdict", *judged.columns.drop(["verdict", "reason"]), "cases", "skipped", *COVERAGE, "reason"]
    table = pd.DataFrame(summary, columns=columns)
    return table.iloc[_ranks(table).argsort(kind="stable")].reset_index(drop=True)


def worst_first(judged: pd.DataFrame) -> pd.DataFrame:
    """Return the rows with the worst verdict first; of one verdict, the nearest to a limit or farthest beyond."""
    order = pd.DataFrame({"rank": _ranks(judged), "nearness": -_margin(judged)})
    return judged.loc[order.sort_values(["rank", "nearness"], kind="stable").index].reset_index(drop=True)


def _ranks(table: pd.DataFrame) -> pd.Series:
    return table["verdict"].map(lambda verdict: Verdict(verdict).rank).astype(int)


def _margin(rows: pd.DataFrame) -> pd.Series:
    """How far error and uncertainty reach towards or beyond the nearer limit, in widths of the gate."""
    numbers = rows[["error", "uncertainty", "lower", "upper"]].astype(float)
    width = (numbers["upper"] - numbers["lower"]).where(lambda w: np.isfinite(w) & (w > 0.0), 1.0)
    beyond = np.maximum(numbers["error"] - numbers["upper"], numbers["lower"] - numbers["error"])
    return ((beyond + numbers["uncertainty"]) / width).fillna(np.inf)
