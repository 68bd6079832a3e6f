"""Errors of models: beside a reference in every case, the largest of each, their summary, and agreement of references.

kappa = (model - reference) / abs(reference) (Sec. 4.3.2 of the paper for the pull-off force, which is positive), here
for any quantity.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
import pandas as pd

from comparisons.data.paper_values import paper_values
from comparisons.numerics.bounds import combined
from comparisons.numerics.kappa import relative_difference, relative_uncertainty
from comparisons.quantities import QUANTITIES
from comparisons.runs.case_columns import keys_in, with_problem, without_empty_problem
from comparisons.runs.cases import Grid
from comparisons.runs.rows import CASE
from comparisons.runs.tasks import Task, problem_for

__all__ = [
    "COMPARED",
    "KAPPA_COLUMNS",
    "LARGEST_COLUMNS",
    "agreement",
    "comparison_table",
    "error_summary",
    "largest",
    "relative_error",
    "worst_rows",
]

_CASE = ["quantity", *CASE]
_SERIES = ["quantity", "model", "n", "k"]
_REFERENCE = ("reference", "reference_value", "u_reference")

#: Columns of `relative_error`.
KAPPA_COLUMNS = ("quantity", "model", *CASE, "value", "u_num", *_REFERENCE, "kappa", "u_kappa")

#: Columns of `largest`.
LARGEST_COLUMNS = (*_SERIES, "cases", "mu", "at_end", "kappa", "u_kappa", "paper_percent", "verdict")

#: Columns of `comparison_table`.
COMPARED = (*_CASE, "model", "status", "value", "u_num", *_REFERENCE, "kappa", "u_kappa", "reason")

#: Columns of `error_summary`.
_SUMMARY = (
    *("quantity", "model", "reference", "asked", "answered", "not_applicable", "failed", "cases"),
    *("largest", "u_largest", *CASE, "rms", "u"),
)


def _with_kappa(table: pd.DataFrame) -> pd.DataFrame:
    numbers = table[["value", "u_num", "reference_value", "u_reference"]].astype(float)
    value, u, reference, u_reference = (numbers[name] for name in numbers)
    with np.errstate(divide="ignore", invalid="ignore"):
        kappa = relative_difference(value, reference)
        return table.assign(kappa=kappa, u_kappa=relative_uncertainty(value, u, reference, u_reference))


def relative_error(rows: pd.DataFrame, reference: str) -> pd.DataFrame:
    """Return kappa of every candidate in every case where it and the reference have a value.

    Parameters
    ----------
    rows : DataFrame
        Stored results (`comparisons.runs.frames.COLUMNS`).
    reference : str
        Name of the model the others are compared with.

    Returns
    -------
    DataFrame
        `KAPPA_COLUMNS`, sorted; `problem` where a case is of a file.

    Examples
    --------
    >>> case = {"quantity": "pull_off_force", "n": 2.0, "k": 0.0, "mu": 1.0, "nu": None, "status": "ok"}
    >>> rows = pd.DataFrame([case | {"model": "a", "value": 1.1, "u_num": 0.0},
    ...                      case | {"model": "b", "value": 1.0, "u_num": 0.01}])
    >>> relative_error(rows, "b")[["model", "kappa", "u_kappa"]].round(3).values.tolist()
    [['a', 0.1, 0.011]]
    """
    rows = with_problem(rows)
    usable = rows.loc[rows["status"] == "ok", [*_CASE, "model", "value", "u_num"]]
    of_reference = usable["model"] == reference
    names = {"model": "reference", "value": "reference_value", "u_num": "u_reference"}
    table = usable[~of_reference].merge(usable[of_reference].rename(columns=names), on=_CASE, validate="many_to_one")
    table = _with_kappa(table).sort_values(["quantity", "model", *CASE], ignore_index=True)
    return without_empty_problem(table[list(KAPPA_COLUMNS)])


def agreement(rows: pd.DataFrame, model: str, reference: str) -> pd.DataFrame:
    """Return the differences of a model from a reference, with their combined uncertainty.

    Parameters
    ----------
    rows : DataFrame
        Stored results (`comparisons.runs.frames.COLUMNS`).
    model, reference : str
        Names of the two.

    Returns
    -------
    DataFrame
        Columns of `relative_error` without kappa, and difference, claimed, en.  `difference` and `claimed`, the bound U
        of `comparisons.numerics.bounds`, are relative for forces and energies, otherwise in the unit of the quantity.
        en = difference / claimed is within -1 and 1 where both bounds hold.

    Examples
    --------
    >>> case = {"quantity": "pull_off_force", "n": 2.0, "k": 0.0, "mu": 1.0, "nu": None, "status": "ok"}
    >>> rows = pd.DataFrame([case | {"model": "a", "value": 4.004, "u_num": 0.008},
    ...                      case | {"model": "b", "value": 4.0, "u_num": 0.0}])
    >>> agreement(rows, "a", "b")[["difference", "claimed", "en"]].round(9).values.tolist()
    [[0.001, 0.002, 0.5]]
    """
    rows = with_problem(rows)
    of_model = rows[rows["model"] == model]
    # Poisson's ratio makes no difference to one of the two, which then has none.
    of_reference = rows[rows["model"] == reference].drop(columns="nu")
    cases = of_model[_CASE].merge(of_reference, on=[name for name in _CASE if name != "nu"])
    table = relative_error(pd.concat([of_model, cases]), reference)
    relative = table["quantity"].map(lambda name: QUANTITIES[name].relative)
    scale = table["reference_value"].abs().where(relative, 1.0)
    table["difference"] = (table["value"] - table["reference_value"]) / scale
    table["claimed"] = combined(table["u_num"], table["u_reference"]) / scale
    table["en"] = table["difference"] / table["claimed"]
    return table.drop(columns=["kappa", "u_kappa"])


def largest(kappa: pd.DataFrame) -> pd.DataFrame:
    """Return the largest abs(kappa) for each quantity, model, n and k, beside the number of the paper.

    Returns
    -------
    DataFrame
        `LARGEST_COLUMNS`: mu is where the largest is, at_end whether that is an end of the range of mu, so that a
        wider one may give more.

    Examples
    --------
    >>> case = {"quantity": "pull_off_force", "n": 2.0, "k": 0.4, "nu": None, "status": "ok", "u_num": 1e-9}
    >>> values = {("md-improved", 1.0): 1.79, ("md-improved", 2.0): 1.73, ("fscm", 1.0): 1.8, ("fscm", 2.0): 1.75}
    >>> rows = pd.DataFrame([case | {"model": m, "mu": mu, "value": value} for (m, mu), value in values.items()])
    >>> largest(relative_error(rows, "fscm"))[["mu", "at_end", "paper_percent", "verdict"]].values.tolist()
    [[2.0, True, '0.73', 'differs']]
    """
    printed = {("pull_off_force", p.model, p.n, p.k): p for p in paper_values("largest_relative_error")}
    table = worst_rows(kappa, _SERIES)[[*_SERIES, "mu", "kappa", "u_kappa"]].sort_values(_SERIES, ignore_index=True)
    ends = kappa.groupby(_SERIES)["mu"].agg(["size", "min", "max"]).reset_index(drop=True)
    at_end = (table["mu"] == ends["min"]) | (table["mu"] == ends["max"])
    table = table.assign(cases=ends["size"], at_end=at_end)
    papers = [printed.get(key) for key in table[_SERIES].itertuples(index=False, name=None)]
    table["paper_percent"] = [paper.text if paper else "" for paper in papers]
    table["verdict"] = [
        paper.verdict(100.0 * abs(value), 100.0 * bound) if paper else ""
        for paper, value, bound in zip(papers, table["kappa"], table["u_kappa"], strict=True)
    ]
    return table[list(LARGEST_COLUMNS)]


def worst_rows(kappa: pd.DataFrame, by: Sequence[str]) -> pd.DataFrame:
    """Return the row of the largest abs(kappa) for each combination of the columns `by`, sorted by these.

    Examples
    --------
    >>> worst_rows(pd.DataFrame({"model": ["a", "a", "b"], "kappa": [0.1, -0.2, 0.3]}), ["model"]).values.tolist()
    [['a', -0.2], ['b', 0.3]]
    """
    return kappa.loc[kappa["kappa"].abs().groupby([kappa[name] for name in by]).idxmax()]


def comparison_table(results: pd.DataFrame, grids: Iterable[Grid], models: Sequence[str] | None) -> pd.DataFrame:
    """Return one row for each quantity, case and model, beside the reference of the grid.

    Parameters
    ----------
    results : DataFrame
        Stored results (`comparisons.runs.frames.COLUMNS`).
    grids : iterable of Grid
    models : sequence of str or None
        Models in place of those each grid names.

    Returns
    -------
    DataFrame
        `COMPARED`.  `value` is NaN unless `status` is "ok"; `kappa` is NaN too where the reference has no value, and
        `reason` states why.
    """
    stored = dict(zip(keys_in(results), results[["status", "value", "u_num", "reason"]].to_numpy(), strict=True))

    def row(grid: Grid, model: str, quantity: str, case: Any) -> dict[str, Any]:
        status, value, u, reason = stored[Task(model, quantity, problem_for(model, case)).key]
        own, reference, u_reference, why = stored[Task(grid.reference, quantity, problem_for(grid.reference, case)).key]
        if status == "ok" and own != "ok":
            reason = f"the reference {grid.reference}: {own}: {why}"
        parameters = dict(zip(CASE, case.key, strict=True))
        table = {"quantity": quantity, "model": model, "status": status, "value": value, "u_num": u, "reason": reason}
        return table | parameters | dict(zip(_REFERENCE, (grid.reference, reference, u_reference), strict=True))

    rows = {
        (quantity, case, model, grid.reference): row(grid, model, quantity, case)
        for grid in grids
        for quantity in grid.quantities
        for case in grid.cases
        for model in models or grid.models
        if model != grid.reference
    }
    table = _with_kappa(pd.DataFrame(rows.values(), columns=[name for name in COMPARED if not name.endswith("kappa")]))
    numbers = ("n", "k", "mu", "nu", "value", "u_num", "reference_value", "u_reference")
    return without_empty_problem(table.astype(dict.fromkeys(numbers, float))[list(COMPARED)])


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
        In how many cases the model was evaluated (asked), has a value (answered), is not applicable and has failed;
        the number of cases with a kappa; the kappa of largest size with its bound and its case; the root mean square
        of kappa; and the largest bound u of a kappa, which bounds the error of both: the largest, and the root mean
        square, change by no more than their terms do.

    Examples
    --------
    >>> row = {"quantity": "pull_off_force", "model": "jkr", "reference": "fscm", "n": 2, "k": 0, "nu": np.nan}
    >>> rows = [row | {"mu": 1, "status": "ok", "kappa": -0.03, "u_kappa": 1e-9},
    ...         row | {"mu": 2, "status": "ok", "kappa": 0.04, "u_kappa": 2e-9},
    ...         row | {"mu": 3, "status": "failed", "kappa": np.nan, "u_kappa": np.nan}]
    >>> summary = error_summary(pd.DataFrame(rows))
    >>> summary[["asked", "answered", "failed", "largest", "mu", "rms"]].round(6).values.tolist()
    [[3.0, 2.0, 1.0, 0.04, 2.0, 0.035355]]
    """
    groups = with_problem(table).groupby(["quantity", "model", "reference"], sort=False)
    rows = [dict(zip(("quantity", "model", "reference"), key, strict=True)) | _summed(rows) for key, rows in groups]
    return without_empty_problem(pd.DataFrame(rows, columns=list(_SUMMARY)))


def _summed(rows: pd.DataFrame) -> dict[str, Any]:
    counts = {name: int((rows["status"] == name.replace("_", "-")).sum()) for name in ("not_applicable", "failed")}
    errors = rows[rows["kappa"].notna()]
    summed = {"asked": len(rows), "answered": int((rows["status"] == "ok").sum()), **counts, "cases": len(errors)}
    if errors.empty:
        return summed | {"problem": ""}
    worst = errors.iloc[int(errors["kappa"].abs().to_numpy().argmax())]
    sizes = {"largest": worst["kappa"], "u_largest": worst["u_kappa"], **{name: worst[name] for name in CASE}}
    rms = float(np.sqrt(np.mean(errors["kappa"].to_numpy(float) ** 2)))
    return summed | sizes | {"rms": rms, "u": errors["u_kappa"].max()}
