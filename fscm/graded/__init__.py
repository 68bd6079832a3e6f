"""Solids with any E(z) and nu(z): surface compliance and response to a ring of pressure."""

from fscm.graded.kernel import GradedKernel
from fscm.graded.response import GradedResponse, response_of

__all__ = ["GradedKernel", "GradedResponse", "response_of"]
