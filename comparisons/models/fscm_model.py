"""The full self-consistent model as one of the models: the reference the others are compared with."""

from __future__ import annotations

from typing import ClassVar

import fscm
from comparisons.model import Curve, Result
from comparisons.models.solver import result_of, translated
from fscm.problem import Problem

__all__ = ["FullSelfConsistent"]


class FullSelfConsistent:
    """The package `fscm`, its exceptions translated into those of the model contract.

    Examples
    --------
    >>> answer = FullSelfConsistent().evaluate(Problem(n=2, k=0.4, mu=1.0), "pull_off_force")
    >>> round(answer.value, 8)
    1.78848171
    """

    name: ClassVar[str] = "fscm"
    version: ClassVar[str] = "1"
    citation: ClassVar[str] = "Zhu, Zheng, Huang & Yu, Eqs. 24-33, by adaptive panels and product integration"
    domain: ClassVar[str] = (
        "n > 2/3, 0 <= k <= 1; to the digits of u_num where the cohesive edge is wider than 1e-6"
    )

    def evaluate(self, problem: Problem, quantity: str) -> Result:
        """Return the quantity, or raise as `comparisons.model.Model` says."""
        with translated(fscm.NoSuchEvent, fscm.NotConverged):
            return result_of(fscm.solve(problem, quantity))

    def curve(self, problem: Problem) -> Curve:
        """Return the whole equilibrium path, from far away into contact."""
        with translated(fscm.NoSuchEvent, fscm.NotConverged):
            path = fscm.trace(problem)
        columns = {"central_gap": path.central_gap, "edge_radius": path.edge_radius}
        return Curve(displacement=path.displacement, load=path.load, columns=columns)
