"""Errors of models: beside a reference in every case, the largest of each, their summary, and agreement of references.

kappa = (model - reference) / abs(reference) (Sec. 4.3.2 of the paper for the pull-off force, which is positive), here
for any quantity.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import product
from typing import Any

import numpy as np
import pandas as pd

from comparisons.data.paper_values import paper_values
from comparisons.judging.standing import shared_ranks
from comparisons.judging.summary import COVERAGE, coverage
from comparisons.numerics.bounds import combined, relative_difference, relative_uncertainty
from comparisons.problem import PARAMETERS
from comparisons.quantities import QUANTITIES
from comparisons.runs.cases import Grid
from comparisons.runs.frames import keys_in, with_problem, without_empty_problem
from comparisons.runs.rows import CASE
from comparisons.runs.tasks import Task, problem_for

_CASE = ["quantity", *CASE]
_SERIES = ["quantity", "model", "n", "k", "reference"]
#: The reference of the errors that the paper prints.
_OF_PAPER = "fscm"
_VALUES = ("value", "u_num", "reference_value", "u_reference")
_KAPPA = ("reference", "reference_value", "u_reference", "kappa", "u_kappa")

#: Columns of `relative_error`, of `largest` and of `comparison_table`, by the names of their files.
COLUMNS = {
    "kappa": ("quantity", "model", *CASE, "value", "u_num", *_KAPPA),
    "largest_kappa": (*_SERIES, "cases", "mu", "at_end", "kappa", "u_kappa", "paper_percent", "verdict"),
    "comparison": (*_CASE, "model", "status", "value", "u_num", *_KAPPA, "reason"),
}

#: Columns of `error_summary`.
_GROUP = ["quantity", "model", "reference"]
_SUMMARY = (*_GROUP, *COVERAGE, "cases", "largest", "u_largest", "size", *CASE, "rms", "mean", "u")


def _with_kappa(table: pd.DataFrame) -> pd.DataFrame:
    value, u, reference, u_reference = (table[name].astype(float) for name in _VALUES)
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
        `COLUMNS` of kappa, sorted; `problem` where a case is of a file.

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
    return without_empty_problem(table[list(COLUMNS["kappa"])])


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
    """Return the largest abs(kappa) for each quantity, model, n, k and reference, beside the number of the paper.

    Returns
    -------
    DataFrame
        `COLUMNS` of largest_kappa: mu is where the largest is, at_end whether that is an end of the range of mu, so
        that a wider one may give more.

    Examples
    --------
    >>> case = {"quantity": "pull_off_force", "n": 2.0, "k": 0.4, "nu": None, "status": "ok", "u_num": 1e-9}
    >>> values = {("md-improved", 1.0): 1.79, ("md-improved", 2.0): 1.73, ("fscm", 1.0): 1.8, ("fscm", 2.0): 1.75}
    >>> rows = pd.DataFrame([case | {"model": m, "mu": mu, "value": value} for (m, mu), value in values.items()])
    >>> largest(relative_error(rows, "fscm"))[["mu", "at_end", "paper_percent", "verdict"]].values.tolist()
    [[2.0, True, '0.73', 'differs']]
    """
    printed = {("pull_off_force", p.model, p.n, p.k, _OF_PAPER): p for p in paper_values("largest_relative_error")}
    table = worst_rows(kappa, _SERIES)[[*_SERIES, "mu", "kappa", "u_kappa"]].sort_values(_SERIES, ignore_index=True)
    ends = kappa.groupby(_SERIES)["mu"].agg(["size", "min", "max"]).reset_index(drop=True)
    at_end = (table["mu"] == ends["min"]) | (table["mu"] == ends["max"])
    papers = [printed.get(key) for key in table[_SERIES].itertuples(index=False, name=None)]
    percents = zip(papers, 100.0 * table["kappa"].abs(), 100.0 * table["u_kappa"], strict=True)
    table = table.assign(
        cases=ends["size"],
        at_end=at_end,
        paper_percent=[paper.text if paper else "" for paper in papers],
        verdict=[paper.verdict(percent, bound) if paper else "" for paper, percent, bound in percents],
    )
    return table[list(COLUMNS["largest_kappa"])]


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
        `COLUMNS` of comparison, and behind the case the varied keys of problem files.  `value` is NaN unless `status`
        is "ok"; `kappa` is NaN too where the reference has no value, and `reason` states why.
    """
    evaluated = results[["status", "value", "u_num", "reason"]].to_dict("records")
    stored = dict(zip(keys_in(results), evaluated, strict=True))
    rows: dict[Any, dict[str, Any]] = {}
    varied: dict[str, None] = {}
    for grid in grids:
        for quantity, case, model in product(grid.quantities, grid.cases, models or grid.models):
            if model == grid.reference:
                continue
            result, reference = (
                stored[Task(name, quantity, problem_for(name, case)).key] for name in (model, grid.reference)
            )
            keys = {name: value for name, value in case.parameters.items() if name not in PARAMETERS}
            row = {"quantity": quantity, "model": model, **dict(zip(CASE, case.key, strict=True)), **keys, **result}
            varied |= dict.fromkeys(keys)
            row |= dict(zip(_KAPPA, (grid.reference, reference["value"], reference["u_num"]), strict=False))
            if result["status"] == "ok" != reference["status"]:
                row["reason"] = f"the reference {grid.reference}: {reference['status']}: {reference['reason']}"
            rows[quantity, case, model, grid.reference] = row
    of_case, others = COLUMNS["comparison"][: len(_CASE)], COLUMNS["comparison"][len(_CASE) :]
    table = pd.DataFrame(rows.values(), columns=[*of_case, *varied, *others])
    return without_empty_problem(_with_kappa(table.astype(dict.fromkeys((*PARAMETERS, *_VALUES), float))))


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
        the number of cases with a kappa; the kappa of largest size with its bound, size and case; the root mean square
        and the mean of kappa; and the largest bound u of a kappa, which bounds the error of all three: they change by
        no more than their terms do.

    Examples
    --------
    >>> row = {"quantity": "pull_off_force", "model": "jkr", "reference": "fscm", "n": 2, "k": 0, "nu": np.nan}
    >>> rows = [row | {"mu": 1, "status": "ok", "kappa": -0.03, "u_kappa": 1e-9},
    ...         row | {"mu": 2, "status": "ok", "kappa": 0.04, "u_kappa": 2e-9},
    ...         row | {"mu": 4, "status": "ok", "kappa": 0.0, "u_kappa": 1e-9},
    ...         row | {"mu": 3, "status": "failed", "kappa": np.nan, "u_kappa": np.nan}]
    >>> summary = error_summary(pd.DataFrame(rows))
    >>> summary[["asked", "answered", "failed", "largest", "mu", "rms"]].round(6).values.tolist()
    [[4.0, 3.0, 1.0, 0.04, 2.0, 0.028868]]
    """
    table = with_problem(table)
    groups = table.groupby(_GROUP, sort=False)
    rms = groups["kappa"].agg(lambda kappa: math.sqrt((kappa**2).mean()))
    mean, u = groups["kappa"].mean(), groups["u_kappa"].max()
    summary = pd.DataFrame({"cases": groups["kappa"].count(), "rms": rms, "mean": mean, "u": u})
    counts = [coverage(statuses) for _, statuses in groups["status"]]
    summary = summary.join(pd.DataFrame(counts, index=summary.index, columns=list(COVERAGE)))
    worst = worst_rows(table[table["kappa"].notna()], _GROUP).set_index(_GROUP)[["kappa", "u_kappa", *CASE]]
    summary = summary.join(worst.rename(columns={"kappa": "largest", "u_kappa": "u_largest"})).reset_index()
    summary = summary.assign(size=summary["largest"].abs(), problem=summary["problem"].fillna(""))
    return without_empty_problem(summary[list(_SUMMARY)])


def within_ranges(evaluations: pd.DataFrame) -> pd.DataFrame:
    """Return the evaluations in which those beyond the range that their model declares count as outside.

    Parameters
    ----------
    evaluations : DataFrame
        With the columns inside, status, kappa and u_kappa.

    Examples
    --------
    >>> rows = pd.DataFrame({"inside": [True, False], "status": "ok", "kappa": 0.5, "u_kappa": 0.0})
    >>> within_ranges(rows)[["status", "kappa"]].values.tolist()
    [['ok', 0.5], ['outside', nan]]
    """
    outside = ~evaluations["inside"]
    judged = evaluations.assign(status=evaluations["status"].mask(outside, "outside"))
    return judged.assign(**{name: judged[name].mask(outside) for name in ("kappa", "u_kappa")})


def ranked(summary: pd.DataFrame) -> pd.DataFrame:
    """Return a summary of errors with the rank of each largest error among those of its quantity and reference.

    Errors whose order their bounds do not decide share a rank.

    Parameters
    ----------
    summary : DataFrame
        As of `error_summary`.

    Examples
    --------
    >>> row = {"quantity": "pull_off_force", "reference": "fscm", "u_largest": 0.01}
    >>> ranked(pd.DataFrame([row | {"size": 0.3}, row | {"size": 0.1}, row | {"size": 0.11}]))["rank"].tolist()
    [3.0, 1.0, 1.0]
    """
    ranks = pd.Series(math.nan, summary.index)
    for _, group in summary.groupby(["quantity", "reference"], sort=False):
        stated = shared_ranks(group["size"].tolist(), group["u_largest"].tolist())
        ranks[group.index] = [math.nan if rank is None else float(rank) for rank in stated]
    return summary.assign(rank=ranks)
