"""The result of one evaluation, without a value where there is none."""

from __future__ import annotations

import math
from dataclasses import dataclass

__all__ = ["CASE", "PARAMETERS", "Key", "Row", "none_if_nan"]

#: Dimensionless parameters of a case; nu is optional.
PARAMETERS = ("n", "k", "mu", "nu")

#: Columns that identify a case: its parameters, and the label of the problem of a file (empty for another case).
CASE = (*PARAMETERS, "problem")

#: What identifies an evaluation: model, quantity, and the columns of `CASE`.
Key = tuple[str, str, float | None, float | None, float | None, float | None, str]


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
