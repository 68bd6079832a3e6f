"""Bodies that are not one power law: surface compliance and response to a ring of pressure."""

from fscm.graded.kernel import GradedKernel
from fscm.graded.response import SurfaceResponse, response_of

__all__ = ["GradedKernel", "SurfaceResponse", "response_of"]
