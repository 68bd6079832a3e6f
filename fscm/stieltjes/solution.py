"""Quantities from the Stieltjes scheme with their numerical uncertainty."""

from __future__ import annotations

import math
import time
from functools import lru_cache

import numpy as np

from fscm._threads import one_thread
from fscm.problem import Problem
from fscm.quantities import TABLE, AtEvent
from fscm.solution import Parts, Solution
from fscm.stieltjes.events import find_event
from fscm.stieltjes.scheme import StieltjesScheme, StieltjesState

__all__ = ["STIELTJES_QUANTITIES", "stieltjes_solution"]

#: From N/2 to N segments the error falls fourfold, so that the difference is three times the error at N if the edge is
#: resolved; the factor covers coarser meshes.  Measured worst error / u_num is 0.65 over n = 1 to 5, k = 0, 0.3, 0.6,
#: mu = 0.2, 0.8, 1.4 on 160 segments, wherever it converges.
_SAFETY = 2.0

#: The quantities at one event of the path; the states of the scheme have no energy.
STIELTJES_QUANTITIES = {
    name: row for name, row in TABLE.items() if isinstance(row, AtEvent) and row.functional != "energy"
}


@lru_cache(maxsize=2)
def _scheme(problem: Problem, segments: int, **settings: float) -> StieltjesScheme:
    """Scheme whose path serves every quantity of a problem: the last one and that on half as many segments."""
    return StieltjesScheme(problem, segments, **settings)


@one_thread()
def stieltjes_solution(problem: Problem, quantity: str, segments: int = 2500, **settings: float) -> Solution:
    """One quantity from the Stieltjes scheme, with its numerical uncertainty.

    The uncertainty is the difference to half as many segments, and the contribution of the traction beyond f(r_max),
    both with a safety factor.

    Parameters
    ----------
    problem : Problem
    quantity : str
        One of `STIELTJES_QUANTITIES`.
    segments : int
        N, at least 20.
    **settings
        farthest_height, gap_step, first_gap, last_gap and last_load of `StieltjesScheme`.

    Raises
    ------
    NoSuchEvent, NotConverged, ValueError
        As `find_event` and `StieltjesScheme`.

    Examples
    --------
    >>> found = stieltjes_solution(Problem(2, 0.4, 0.5), "pull_off_force", 200, gap_step=0.2)
    >>> bool(abs(found.value - 1.86628026) < found.u_num < 0.01)
    True
    """
    if quantity not in STIELTJES_QUANTITIES:
        raise ValueError(f"unknown quantity {quantity!r}; known are {', '.join(STIELTJES_QUANTITIES)}")
    start = time.perf_counter()
    row = STIELTJES_QUANTITIES[quantity]
    scheme = _scheme(problem, segments, **settings)
    state = find_event(scheme, row.event)
    value = row.value(state)
    coarse = row.value(find_event(_scheme(problem, segments // 2, **settings), row.event))
    parts = Parts(mesh=_SAFETY * abs(value - coarse), tail=_SAFETY * _beyond(scheme, state, row))
    iterations = sum(s.iterations for s in scheme.path)
    return Solution(value, parts, segments, iterations, state.change, time.perf_counter() - start)


def _beyond(scheme: StieltjesScheme, state: StieltjesState, row: AtEvent) -> float:
    """Bound on the effect of the traction beyond the last segment."""
    load, displacement = (_tail(scheme, state, x) for x in (2.0, 1.0 - scheme.problem.k))
    if row.kind == "load":
        return load
    if row.event == "zero_load":
        rates = scheme.rates(state)
        return displacement * scheme.problem.compliance + load * abs(rates.displacement / rates.load)
    return displacement * scheme.problem.compliance


def _tail(scheme: StieltjesScheme, state: StieltjesState, exponent: float) -> float:
    """Size of the integral of p d(r^exponent) beyond the last segment, where w hardly changes."""
    from scipy.integrate import quad

    problem, radius = scheme.problem, float(scheme.radius[-1])
    shift = float(state.gap[-1]) - scheme.farthest_height

    def density(log_ratio: float) -> float:
        r = np.array([radius * math.exp(log_ratio)])
        gap = problem.punch.height(r) + shift
        return float((problem.law.traction(gap) * exponent * r**exponent)[0])

    # In log r the integrand decays exponentially; it is negligible where f has grown by e^60.
    return abs(float(quad(density, 0.0, 60.0 / problem.punch.growth, limit=200)[0]))
