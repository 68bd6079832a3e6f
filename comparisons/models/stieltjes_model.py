"""The Stieltjes scheme: the paper's own discretisation of the full self-consistent model."""

from __future__ import annotations

from typing import ClassVar

from comparisons.model import Curve, NotApplicable, Result
from comparisons.models.solver import result_of, translated
from comparisons.problem import Problem
from fscm.errors import NoSuchEvent, NotConverged
from fscm.stieltjes import STIELTJES_QUANTITIES, StieltjesScheme, stieltjes_solution

__all__ = ["CoarseStieltjesModel", "StieltjesModel"]

MODELS = {"fscm-stieltjes": "StieltjesModel", "fscm-stieltjes-400": "CoarseStieltjesModel"}


class StieltjesModel:
    """Eqs. 34-39 as printed in the paper: N uniform segments up to f = 50, Riemann-Stieltjes sums, central-gap control.

    Parameters
    ----------
    segments : int
        N; the paper uses 2500.

    Examples
    --------
    >>> result = StieltjesModel(segments=200).evaluate(Problem.dimensionless(n=2, k=0.4, mu=0.5), "pull_off_force")
    >>> abs(result.value - 1.86628026) < result.u_num
    True
    """

    name: ClassVar[str] = "fscm-stieltjes"
    version: ClassVar[str] = "1"
    citation: ClassVar[str] = "Zhu, Zheng, Huang & Yu, Sec. 2.4, Eqs. 34-39"
    domain: ClassVar[str] = "k < 1, central gaps from 10 to -0.4, cohesive edge wider than the 2500 segments"

    def __init__(self, segments: int = 2500) -> None:
        self._segments = segments

    def evaluate(self, problem: Problem, quantity: str) -> Result:
        """Return the quantity, or raise as in `comparisons.model.Model`."""
        if quantity not in STIELTJES_QUANTITIES:
            raise NotApplicable(f"the Stieltjes scheme is for points of the path, not for {quantity}")
        _check(problem)
        with translated(NoSuchEvent, NotConverged):
            return result_of(stieltjes_solution(problem.posed, quantity, self._segments))

    def curve(self, problem: Problem) -> Curve:
        """Return the path from a central gap of 10 to the first compressive load, at the latest to a gap of -0.4."""
        _check(problem)
        with translated(NoSuchEvent, NotConverged):
            central_gap, displacement, load = StieltjesScheme(problem.posed, self._segments).curve()
        return Curve(displacement=displacement, load=load, columns={"central_gap": central_gap})


class CoarseStieltjesModel(StieltjesModel):
    """The same with 400 segments: a second instead of minutes.

    At small and moderate Tabor numbers what it leaves out beyond f = 50 is most of its error, with 2500
    segments as with 400 (n = 2, k = 0, mu = 0.5: 0.06 % of the pull-off force with either).

    Examples
    --------
    >>> CoarseStieltjesModel().name
    'fscm-stieltjes-400'
    """

    name: ClassVar[str] = "fscm-stieltjes-400"
    domain: ClassVar[str] = StieltjesModel.domain.replace("2500", "400")

    def __init__(self) -> None:
        super().__init__(segments=400)


def _check(problem: Problem) -> None:
    if problem.k >= 1.0:
        raise NotApplicable(f"the Stieltjes scheme is for k < 1, not k = {problem.k:g}")
