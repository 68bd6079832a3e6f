"""Columns of tables of cases: the key of a row, and the column of problems of files, which a table may leave out."""

from __future__ import annotations

import pandas as pd

from comparisons.runs.rows import CASE, Key, none_if_nan

__all__ = ["keys_in", "with_problem", "without_empty_problem"]


def keys_in(table: pd.DataFrame) -> list[Key]:
    """Return the key of each row of a table with the columns model, quantity and `CASE`.

    Examples
    --------
    >>> case = {"n": [2.0], "k": [0.0], "mu": [1.0], "nu": [None]}
    >>> keys_in(pd.DataFrame({"model": ["jkr"], "quantity": ["pull_off_force"], **case}))
    [('jkr', 'pull_off_force', 2.0, 0.0, 1.0, None, '')]
    """
    columns = ["model", "quantity", *CASE]
    return [
        (model, quantity, *(none_if_nan(number) for number in (n, k, mu, nu)), problem)
        for model, quantity, n, k, mu, nu, problem in with_problem(table)[columns].itertuples(index=False, name=None)
    ]


def with_problem(table: pd.DataFrame) -> pd.DataFrame:
    """Return a table of cases with the column `problem`, which it may leave out where no case is of a file.

    Examples
    --------
    >>> with_problem(pd.DataFrame({"n": [2.0]}))["problem"].tolist()
    ['']
    """
    return table if "problem" in table else table.assign(problem="")


def without_empty_problem(table: pd.DataFrame) -> pd.DataFrame:
    """Return a table without the column `problem` where no case is of a file.

    Examples
    --------
    >>> list(without_empty_problem(pd.DataFrame({"n": [2.0], "problem": [""]})))
    ['n']
    """
    empty = "problem" in table and not (table["problem"].fillna("") != "").any()
    return table.drop(columns="problem") if empty else table
