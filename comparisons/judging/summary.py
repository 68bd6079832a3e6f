"""The summary of verdicts: one row a gate and candidate, worst first."""

from __future__ import annotations

import numpy as np
import pandas as pd

from comparisons.judging.decision import Verdict, roll_up

__all__ = ["summarise", "worst_first"]


def summarise(judged: pd.DataFrame) -> pd.DataFrame:
    """Return one row a gate and candidate, worst first: the rolled-up verdict and the worst case.

    Of cases with the same verdict the worst is the one nearest to a limit, or farthest beyond.  `cases`
    counts those evaluated, `skipped` those that did not apply.
    """
    summary = []
    for _, group in judged.groupby(["gate", "candidate"], sort=False):
        applies = group["verdict"] != Verdict.NOT_APPLICABLE
        verdict = roll_up(group["verdict"])
        candidates = group.loc[group["verdict"] == verdict] if applies.any() else group
        worst = candidates.iloc[int(_margin(candidates).argmax())]
        summary.append(
            {
                "verdict": verdict,
                **worst.drop(["verdict", "reason"]).to_dict(),
                "cases": int((applies & group["mu"].notna()).sum()),
                "skipped": int((~applies).sum()),
                "reason": worst["reason"],
            }
        )
    table = pd.DataFrame(
        summary,
        columns=["verdict", *judged.columns.drop(["verdict", "reason"]), "cases", "skipped", "reason"],
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
