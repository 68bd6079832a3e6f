"""The result of one evaluation, without a value where there is none."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = ["Key", "Row"]

#: What identifies an evaluation: model, quantity, n, k, mu and nu.
Key = tuple[str, str, float, float, float, float | None]


@dataclass(frozen=True, slots=True)
class Row:
    """The result of one evaluation: of one quantity, by one model, in one case.

    Attributes
    ----------
    model, model_version, quantity : str
        Names, as in `comparisons.registry` and `comparisons.quantities`.
    n, k, mu : float
        The problem.
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
    """

    model: str
    model_version: str
    quantity: str
    n: float
    k: float
    mu: float
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

    @property
    def key(self) -> Key:
        """What identifies the evaluation; a run makes each once."""
        return self.model, self.quantity, self.n, self.k, self.mu, self.nu
