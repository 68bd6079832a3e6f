"""Evaluations of an external model by `check-model`, and the findings of its checks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from comparisons.external.data_model import DataModel
from comparisons.external.process_model import ExternalModel
from comparisons.model import ComputationFailed, NotApplicable, Result
from comparisons.problem import Problem

__all__ = ["FAILED", "OK", "SKIPPED", "WRONG", "AnyExternalModel", "Evaluations", "Finding", "Key"]

#: A model of the user: a class or program, or a table of data.
AnyExternalModel = ExternalModel | DataModel

#: Statuses of findings: the rule is kept or broken, could not be computed, or was not checked.
OK, WRONG, FAILED, SKIPPED = "ok", "wrong", "failed", "not checked"


class Key(NamedTuple):
    """A quantity in a case.

    Examples
    --------
    >>> str(Key("pull_off_force", 2.0, 0.4, 1.0))
    'pull_off_force at n = 2, k = 0.4, mu = 1'
    """

    quantity: str
    n: float
    k: float
    mu: float

    def __str__(self) -> str:
        return f"{self.quantity} at n = {self.n:g}, k = {self.k:g}, mu = {self.mu:g}"

    def problem(self) -> Problem:
        """Return the case as a problem."""
        return Problem.dimensionless(self.n, self.k, self.mu)


@dataclass(frozen=True, slots=True)
class Finding:
    """The outcome of one check: the rule, one of the statuses above, and the reason or the extent of the check."""

    check: str
    status: str
    text: str


class Evaluations:
    """Results of a model; each case is evaluated once.

    Attributes
    ----------
    model : ExternalModel or DataModel
    results : dict of Key to Result
        The cases that have a value.
    refusals, failures : dict of Key to str
        Reasons where the model is not applicable, and of the computations that failed.
    """

    def __init__(self, model: AnyExternalModel) -> None:
        self.model = model
        self.results: dict[Key, Result] = {}
        self.refusals: dict[Key, str] = {}
        self.failures: dict[Key, str] = {}

    def get(self, key: Key) -> Result | None:
        """Return the result, or None where the model is not applicable or fails."""
        if key not in self.results | self.refusals | self.failures:
            try:
                self.results[key] = self.model.evaluate(key.problem(), key.quantity)
            except NotApplicable as refusal:
                self.refusals[key] = str(refusal)
            except ComputationFailed as failure:
                self.failures[key] = str(failure)
        return self.results.get(key)
