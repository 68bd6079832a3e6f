"""An external model in a process of its own, as a `comparisons.model.Model`."""

from __future__ import annotations

import os
import time
from dataclasses import replace
from typing import Any

from comparisons.external.child import Child
from comparisons.external.replies import curve_of, result_of
from comparisons.external.text_rules import one_line
from comparisons.model import ComputationFailed, Curve, NotApplicable, Result
from comparisons.quantities import QUANTITIES
from fscm.laws import LennardJones
from fscm.problem import Problem
from fscm.punch import PowerPunch

__all__ = ["ExternalModel", "ExternalModelWithCurve", "connect"]


class ExternalModel:
    """A model in a process of its own.

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

    def __init__(self, child: Child, is_program: bool) -> None:
        self._child = child
        stated = child.description
        self.name, self.version = stated.name, stated.version
        self.citation, self.domain = stated.citation, stated.domain
        self.hashed, self.limits = stated.hashed, stated.limits
        self.physical, self.applies_to = stated.physical, stated.applies_to
        self.is_program = is_program

    def evaluate(self, problem: Problem, quantity: str, *, scales: int = 0) -> Result:
        """Return the quantity, or raise `NotApplicable` or `ComputationFailed`; nothing else."""
        if quantity not in QUANTITIES:
            raise ValueError(f"quantity {quantity!r} is unknown; the known ones are {', '.join(QUANTITIES)}")
        more = {"scales": scales} if scales else {}
        started = time.perf_counter()
        reply = self._reply({"request": "evaluate", "quantity": quantity, **more}, problem)
        return replace(result_of(reply), seconds=time.perf_counter() - started)

    def close(self) -> None:
        """End the process; the next request starts a new one."""
        self._child.close()

    def _reply(self, request: dict[str, Any], problem: Problem) -> dict[str, Any]:
        if problem.punch != PowerPunch(problem.n) or problem.law != LennardJones():
            raise NotApplicable("external models are evaluated for the power-law punch and the 9-3 law alone")
        return self._child.request({**request, "n": problem.n, "k": problem.k, "mu": problem.mu})


class ExternalModelWithCurve(ExternalModel):
    """A model in a process of its own that has a force-displacement curve as well."""

    def curve(self, problem: Problem) -> Curve:
        """Return the curve, or raise as `evaluate`."""
        return curve_of(self._reply({"request": "curve"}, problem))


def connect(source: dict[str, Any], spec: str, poisson_ratio: float | None = None) -> ExternalModel:
    """Start a process that loads the model, and return the model.

    Raises
    ------
    ValueError
        If the model cannot be loaded, or its name or texts are not admissible.
    """
    if os.name != "posix":
        raise ValueError("models that are code are run on Linux and macOS only; predictions as data everywhere")
    try:
        child = Child(source | {"poisson_ratio": poisson_ratio})
    except (ComputationFailed, NotApplicable) as failure:
        raise ValueError(f"the model {one_line(spec, 200)} cannot be loaded: {one_line(str(failure))}") from None
    cls = ExternalModelWithCurve if child.description.has_curve else ExternalModel
    return cls(child, source["kind"] == "program")
