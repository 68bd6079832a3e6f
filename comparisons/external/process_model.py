"""A model from outside as a `comparisons.model.Model`: what the rest of the program sees of it."""

from __future__ import annotations

import math
import os
from typing import Any

import numpy as np

from comparisons.external.child import Child
from comparisons.external.identity import DIGEST
from comparisons.external.limits import LARGEST_COUNT, Limits
from comparisons.external.text_rules import model_name, one_line
from comparisons.model import ComputationFailed, Curve, NotApplicable, Result
from comparisons.quantities import QUANTITIES
from fscm.laws import LennardJones93
from fscm.problem import Problem
from fscm.punch import PowerPunch

__all__ = ["ExternalModel", "ExternalModelWithCurve", "connect"]


class ExternalModel:
    """A model in a child process.

    Attributes
    ----------
    name, version, citation, domain : str
        As in `comparisons.model.Model`; `version` ends in a digest of the model's files.
    hashed : str
        Which files these are, in words.
    limits : tuple of str
        Limits the model claims to be right in (see `comparisons.external.contract_checks`).
    physical : bool
        Whether it works in physical units.
    """

    def __init__(self, child: Child, opened: dict[str, Any], poisson_ratio: float | None = None) -> None:
        self._child = child
        self._poisson_ratio = poisson_ratio
        self.name = model_name(opened["name"])
        self.version = one_line(f"{one_line(opened['version'], 60)} ({opened['digest'][:DIGEST]})")
        self.hashed = one_line(opened["hashed"])
        self.citation, self.domain = one_line(opened["citation"]), one_line(opened["domain"])
        self.limits = tuple(one_line(limit, 60) for limit in opened["limits"])
        self.physical = bool(opened["physical"])

    def evaluate(self, problem: Problem, quantity: str, *, scales: int = 0) -> Result:
        """Return the quantity, or raise `NotApplicable` or `ComputationFailed`; nothing else."""
        if quantity not in QUANTITIES:
            raise ValueError(f"quantity {quantity!r} is unknown; the known ones are {', '.join(QUANTITIES)}")
        answer = self._ask("evaluate", problem, quantity=quantity, scales=scales)
        try:
            return Result(
                value=float(answer["value"]),
                u_num=float(answer["u_num"]),
                size=_count(answer["size"]),
                iterations=_count(answer["iterations"]),
                residual=float(answer["residual"]),
                seconds=_seconds(answer),
            )
        except (KeyError, TypeError, ValueError, OverflowError):
            raise ComputationFailed("its process wrote something that is not an answer") from None

    def close(self) -> None:
        """End the process; the next question starts a new one."""
        self._child.close()

    def _ask(self, what: str, problem: Problem, **more: Any) -> dict[str, Any]:
        if problem.punch != PowerPunch(problem.n) or type(problem.law) is not LennardJones93:
            raise NotApplicable("models from outside are asked for the power-law punch and the 9-3 law alone")
        answer = self._child.ask(
            ask=what,
            n=problem.n,
            k=problem.k,
            mu=problem.mu,
            poisson_ratio=self._poisson_ratio,
            **more,
        )
        if answer["status"] == "ok":
            return answer
        reason = one_line(str(answer.get("reason", ""))) or "the model did not say why"
        raise (NotApplicable if answer["status"] == "not-applicable" else ComputationFailed)(reason)


class ExternalModelWithCurve(ExternalModel):
    """A model in a child process that also knows its force-displacement curve."""

    def curve(self, problem: Problem) -> Curve:
        """Return the curve, or raise as `evaluate`."""
        answer = self._ask("curve", problem)
        try:
            columns = {str(name): np.asarray(values, float) for name, values in answer["columns"].items()}
            return Curve(columns.pop("displacement"), columns.pop("load"), columns)
        except (KeyError, TypeError, ValueError, AttributeError):
            raise ComputationFailed("its process wrote something that is not an answer") from None


def connect(door: dict[str, Any], spec: str, poisson_ratio: float | None = None) -> ExternalModel:
    """Start a child, let it load the model, and return what stands for it here.

    Raises
    ------
    ValueError
        If the model cannot be loaded or does not say properly what it is.
    """
    if os.name != "posix":
        raise ValueError("models that are code are run on Linux and macOS only; predictions as data everywhere")
    child = Child(door, Limits.of_environment())
    opened = child.ask(ask="open")
    if opened["status"] != "ok":
        child.close()
        raise ValueError(f"the model {one_line(spec, 200)} cannot be loaded: {one_line(opened['reason'])}")
    try:
        return (ExternalModelWithCurve if opened["curve"] is True else ExternalModel)(child, opened, poisson_ratio)
    except (KeyError, TypeError):
        child.close()
        raise ValueError(f"the model {one_line(spec, 200)} cannot be loaded: its process wrote nonsense") from None
    except ValueError:
        child.close()
        raise


def _count(value: Any) -> int:
    """Read a count; the worker has refused those that do not fit, but what answers may not be the worker."""
    count = int(value)
    if not 0 <= count < LARGEST_COUNT:
        raise ValueError
    return count


def _seconds(answer: dict[str, Any]) -> float:
    seconds = float(answer.get("seconds", 0.0))
    return seconds if math.isfinite(seconds) and seconds >= 0 else 0.0
