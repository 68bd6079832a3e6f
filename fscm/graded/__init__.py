"""Solids whose modulus is any function of the depth: their surface compliance and their response to a ring."""

from fscm.graded.kernel import GradedKernel
from fscm.graded.response import GradedResponse, response_of

__all__ = ["GradedKernel", "GradedResponse", "response_of"]
