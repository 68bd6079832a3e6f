"""Width of the cohesive edge, and the narrowest one that can be computed."""

from __future__ import annotations

import math

from fscm._roots import bracketed_root
from fscm._surface.response import response_of
from fscm.errors import Failure, NotConverged
from fscm.problem import Problem

__all__ = ["check_edge", "log_edge_width"]

#: The width of the cohesive edge is (1.03 M)^(-1/(1-k)) for the 9-3 law; decimal logarithm of the least width, relative
#: to a contact radius, that is computed.  Measured: 26 s of CPU at 10^-16 (n = 2, k = 0.98, mu = 1) and 55 s and 3 GB
#: at 10^-21 (k = 0.985; half the memory since); the number of panels grows with the logarithm.
_EDGE, _NARROWEST = 1.03, -22.0


def log_edge_width(problem: Problem) -> float:
    """Decimal logarithm of the width of the cohesive edge.

    Examples
    --------
    >>> round(log_edge_width(Problem(n=2, k=0.4, mu=1.0)), 2)
    -0.52
    """
    return -math.log10(_EDGE * problem.compliance) / (1.0 - problem.k)


def _log_width(problem: Problem, log_mu: float) -> float:
    """Decimal logarithm of the width of the cohesive edge over the contact radius, about (n mu)^(1/n), at log10 mu."""
    n, k = problem.n, problem.k
    log_M = math.log10(2.0) + (2.0 * n + k - 1.0) / n * log_mu
    radius = max(math.log10(n) + log_mu, 0.0) / n
    return -(math.log10(_EDGE) + log_M) / (1.0 - k) - radius


def check_edge(problem: Problem) -> None:
    """Raise NotConverged for a cohesive edge that needs too many panels; surface tension makes the edge wider."""
    if problem.graded is not None and problem.k not in response_of(problem.graded).singular_parts:
        return
    log_mu = math.log10(problem.mu)
    if _log_width(problem, log_mu) < _NARROWEST:
        largest = bracketed_root(lambda x: _log_width(problem, x) - _NARROWEST, -400.0, log_mu)
        raise NotConverged(
            f"the contact edge of {problem} is about 10^{_log_width(problem, log_mu):.0f} of its radius wide, below "
            f"10^{_NARROWEST:.0f}, which needs too much memory: the largest Tabor number at n = {problem.n:g}, "
            f"k = {problem.k:g} is mu = {10.0**largest:.3g}",
            Failure.MESH,
        )
