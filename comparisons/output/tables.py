"""Tables of stored results: relative errors, and the largest of them beside those of the paper.

kappa = (model - reference) / abs(reference) (Sec. 4.3.2 of the paper for the pull-off force, which is positive), here
for any quantity.
"""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from comparisons.data.paper_values import paper_values
from comparisons.numerics.bounds import combined
from comparisons.numerics.kappa import relative_difference, relative_uncertainty
from comparisons.quantities import QUANTITIES
from comparisons.runs.case_columns import with_problem, without_empty_problem
from comparisons.runs.rows import CASE

__all__ = [
    "agreement",
    "largest",
    "relative_error",
    "worst_rows",
]

_CASE = ["quantity", *CASE]
_SERIES = ["quantity", "model", "n", "k"]


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
        Columns quantity, model, n, k, mu, nu, perhaps problem, value, u_num, reference (its name), reference_value,
        u_reference, kappa, u_kappa (`comparisons.numerics.kappa`), sorted.

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
    is_reference = usable["model"] == reference
    values = (
        usable[is_reference].drop(columns="model").rename(columns={"value": "reference_value", "u_num": "u_reference"})
    )
    table = usable[~is_reference].merge(values, on=_CASE, validate="many_to_one")
    table["reference"] = reference
    table["kappa"] = relative_difference(table["value"], table["reference_value"])
    table["u_kappa"] = relative_uncertainty(
        table["value"], table["u_num"], table["reference_value"], table["u_reference"]
    )
    table = table.sort_values(["quantity", "model", *CASE], ignore_index=True)
    values = ["value", "u_num", "reference", "reference_value", "u_reference", "kappa", "u_kappa"]
    return without_empty_problem(table[["quantity", "model", *CASE, *values]])


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
        Columns quantity, model, n, k, mu, nu, perhaps problem, value, u_num, reference, reference_value, u_reference,
        difference, claimed, en.  `difference` and `claimed`, the bound U of `comparisons.numerics.bounds`, are relative
        for forces and energies, otherwise in the unit of the quantity.  en = difference / claimed is within -1 and 1
        where both bounds hold.

    Examples
    --------
    >>> case = {"quantity": "pull_off_force", "n": 2.0, "k": 0.0, "mu": 1.0, "nu": None, "status": "ok"}
    >>> rows = pd.DataFrame([case | {"model": "a", "value": 4.004, "u_num": 0.008},
    ...                      case | {"model": "b", "value": 4.0, "u_num": 0.0}])
    >>> agreement(rows, "a", "b")[["difference", "claimed", "en"]].round(9).values.tolist()
    [[0.001, 0.002, 0.5]]
    """
    rows = with_problem(rows)
    # Poisson's ratio makes no difference to one of the two, which then has none.
    of_reference = rows[rows["model"] == reference].drop(columns="nu")
    cases = rows.loc[rows["model"] == model, [*_CASE]].merge(of_reference, on=[name for name in _CASE if name != "nu"])
    table = relative_error(pd.concat([rows[rows["model"] == model], cases]), reference)
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
        Columns quantity, model, n, k, cases, mu (where the largest is), at_end (whether that is an end of
        the range of mu, so that a wider one may give more), kappa, u_kappa, paper_percent, verdict.

    Examples
    --------
    >>> case = {"quantity": "pull_off_force", "n": 2.0, "k": 0.4, "nu": None, "status": "ok", "u_num": 1e-9}
    >>> values = {("md-improved", 1.0): 1.79, ("md-improved", 2.0): 1.73, ("fscm", 1.0): 1.8, ("fscm", 2.0): 1.75}
    >>> rows = pd.DataFrame([case | {"model": m, "mu": mu, "value": value} for (m, mu), value in values.items()])
    >>> largest(relative_error(rows, "fscm"))[["mu", "at_end", "paper_percent", "verdict"]].values.tolist()
    [[2.0, True, '0.73', 'differs']]
    """
    known = {("pull_off_force", p.model, p.n, p.k): p for p in paper_values("largest_relative_error")}
    table = worst_rows(kappa, _SERIES)[[*_SERIES, "mu", "kappa", "u_kappa"]].sort_values(_SERIES, ignore_index=True)
    ends = kappa.groupby(_SERIES)["mu"].agg(["size", "min", "max"]).reset_index(drop=True)
    table.insert(4, "cases", ends["size"])
    table.insert(6, "at_end", (table["mu"] == ends["min"]) | (table["mu"] == ends["max"]))
    papers = [known.get(key) for key in table[_SERIES].itertuples(index=False, name=None)]
    table["paper_percent"] = [paper.text if paper else "" for paper in papers]
    table["verdict"] = [
        paper.verdict(100.0 * abs(value), 100.0 * bound) if paper else ""
        for paper, value, bound in zip(papers, table["kappa"], table["u_kappa"], strict=True)
    ]
    return table


def worst_rows(kappa: pd.DataFrame, by: Sequence[str]) -> pd.DataFrame:
    """Return the row of the largest abs(kappa) for each combination of the columns `by`, sorted by these.

    Examples
    --------
    >>> worst_rows(pd.DataFrame({"model": ["a", "a", "b"], "kappa": [0.1, -0.2, 0.3]}), ["model"]).values.tolist()
    [['a', -0.2], ['b', 0.3]]
    """
    return kappa.loc[kappa["kappa"].abs().groupby([kappa[name] for name in by]).idxmax()]
