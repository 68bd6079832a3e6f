"""Evaluations of an external model by `check-model`, and the findings of its checks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from comparisons.external.data_model import DataModel
from comparisons.external.process_model import ExternalModel
from comparisons.model import ComputationFailed, NotApplicable, Result
from fscm.problem import Problem

__all__ = ["FAILED", "OK", "SKIPPED", "WRONG", "AnyExternalModel", "Evaluations", "Finding", "Key"]

#: A model of the user: a class or program, or a table of data.
AnyExternalModel = ExternalModel | DataModel

#: Findings of the check of a model: the part of the contract is kept or broken, could not be computed, or was not
#: checked.
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
        return Problem(self.n, self.k, self.mu)


@dataclass(frozen=True, slots=True)
class Finding:
    """The outcome of one check.

    Attributes
    ----------
    check : str
        The rule that was checked.
    status : str
        ``"ok"``, ``"wrong"``, ``"failed"`` (a computation failed) or ``"not checked"``.
    text : str
        The reason, or the extent of the check.
    """

    check: str
    status: str
    text: str


class Evaluations:
    """Results of a model; each case is evaluated once.

    Parameters
    ----------
    model : ExternalModel or DataModel

    Attributes
    ----------
    results : dict of Key to Result
        The cases that have a value.
    refused : set of Key
        The cases for which the model is not applicable.
    failures : dict of Key to str
        Reasons of the computations that failed.
    """

    def __init__(self, model: AnyExternalModel) -> None:
        self.model = model
        self.results: dict[Key, Result] = {}
        self.refused: set[Key] = set()
        self.failures: dict[Key, str] = {}

    def get(self, key: Key) -> Result | None:
        """Return the result, or None where the model is not applicable or fails."""
        if key not in self.results.keys() | self.refused | self.failures.keys():
            try:
                self.results[key] = self.model.evaluate(key.problem(), key.quantity)
            except NotApplicable:
                self.refused.add(key)
            except ComputationFailed as failure:
                self.failures[key] = str(failure)
        return self.results.get(key)
