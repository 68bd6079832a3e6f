"""The result of one evaluation, without a value where there is none."""

from __future__ import annotations

import math
from dataclasses import dataclass

import pandas as pd

__all__ = ["CASE", "PARAMETERS", "Key", "Row", "keys_in", "none_if_nan", "with_problem", "without_empty_problem"]

#: Dimensionless parameters of a case; nu is optional.
PARAMETERS = ("n", "k", "mu", "nu")

#: Columns that identify a case: its parameters, and the label of the problem of a file (empty for another case).
CASE = (*PARAMETERS, "problem")

#: What identifies an evaluation: model, quantity, and the columns of `CASE`.
Key = tuple[str, str, float | None, float | None, float | None, float | None, str]


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


def none_if_nan(number: float | None) -> float | None:
    """Return a number, None for NaN: two keys with NaN would not be equal."""
    return None if number is None or math.isnan(number) else float(number)


@dataclass(frozen=True, slots=True)
class Row:
    """The result of one evaluation: of one quantity, by one model, in one case.

    Attributes
    ----------
    model, model_version, quantity : str
        Names, as in `comparisons.registry` and `comparisons.quantities`.
    n, k, mu : float or None
        The problem; None for one of a file that has no such form.
    nu : float or None
        Poisson's ratio, if one was prescribed.
    value, u_num : float or None
        The result and its numerical uncertainty, in `unit`; None unless `status` is ``"ok"``.
    unit : str
        The scale of the dimensionless value.
    status : str
        ``"ok"``, ``"not-applicable"`` or ``"failed"``.
    reason : str
        One sentence when there is no value, or when the value depends on a reference; else empty.
    size, iterations, residual
        Of the discrete problem; None when there is no value.
    seconds : float
        Wall-clock time: what the model states, or else the duration of the call.
    problem, digest : str
        Label and SHA-256 of the problem of a file (`comparisons.runs.cases.FileProblem`), else empty.
    """

    model: str
    model_version: str
    quantity: str
    n: float | None
    k: float | None
    mu: float | None
    nu: float | None
    value: float | None
    u_num: float | None
    unit: str
    status: str
    reason: str
    size: int | None
    iterations: int | None
    residual: float | None
    seconds: float
    observed_order: float | None = None
    points: tuple[list[float], list[float], float] | None = None
    problem: str = ""
    digest: str = ""

    @property
    def key(self) -> Key:
        """What identifies the evaluation; a run makes each once."""
        return self.model, self.quantity, self.n, self.k, self.mu, self.nu, self.problem
