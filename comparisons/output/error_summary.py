"""Summary of the relative errors of models: largest, root mean square, their bounds, and the coverage."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd

from comparisons.problem import PARAMETERS
from comparisons.runs.case_columns import with_problem, without_empty_problem
from comparisons.runs.rows import CASE

__all__ = ["SUMMARY_COLUMNS", "error_summary"]

#: Columns of `error_summary`.
SUMMARY_COLUMNS = (
    *("quantity", "model", "reference", "asked", "answered", "not_applicable", "failed", "cases"),
    *("largest", "u_largest", *CASE, "rms", "u"),
)


def error_summary(table: pd.DataFrame) -> pd.DataFrame:
    """Return one row for each quantity, model and reference.

    Parameters
    ----------
    table : DataFrame
        One row for each evaluation, with the columns quantity, model, reference, n, k, mu, nu, status, kappa and
        u_kappa; kappa is NaN where the model or the reference has no value.

    Returns
    -------
    DataFrame
        `SUMMARY_COLUMNS`: in how many cases the model was evaluated, has a value, is not applicable and has failed;
        the number of cases with a kappa; the kappa of largest size with its bound and its case; the root mean square
        of kappa; and the largest bound u of a kappa, which bounds the error of both: the largest, and the root mean
        square, change by no more than their terms do.

    Examples
    --------
    >>> row = {"quantity": "pull_off_force", "model": "jkr", "reference": "fscm", "n": 2, "k": 0, "nu": np.nan}
    >>> rows = [row | {"mu": 1, "status": "ok", "kappa": -0.03, "u_kappa": 1e-9},
    ...         row | {"mu": 2, "status": "ok", "kappa": 0.04, "u_kappa": 2e-9},
    ...         row | {"mu": 3, "status": "failed", "kappa": np.nan, "u_kappa": np.nan}]
    >>> found = error_summary(pd.DataFrame(rows))
    >>> found[["asked", "answered", "failed", "largest", "mu", "rms"]].round(6).values.tolist()
    [[3.0, 2.0, 1.0, 0.04, 2.0, 0.035355]]
    """
    rows = []
    table = with_problem(table)
    for key, group in table.groupby(["quantity", "model", "reference"], sort=False):
        statuses = group["status"].value_counts()
        counts = {name: int(statuses.get(name.replace("_", "-"), 0)) for name in ("not_applicable", "failed")}
        counted = {"asked": len(group), "answered": int(statuses.get("ok", 0)), **counts}
        known = group[group["kappa"].notna()]
        rows.append(dict(zip(SUMMARY_COLUMNS, key, strict=False)) | counted | {"cases": len(known)} | _errors(known))
    return without_empty_problem(pd.DataFrame(rows, columns=list(SUMMARY_COLUMNS)))


def _errors(known: pd.DataFrame) -> dict[str, Any]:
    if known.empty:
        return dict.fromkeys(("largest", "u_largest", *PARAMETERS, "rms", "u"), np.nan) | {"problem": ""}
    worst = known.iloc[int(known["kappa"].abs().to_numpy().argmax())]
    return {
        "largest": worst["kappa"],
        "u_largest": worst["u_kappa"],
        **{name: worst[name] for name in CASE},
        "rms": float(np.sqrt(np.mean(known["kappa"].to_numpy(float) ** 2))),
        "u": known["u_kappa"].max(),
    }
