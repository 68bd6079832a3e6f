"""Bodies that are not one power law: surface compliance and response to a ring of pressure."""

from fscm._surface.response.kernel import GradedKernel
from fscm._surface.response.response import SurfaceResponse, response_of
from fscm.problem import Problem

__all__ = ["GradedKernel", "SurfaceResponse", "largest_mu", "response_of"]


def largest_mu(problem: Problem) -> float:
    """The Tabor number of the softest part of the bodies: that of a power law is the only one."""
    if problem.graded is None:
        return problem.mu
    return response_of(problem.graded).largest_mu(problem.mu, problem.n)
