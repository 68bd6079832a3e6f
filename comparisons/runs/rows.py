"""The result of one evaluation, without a value where there is none."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from comparisons.model import Effort
from comparisons.numerics.number_text import case_text, short
from comparisons.problem import PARAMETERS
from comparisons.problem.units import si_text

#: Columns that identify a problem: n, k, mu, nu and its name (empty for a dimensionless one).
CASE = (*PARAMETERS, "problem")

#: Columns of the value of the problem of a file in the units of the paper.
DIMENSIONLESS = ("dimensionless_value", "dimensionless_u_num", "dimensionless_unit")

#: What identifies an evaluation: model, quantity, and the columns of `CASE`.
Key = tuple[str, str, float | None, float | None, float | None, float | None, str]


def none_if_nan(number: float | None) -> float | None:
    """Return a number, None for NaN: two keys with NaN would not be equal."""
    return None if number is None or math.isnan(number) else float(number)


@dataclass(frozen=True, slots=True)
class Row(Effort):
    """The result of one evaluation: of one quantity, by one model, for one problem.

    Attributes
    ----------
    model, model_version, quantity : str
        Names, as in `comparisons.registry` and `comparisons.quantities`.
    problem, digest, parameters
        Name, digest and parameters of the problem, as of `comparisons.Problem`.
    value, u_num : float or None
        The result and its numerical uncertainty, in `unit`; None unless `status` is ``"ok"``.
    unit : str
        In SI for the problem of a file.
    status : str
        ``"ok"``, ``"not-applicable"`` or ``"failed"``.
    reason : str
        One sentence where there is no value, or on what the value depends on besides.
    size, iterations, residual, seconds
        As of `comparisons.model.Effort`; None where there is no value, but for the time.
    points : tuple of (list of float, list of float, float), or None
        Of a curve or a field: horizontal values, vertical values, and the bound on their distance from the
        exact curve (see `comparisons.quantities.Points`).
    dimensionless_value, dimensionless_u_num : float or None
        Of the problem of a file, in `dimensionless_unit`, where the units of the paper are defined.
    dimensionless_unit : str
    """

    model: str
    model_version: str
    quantity: str
    problem: str
    digest: str
    parameters: Mapping[str, float | str]
    unit: str
    status: str
    reason: str = ""
    value: float | None = None
    u_num: float | None = None
    points: tuple[list[float], list[float], float] | None = None
    dimensionless_value: float | None = None
    dimensionless_u_num: float | None = None
    dimensionless_unit: str = ""

    def __float__(self) -> float:
        if self.value is None:
            raise ValueError(f"{self.model} has no {self.quantity}: {self.reason}")
        return self.value

    def __format__(self, spec: str) -> str:
        return format(float(self), spec) if spec else str(self)

    def __str__(self) -> str:
        value = self.reason if self.value is None else self._value_text(self.value)
        return f"{self.model}, {self.quantity}: {value}"

    def _value_text(self, value: float) -> str:
        # In SI with a prefix; the units of the paper have none.
        if self.problem:
            return si_text(value, self.u_num or 0.0, self.unit)
        return f"{short(value, self.u_num)} {self.unit}"

    @property
    def numbers(self) -> dict[str, Any]:
        """Values of n, k, mu and nu, None where they are no parameters of the problem."""
        return {name: self.parameters.get(name) for name in PARAMETERS}

    @property
    def label(self) -> str:
        """The problem in one line for people."""
        return self.problem or case_text(self.parameters)

    @property
    def key(self) -> Key:
        """What identifies the evaluation; a run makes each once."""
        n, k, mu, nu = self.numbers.values()
        return self.model, self.quantity, n, k, mu, nu, self.problem
