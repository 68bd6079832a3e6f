"""Evaluations of an external model by `check-model`, and the findings of its checks."""

from __future__ import annotations

from dataclasses import dataclass

from comparisons.external.data_model import DataModel
from comparisons.external.process_model import ExternalModel
from comparisons.model import ComputationFailed, NotApplicable, Result
from comparisons.problem import Problem

__all__ = ["FAILED", "OK", "SKIPPED", "WRONG", "AnyExternalModel", "Evaluations", "Finding", "Key", "label"]

#: A model of the user: a class or program, or a table of data.
AnyExternalModel = ExternalModel | DataModel

#: A quantity in a case.
Key = tuple[str, Problem]

#: Statuses of findings: the rule is kept or broken, could not be computed, or was not checked.
OK, WRONG, FAILED, SKIPPED = "ok", "wrong", "failed", "not checked"


@dataclass(frozen=True, slots=True)
class Finding:
    """The outcome of one check: the rule, one of the statuses above, and the reason or the extent of the check."""

    check: str
    status: str
    text: str


class Evaluations:
    """Outcomes of a model in cases, each of which is evaluated once: results, or why there is none."""

    def __init__(self, model: AnyExternalModel) -> None:
        self.model = model
        self.outcomes: dict[Key, Result | NotApplicable | ComputationFailed] = {}

    def get(self, key: Key) -> Result | None:
        """Return the result, or None where the model is not applicable or fails."""
        quantity, problem = key
        if key not in self.outcomes:
            try:
                self.outcomes[key] = self.model.evaluate(problem, quantity)
            except (NotApplicable, ComputationFailed) as refusal:
                self.outcomes[key] = refusal
        outcome = self.outcomes[key]
        return outcome if isinstance(outcome, Result) else None

    @property
    def results(self) -> dict[Key, Result]:
        """The cases that have a value."""
        return {key: outcome for key, outcome in self.outcomes.items() if isinstance(outcome, Result)}


def label(key: Key) -> str:
    """Return a quantity and its case for a sentence.

    Examples
    --------
    >>> label(("pull_off_force", Problem.dimensionless(2, 0.4, 1)))
    'pull_off_force at n = 2, k = 0.4, mu = 1'
    """
    quantity, problem = key
    return f"{quantity} at {problem.label}"
