"""The atlas of the full self-consistent model: its values in microseconds."""

from __future__ import annotations

from typing import Any, ClassVar

import fscm
from comparisons.model import Curve, NotApplicable, Result
from comparisons.problem import Problem
from fscm.interpolation.coordinates import BOX
from fscm.interpolation.storage import data_digest

__all__ = ["Atlas"]

MODELS = {"atlas": "Atlas"}


class Atlas:
    """The function `fscm.atlas`; `u_num` is its bound.

    Examples
    --------
    >>> result = Atlas().evaluate(Problem.dimensionless(n=2, k=0.4, mu=1.0), "pull_off_force")
    >>> abs(result.value - 1.78848171) <= result.u_num
    True
    """

    name: ClassVar[str] = "atlas"
    citation: ClassVar[str] = "Chebyshev series of the full self-consistent model, fitted to its values at nodes"
    domain: ClassVar[str] = "1 <= n <= 6, 0 <= k <= 0.8, 0.01 <= mu <= 10"
    applies_to: ClassVar[dict[str, list[Any]]] = {
        "quantities": list(fscm.ATLAS_QUANTITIES),
        **{name: list(ends) for name, ends in BOX.items()},
    }

    @property
    def version(self) -> str:
        """Version of the adapter and digest of the data: another fit is another model."""
        return f"1+{data_digest()}"

    def evaluate(self, problem: Problem, quantity: str) -> Result:
        """Return the quantity, or raise as in `comparisons.model.Model`."""
        if quantity not in fscm.ATLAS_QUANTITIES:
            raise NotApplicable(f"the atlas does not contain {quantity}")
        try:
            value, bound = fscm.atlas(problem.n, problem.k, problem.mu, quantity)
        except (fscm.OutsideAtlas, fscm.NoSuchEvent) as reason:
            raise NotApplicable(str(reason)) from reason
        return Result(float(value), float(bound))

    def curve(self, problem: Problem) -> Curve:
        """Raise `NotApplicable`: the atlas has numbers only."""
        raise NotApplicable("the atlas has no force-displacement curve; fscm computes it")
