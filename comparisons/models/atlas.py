"""The atlas of `fscm` as a model."""

from __future__ import annotations

from typing import ClassVar

import fscm
from comparisons.model import Result
from comparisons.models.solver import SolverModel
from comparisons.problem import Problem
from fscm.interpolation.coordinates import BOX
from fscm.interpolation.storage import data_digest


class Atlas(SolverModel):
    """The function `fscm.atlas`, the values in microseconds; `u_num` is its bound.

    Examples
    --------
    >>> result = Atlas().evaluate(Problem.dimensionless(n=2, k=0.4, mu=1.0), "pull_off_force")
    >>> abs(result.value - 1.78848171) <= result.u_num
    True
    """

    name: ClassVar[str] = "atlas"
    citation: ClassVar[str] = "Chebyshev series of the full self-consistent model, fitted to its values at nodes"
    domain: ClassVar[str] = "1 <= n <= 6, 0 <= k <= 0.8, 0.01 <= mu <= 10"
    package = fscm
    quantities = fscm.ATLAS_QUANTITIES

    def __init__(self) -> None:
        # Another fit is another model.
        self.version = f"1+{data_digest()}"

    def skip(self, problem: Problem, quantity: str) -> str | None:
        """Return why not outside the box of the series."""
        if reason := super().skip(problem, quantity):
            return reason
        for name, (low, high) in BOX.items():
            value = getattr(problem, name)
            if not low <= value <= high:
                return (
                    f"{name} = {value:g} is outside [{low:g}, {high:g}], the range of the atlas; fscm has a wider one"
                )
        return None

    def _result(self, problem: Problem, quantity: str) -> Result:
        value, bound = fscm.atlas(problem.n, problem.k, problem.mu, quantity)
        return Result(float(value), float(bound))
