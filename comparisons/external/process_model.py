"""An external model in a child process, as a `comparisons.model.Model`."""

from __future__ import annotations

import math
import os
from typing import Any

import numpy as np

from comparisons.domain import Domain
from comparisons.external.child import Child
from comparisons.external.identity import DIGEST
from comparisons.external.limits import LARGEST_COUNT, Limits
from comparisons.external.text_rules import model_name, one_line
from comparisons.model import ComputationFailed, Curve, NotApplicable, Result
from comparisons.quantities import QUANTITIES
from fscm.laws import LennardJones
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
        Limits in which the model is exact, as its author states (see `comparisons.external.contract_checks`).
    physical : bool
        Whether it works in physical units.
    applies_to : Domain or None
        The domain that it declares.
    is_program : bool
        Whether it is a program, and no class of Python.
    """

    def __init__(self, child: Child, loaded: dict[str, Any], poisson_ratio: float | None = None) -> None:
        self._child = child
        self._poisson_ratio = poisson_ratio
        self.name = model_name(loaded["name"])
        self.version = one_line(f"{one_line(loaded['version'], 60)} ({loaded['digest'][:DIGEST]})")
        self.hashed = one_line(loaded["hashed"])
        self.citation, self.domain = one_line(loaded["citation"]), one_line(loaded["domain"])
        self.limits = tuple(one_line(limit, 60) for limit in loaded["limits"])
        self.physical = bool(loaded["physical"])
        self.applies_to = None if loaded.get("applies_to") is None else Domain.of(loaded["applies_to"])
        self.is_program = child.is_program

    def evaluate(self, problem: Problem, quantity: str, *, scales: int = 0) -> Result:
        """Return the quantity, or raise `NotApplicable` or `ComputationFailed`; nothing else."""
        if quantity not in QUANTITIES:
            raise ValueError(f"quantity {quantity!r} is unknown; the known ones are {', '.join(QUANTITIES)}")
        reply = self._request("evaluate", problem, quantity=quantity, scales=scales)
        try:
            return Result(
                value=float(reply["value"]),
                u_num=float(reply["u_num"]),
                size=_count(reply["size"]),
                iterations=_count(reply["iterations"]),
                residual=float(reply["residual"]),
                seconds=_seconds(reply),
            )
        except (KeyError, TypeError, ValueError, OverflowError):
            raise ComputationFailed("its process wrote something that is not a result") from None

    def close(self) -> None:
        """End the process; the next request starts a new one."""
        self._child.close()

    def _request(self, request: str, problem: Problem, **more: Any) -> dict[str, Any]:
        if problem.punch != PowerPunch(problem.n) or problem.law != LennardJones():
            raise NotApplicable("external models are evaluated for the power-law punch and the 9-3 law alone")
        reply = self._child.request(
            request,
            n=problem.n,
            k=problem.k,
            mu=problem.mu,
            poisson_ratio=self._poisson_ratio,
            **more,
        )
        if reply["status"] == "ok":
            return reply
        reason = one_line(str(reply.get("reason", ""))) or "the model gave no reason"
        raise (NotApplicable if reply["status"] == "not-applicable" else ComputationFailed)(reason)


class ExternalModelWithCurve(ExternalModel):
    """A model in a child process that has a force-displacement curve as well."""

    def curve(self, problem: Problem) -> Curve:
        """Return the curve, or raise as `evaluate`."""
        reply = self._request("curve", problem)
        try:
            columns = {str(name): np.asarray(values, float) for name, values in reply["columns"].items()}
            return Curve(columns.pop("displacement"), columns.pop("load"), columns)
        except (KeyError, TypeError, ValueError, AttributeError):
            raise ComputationFailed("its process wrote something that is not a result") from None


def connect(source: dict[str, Any], spec: str, poisson_ratio: float | None = None) -> ExternalModel:
    """Start a child that loads the model, and return the model.

    Raises
    ------
    ValueError
        If the model cannot be loaded, or its name or texts are not admissible.
    """
    if os.name != "posix":
        raise ValueError("models that are code are run on Linux and macOS only; predictions as data everywhere")
    child = Child(source, Limits.of_environment())
    loaded = child.request("load")
    if loaded["status"] != "ok":
        child.close()
        raise ValueError(f"the model {one_line(spec, 200)} cannot be loaded: {one_line(loaded['reason'])}")
    try:
        return (ExternalModelWithCurve if loaded["curve"] is True else ExternalModel)(child, loaded, poisson_ratio)
    except (KeyError, TypeError):
        child.close()
        raise ValueError(
            f"the model {one_line(spec, 200)} cannot be loaded: its process did not describe a model"
        ) from None
    except ValueError:
        child.close()
        raise


def _count(value: Any) -> int:
    """Return a count; the worker has checked it, but a model can write to the pipe in place of the worker."""
    count = int(value)
    if not 0 <= count < LARGEST_COUNT:
        raise ValueError
    return count


def _seconds(reply: dict[str, Any]) -> float:
    seconds = float(reply.get("seconds", 0.0))
    return seconds if math.isfinite(seconds) and seconds >= 0 else 0.0
