"""The full self-consistent model as one of the models: the reference the others are compared with."""

from __future__ import annotations

from typing import ClassVar

import fscm
from comparisons.model import ComputationFailed, Curve, NotApplicable, Result
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
    domain: ClassVar[str] = "n > 2/3, 0 <= k <= 0.8, 0.01 <= mu <= 10"

    def evaluate(self, problem: Problem, quantity: str) -> Result:
        """Return the quantity, or raise as `comparisons.model.Model` says."""
        try:
            solution = fscm.solve(problem, quantity)
        except fscm.NoSuchEvent as reason:
            raise NotApplicable(str(reason)) from reason
        except fscm.NotConverged as failure:
            raise ComputationFailed(str(failure)) from failure
        return Result(
            value=solution.value,
            u_num=solution.u_num,
            size=solution.size,
            iterations=solution.iterations,
            residual=solution.residual,
            seconds=solution.seconds,
        )

    def curve(self, problem: Problem) -> Curve:
        """Return the whole equilibrium path, from far away into contact."""
        try:
            path = fscm.trace(problem)
        except fscm.NotConverged as failure:
            raise ComputationFailed(str(failure)) from failure
        columns = {"central_gap": path.central_gap, "edge_radius": path.edge_radius}
        return Curve(displacement=path.displacement, load=path.load, columns=columns)
