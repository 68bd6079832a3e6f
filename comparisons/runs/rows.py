"""The result of one evaluation, without a value where there is none."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

__all__ = ["CASE", "PARAMETERS", "Key", "Row", "joined_label", "none_if_nan", "split_label"]

#: Dimensionless parameters of a case; nu is optional.
PARAMETERS = ("n", "k", "mu", "nu")

#: Columns that identify a case: its parameters, and the label of the problem of a file (empty for another case).
CASE = (*PARAMETERS, "problem")

#: What identifies an evaluation: model, quantity, and the columns of `CASE`.
Key = tuple[str, str, float | None, float | None, float | None, float | None, str]


#: Between the name of a problem file and the values of its keys.
_BETWEEN = "; "


def joined_label(name: str, texts: Iterable[str]) -> str:
    """Return the label of a problem: the name of its file, and the values of its keys.

    Examples
    --------
    >>> joined_label("pad.toml", ["solid.thickness=12 nm"])
    'pad.toml; solid.thickness=12 nm'
    """
    return _BETWEEN.join([name, *texts])


def split_label(label: str) -> list[str]:
    """Return the name of the file of a label, and the values of its keys.

    Examples
    --------
    >>> split_label("pad.toml; solid.thickness=12 nm")
    ['pad.toml', 'solid.thickness=12 nm']
    """
    return label.split(_BETWEEN)


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
    parameters : dict of str to float or str
        The varied keys of that file in SI, by the names of their columns.
    dimensionless_value, dimensionless_u_num : float or None
        Of the problem of a file, in `dimensionless_unit`, where the units of the paper are defined.
    dimensionless_unit : str
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
    parameters: Mapping[str, float | str] = field(default_factory=dict)
    dimensionless_value: float | None = None
    dimensionless_u_num: float | None = None
    dimensionless_unit: str = ""

    @property
    def key(self) -> Key:
        """What identifies the evaluation; a run makes each once."""
        return self.model, self.quantity, self.n, self.k, self.mu, self.nu, self.problem
