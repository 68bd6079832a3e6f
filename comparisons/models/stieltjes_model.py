"""The paper's own discretisation of the full self-consistent model as one of the models."""

from __future__ import annotations

import time
from typing import ClassVar

import numpy as np
from scipy.integrate import quad

from comparisons.model import ComputationFailed, Curve, NotApplicable, Result
from fscm.errors import NoSuchEvent, NotConverged
from fscm.problem import Problem
from fscm.stieltjes import StieltjesScheme, StieltjesState

__all__ = ["PublishedScheme"]

#: Quantity -> event of the path and what to read there.
_READINGS = {
    "pull_off_force": ("pull_off", "load"),
    "pull_off_displacement": ("pull_off", "displacement"),
    "jump_in_displacement": ("jump_in", "displacement"),
    "jump_in_gap": ("jump_in", "central_gap"),
    "jump_out_displacement": ("jump_out", "displacement"),
    "jump_out_gap": ("jump_out", "central_gap"),
    "zero_load_displacement": ("zero_load", "displacement"),
}

#: The scheme converges with the second power of the segment once the edge is resolved, so the difference to half as
#: many segments is three times the error; where it is not resolved, the difference is all there is to go by.
_SAFETY = 1.5


class PublishedScheme:
    """Eqs. 34-39 as published: N uniform segments up to f = 50, Riemann-Stieltjes sums, central-gap control.

    Parameters
    ----------
    segments : int
        N, even; the paper uses 2500.

    Notes
    -----
    `u_num` is the difference to N / 2 segments with a safety factor, plus what the truncation leaves out of load and
    displacement.  The seconds are those of the N segments alone: the published scheme has no error estimate.

    Examples
    --------
    >>> answer = PublishedScheme(segments=200).evaluate(Problem(n=2, k=0.4, mu=0.5), "pull_off_force")
    >>> abs(answer.value - 1.86628026) < answer.u_num
    True
    """

    name: ClassVar[str] = "fscm-stieltjes"
    version: ClassVar[str] = "1"
    citation: ClassVar[str] = "Zhu, Zheng, Huang & Yu, Sec. 2.4, Eqs. 34-39"
    domain: ClassVar[str] = "0 <= k < 1; cohesive edge wider than the segments; central gaps from 10 to -0.1"

    def __init__(self, segments: int = 2500) -> None:
        self._segments = segments

    def evaluate(self, problem: Problem, quantity: str) -> Result:
        """Return the quantity, or raise as `comparisons.model.Model` says."""
        if quantity not in _READINGS:
            raise NotApplicable(f"the published scheme is kept for points of the path, not for {quantity}")
        event, reading = _READINGS[quantity]
        started = time.perf_counter()
        state = self._event(problem, event, self._segments)
        seconds = time.perf_counter() - started
        coarse = self._event(problem, event, self._segments // 2)
        value, other = (float(getattr(found, reading)) for found in (state, coarse))
        return Result(
            value=-value if quantity == "pull_off_force" else value,
            u_num=_SAFETY * abs(value - other) + _left_out(problem, state.gap[-1], reading),
            size=self._segments,
            iterations=state.iterations,
            residual=0.0,
            seconds=seconds,
        )

    def curve(self, problem: Problem) -> Curve:
        """Return the path from a central gap of 10 to -0.1."""
        try:
            central_gap, displacement, load = self._scheme(problem, self._segments).curve()
        except NotConverged as failure:
            raise ComputationFailed(str(failure)) from failure
        return Curve(displacement=displacement, load=load, columns={"central_gap": central_gap})

    @staticmethod
    def _scheme(problem: Problem, segments: int) -> StieltjesScheme:
        if problem.k >= 1.0:
            raise NotApplicable("the published scheme is for k < 1")
        return StieltjesScheme(problem, segments)

    def _event(self, problem: Problem, event: str, segments: int) -> StieltjesState:
        try:
            return self._scheme(problem, segments).event(event)
        except NoSuchEvent as reason:
            raise NotApplicable(str(reason)) from reason
        except NotConverged as failure:
            raise ComputationFailed(str(failure)) from failure


def _left_out(problem: Problem, last_gap: float, reading: str) -> float:
    """What the traction beyond the last segment would add to the load or, at r = 0, to the displacement."""
    k, height = problem.k, problem.profile.height
    last = StieltjesScheme(problem, segments=10).radius[-1]

    def share(log_radius: float) -> float:
        r = np.array(last * np.exp(log_radius))
        gap = last_gap + height(r) - height(np.array(last))
        weight = 2.0 * r * r if reading == "load" else problem.compliance * (1.0 - k) * r ** (1.0 - k)
        return float(weight * problem.law.traction(gap))

    return abs(quad(share, 0.0, np.inf)[0])
